"""Lookup tables: linear interpolation in every input, or in tetrahedra for three inputs.

Both are in the reference engine's order, all in float32. Linear: the weight of a corner is the
product of its distances from the last input to the first; corners are added with the first input's
bit varying fastest. In tetrahedra: from the cell's first corner along its edges to the last, the
input that has come farthest first; the steps of the third input are added first, then those of the
second and of the first. The reference's host chooses for the tables of profiles of version 4; among
processing elements (iccdev 0.1.1) tables are linear whatever it chooses.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import Enum
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.tables import LookupTable
from brdfc.engine.kernels import Values
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import ValueGivenError

Places = NDArray[np.intp]

_ZERO, _ONE = np.float32(0), np.float32(1)


class Interpolation(Enum):
    """How tables of three inputs are interpolated. All others are linear."""

    LINEAR = "linear"
    TETRAHEDRAL = "tetrahedral"


def interpolation_named(given: Interpolation | str) -> Interpolation:
    """The interpolation a user means; ValueGivenError, with the nearest, for another text."""
    known = [i.value for i in Interpolation]
    if isinstance(given, str) and given not in known:
        raise ValueGivenError(
            f"there is no interpolation '{given}'",
            hint=did_you_mean(given, known) or ", ".join(known),
        )
    return Interpolation(given)


def held(x: Values) -> Values:
    """Within 0..1; NaN counts as 0."""
    return np.where(x > 0, np.where(x < 1, x, _ONE), _ZERO)


def apply_table(
    table: LookupTable, inputs: Sequence[Values], interpolation: Interpolation
) -> list[Values]:
    """The outputs, for inputs held within 0..1; NaN counts as 0."""
    points = table.samples.values.reshape(-1, table.outputs)
    first = np.zeros(np.broadcast_shapes(*(x.shape for x in inputs)), dtype=np.intp)
    steps, parts = [], []
    for axis, x in enumerate(inputs):
        cells = table.grid[axis] - 1
        position = held(x) * np.float32(cells)
        cell = np.minimum(position.astype(np.intp), cells - 1)
        parts.append(position - cell.astype(np.float32))
        steps.append(math.prod(table.grid[axis + 1 :]))
        first += cell * steps[-1]
    tetrahedral = interpolation is Interpolation.TETRAHEDRAL and table.inputs == 3
    between = _tetrahedral if tetrahedral else _linear
    total = between(points, first, steps, parts)
    return [total[..., channel] for channel in range(table.outputs)]


def _linear(points: Values, first: Places, steps: Sequence[int], parts: Sequence[Values]) -> Values:
    total = np.zeros((*first.shape, points.shape[1]), dtype=np.float32)
    sides = [(_ONE - above, above) for above in parts]
    for corner in range(1 << len(steps)):
        bits = [corner >> axis & 1 for axis in range(len(steps))]
        distances = [side[bit] for side, bit in zip(sides, bits, strict=True)]
        weight = np.asarray(reduce(np.multiply, reversed(distances)))
        place = first + sum(step for step, bit in zip(steps, bits, strict=True) if bit)
        total += points[place] * weight[..., None]
    return total


def _tetrahedral(
    points: Values, first: Places, steps: Sequence[int], parts: Sequence[Values]
) -> Values:
    x, y, z = parts
    # Which of two inputs goes first. Ties are as in the reference: they decide what is rounded.
    y_before_z = z < y
    x_before_z = np.where(y_before_z, ~(z > x), z < x)
    x_before_y = y < x
    starts = (
        first + ~x_before_z * steps[2] + ~x_before_y * steps[1],
        first + ~y_before_z * steps[2] + x_before_y * steps[0],
        first + y_before_z * steps[1] + x_before_z * steps[0],
    )
    total = points[first]
    for axis in (2, 1, 0):
        rise = points[starts[axis] + steps[axis]] - points[starts[axis]]
        total = total + parts[axis][..., None] * rise
    return total
