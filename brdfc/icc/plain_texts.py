"""Texts of other kinds: `text` and `desc` (version 2's textDescriptionType), `zut8`, `zxml`
and `ZXML`."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from typing import ClassVar

from brdfc.icc.layout import unpack
from brdfc.icc.signatures import signature_bytes
from brdfc.icc.tag import Tag
from brdfc.source.errors import ProfileError

SCRIPT_BYTES = 67
"""Bytes that the Macintosh part of a `desc` takes, whatever its count says."""

INFLATED_LIMIT = 16 * 1024 * 1024
"""A compressed text is read up to so many bytes."""


@dataclass(frozen=True)
class PlainText(Tag):
    """`text`: seven-bit ASCII, ended by a NUL; other bytes are kept as Latin-1."""

    type_signature: ClassVar[str] = "text"
    text: str

    def encode(self) -> bytes:
        return b"text" + bytes(4) + _latin1(self.text) + b"\0"

    @staticmethod
    def decode(data: bytes, where: str) -> PlainText:
        text, terminator, _ = data[8:].partition(b"\0")
        if not terminator:
            raise ProfileError("the text has no terminating NUL", where=where)
        return PlainText(text.decode("latin-1"))


@dataclass(frozen=True)
class TextDescription(Tag):
    """`desc`: a text in ASCII, and if there are any in UTF-16 and in a Macintosh script.

    unicode: without its terminating NUL; language and script_code as the file has them. script:
    up to 67 bytes. Profiles end after any of the three parts; a missing one reads as empty.
    """

    type_signature: ClassVar[str] = "desc"
    text: str
    unicode: str = ""
    language: int = 0
    script: bytes = b""
    script_code: int = 0

    def encode(self) -> bytes:
        text = _latin1(self.text) + b"\0"
        wide = (self.unicode + "\0").encode("utf-16-be", "surrogatepass") if self.unicode else b""
        try:
            return (
                struct.pack(">4sII", b"desc", 0, len(text))
                + text
                + struct.pack(">II", self.language, len(wide) // 2)
                + wide
                + struct.pack(">HB", self.script_code, len(self.script))
                + struct.pack(f"{SCRIPT_BYTES}s", _fitting(self.script))
            )
        except struct.error as error:
            raise ProfileError(f"'desc' cannot hold a value: {error}") from error

    @staticmethod
    def decode(data: bytes, where: str) -> TextDescription:
        return read_description(data, 0, where)[0]


def read_description(data: bytes, offset: int, where: str) -> tuple[TextDescription, int]:
    """The description at an offset, and where it ends."""
    (count,) = unpack("I", data, offset + 8, where)
    start = offset + 12
    (text,) = unpack(f"{min(count, len(data) + 1)}s", data, start, where)
    place = start + count
    text = text.partition(b"\0")[0].decode("latin-1")
    if place + 8 > len(data):
        return TextDescription(text), len(data)
    language, count = unpack("II", data, place, where)
    place += 8
    if place + 2 * count > len(data):
        raise ProfileError(
            f"{count} UTF-16 codes from byte {place} on, in {len(data)} bytes", where=where
        )
    wide = data[place : place + 2 * count].decode("utf-16-be", "surrogatepass").partition("\0")[0]
    place += 2 * count
    if place + 3 > len(data):
        return TextDescription(text, wide, language), len(data)
    code, count = unpack("HB", data, place, where)
    script = data[place + 3 : place + 3 + min(count, SCRIPT_BYTES)]
    end = min(len(data), place + 3 + SCRIPT_BYTES)
    return TextDescription(text, wide, language, script, code), end


def _fitting(script: bytes) -> bytes:
    if len(script) > SCRIPT_BYTES:
        raise ProfileError(f"a script text has up to {SCRIPT_BYTES} bytes, not {len(script)}")
    return script


@dataclass(frozen=True)
class CompressedText(Tag):
    """`zut8`, `zxml` or `ZXML`: UTF-8 as compressed by zlib, inflated only when asked
    for."""

    kind: str
    data: bytes

    @property
    def type_signature(self) -> str:
        return self.kind

    @property
    def text(self) -> str:
        """The text; ProfileError if it is none, or longer than INFLATED_LIMIT."""
        inflater = zlib.decompressobj()
        try:
            text = inflater.decompress(self.data, INFLATED_LIMIT)
            if not inflater.eof:
                fault = "goes on beyond" if inflater.unconsumed_tail else "ends within"
                raise ProfileError(
                    f"the compressed text {fault} {len(text):,} bytes", where=f"'{self.kind}'"
                )
            return text.rstrip(b"\0").decode("utf-8")
        except (zlib.error, UnicodeDecodeError) as error:
            raise ProfileError(f"no compressed text: {error}", where=f"'{self.kind}'") from error

    def encode(self) -> bytes:
        return signature_bytes(self.kind) + bytes(4) + self.data

    @staticmethod
    def decode(data: bytes, where: str) -> CompressedText:
        return CompressedText(data[:4].decode("latin-1"), data[8:])


def _latin1(text: str) -> bytes:
    try:
        data = text.encode("latin-1")
    except UnicodeEncodeError as error:
        raise ProfileError(f"no Latin-1 text: {text[:40]!r}") from error
    if b"\0" in data:
        raise ProfileError(f"a text with a NUL inside: {text[:40]!r}")
    return data
