"""The table inside `mAB ` and `mBA ` (ICC.1, 10.12.3), and what any table of a tag must be."""

from __future__ import annotations

import math
import struct

from brdfc.calc.samples import Samples, Storage
from brdfc.calc.tables import LookupTable, check_grid
from brdfc.icc.layout import profile_errors, unpack
from brdfc.source.errors import ProfileError

STORAGES = {1: Storage.UINT8, 2: Storage.UINT16}
"""Of a table's numbers, by their precision in bytes."""


def read_clut(data: bytes, offset: int, inputs: int, outputs: int, where: str) -> LookupTable:
    """The table at an offset: 16 bytes of grid points, precision, 3 bytes, the numbers."""
    *points, precision = unpack("17B", data, offset, where)
    if precision not in STORAGES:
        raise ProfileError(f"a table of {precision} bytes a number, not 1 or 2", where=where)
    grid = tuple(points[:inputs])
    with profile_errors():
        check_grid(inputs, outputs, grid, where)
        count = math.prod(grid) * outputs
        samples = Samples.read(STORAGES[precision], count, data, offset + 20, where)
    return LookupTable(inputs, outputs, grid, samples, extended=True)


def clut_bytes(table: LookupTable) -> bytes:
    """A table that check_table lets pass, padded to 4 bytes."""
    precision = table.samples.storage.dtype.itemsize
    head = struct.pack(">16sBxxx", bytes(table.grid), precision)
    return head + table.samples.data + bytes(-len(table.samples.data) % 4)


def check_table(table: LookupTable, where: str) -> None:
    """That a table is of whole numbers, and as many as its grid says."""
    with profile_errors():
        check_grid(table.inputs, table.outputs, table.grid, where)
    if table.samples.storage not in STORAGES.values():
        raise ProfileError("a table is of UINT8 or UINT16", where=where)
    needed = math.prod(table.grid) * table.outputs
    if table.samples.count != needed or table.outputs > 255:
        raise ProfileError(
            f"{table.samples.count} numbers for {table.outputs} outputs at {needed} points",
            where=where,
        )
