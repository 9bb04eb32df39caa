"""`tstr`: a structure, whose members are tags under names of four letters."""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

from brdfc.icc.layout import read_parts, unpack, unpack_records, write_parts
from brdfc.icc.signatures import signature_bytes, signature_text
from brdfc.icc.tag import Tag


@dataclass(frozen=True)
class Structure(Tag):
    """kind: the structure's own signature, such as "brdf"; members: tags by signature, in the
    order of the file."""

    type_signature: ClassVar[str] = "tstr"
    kind: str
    members: Mapping[str, Tag]

    def encode(self) -> bytes:
        start = 16 + 12 * len(self.members)
        places, body = write_parts(
            self.members.values(), lambda tag: tag.to_bytes(), key=id, start=start
        )
        head = struct.pack(">4sI4sI", b"tstr", 0, signature_bytes(self.kind), len(self.members))
        for name, place in zip(self.members, places, strict=True):
            head += signature_bytes(name) + struct.pack(">II", *place)
        return head + body

    @staticmethod
    def decode(data: bytes, where: str, member: Callable[[bytes, str], Tag]) -> Structure:
        """member: what decodes the bytes of a member's tag."""
        kind, count = unpack("4sI", data, 8, where)
        records = unpack_records("4sII", count, data, 16, where)
        names = [signature_text(name) for name, _, _ in records]
        tags = read_parts(
            data,
            [(offset, size) for _, offset, size in records],
            [f"member '{name}'" for name in names],
            16 + 12 * count,
            where,
            member,
        )
        members: dict[str, Tag] = {}
        for name, tag in zip(names, tags, strict=True):
            members.setdefault(name, tag)
        return Structure(signature_text(kind), members)
