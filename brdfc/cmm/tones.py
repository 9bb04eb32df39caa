"""Tone curves of a profile (`curv`, `para`) as curves of the engine, and their inverses."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.curves import (
    FormulaSegment,
    KnottedCurve,
    SampledCurve,
    SegmentedCurve,
)
from brdfc.engine.curves import apply_curve
from brdfc.icc.curves import AnyCurve, ParametricCurve
from brdfc.source.errors import LinkError

Wide = NDArray[np.float64]
Tone = SampledCurve | SegmentedCurve | KnottedCurve

_POINTS = 4096
"""Where a curve that has no inverse in closed form is looked at."""
_JUMP = 1 / 65535
"""Formulas whose pieces are nearer than this are meant to meet; their numbers are rounded."""


def _power(g: float, a: float = 1.0, b: float = 0.0, c: float = 0.0) -> FormulaSegment:
    """(a x + b)^g + c."""
    return FormulaSegment(0, (g, a, b, c))


def _line(slope: float, offset: float) -> FormulaSegment:
    return _power(1.0, slope, offset)


def tone(curve: AnyCurve) -> Tone:
    """The curve as the engine runs it. What `curv` takes is clipped to 0..1, as the ICC's engine
    does; what `para` takes is not."""
    if isinstance(curve, ParametricCurve):
        return _parametric(curve)
    if curve.samples is not None:
        return SampledCurve(0.0, 1.0, curve.samples)
    gamma = 1.0 if curve.gamma is None else curve.gamma
    return _within(0.0, 1.0, (), (_power(gamma),), _line(0.0, float(gamma == 0)))


def _within(
    low: float,
    high: float,
    breaks: tuple[float, ...],
    segments: tuple[FormulaSegment, ...],
    below: FormulaSegment,
) -> SegmentedCurve:
    """Segments between two ends; below gives what holds before the first, and 1 after the last."""
    return SegmentedCurve((low, *breaks, high), (below, *segments, _line(0.0, 1.0)))


def _pieces(curve: ParametricCurve) -> tuple[float | None, FormulaSegment, FormulaSegment]:
    """Where the upper formula begins, None for everywhere; the lower formula and the upper."""
    g, a, b, c, d, e, f = (*curve.parameters, *(0.0,) * (7 - len(curve.parameters)))
    if curve.function == 0:
        return None, _line(0.0, 0.0), _power(g)
    if curve.function in (1, 2):
        return (-b / a if a else None), _line(0.0, c), _power(g, a, b, c)
    return d, _line(c, f), _power(g, a, b, e)


def _parametric(curve: ParametricCurve) -> SegmentedCurve:
    start, lower, upper = _pieces(curve)
    if start is None:
        return SegmentedCurve((), (upper,))
    # A segment holds up to its break and with it; the upper formula begins there.
    last = float(np.nextafter(np.float32(start), np.float32(-np.inf)))
    return SegmentedCurve((last,), (lower, upper))


def inverse_tone(curve: AnyCurve) -> Tone:
    """The inverse over 0..1, clipped to it; LinkError for a curve that has none.

    In closed form where there is one, and else through the curve's own points. The reference takes
    2048 equal steps of it, which leaves dark values with few of them.
    """
    if isinstance(curve, ParametricCurve):
        closed = _inverse_of_formula(curve)
        if closed is not None:
            return closed
    elif curve.samples is None:
        gamma = 1.0 if curve.gamma is None else curve.gamma
        if gamma > 0:
            return _within(0.0, 1.0, (), (_power(1 / gamma),), _line(0.0, 0.0))
    samples = None if isinstance(curve, ParametricCurve) else curve.samples
    places = np.linspace(0.0, 1.0, samples.count if samples is not None else _POINTS)
    found = apply_curve(tone(curve), places.astype(np.float32))
    return _through(places, found.astype(np.float64))


def _inverse_of_formula(curve: ParametricCurve) -> Tone | None:
    """None where the formula does not rise from 0 to 1."""
    start, lower, upper = _pieces(curve)
    g, a, b, e = upper.parameters
    slope, offset = lower.parameters[1:3]
    split = 0.0 if start is None else min(max(start, 0.0), 1.0)
    if not (g > 0 and a > 0 and a * split + b >= 0 and slope >= 0):
        return None
    scale = a**-g
    upper_inverse = _power(1 / g, scale, -e * scale, -b / a)
    middle, high = (a * split + b) ** g + e, (a + b) ** g + e
    low = offset if split > 0 else middle
    breaks: tuple[float, ...] = ()
    segments: tuple[FormulaSegment, ...] = (upper_inverse,)
    if split > 0 and slope > 0:
        last, lower_inverse = slope * split + offset, _line(1 / slope, -offset / slope)
        if split == 1:
            segments = (lower_inverse,)
        elif middle - last > _JUMP:
            breaks, segments = (last, middle), (lower_inverse, _line(0.0, split), upper_inverse)
        else:
            breaks, segments = (last,), (lower_inverse, upper_inverse)
    else:
        low = middle
    if split == 1:
        high = slope + offset
    ends = (low, *breaks, high)
    if not all(first < second for first, second in pairwise(map(np.float32, ends))):
        return None
    return _within(low, high, breaks, segments, _line(0.0, 0.0))


def _through(places: Wide, values: Wide) -> KnottedCurve:
    """The curve from values to places, which rises. Where the curve is level it steps."""
    if values[0] > values[-1]:
        places, values = places[::-1], values[::-1]
    rising = np.maximum.accumulate(values)
    if rising[0] == rising[-1]:
        raise LinkError("a tone curve is constant, and has no inverse")
    steps = np.diff(rising) > 0
    kept = np.append(steps, True) | np.append(True, steps)  # both ends of what is level
    return KnottedCurve(tuple(rising[kept].tolist()), tuple(places[kept].tolist()))
