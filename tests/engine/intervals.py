"""Intervals of float32 values: what any engine may have for each pixel.

An interval runs from low to high through all floats, of which -0 stands just below 0, so that the
sign of a zero is known where it is settled. It holds nothing where low is above high. Whether the
value may be NaN stands beside it, and which of the points that engines dispute it rests on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import reduce

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float32]
Flags = NDArray[np.bool_]

INF, ZERO, ONE = np.float32(np.inf), np.float32(0), np.float32(1)
_HIGHEST = 0x7F800000
NOWHERE = np.int64(0)


@dataclass(frozen=True)
class Interval:
    """low, high, nan (may be NaN): one for each pixel, or one for all. disputed: bit k where the
    value rests on the k-th of the points that engines dispute."""

    low: Floats
    high: Floats
    nan: Flags
    disputed: NDArray[np.int64] | np.int64 = NOWHERE

    @property
    def some(self) -> Flags:
        """Whether there is a number in it."""
        return self.low <= self.high

    @property
    def single(self) -> Flags:
        """Whether there is just one number in it."""
        return self.low == self.high

    def contains(self, values: Floats) -> Flags:
        """Whether an engine may have these; 0 is as good as -0."""
        inside = (self.low <= values) & (values <= self.high)
        return np.where(np.isnan(values), self.nan, inside)


def _ordered(values: ArrayLike) -> NDArray[np.int32]:
    """Numbers in the order of floats, -1 for -0 and 0 for 0. It undoes itself."""
    bits = np.asarray(values, dtype=np.float32).view(np.int32)
    return bits ^ ((bits >> 31) & 0x7FFFFFFF)


def _floats(numbers: NDArray[np.int32]) -> Floats:
    return (numbers ^ ((numbers >> 31) & 0x7FFFFFFF)).view(np.float32)


def least(*values: Floats) -> Floats:
    """The least of floats; of zeros, -0."""
    return _floats(reduce(np.minimum, map(_ordered, values)))


def greatest(*values: Floats) -> Floats:
    """The greatest of floats; of zeros, 0."""
    return _floats(reduce(np.maximum, map(_ordered, values)))


def place(values: ArrayLike) -> NDArray[np.int64]:
    """Floats numbered from -inf to inf, -1 for -0 and 0 for 0."""
    return _ordered(values).astype(np.int64)


def at(places: NDArray[np.int64]) -> Floats:
    """The floats of these numbers; what lies beyond the infinities is infinite."""
    within = np.minimum(np.maximum(places, ~_HIGHEST), _HIGHEST)
    return _floats(np.asarray(within, dtype=np.int32))


def exact(values: ArrayLike) -> Interval:
    """One value a pixel."""
    return enclosing(np.asarray(values, dtype=np.float32))


def enclosing(*values: Floats) -> Interval:
    """From the least to the greatest of some values; NaN where any of them is."""
    nan = [np.isnan(v) for v in values]
    lows = [np.where(n, INF, v) for n, v in zip(nan, values, strict=True)]
    highs = [np.where(n, -INF, v) for n, v in zip(nan, values, strict=True)]
    return Interval(least(*lows), greatest(*highs), reduce(np.logical_or, nan))


def joined(*parts: tuple[Interval, Flags]) -> Interval:
    """All values of those intervals that their flags let in, with what they rest on."""
    return Interval(
        least(*(np.where(use, x.low, INF) for x, use in parts)),
        greatest(*(np.where(use, x.high, -INF) for x, use in parts)),
        reduce(np.logical_or, [x.nan & use for x, use in parts]),
        reduce(np.bitwise_or, [np.where(use, x.disputed, 0) for x, use in parts]),
    )


def chosen(condition: Flags, x: Interval, y: Interval) -> Interval:
    """x where the condition holds, else y."""
    return Interval(
        np.where(condition, x.low, y.low),
        np.where(condition, x.high, y.high),
        np.where(condition, x.nan, y.nan),
        np.where(condition, x.disputed, y.disputed),
    )


def everything(x: Interval, *, nan: bool = False) -> Interval:
    """All numbers, for as many pixels as another interval has."""
    every = np.full_like(x.low, INF)
    return Interval(-every, every, np.full_like(x.nan, nan))


def widened(x: Interval, ulps: int) -> Interval:
    """So many floats more at either end."""
    low, high = at(place(x.low) - ulps), at(place(x.high) + ulps)
    return replace(x, low=np.where(x.some, low, INF), high=np.where(x.some, high, -INF))


def clipped(x: Interval, low: float, high: float) -> Interval:
    """The numbers of it that are in a range; NaN where there are others."""
    outside = x.some & ((x.low < low) | (x.high > high))
    first, last = np.maximum(place(x.low), place(low)), np.minimum(place(x.high), place(high))
    some = first <= last
    return Interval(np.where(some, at(first), INF), np.where(some, at(last), -INF), x.nan | outside)


def around(values: Floats, distance: NDArray[np.float64]) -> Interval:
    """All within a distance of a value; the value itself where that is 0."""
    low, high = (place((values + d).astype(np.float32)) for d in (-distance, distance))
    beyond = (distance > 0).astype(np.int64)
    return Interval(at(low - beyond), at(high + beyond), np.isnan(values))


Rule = Callable[..., Interval]


def propagating(rule: Rule) -> Rule:
    """A rule for numbers that gives NaN for NaN."""

    def bound(*arguments: Interval) -> Interval:
        found = rule(*arguments)
        some = reduce(np.logical_and, [x.some for x in arguments])
        nan = reduce(np.logical_or, [x.nan for x in arguments], found.nan & some)
        some = some & found.some
        low, high = np.where(some, found.low, INF), np.where(some, found.high, -INF)
        return Interval(low, high, nan, found.disputed)

    return bound


def corners(kernel: Rule, x: Interval, y: Interval) -> Interval:
    """The hull of a function of floats that takes its extremes at the corners."""
    found = [kernel(a, b) for a in (x.low, x.high) for b in (y.low, y.high)]
    return hull(found)


def pieces(kernel: Callable[[Floats], Interval], joint: float, x: Interval) -> Interval:
    """The hull of a function of floats with two growing pieces."""
    single = np.float32(joint)
    around_it = (np.nextafter(single, -INF), single, np.nextafter(single, INF))
    return hull(
        [kernel(v) for v in (x.low, *(np.clip(j, x.low, x.high) for j in around_it), x.high)]
    )


def hull(parts: Sequence[Interval]) -> Interval:
    """All values of some intervals."""
    return joined(*((x, np.True_) for x in parts))


def has(x: Interval, value: float) -> Flags:
    """Whether a number may be this."""
    return (x.low <= value) & (x.high >= value)


def infinite(x: Interval) -> Flags:
    """Whether a number may be infinite."""
    return has(x, np.inf) | has(x, -np.inf)
