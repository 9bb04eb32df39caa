"""`ncl2`: named colours of versions 2 and 4."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import ClassVar

from brdfc.icc.layout import unpack, unpack_records
from brdfc.icc.records import name_bytes, read_name
from brdfc.icc.tag import Tag
from brdfc.source.errors import ProfileError

MAX_COORDINATES = 255
"""Device coordinates of a colour; the format's own colour spaces have up to 15."""

_ROWS = 84
"""Where the colours begin."""


@dataclass(frozen=True)
class NamedColour:
    """A name; the PCS and the device coordinates as 16-bit codes."""

    name: str
    pcs: tuple[int, int, int]
    device: tuple[int, ...]


@dataclass(frozen=True)
class NamedColours(Tag):
    """coordinates: how many device coordinates every colour has. prefix and suffix stand around
    every name."""

    type_signature: ClassVar[str] = "ncl2"
    colours: tuple[NamedColour, ...]
    coordinates: int
    prefix: str = ""
    suffix: str = ""
    vendor_flags: int = 0

    def encode(self) -> bytes:
        if not 0 <= self.coordinates <= MAX_COORDINATES:
            raise ProfileError(f"{self.coordinates} coordinates, not 0 to {MAX_COORDINATES}")
        prefix, suffix = name_bytes(self.prefix), name_bytes(self.suffix)
        counts = (self.vendor_flags, len(self.colours), self.coordinates)
        row = struct.Struct(f">32s3H{self.coordinates}H")
        try:
            head = struct.pack(">4sI3I32s32s", b"ncl2", 0, *counts, prefix, suffix)
            rows = [row.pack(name_bytes(c.name), *c.pcs, *c.device) for c in self.colours]
        except struct.error as error:
            raise ProfileError(f"'ncl2' cannot hold a value: {error}") from error
        return head + b"".join(rows)

    @staticmethod
    def decode(data: bytes, where: str) -> NamedColours:
        flags, count, coordinates, prefix, suffix = unpack("3I32s32s", data, 8, where)
        if coordinates > MAX_COORDINATES:
            raise ProfileError(
                f"{coordinates} device coordinates, more than {MAX_COORDINATES}", where=where
            )
        rows = unpack_records(f"32s3H{coordinates}H", count, data, _ROWS, where)
        colours = tuple(
            NamedColour(read_name(name, f"{where}, colour {index}"), (a, b, c), tuple(device))
            for index, (name, a, b, c, *device) in enumerate(rows)
        )
        prefix, suffix = (
            read_name(prefix, f"{where}, prefix"),
            read_name(suffix, f"{where}, suffix"),
        )
        return NamedColours(colours, coordinates, prefix, suffix, flags)
