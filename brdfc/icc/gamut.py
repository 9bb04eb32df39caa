"""`gbd `: the boundary of a gamut, as triangles between vertices (ICC.2)."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from brdfc.calc.samples import Samples, Storage
from brdfc.icc.layout import profile_errors, unpack
from brdfc.icc.tag import Tag
from brdfc.source.errors import ProfileError

_HEAD = 20


@dataclass(frozen=True)
class GamutBoundary(Tag):
    """triangles: three vertex numbers each, as big-endian u32. pcs, device: the coordinates of the
    vertices, one vertex after the other, FLOAT32; device may be empty."""

    type_signature: ClassVar[str] = "gbd "
    pcs_channels: int
    device_channels: int
    vertices: int
    triangles: bytes
    pcs: Samples
    device: Samples

    def encode(self) -> bytes:
        for values, channels in (
            (self.pcs, self.pcs_channels),
            (self.device, self.device_channels),
        ):
            if values.storage is not Storage.FLOAT32 or values.count != channels * self.vertices:
                raise ProfileError(f"FLOAT32 for {channels} channels of {self.vertices} vertices")
        _check_triangles(self.triangles, self.vertices, "'gbd '")
        try:
            head = struct.pack(
                ">4sIHHII",
                b"gbd ",
                0,
                self.pcs_channels,
                self.device_channels,
                self.vertices,
                len(self.triangles) // 12,
            )
        except struct.error as error:
            raise ProfileError(f"'gbd ' cannot hold a value: {error}") from error
        return head + self.triangles + self.pcs.data + self.device.data

    @staticmethod
    def decode(data: bytes, where: str) -> GamutBoundary:
        pcs_channels, device_channels, vertices, count = unpack("HHII", data, 8, where)
        start = _HEAD + 12 * count
        if start > len(data):
            raise ProfileError(f"{count} triangles in {len(data)} bytes", where=where)
        triangles = data[_HEAD:start]
        _check_triangles(triangles, vertices, where)
        with profile_errors():
            float32 = Storage.FLOAT32
            pcs = Samples.read(float32, vertices * pcs_channels, data, start, where)
            start += len(pcs.data)
            device = Samples.read(float32, vertices * device_channels, data, start, where)
        return GamutBoundary(pcs_channels, device_channels, vertices, triangles, pcs, device)


def _check_triangles(triangles: bytes, vertices: int, where: str) -> None:
    if len(triangles) % 12:
        raise ProfileError("a triangle has three vertices of 4 bytes", where=where)
    highest = int(np.frombuffer(triangles, dtype=">u4").max(initial=0))
    if triangles and highest >= vertices:
        raise ProfileError(f"a triangle of vertex {highest}, of {vertices}", where=where)
