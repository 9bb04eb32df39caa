"""Lookup tables: linear interpolation in every input, in the reference engine's order.

The weight of a corner is the product of its distances from the last input to the first; corners are
added with the first input's bit varying fastest. All in float32. The reference interpolates three
inputs so where its host asks for linear interpolation, and in tetrahedra where it does not.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import reduce

import numpy as np

from brdfc.calc.tables import LookupTable
from brdfc.engine.kernels import Values

_ZERO, _ONE = np.float32(0), np.float32(1)


def apply_table(table: LookupTable, inputs: Sequence[Values]) -> list[Values]:
    """The outputs, for inputs held within 0..1; NaN counts as 0."""
    points = table.samples.values.reshape(-1, table.outputs)
    first = np.zeros(np.broadcast_shapes(*(x.shape for x in inputs)), dtype=np.intp)
    steps, sides = [], []
    for axis, x in enumerate(inputs):
        cells = table.grid[axis] - 1
        position = np.where(x > 0, np.where(x < 1, x, _ONE), _ZERO) * np.float32(cells)
        cell = np.minimum(position.astype(np.intp), cells - 1)
        above = position - cell.astype(np.float32)
        steps.append(math.prod(table.grid[axis + 1 :]))
        sides.append((_ONE - above, above))
        first += cell * steps[-1]
    total = np.zeros((*first.shape, table.outputs), dtype=np.float32)
    for corner in range(1 << table.inputs):
        bits = [corner >> axis & 1 for axis in range(table.inputs)]
        distances = [side[bit] for side, bit in zip(sides, bits, strict=True)]
        weight = np.asarray(reduce(np.multiply, reversed(distances)))
        place = first + sum(step for step, bit in zip(steps, bits, strict=True) if bit)
        total += points[place] * weight[..., None]
    return [total[..., channel] for channel in range(table.outputs)]
