"""`tary` of anything but names: tags of one type, such as colorantInfo's structures."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from brdfc.icc.layout import read_parts, unpack, unpack_records, write_parts
from brdfc.icc.signatures import signature_bytes, signature_text
from brdfc.icc.tag import Tag


@dataclass(frozen=True)
class TagArray(Tag):
    """kind: the array's own signature, such as "cinf"; entries: whole tags, or None for none."""

    type_signature: ClassVar[str] = "tary"
    kind: str
    entries: tuple[Tag | None, ...]

    def encode(self) -> bytes:
        there = [entry for entry in self.entries if entry is not None]
        start = 16 + 8 * len(self.entries)
        places, body = write_parts(there, lambda tag: tag.to_bytes(), key=id, start=start)
        remaining = iter(places)
        head = struct.pack(">4sI4sI", b"tary", 0, signature_bytes(self.kind), len(self.entries))
        for entry in self.entries:
            head += struct.pack(">II", *((0, 0) if entry is None else next(remaining)))
        return head + body

    @staticmethod
    def decode(data: bytes, where: str, entry: Callable[[bytes, str], Tag]) -> TagArray:
        """entry: what decodes the bytes of an entry."""
        kind, count = unpack("4sI", data, 8, where)
        places = unpack_records("II", count, data, 16, where)
        labels = [f"entry {index}" for index in range(count)]
        entries = read_parts(
            data,
            places,
            labels,
            16 + 8 * count,
            where,
            lambda part, at: entry(part, at) if part else None,
        )
        return TagArray(signature_text(kind), tuple(entries))
