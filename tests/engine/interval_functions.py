"""What functions make of intervals: those of any library that is within one unit in the last place.

Such a library gives the nearest float or one beside it, but for what C fixes (ISO/IEC 9899, F.10)
and for the ranges of sine, cosine and exponential, which none leaves.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from intervals import (
    INF,
    ONE,
    ZERO,
    Flags,
    Floats,
    Interval,
    Rule,
    at,
    chosen,
    clipped,
    corners,
    enclosing,
    everything,
    exact,
    hull,
    joined,
    pieces,
    place,
    propagating,
)

from brdfc.engine.kernels import CUBE_ABOVE, INNER, ROOT_ABOVE, compute

FIXED: dict[str, Callable[..., Flags]] = {
    "exp": lambda x: (x == 0) | np.isinf(x),
    "ln": lambda x: np.isin(x, (0, 1, np.inf)),
    "log": lambda x: np.isin(x, (0, 1, np.inf)),
    "cbrt": lambda x: (x == 0) | np.isinf(x),
    "asin": lambda x: x == 0,
    "acos": lambda x: x == 1,
    "atan": lambda x: x == 0,
    "sin": lambda x: x == 0,
    "cos": lambda x: x == 0,
    "tan": lambda x: x == 0,
    "pow": lambda x, y: np.isin(np.abs(x), (0, np.inf)) | (x == 1) | (y == 0) | np.isinf(y),
    "atn2": lambda x, y: (y == 0) & ~np.signbit(x),
    "lab root": lambda t: t <= ROOT_ABOVE,  # what is below is arithmetic
}
"""Every function, and the arguments for which all libraries give the same."""

_RANGES = {"exp": (ZERO, INF), "sin": (-ONE, ONE), "cos": (-ONE, ONE)}
_REALS = (-np.inf, np.inf)
_DOMAINS = {"ln": (-0.0, np.inf), "log": (-0.0, np.inf), "asin": (-1.0, 1.0), "acos": (-1.0, 1.0)}


def moved(
    name: str, fixed: Flags, arguments: tuple[Floats, ...], *ulps: np.ndarray | int
) -> list[Floats]:
    """What libraries give that are so many floats off, each, but where the result is fixed."""
    result = np.asarray(compute(name, *arguments))
    low, high = (place(end) for end in _RANGES.get(name, _REALS))
    off = [at(np.minimum(np.maximum(place(result) + n, low), high)) for n in ulps]
    return [np.where(fixed | np.isnan(result), result, values) for values in off]


def _ends(name: str, alone: Flags, *arguments: Floats) -> Interval:
    """What libraries may give for one set of arguments. alone: there are no others; of those
    beside it, a library may give less than what is fixed for it."""
    return enclosing(*moved(name, alone & FIXED[name](*arguments), arguments, -1, 1))


def _nothing(x: Interval) -> Interval:
    return exact(np.full_like(x.low, np.nan))


def _growing(name: str) -> Rule:
    """A function that grows, or falls, all through its domain."""

    def rule(x: Interval) -> Interval:
        inside = clipped(x, *_DOMAINS.get(name, _REALS))
        found = hull([_ends(name, x.single, v) for v in (inside.low, inside.high)])
        return replace(chosen(inside.some, found, _nothing(x)), nan=inside.nan)

    return propagating(rule)


_FAR = 1e6
"""From here on a float's step is too long to look for peaks in between."""


def _passes(x: Interval, first: float, period: float) -> Flags:
    """Whether one of first + k period is inside, or so near that it may be."""
    low, high = x.low.astype(np.float64) - 1e-8, x.high.astype(np.float64) + 1e-8
    next_one = first + np.ceil((low - first) / period) * period
    far = (np.abs(x.low) > _FAR) | (np.abs(x.high) > _FAR)
    return ~x.single & (far | (next_one <= high))


