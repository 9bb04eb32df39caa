"""Lookup-table tags: `mft1`, `mft2`, `mAB ` and `mBA ` (ICC.1, lut8Type to lutBToAType).

Tables stay as the file has them (calc.samples.Samples). The numbers stand for 0 to 1 in every
channel; what 0 to 1 means is the business of the colour space: in `mft2` a Lab PCS has an
encoding of its own.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from brdfc.calc.samples import Samples, Storage
from brdfc.calc.tables import LookupTable, check_grid
from brdfc.icc.cluts import STORAGES, check_table, clut_bytes, read_clut
from brdfc.icc.curves import AnyCurve, curves_bytes, read_curves
from brdfc.icc.layout import profile_errors, unpack
from brdfc.icc.numbers import fixed_bytes, unpack_fixed
from brdfc.icc.tag import Tag
from brdfc.source.errors import ProfileError

IDENTITY = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class TableLut(Tag):
    """`mft1` (8 bits) or `mft2` (16 bits): matrix, input curves, table, output curves.

    matrix: 9 s15Fixed16 by rows, for XYZ input only. input_curves and output_curves: samples at
    equal steps, all of the first channel, then all of the next; 256 a channel with 8 bits, 2 to
    4096 with 16. table: the same number of grid points in every input. All three are of UINT8 or
    all of UINT16.
    """

    input_curves: Samples
    table: LookupTable
    output_curves: Samples
    matrix: tuple[float, ...] = IDENTITY

    @property
    def type_signature(self) -> str:
        return "mft1" if self.bits == 8 else "mft2"

    @property
    def bits(self) -> int:
        return 8 if self.table.samples.storage is Storage.UINT8 else 16

    @property
    def inputs(self) -> int:
        return self.table.inputs

    @property
    def outputs(self) -> int:
        return self.table.outputs

    def encode(self) -> bytes:
        parts = (self.input_curves, self.table.samples, self.output_curves)
        storage = STORAGES[self.bits // 8]
        if any(part.storage is not storage for part in parts):
            raise ProfileError("the parts of a lookup table are all of UINT8 or all of UINT16")
        check_table(self.table, "the table")
        points = set(self.table.grid)
        if len(points) > 1 or len(self.matrix) != 9:
            raise ProfileError("one number of grid points, and 9 numbers of a matrix, are needed")
        entries = [
            _entries_of(self.input_curves, self.inputs, self.bits),
            _entries_of(self.output_curves, self.outputs, self.bits),
        ]
        try:
            kind = self.type_signature.encode()
            head = struct.pack(">4sI3Bx", kind, 0, self.inputs, self.outputs, points.pop())
        except struct.error as error:
            raise ProfileError(f"{self.inputs} or {self.outputs} channels: {error}") from error
        head += fixed_bytes(self.matrix, "the matrix")
        if self.bits == 16:
            head += struct.pack(">HH", *entries)
        return head + b"".join(part.data for part in parts)

    @staticmethod
    def decode(data: bytes, where: str) -> TableLut:
        inputs, outputs, points = unpack("3B", data, 8, where)
        matrix = unpack_fixed(9, data, 12, where)
        storage, offset, entries = Storage.UINT8, 48, (256, 256)
        if data[:4] == b"mft2":
            storage, offset, entries = Storage.UINT16, 52, unpack("HH", data, 48, where)
        for count in entries:
            _check_entries(count, where)
        grid = (points,) * inputs
        with profile_errors():
            check_grid(inputs, outputs, grid, where)
        parts = []
        counts = (inputs * entries[0], points**inputs * outputs, outputs * entries[1])
        for name, count in zip(("input curves", "table", "output curves"), counts, strict=True):
            with profile_errors():
                samples = Samples.read(storage, count, data, offset, f"{where}, {name}")
            parts.append(samples)
            offset += len(samples.data)
        table = LookupTable(inputs, outputs, grid, parts[1], extended=True)
        return TableLut(parts[0], table, parts[2], matrix)


def _entries_of(curves: Samples, channels: int, bits: int) -> int:
    """The samples of each of so many curves."""
    entries, rest = divmod(curves.count, channels)
    if rest or (bits == 8 and entries != 256):
        raise ProfileError(f"{curves.count} samples are not those of {channels} curves")
    _check_entries(entries, "the curves")
    return entries


def _check_entries(count: int, where: str) -> None:
    if not 2 <= count <= 4096:
        raise ProfileError(f"a curve of {count} samples, not 2 to 4096", where=where)


Kind = Literal["mAB ", "mBA "]


def _sides(kind: Kind, inputs: int, outputs: int) -> tuple[int, int]:
    """The channels of the PCS and of the device."""
    return (outputs, inputs) if kind == "mAB " else (inputs, outputs)


@dataclass(frozen=True)
class StagedLut(Tag):
    """`mAB ` (A curves, table, M curves, matrix, B curves) or `mBA ` (the other way round).

    Only the B curves must be there. The A curves are those of the device's channels, all others
    those of the PCS. clut: of UINT8 or UINT16. matrix: 12 s15Fixed16, 9 by rows and 3 offsets,
    where the PCS side has 3 channels; without a table both sides have as many.
    """

    kind: Kind
    inputs: int
    outputs: int
    b_curves: tuple[AnyCurve, ...]
    matrix: tuple[float, ...] | None = None
    m_curves: tuple[AnyCurve, ...] | None = None
    clut: LookupTable | None = None
    a_curves: tuple[AnyCurve, ...] | None = None

    @property
    def type_signature(self) -> str:
        return self.kind

    def encode(self) -> bytes:
        self._check("a lookup table")
        starts, body = [], b""
        for stage in (
            curves_bytes(self.b_curves),
            fixed_bytes(self.matrix or (), "the matrix"),
            curves_bytes(self.m_curves or ()),
            clut_bytes(self.clut) if self.clut else b"",
            curves_bytes(self.a_curves or ()),
        ):
            starts.append(_HEAD + len(body) if stage else 0)
            body += stage
        kind = self.kind.encode()
        return struct.pack(">4sI2Bxx5I", kind, 0, self.inputs, self.outputs, *starts) + body

    @staticmethod
    def decode(data: bytes, where: str) -> StagedLut:
        inputs, outputs, b, matrix, m, clut, a = unpack("BBxx5I", data, 8, where)
        kind: Kind = "mAB " if data[:4] == b"mAB " else "mBA "
        pcs, device = _sides(kind, inputs, outputs)
        curves: dict[tuple[int, int], tuple[AnyCurve, ...]] = {}
        extents = [(0, _HEAD, "the header")]

        def read(name: str, offset: int, count: int) -> tuple[AnyCurve, ...] | None:
            if offset and (offset, count) not in curves:
                curves[offset, count], end = read_curves(data, offset, count, f"{where}, {name}")
                extents.append((offset, end, name))
            return curves.get((offset, count))

        b_curves = read("B curves", b, pcs)
        if b_curves is None:
            raise ProfileError("no B curves, which must be there", where=where)
        table = read_clut(data, clut, inputs, outputs, f"{where}, table") if clut else None
        if table is not None:
            extents.append((clut, clut + 20 + len(table.samples.data), "the table"))
        if matrix:
            extents.append((matrix, matrix + 48, "the matrix"))
        lut = StagedLut(
            kind,
            inputs,
            outputs,
            b_curves,
            unpack_fixed(12, data, matrix, f"{where}, matrix") if matrix else None,
            read("M curves", m, pcs),
            table,
            read("A curves", a, device),
        )
        _check_extents(extents, where)
        lut._check(where)
        return lut

    def _check(self, where: str) -> None:
        """That the stages fit one another."""
        pcs, device = _sides(self.kind, self.inputs, self.outputs)
        if not (1 <= self.inputs <= 255 and 1 <= self.outputs <= 255):
            raise ProfileError(f"{self.inputs} channels in, {self.outputs} out", where=where)
        for name, curves, count in (
            ("A", self.a_curves, device),
            ("M", self.m_curves, pcs),
            ("B", self.b_curves, pcs),
        ):
            if curves is not None and len(curves) != count:
                raise ProfileError(f"{len(curves)} {name} curves, not {count}", where=where)
        if self.matrix is not None and (pcs != 3 or len(self.matrix) != 12):
            raise ProfileError("a matrix has 12 numbers and stands between 3 channels", where=where)
        if self.clut is None and self.inputs != self.outputs:
            raise ProfileError(
                f"no table, which {self.inputs} channels in and {self.outputs} out need",
                where=where,
            )
        if self.clut is not None:
            check_table(self.clut, where)
            if (self.clut.inputs, self.clut.outputs) != (self.inputs, self.outputs):
                raise ProfileError("the table has other channels than the tag", where=where)


_HEAD = 32


def _check_extents(extents: list[tuple[int, int, str]], where: str) -> None:
    """Stages must not overlap; curves may stand in two stages at once."""
    starts = {start: (end, name) for start, end, name in sorted(extents)}
    for (_, (end, name)), (start, (_, after)) in pairwise(starts.items()):
        if start < end:
            raise ProfileError(f"{after} at byte {start} overlap {name}", where=where)
