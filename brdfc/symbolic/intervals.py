"""Intervals of numbers, as float32 arithmetic can produce them.

Bounds hold for the value a program computes; the real value lies in them up to the rounding of the
steps that lead to it. Overflow is infinity, and a result that may be subnormal may be 0, as some
engines flush it. `undefined` says that somewhere in the range the operation has no value all
engines agree on (x/0, the root of a negative number, infinity times 0).
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from fractions import Fraction

INF = math.inf
LARGEST = 3.4028234663852886e38
SMALLEST = 1.1754943508222875e-38
"""The largest float32, and the smallest that is not subnormal."""

ROUNDING = 2.0**-22
"""Four units in the last place of a float32: covers one rounding and any library's error."""


@dataclass(frozen=True)
class Interval:
    """low <= value <= high. gap: no value lies strictly between -gap and gap (0: unknown)."""

    low: float
    high: float
    undefined: bool = False
    gap: float = 0.0

    @property
    def finite(self) -> bool:
        return not self.undefined and self.low > -INF and self.high < INF

    @property
    def has_zero(self) -> bool:
        return self.low <= 0 <= self.high and self.gap == 0

    @property
    def single(self) -> bool:
        return self.low == self.high

    def __str__(self) -> str:
        return f"{self.low:.6g}..{self.high:.6g}"


EVERYTHING = Interval(-INF, INF, undefined=True)


def hull(*intervals: Interval) -> Interval:
    """The least interval that holds them all."""
    return Interval(
        min(i.low for i in intervals),
        max(i.high for i in intervals),
        any(i.undefined for i in intervals),
    )


def meet(a: Interval, b: Interval) -> Interval:
    """a, narrowed to b; a itself where they have nothing in common (then nothing is known).

    What may be undefined stays so: no bound cures it.
    """
    low, high = max(a.low, b.low), min(a.high, b.high)
    if low > high:
        return a
    gap = max(a.gap, b.gap)
    if gap > 0 and low > -gap:
        low = max(low, gap)
    if gap > 0 and high < gap:
        high = min(high, -gap)
    return Interval(low, high, a.undefined, gap) if low <= high else a


def single(value: float | Fraction) -> float:
    """The nearest float32; infinite where it overflows."""
    try:
        return float(struct.unpack("f", struct.pack("f", float(value)))[0])
    except OverflowError:
        return INF if value > 0 else -INF


def outward(low: float, high: float, *, undefined: bool = False) -> Interval:
    """Widened for the error of a library function."""
    if math.isnan(low) or math.isnan(high):
        return EVERYTHING
    low -= abs(low) * ROUNDING if math.isfinite(low) else 0.0
    high += abs(high) * ROUNDING if math.isfinite(high) else 0.0
    return float32_bounds(low, high, undefined=undefined)


def rounded(low: float, high: float, *, undefined: bool = False) -> Interval:
    """Bounds of a correctly rounded operator: rounding keeps order, so they round as values do."""
    if math.isnan(low) or math.isnan(high):
        return EVERYTHING
    return float32_bounds(single(low), single(high), undefined=undefined)


def float32_bounds(low: float, high: float, *, undefined: bool) -> Interval:
    """Overflow is infinity; what may be subnormal may be 0, as some engines flush it."""
    low = -INF if low < -LARGEST else (0.0 if 0 < low < SMALLEST else min(low, LARGEST))
    high = INF if high > LARGEST else (0.0 if -SMALLEST < high < 0 else max(high, -LARGEST))
    return Interval(low, high, undefined)


_LEAST = 2.0**-149


def above(value: float) -> float:
    """The least float32 greater than a value (never rounded up past it)."""
    return max(value + _LEAST, value * (1 + 2.0**-24) if value > 0 else value * (1 - 2.0**-24))


def below(value: float) -> float:
    return -above(-value)
