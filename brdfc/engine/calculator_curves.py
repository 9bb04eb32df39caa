"""Curves sampled from calculators, as the reference engine samples them when a run starts."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.calculator_curves import CalculatorCurve
from brdfc.engine.kernels import Values

Numbers = NDArray[np.intp]
Calculate = Callable[[Values], Values]
"""What a curve's calculator gives for values of its channel (rows, pixels), in the environment of
those pixels."""

_NEEDED = 6
"""Samples that a value needs: the two that it lies between, and two at each end."""


def cell(position: Values, last: int) -> tuple[Numbers, Numbers, Values]:
    """Of points from 0 to `last` the two that a position lies between, and how far on it is."""
    index = np.clip(np.nan_to_num(position), 0, last).astype(np.intp)
    return index, np.minimum(index + 1, last), position - index.astype(np.float32)


def line(lower: Values, upper: Values, part: Values) -> Values:
    """The line between two points.

    The reference rounds the second product alone to float32 before it adds in float64.
    """
    product = (part * upper).astype(np.float64)
    between = (1.0 - part.astype(np.float64)) * lower + product
    return np.where(part == 0, lower, between.astype(np.float32))


def apply_calculator_curve(
    curve: CalculatorCurve, x: Values, calculate: Calculate, same: bool
) -> Values:
    """The curve's values for x (pixels). same: whether it is the same curve for all pixels.

    All samples are taken where the values need as many, else those that they need: so curves inside
    calculators inside curves take no more than verification counted.
    """
    first, last = np.float32(curve.first), np.float32(curve.last)
    count, span = curve.points - 1, last - first
    steps = np.float32(count)
    lower, upper, part = cell((x - first) / span * steps, count)
    needed = np.stack(np.broadcast_arrays(lower, upper, 0, 1, count - 1, count))

    def samples(numbers: Numbers) -> Values:
        return calculate(numbers.astype(np.float32) / steps * span + first)

    if curve.points <= _NEEDED or (same and curve.points <= needed.size):
        numbers = np.arange(curve.points)[:, None]
        every = samples(numbers if same else np.repeat(numbers, x.size, axis=1))
        every = np.broadcast_to(every, (curve.points, x.size))
        found = np.take_along_axis(every, needed, axis=0)
    else:
        found = samples(needed)
    start, second, last_but_one, end = found[2:]
    below, above = start, end
    if curve.extend:
        low, high = (second - start) / (span / steps), (end - last_but_one) / (span / steps)
        below, above = low * x + (start - low * first), high * x + (end - high * last)
    inside = line(found[0], found[1], part)
    finite = np.where(x < first, below, np.where(x > last, above, inside))
    return np.where(np.isfinite(x), finite, start)