def _wave(name: str, peak: float) -> Rule:
    def rule(x: Interval) -> Interval:
        ends = hull([_ends(name, x.single, v) for v in (x.low, x.high)])
        low = np.where(_passes(x, peak + np.pi, 2 * np.pi), -ONE, ends.low)
        high = np.where(_passes(x, peak, 2 * np.pi), ONE, ends.high)
        return Interval(low, high, ends.nan)

    return propagating(rule)


def _tangent(x: Interval) -> Interval:
    ends = hull([_ends("tan", x.single, v) for v in (x.low, x.high)])
    every = replace(everything(ends), nan=ends.nan)
    return chosen(_passes(x, np.pi / 2, np.pi), every, ends)


def _angle(x: Interval, y: Interval) -> Interval:
    alone = x.single & y.single
    ends = corners(lambda x, y: _ends("atn2", alone, x, y), x, y)
    cut = np.signbit(y.low) & ~np.signbit(y.high) & np.signbit(x.low)
    straight = _ends("atn2", alone, np.full_like(ends.low, -1), np.zeros_like(ends.low))
    return chosen(cut, Interval(-straight.high, straight.high, ends.nan), ends)


def _power(x: Interval, y: Interval) -> Interval:
    """Of a negative base, whole exponents give numbers; of minus infinity, all do."""

    alone = x.single & y.single

    def powers(base: Interval) -> Interval:
        return corners(lambda x, y: _ends("pow", alone, x, y), base, y)

    whole = y.single & (np.floor(y.low) == y.low)
    even = whole & (np.isinf(y.low) | (np.fmod(y.low, 2) == 0))
    negative, across = np.signbit(x.low), np.signbit(x.low) & ~np.signbit(x.high)
    real = clipped(x, -0.0, np.inf)
    roots = replace(chosen(real.some, powers(real), _nothing(x)), nan=real.nan)
    found = chosen(negative & ~alone & ~whole, roots, powers(x))
    found = chosen(even, powers(size(x)), found)
    pole = whole & ~even & across & (y.low < 0)
    odd = negative & ~alone & ~whole & ((x.low == -INF) | ~y.single)
    found = chosen(pole | odd, everything(found, nan=True), found)
    return _with_nan(x, y, found)


def _with_nan(x: Interval, y: Interval, found: Interval) -> Interval:
    """NaN to the power 0 and 1 to the power NaN are 1."""
    one = (x.nan & (y.low <= 0) & (y.high >= 0)) | (y.nan & (x.low <= 1) & (x.high >= 1))
    settled = (y.single & (y.low == 0) & ~y.nan) | (x.single & (x.low == 1) & ~x.nan)
    found = joined((found, x.some & y.some), (exact(ONE), one))
    return Interval(found.low, found.high, found.nan | ((x.nan | y.nan) & ~settled))


def size(x: Interval) -> Interval:
    """|x|."""
    ends = enclosing(np.abs(x.low), np.abs(x.high))
    across = np.signbit(x.low) & ~np.signbit(x.high)
    return Interval(np.where(across, ZERO, ends.low), ends.high, ends.nan)


def _lab_root(t: Interval) -> Interval:
    return pieces(lambda v: _ends("lab root", np.True_, v), ROOT_ABOVE, t)


def _lab_cube(f: Interval) -> Interval:
    """0 for NaN."""
    found = pieces(lambda v: exact(INNER["lab cube"](v)), CUBE_ABOVE, f)
    found = joined((found, f.some), (exact(ZERO), f.nan))
    return Interval(found.low, found.high, np.zeros_like(f.nan))


RULES: dict[str, Rule] = {
    **{name: _growing(name) for name in ("exp", "ln", "log", "cbrt", "asin", "acos", "atan")},
    "sin": _wave("sin", np.pi / 2),
    "cos": _wave("cos", 0.0),
    "tan": propagating(_tangent),
    "pow": _power,
    "atn2": propagating(_angle),
    "lab root": propagating(
        lambda t: pieces(lambda v: _ends("lab root", np.True_, v), ROOT_ABOVE, t)
    ),
    "lab cube": _lab_cube,
}
