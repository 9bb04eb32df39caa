"""Curves sampled from calculators, as the reference engine samples them when a run starts."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.calculator_curves import CalculatorCurve
from brdfc.engine.kernels import Values

Calculate = Callable[[Values], Values]
"""What a curve's calculator gives for values of its channel, in the run's environment."""
Points = Callable[[NDArray[np.intp]], Values]
"""The points of a curve by their numbers."""


def between(at: Points, last: int, position: Values) -> Values:
    """The line between the two points a position lies between, of those from 0 to `last`.

    The reference rounds the second product alone to float32 before it adds in float64.
    """
    index = np.clip(np.nan_to_num(position), 0, last).astype(np.intp)
    part = position - index.astype(np.float32)
    lower, upper = at(index), at(np.minimum(index + 1, last))
    product = (part * upper).astype(np.float64)
    line = (1.0 - part.astype(np.float64)) * lower + product
    return np.where(part == 0, lower, line.astype(np.float32))


def apply_calculator_curve(
    curve: CalculatorCurve, x: Values, calculate: Calculate, same: bool
) -> Values:
    """same: whether the calculator gives the same curve for every value. Else, and where there are
    fewer values than samples, only those are computed that a value lies between; what that gives is
    the same.
    """
    first, last = np.float32(curve.first), np.float32(curve.last)
    count, span = curve.points - 1, last - first
    steps = np.float32(count)

    def sample(number: NDArray[np.intp]) -> Values:
        return calculate(np.asarray(number.astype(np.float32) / steps * span + first))

    at: Points = sample
    if same and x.size > count:
        at = np.broadcast_to(sample(np.arange(count + 1)), count + 1).__getitem__
    start, second, last_but_one, end = (
        sample(np.asarray(number)) for number in (0, 1, count - 1, count)
    )
    below, above = start, end
    if curve.extend:
        low, high = (second - start) / (span / steps), (end - last_but_one) / (span / steps)
        below, above = low * x + (start - low * first), high * x + (end - high * last)
    inside = between(at, count, (x - first) / span * steps)
    finite = np.where(x < first, below, np.where(x > last, above, inside))
    return np.where(np.isfinite(x), finite, start)
