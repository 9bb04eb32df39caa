"""A profile: a header and tags, to bytes and back."""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from brdfc.files import read_file, write_whole
from brdfc.icc.header import HEADER_SIZE, Header
from brdfc.icc.layout import read_parts, unpack, unpack_records, write_parts
from brdfc.icc.signatures import signature_bytes, signature_text
from brdfc.icc.types import Tag, decode_tag
from brdfc.source.errors import ProfileError, ProgramError

FILE_LIMIT = 48 * 1024 * 1024
"""Larger files are not read, nor written: a table is held three times while it is read. Profiles
with the largest spectral tables stay well below."""

TABLE_START = HEADER_SIZE + 4


@dataclass(frozen=True)
class Profile:
    """A header and tags by signature ("A2M0"), in the order of the file.

    A tag that stands under two signatures as the same object is written once. source are the
    bytes a profile was read from, which validate judges the layout by; a profile that was made,
    or changed with dataclasses.replace, has none.
    """

    header: Header
    tags: Mapping[str, Tag]
    source: bytes | None = field(default=None, init=False, compare=False, repr=False)

    def to_bytes(self, *, profile_id: bool | None = None) -> bytes:
        """The profile as a file has it; the same profile gives the same bytes.

        profile_id: True puts the MD5 of the contents into the header, False zeros, "not
        computed". None leaves a profile that was read and not changed as it was read, byte for
        byte, and computes the ID of any other. Before version 4 there was none.
        """
        if self.source is not None and profile_id is None:
            return self.source
        data = self._encoded() if self.source is None else self.source
        if self.header.major_version < 4:
            return data
        return (
            data[:84]
            + (bytes(16) if profile_id is False else compute_profile_id(data))
            + data[100:]
        )

    def _encoded(self) -> bytes:
        """The bytes of the header, without a profile ID, and of the tags in their order."""
        start = TABLE_START + 12 * len(self.tags)
        places, body = write_parts(
            self.tags.items(), _encode_entry, key=lambda entry: id(entry[1]), start=start
        )
        size = start + len(body)
        if size > FILE_LIMIT:
            raise ProfileError(f"a profile of {size:,} bytes is over {FILE_LIMIT:,}")
        table = struct.pack(">I", len(self.tags))
        for signature, place in zip(self.tags, places, strict=True):
            table += signature_bytes(signature) + struct.pack(">II", *place)
        return replace(self.header, profile_id=bytes(16)).encode(size) + table + body

    def save(self, path: str | Path, *, profile_id: bool | None = None) -> None:
        """Write the profile to a file, whole or not at all."""
        write_whole(path, self.to_bytes(profile_id=profile_id))

    @staticmethod
    def from_bytes(data: bytes, where: str = "profile") -> Profile:
        """The profile that these bytes are; ProfileError, naming where, if they are none.

        Whatever can be read is accepted; what is readable and wrong is validate's to say.
        """
        _check_is_profile(data, where)
        header = Header.decode(data, where)
        (count,) = unpack("I", data, HEADER_SIZE, where)
        table_where = f"{where}, tag table"
        records = unpack_records("4sII", count, data, TABLE_START, table_where)
        signatures = [signature_text(signature) for signature, _, _ in records]
        tags = read_parts(
            data,
            [(offset, size) for _, offset, size in records],
            [f"tag '{signature}'" for signature in signatures],
            TABLE_START + 12 * count,
            where,
            decode_tag,
        )
        by_signature: dict[str, Tag] = {}
        for signature, tag in zip(signatures, tags, strict=True):
            # Where a signature stands twice the first counts, as for the reference.
            by_signature.setdefault(signature, tag)
        profile = Profile(header, by_signature)
        object.__setattr__(profile, "source", data)
        return profile

    @staticmethod
    def load(path: str | Path) -> Profile:
        """The profile in a file."""
        return Profile.from_bytes(read_file(path, limit=FILE_LIMIT), where=str(path))


def _encode_entry(entry: tuple[str, Tag]) -> bytes:
    signature, tag = entry
    try:
        return tag.to_bytes()
    except (ProfileError, ProgramError) as error:
        raise ProfileError(error.message, where=f"tag '{signature}'", hint=error.hint) from error


def compute_profile_id(data: bytes) -> bytes:
    """MD5 of a profile's bytes with flags, rendering intent and the ID taken as zero."""
    digest = hashlib.md5(usedforsecurity=False)
    digest.update(data[:44] + bytes(4) + data[48:64] + bytes(4) + data[68:84] + bytes(16))
    digest.update(memoryview(data)[100:])
    return digest.digest()


def _check_is_profile(data: bytes, where: str) -> None:
    if not data:
        raise ProfileError("not an ICC profile: the file is empty", where=where)
    if data[36:40] != b"acsp":
        looks = _looks_like(data)
        like = f"it looks like {looks}" if looks else "'acsp' is missing at byte 36"
        raise ProfileError(f"not an ICC profile: {like}", where=where)
    if len(data) < TABLE_START:
        raise ProfileError(
            f"truncated: {len(data)} bytes, where the header alone takes {TABLE_START}",
            where=where,
        )
    (size,) = unpack("I", data, 0, where)
    if size != len(data):
        fault = "truncated" if size > len(data) else "bytes after the end"
        raise ProfileError(
            f"{fault}: the header says {size} bytes, there are {len(data)}",
            where=f"{where}, header at byte 0",
        )


_BEGINNINGS = {
    b"II*\0": "a TIFF image",
    b"MM\0*": "a TIFF image",
    b"II+\0": "a BigTIFF image",
    b"MM\0+": "a BigTIFF image",
    b"\x89PNG": "a PNG image",
    b"\xff\xd8\xff": "a JPEG image",
    b"GIF8": "a GIF image",
    b"v/1\x01": "an OpenEXR image",
    b"%PDF": "a PDF document",
    b"PK\x03\x04": "a ZIP archive",
    b"\x1f\x8b": "gzip-compressed data",
    b"<?xml": "XML",
}


def _looks_like(data: bytes) -> str | None:
    for beginning, name in _BEGINNINGS.items():
        if data.startswith(beginning):
            return name
    try:
        text = data[:1024].decode("utf-8")
    except UnicodeDecodeError as error:
        if error.start < 1000:  # otherwise a character cut at the end
            return None
        text = data[: error.start].decode("utf-8")
    return "text" if all(c.isprintable() or c.isspace() for c in text) else None
