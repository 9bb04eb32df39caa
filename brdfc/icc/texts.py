"""Tag types that hold text: `mluc`, `utf8`, `tary` of utf8, and `dict`."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import ClassVar
from xml.sax.saxutils import escape

from brdfc.icc.layout import read_parts, unpack, unpack_records, write_parts
from brdfc.icc.signatures import signature_bytes, signature_text
from brdfc.icc.tag import Tag
from brdfc.source.errors import ProfileError


@dataclass(frozen=True)
class LocalizedText(Tag):
    """`mluc`: one text in several languages, as pairs such as ("enUS", "Ward, matte paper")."""

    type_signature: ClassVar[str] = "mluc"
    records: tuple[tuple[str, str], ...]

    @staticmethod
    def english(text: str) -> LocalizedText:
        """The text in one language, US English, which is what profiles are written with."""
        return LocalizedText((("enUS", text),))

    @property
    def text(self) -> str:
        """The US English text, or the first; "" if there is none."""
        texts = dict(reversed(self.records))
        return texts.get("enUS", self.records[0][1] if self.records else "")

    def encode(self) -> bytes:
        start = 16 + 12 * len(self.records)
        texts = [text for _, text in self.records]
        places, body = write_parts(texts, _utf16, key=str, start=start, align=2)
        head = struct.pack(">4sIII", b"mluc", 0, len(self.records), 12)
        for (language, _), (offset, size) in zip(self.records, places, strict=True):
            head += signature_bytes(language) + struct.pack(">II", size, offset)
        return head + body

    @staticmethod
    def decode(data: bytes, where: str) -> LocalizedText:
        count, width = unpack("II", data, 8, where)
        if width != 12:
            raise ProfileError(f"text records of {width} bytes, not 12", where=where)
        records = unpack_records("4sII", count, data, 16, where)
        languages = [signature_text(language) for language, _, _ in records]
        places = [(offset, size) for _, size, offset in records]
        labels = [f"text {language!r}" for language in languages]
        texts = read_parts(data, places, labels, 16 + 12 * count, where, _from_utf16)
        return LocalizedText(tuple(zip(languages, texts, strict=True)))


@dataclass(frozen=True)
class Utf8Text(Tag):
    """`utf8`: one text, ended by a NUL that counts as part of the tag."""

    type_signature: ClassVar[str] = "utf8"
    text: str

    def encode(self) -> bytes:
        return b"utf8" + bytes(4) + _utf8(self.text) + b"\0"

    @staticmethod
    def decode(data: bytes, where: str) -> Utf8Text:
        text, terminator, padding = data[8:].partition(b"\0")
        if not terminator:
            raise ProfileError("the text has no terminating NUL", where=where)
        if padding.strip(b"\0"):
            # Readers that stop at the NUL and readers that do not would see different names.
            raise ProfileError("the text goes on after its terminating NUL", where=where)
        try:
            return Utf8Text(text.decode("utf-8"))
        except UnicodeDecodeError as error:
            raise ProfileError(
                f"not UTF-8: {error.reason} at byte {8 + error.start}", where=where
            ) from error


@dataclass(frozen=True)
class Utf8Array(Tag):
    """`tary` of utf8: names, such as those of the multiplex channels (`mcta`).

    The array signature is `utf8`: with any other the reference validates but does not connect.
    """

    type_signature: ClassVar[str] = "tary"
    names: tuple[str, ...]

    def encode(self) -> bytes:
        places, body = write_parts(
            self.names,
            lambda name: Utf8Text(name).encode(),
            key=str,
            start=16 + 8 * len(self.names),
        )
        head = struct.pack(">4sI4sI", b"tary", 0, b"utf8", len(self.names))
        return head + b"".join(struct.pack(">II", *place) for place in places) + body

    @staticmethod
    def decode(data: bytes, where: str) -> Utf8Array:
        (count,) = unpack("I", data, 12, where)
        places = unpack_records("II", count, data, 16, where)
        labels = [f"name {index}" for index in range(count)]
        names = read_parts(data, places, labels, 16 + 8 * count, where, _array_entry)
        return Utf8Array(tuple(names))


def _array_entry(data: bytes, where: str) -> str:
    if not data:
        return ""  # an offset and size of 0 stand for no entry
    if data[:4] != b"utf8":
        raise ProfileError(f"an entry of type {data[:4]!r}, not utf8", where=where)
    return Utf8Text.decode(data, where).text


# 2.2.61 of the reference copies each through a buffer of 256 bytes when it writes XML.
DICTIONARY_TEXT_LIMIT = 200


@dataclass(frozen=True)
class Dictionary(Tag):
    """`dict`: names and values, in the order of the file.

    Display names, which other writers may add, are passed over on reading, and a value that is
    undefined reads as "".
    """

    type_signature: ClassVar[str] = "dict"
    entries: tuple[tuple[str, str], ...]

    def get(self, name: str) -> str | None:
        """The first value under this name, or None."""
        return next((value for key, value in self.entries if key == name), None)

    def encode(self) -> bytes:
        texts = [text for entry in self.entries for text in entry]
        for text in texts:
            _refuse_long(text)
        places, body = write_parts(texts, _utf16, key=str, start=16 + 16 * len(self.entries))
        head = struct.pack(">4sIII", b"dict", 0, len(self.entries), 16)
        return head + b"".join(struct.pack(">II", *place) for place in places) + body

    @staticmethod
    def decode(data: bytes, where: str) -> Dictionary:
        count, width = unpack("II", data, 8, where)
        if width not in (16, 24, 32):
            raise ProfileError(f"records of {width} bytes, not 16, 24 or 32", where=where)
        records = unpack_records(f"IIII{width - 16}x", count, data, 16, where)
        places = [place for a, b, c, d in records for place in ((a, b), (c, d))]
        labels = [f"{part} {index}" for index in range(count) for part in ("name", "value")]
        texts = read_parts(data, places, labels, 16 + width * count, where, _from_utf16)
        return Dictionary(tuple(zip(texts[::2], texts[1::2], strict=True)))


def _refuse_long(text: str) -> None:
    length = len(_utf8(escape(text, {'"': "&quot;", "'": "&apos;"})))
    if length > DICTIONARY_TEXT_LIMIT:
        raise ProfileError(
            f"a dictionary text of {length} bytes, escaped for XML, is over "
            f"{DICTIONARY_TEXT_LIMIT}: {text[:40]!r}...",
            hint="split long text over numbered entries",
        )


def _utf8(text: str) -> bytes:
    if "\0" in text:
        raise ProfileError(f"a text with a NUL inside: {text[:40]!r}")
    try:
        return text.encode("utf-8")
    except UnicodeEncodeError as error:
        raise ProfileError(f"no Unicode text: {text[:40]!r}") from error


def _utf16(text: str) -> bytes:
    try:
        return text.encode("utf-16-be")
    except UnicodeEncodeError as error:
        raise ProfileError(f"no Unicode text: {text[:40]!r}") from error


def _from_utf16(data: bytes, where: str) -> str:
    try:
        return data.decode("utf-16-be")
    except UnicodeDecodeError as error:
        raise ProfileError(
            f"not UTF-16: {error.reason} at byte {error.start}", where=where
        ) from error
