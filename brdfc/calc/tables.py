"""Lookup tables (`clut`, `xclt`): the element and its bytes.

An engine interpolates linearly in every input between the 2^inputs corners of a cell. The reference
engine does not clamp: inputs beyond 0..1 and NaN make it read outside the table, so a program has
to clamp them first.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass

from brdfc.calc.samples import Samples, Storage
from brdfc.source.errors import ProgramError

MAX_INPUTS = 16
GRID_BYTES = 16


@dataclass(frozen=True)
class LookupTable:
    """Outputs at the points of a grid over 0..1 in every input.

    grid: points an input, 2 to 255. samples: the first input varies slowest, the outputs of a point
    stand side by side. extended: written as `xclt`, the only form that names its storage type.
    """

    inputs: int
    outputs: int
    grid: tuple[int, ...]
    samples: Samples
    extended: bool = False

    @property
    def signature(self) -> str:
        return "xclt" if self.extended else "clut"


def encode_table(table: LookupTable) -> bytes:
    """The element from its own signature on."""
    check_grid(table.inputs, table.outputs, table.grid, "a lookup table")
    needed = math.prod(table.grid) * table.outputs
    if table.samples.count != needed:
        raise ProgramError(f"a lookup table needs {needed} numbers, not {table.samples.count}")
    storage = table.samples.storage
    if storage is not Storage.FLOAT32 and not table.extended:
        raise ProgramError(f"a 'clut' holds FLOAT32 numbers; {storage.name} takes an 'xclt'")
    head = struct.pack(">4sIHH", table.signature.encode(), 0, table.inputs, table.outputs)
    if table.extended:
        head += struct.pack(">HH", storage.code, 0)
    return head + bytes(table.grid).ljust(GRID_BYTES, b"\0") + table.samples.data


def decode_table(data: bytes, inputs: int, outputs: int, where: str) -> LookupTable:
    """The table that `data` begins with, its header of 12 bytes included."""
    extended = data[:4] == b"xclt"
    start = 16 if extended else 12
    if len(data) < start + GRID_BYTES:
        raise ProgramError("the lookup table ends within its header", where=where)
    code = struct.unpack_from(">H", data, 12)[0] if extended else Storage.FLOAT32.code
    storage = Storage.of_code(code, where)
    grid = tuple(data[start : start + min(inputs, GRID_BYTES)])
    check_grid(inputs, outputs, grid, where)
    count = math.prod(grid) * outputs
    samples = Samples.read(storage, count, data, start + GRID_BYTES, where)
    return LookupTable(inputs, outputs, grid, samples, extended)


def check_grid(inputs: int, outputs: int, grid: tuple[int, ...], where: str) -> None:
    """Refuse what no table can have: ProgramError."""
    if not 1 <= inputs <= MAX_INPUTS or outputs < 1:
        raise ProgramError(
            f"a lookup table has 1 to {MAX_INPUTS} inputs and 1 output or more, not {inputs} and "
            f"{outputs}",
            where=where,
        )
    if len(grid) != inputs or not all(2 <= points <= 255 for points in grid):
        raise ProgramError(
            f"a grid has 2 to 255 points for each of {inputs} inputs, not {grid}", where=where
        )
