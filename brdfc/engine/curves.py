"""Curves: sampled ones and segmented ones, computed as the reference engine computes them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.curves import FormulaSegment, SampledCurve, SampledSegment, SegmentedCurve
from brdfc.engine.calculator_curves import cell, line
from brdfc.engine.kernels import Values

Wide = NDArray[np.float64]


def apply_curve(curve: SampledCurve | SegmentedCurve, x: Values) -> Values:
    """A curve's value for each of x."""
    return _sampled(curve, x) if isinstance(curve, SampledCurve) else _segmented(curve, x)


def _sampled(curve: SampledCurve, x: Values) -> Values:
    points = curve.samples.values
    first, last = np.float32(curve.first), np.float32(curve.last)
    steps, span = np.float32(len(points) - 1), last - first
    slopes = (np.float32(0), np.float32(0))
    if curve.extend:
        slopes = (
            (points[1] - points[0]) / (span / steps),
            (points[-1] - points[-2]) / (span / steps),
        )
    below = slopes[0] * x + (points[0] - slopes[0] * first)
    above = slopes[1] * x + (points[-1] - slopes[1] * last)
    lower, upper, part = cell((x - first) / span * steps, len(points) - 1)
    inside = line(points[lower], points[upper], part)
    finite = np.where(x < first, below, np.where(x > last, above, inside))
    # The newest release gives 1 or 0 for what is not finite, whatever the curve; older ones differ.
    return np.where(np.isfinite(x), finite, (x > 0).astype(np.float32))


def _segmented(curve: SegmentedCurve, x: Values) -> Values:
    """Each value by its segment, the first that does not end before it."""
    breaks = np.array(curve.breaks, dtype=np.float32)
    number = np.searchsorted(breaks, x, side="left")
    result = np.array(x)  # as the reference has it for NaN and plus infinity
    for k in np.unique(number):
        chosen = (number == k) & (x < np.inf)
        result[chosen] = _segment(curve, int(k), x[chosen])
    return result


def _segment(curve: SegmentedCurve, k: int, x: Values) -> Values:
    segment = curve.segments[k]
    if isinstance(segment, FormulaSegment):
        wide = _FORMULAS[segment.type](x.astype(np.float64), *segment.parameters)
        return wide.astype(np.float32)
    start, end = np.float32(curve.breaks[k - 1]), np.float32(curve.breaks[k])
    values = np.concatenate([[_at_end(curve, k - 1)], segment.samples.values])
    points, count = values.astype(np.float32), segment.samples.count
    lower, upper, part = cell((x - start) / (end - start) * np.float32(count), count)
    return line(points[lower], points[upper], part)


def _at_end(curve: SegmentedCurve, k: int) -> np.float32:
    """The value at the end of a segment."""
    segment = curve.segments[k]
    if isinstance(segment, SampledSegment):
        return np.float32(segment.samples.values[-1])
    return np.float32(_segment(curve, k, np.array([curve.breaks[k]], dtype=np.float32))[0])


# Formulas (ICC.2, formulaCurveSegment; types 3 to 7 as in the reference engine's source). They are
# computed in float64 and rounded where the reference was measured to round. Where ICC.2 leaves them
# undefined they give what it gives: a negative base of a power without a real value is 0, a
# logarithm's argument is the least normal float32 at least, and a quotient by 0 makes its term 0.

_LEAST = float(np.finfo(np.float32).tiny)


def _single(x: Wide) -> Wide:
    """Rounded to float32, for the operations that the reference does in it."""
    return x.astype(np.float32).astype(np.float64)


def _power(x: Wide | float, y: Wide | float) -> Wide:
    return np.asarray(np.power(np.where(np.less(x, 0) & (np.floor(y) != y), 0.0, x), y))


def _linear(x: Wide, slope: float, offset: float) -> Wide:
    return _single(_single(slope * x) + offset)


def _affine(x: Wide, g: float, slope: float, offset: float) -> Wide:
    """slope x^g + offset. The reference has a short cut for g = 1, in float32."""
    return _linear(x, slope, offset) if g == 1 else slope * _power(x, g) + offset


def _quotient(x: Wide, y: Wide | float, g: float) -> Wide:
    """The same short cut divides in float32."""
    return _single(x / y) if g == 1 else x / y


def _parametric(x: Wide, g: float, a: float, b: float, c: float) -> Wide:
    return _power(_linear(x, a, b), g) + c


def _logarithmic(x: Wide, g: float, a: float, b: float, c: float, d: float) -> Wide:
    return a * np.log10(np.maximum(b * _power(x, g) + c, _LEAST)) + d


def _exponential(x: Wide, a: float, b: float, c: float, d: float, e: float) -> Wide:
    return a * _power(b, _linear(x, c, d)) + e


def _clipped(x: Wide, g: float, a: float, b: float, c: float, d: float) -> Wide:
    base = _linear(x, b, c)
    power = np.where(base <= 0, 0.0, np.power(np.where(base <= 0, 1.0, base), g))
    return _linear(_single(power), a, d)


def _natural(x: Wide, g: float, a: float, b: float, c: float, d: float) -> Wide:
    return a * np.log(np.maximum(_affine(x, g, d, -b), _LEAST)) + c


def _growing(x: Wide, g: float, a: float, b: float, c: float, d: float, e: float) -> Wide:
    if a == 0:
        return np.full_like(x, b)
    return e * np.exp(_quotient(_affine(x, g, d, -c), a, g)) + b


def _quantizer(
    x: Wide, w: float, g: float, a: float, b: float, c: float, d: float, e: float
) -> Wide:
    upper = np.maximum(_single(_affine(x, g, e, -a)), 0.0)
    lower = _single(_affine(x, g, -c, b))
    return np.where(lower == 0, 0.0, d * _power(_single(upper / lower), w))


def _rational(x: Wide, w: float, g: float, a: float, b: float, c: float, d: float) -> Wide:
    upper, lower = _affine(x, g, b, a), _single(_affine(x, g, c, 1.0))
    return np.where(lower == 0, 0.0, d * _power(_quotient(upper, lower, g), w))


_FORMULAS: dict[int, Callable[..., Wide]] = {
    0: _parametric,
    1: _logarithmic,
    2: _exponential,
    3: _clipped,
    4: _natural,
    5: _growing,
    6: _quantizer,
    7: _rational,
}
"""By a segment's type; parameters in the order of the file."""
