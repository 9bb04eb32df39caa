"""Intervals of the trigonometric functions and their inverses."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

from brdfc.symbolic.intervals import EVERYTHING, ROUNDING, Interval, outward, single


@cache
def _nearest_to_zero(low: float, high: float) -> float:
    """The least |cos x| over float32 numbers x in low..high.

    No float32 is an odd multiple of pi/2, so the cosine a program computes is never 0: beside
    pi/2 it is 4.4e-8. Found at the two floats around each zero, in high precision.
    """
    import numpy as np
    from mpmath import mp

    with mp.workdps(40):
        first = int(mp.ceil(low / mp.pi - mp.mpf("0.5")))
        last = int(mp.floor(high / mp.pi - mp.mpf("0.5")))
        if last - first > 1000:
            return 0.0
        # One zero beyond either end: the nearest float to it may lie inside.
        zeros = [(k + mp.mpf("0.5")) * mp.pi for k in range(first - 1, last + 2)]
        candidates = []
        for zero in zeros:
            middle = np.float32(float(zero))
            sides = (np.nextafter(middle, -np.inf), middle, np.nextafter(middle, np.inf))
            candidates += [float(s) for s in sides if low <= float(s) <= high]
        edges = [abs(mp.cos(mp.mpf(x))) for x in (*candidates, low, high)]
        return float(min(edges)) * (1 - 1e-6)


def widest_above(cosine: float) -> float:
    """A bound on |x| for float32 angles x whose computed cosine exceeds a bound of 0..1.

    Beside pi/2 the sign of a cosine is never in doubt. Elsewhere it may have been rounded up past
    the bound, so the angle is that of a slightly lesser cosine.
    """
    if cosine > 0:
        return math.acos(min(cosine, 1.0) * (1 - ROUNDING)) * (1 + ROUNDING)
    x = single(math.pi / 2)
    while math.cos(x) <= 0:
        x = single(x * (1 - 2.0**-24))
    return x


def _cos(a: Interval) -> Interval:
    if not a.finite:
        return Interval(-1.0, 1.0, undefined=True)
    edges = (math.cos(a.low), math.cos(a.high))
    low = -1.0 if holds_multiple(a, math.pi, 2 * math.pi) else min(edges)
    high = 1.0 if holds_multiple(a, 0.0, 2 * math.pi) else max(edges)
    gap = _nearest_to_zero(a.low, a.high) if low <= 0 <= high else 0.0
    return unit(low, high, undefined=a.undefined, gap=gap)


def unit(low: float, high: float, *, undefined: bool, gap: float = 0.0) -> Interval:
    """Bounds of a sine or cosine, which no library takes beyond -1..1."""
    wide = outward(low, high, undefined=undefined)
    return Interval(max(wide.low, -1.0), min(wide.high, 1.0), undefined, gap)


def holds_multiple(a: Interval, offset: float, period: float) -> bool:
    """Whether offset + k period lies in the interval, within rounding."""
    slack = 1e-6 * max(1.0, abs(a.low), abs(a.high))
    k = math.ceil((a.low - slack - offset) / period)
    return offset + k * period <= a.high + slack


def _sin(a: Interval) -> Interval:
    if not a.finite:
        return Interval(-1.0, 1.0, undefined=True)
    edges = (math.sin(a.low), math.sin(a.high))
    low = -1.0 if holds_multiple(a, -math.pi / 2, 2 * math.pi) else min(edges)
    high = 1.0 if holds_multiple(a, math.pi / 2, 2 * math.pi) else max(edges)
    return unit(low, high, undefined=a.undefined)


def _tan(a: Interval) -> Interval:
    cosine = _cos(a)
    if not cosine.finite or cosine.has_zero:
        return EVERYTHING
    if cosine.low <= 0 <= cosine.high:
        return outward(-1 / cosine.gap, 1 / cosine.gap, undefined=a.undefined)
    return outward(math.tan(a.low), math.tan(a.high), undefined=a.undefined)


def _arc(
    function: Callable[[float], float], low: float, high: float
) -> Callable[[Interval], Interval]:
    def rule(a: Interval) -> Interval:
        bounds = [function(min(max(v, -1.0), 1.0)) for v in (a.low, a.high)]
        undefined = a.undefined or a.low < -1 or a.high > 1
        wide = outward(min(bounds), max(bounds), undefined=undefined)
        return Interval(max(wide.low, low), min(wide.high, high), undefined)

    return rule


def _atan(a: Interval) -> Interval:
    return outward(math.atan(a.low), math.atan(a.high), undefined=a.undefined)


_PI = 3.1415928  # a float32 pi is slightly more than pi

TRIGONOMETRY: dict[str, Callable[..., Interval]] = {
    "sin": _sin,
    "cos": _cos,
    "tan": _tan,
    "asin": _arc(math.asin, -_PI / 2, _PI / 2),
    "acos": _arc(math.acos, 0.0, _PI),
    "atan": _atan,
    "atan2": lambda y, x: Interval(-_PI, _PI, y.undefined or x.undefined),
}
"""By operator, as bounds.RULES."""
