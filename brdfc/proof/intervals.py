"""Interval arithmetic on arrays: enclosures of exact values, many at once.

An enclosure holds every value that its arguments' enclosures allow, where there is one. Bounds are
rounded outwards: NumPy's functions are within four units in the last place, which WIDER covers;
what underflows counts as 0. A bound that is NaN, or infinite, bounds nothing (R. Moore,
R. Kearfott, M. Cloud, Introduction to Interval Analysis, SIAM 2009).
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from brdfc.symbolic.expression import nearest

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

WIDER = 2.0**-50
"""Relative: four units in the last place of a float64."""
_TURN = 2 * np.pi
_GREATEST = float(np.finfo(np.float64).max)


class Enclosure(NamedTuple):
    """low <= value <= high."""

    low: Array
    high: Array

    @property
    def size(self) -> Array:
        """The largest absolute value."""
        return np.maximum(np.abs(self.low), np.abs(self.high))

    @property
    def middle(self) -> Array:
        return (self.low + self.high) / 2


def enclosure(low: Array, high: Array) -> Enclosure:
    """Rounded outwards."""
    return Enclosure(low - np.abs(low) * WIDER, high + np.abs(high) * WIDER)


def exactly(value: float) -> Enclosure:
    """A number that float64 holds."""
    held = np.array([[value]])
    return Enclosure(held, held)


def number(value: Fraction) -> Enclosure:
    """A rational number."""
    held = nearest(value)
    if not np.isfinite(held):
        ends = np.array([[_GREATEST]]), np.array([[np.inf]])
        return Enclosure(*ends) if held > 0 else neg(Enclosure(*ends))
    return exactly(held) if value == Fraction(held) else enclosure(*exactly(held))


def hull(*several: Enclosure) -> Enclosure:
    """What holds them all."""
    low, high = several[0]
    for one in several[1:]:
        low, high = np.minimum(low, one.low), np.maximum(high, one.high)
    return Enclosure(low, high)


def meet(a: Enclosure, b: Enclosure) -> Enclosure:
    """What both allow: two enclosures of one value have something in common."""
    return Enclosure(np.fmax(a.low, b.low), np.fmin(a.high, b.high))


# ---------------------------------------------------------------- arithmetic


def add(a: Enclosure, b: Enclosure) -> Enclosure:
    return enclosure(a.low + b.low, a.high + b.high)


def neg(a: Enclosure) -> Enclosure:
    return Enclosure(-a.high, -a.low)


def sub(a: Enclosure, b: Enclosure) -> Enclosure:
    return add(a, neg(b))


def mul(a: Enclosure, b: Enclosure) -> Enclosure:
    if a.low is a.high:
        a, b = b, a
    p, q = _times(a.low, b.low), _times(a.high, b.low)
    low, high = np.minimum(p, q), np.maximum(p, q)
    if b.low is not b.high:  # else b is one number
        p, q = _times(a.low, b.high), _times(a.high, b.high)
        low, high = np.minimum(low, np.minimum(p, q)), np.maximum(high, np.maximum(p, q))
    return enclosure(low, high)


def _times(x: Array, y: Array) -> Array:
    """A product of bounds: 0 times infinity is 0, as the values themselves are finite."""
    product = x * y
    if np.isnan(product).any():
        return np.where((x == 0) | (y == 0), 0.0, product)
    return product


def square(a: Enclosure) -> Enclosure:
    least = np.maximum(np.maximum(a.low, -a.high), 0.0)
    return _from_zero(enclosure(least * least, a.size**2))


def _from_zero(a: Enclosure) -> Enclosure:
    """What is never negative; what is not known stays so."""
    return Enclosure(np.fmax(a.low, 0.0), np.maximum(a.high, 0.0))


def reciprocal(a: Enclosure) -> Enclosure:
    """1/x; where the enclosure reaches 0 from one side only, that side's infinity."""
    above, below = (a.low >= 0) & (a.high > 0), (a.high <= 0) & (a.low < 0)
    low = np.where(above | (a.high < 0), 1 / a.high, -np.inf)
    high = np.where(below | (a.low > 0), 1 / a.low, np.inf)
    return enclosure(low, high)


def div(a: Enclosure, b: Enclosure) -> Enclosure:
    return mul(a, reciprocal(b))


# ---------------------------------------------------------------- functions


def rising(function: Callable[[Array], Array]) -> Callable[[Enclosure], Enclosure]:
    """The rule of a function that never falls."""
    return lambda a: enclosure(function(a.low), function(a.high))


atan, cbrt = rising(np.arctan), rising(np.cbrt)
expm1, log1p = rising(np.expm1), rising(np.log1p)
_SMALL, _LARGE = 1e-300, 1e300


def exp(a: Enclosure) -> Enclosure:
    """Never 0 and never infinite, as products of what underflows and what overflows may be
    anything."""
    return _in_reach(np.exp(a.low), np.exp(a.high))


def _in_reach(low: Array, high: Array) -> Enclosure:
    """The bounds of what is above 0, where either may have left float64's range."""
    low, high = np.minimum(low, _LARGE), np.maximum(high, _SMALL)
    return enclosure(np.where(low < _SMALL, 0.0, low), high)


def sqrt(a: Enclosure) -> Enclosure:
    root = enclosure(np.sqrt(np.fmax(a.low, 0.0)), np.sqrt(np.maximum(a.high, 0.0)))
    return _from_zero(root)


def ln(a: Enclosure) -> Enclosure:
    return enclosure(np.log(np.fmax(a.low, 0.0)), np.log(np.maximum(a.high, 0.0)))


def _holds(a: Enclosure, offset: float) -> Mask:
    """Whether offset and whole turns from it lie in the enclosure, within rounding."""
    slack = 1e-12 * np.maximum(1.0, a.size)
    turns = np.ceil((a.low - slack - offset) / _TURN)
    return np.asarray(~(offset + turns * _TURN > a.high + slack))


def cos(a: Enclosure) -> Enclosure:
    ends = np.cos(a.low), np.cos(a.high)
    low = np.where(_holds(a, np.pi), -1.0, np.minimum(*ends))
    high = np.where(_holds(a, 0.0), 1.0, np.maximum(*ends))
    wide = enclosure(low, high)
    return Enclosure(np.fmax(wide.low, -1.0), np.fmin(wide.high, 1.0))


_QUARTER = Enclosure(
    np.array([[np.nextafter(np.pi / 2, 0.0)]]), np.array([[np.nextafter(np.pi / 2, 2.0)]])
)


def sin(a: Enclosure) -> Enclosure:
    """Near 0 as good as the angle: |sin x| <= |x|."""
    wide = cos(sub(a, _QUARTER))
    ends = enclosure(np.sin(a.low), np.sin(a.high))
    small = a.size < 1.5
    return Enclosure(np.where(small, ends.low, wide.low), np.where(small, ends.high, wide.high))


def tan(a: Enclosure) -> Enclosure:
    """Within one branch only."""
    cosine = cos(a)
    inside = cosine.low > 0
    ends = enclosure(np.tan(a.low), np.tan(a.high))
    # From the cosine, where the angle lies in another branch than that around 0.
    inside &= a.size < 1.6
    if inside.all():
        return ends
    other = div(sin(a), cosine)
    return Enclosure(np.where(inside, ends.low, other.low), np.where(inside, ends.high, other.high))


def asin(a: Enclosure) -> Enclosure:
    return rising(np.arcsin)(Enclosure(np.fmax(a.low, -1.0), np.fmin(a.high, 1.0)))


def acos(a: Enclosure) -> Enclosure:
    return _from_zero(sub(_QUARTER, asin(a)))


def atan2(y: Enclosure, x: Enclosure) -> Enclosure:
    corners = [np.arctan2(v, u) for v in y for u in x]
    wide = enclosure(np.minimum.reduce(corners), np.maximum.reduce(corners))
    right = x.low > 0  # elsewhere the half turn behind is in reach
    return Enclosure(np.where(right, wide.low, -3.15), np.where(right, wide.high, 3.15))


def whole_power(a: Enclosure, exponent: int) -> Enclosure:
    """x to a whole constant."""
    if exponent < 0:
        return reciprocal(whole_power(a, -exponent))
    if exponent % 2:
        return enclosure(a.low**exponent, a.high**exponent)
    least = np.maximum(np.maximum(a.low, -a.high), 0.0)
    return _from_zero(enclosure(least**exponent, a.size**exponent))


def power(a: Enclosure, b: Enclosure) -> Enclosure:
    """x to any exponent, x not negative: monotone in each, so bounds are at corners. Of a negative
    x nothing is known: it has a value for some exponents."""
    bases = [np.where(end < 0, np.nan, end) for end in a]
    corners = [np.power(x, y) for x in bases for y in b]
    found = _in_reach(np.minimum.reduce(corners), np.maximum.reduce(corners))
    # x^0 is 1 for every x, 0 too; the corners of a range of exponents around 0 miss that at x = 0.
    zero = (b.low <= 0) & (b.high >= 0)
    return Enclosure(
        np.where(zero, np.minimum(found.low, 1.0), found.low),
        np.where(zero, np.maximum(found.high, 1.0), found.high),
    )


def absolute(a: Enclosure) -> Enclosure:
    return Enclosure(np.maximum(np.maximum(a.low, -a.high), 0.0), a.size)


LOG10 = enclosure(*exactly(1 / float(np.log(10.0))))
THIRD = enclosure(*exactly(1 / 3))

FUNCTIONS: dict[str, Callable[[Enclosure], Enclosure]] = {
    "exp": exp,
    "ln": ln,
    "log10": lambda a: mul(ln(a), LOG10),
    "sqrt": sqrt,
    "cbrt": cbrt,
    "sin": sin,
    "cos": cos,
    "tan": tan,
    "asin": asin,
    "acos": acos,
    "atan": atan,
}
"""Of one argument, by operator of an expression."""


def truth(surely: Mask, never: Mask) -> Enclosure:
    """Of a condition: 1 where it holds, 0 where it does not."""
    return Enclosure(np.where(surely, 1.0, 0.0), np.where(never, 0.0, 1.0))


def _not(a: Enclosure) -> Enclosure:
    return Enclosure(1 - a.high, 1 - a.low)


def _equal(a: Enclosure, b: Enclosure) -> Enclosure:
    same = (a.low == a.high) & (b.low == b.high) & (a.low == b.low)
    return truth(same, (a.high < b.low) | (b.high < a.low))


CONDITIONS: dict[str, Callable[..., Enclosure]] = {
    "lt": lambda a, b: truth(a.high < b.low, a.low >= b.high),
    "le": lambda a, b: truth(a.high <= b.low, a.low > b.high),
    "gt": lambda a, b: truth(a.low > b.high, a.high <= b.low),
    "ge": lambda a, b: truth(a.low >= b.high, a.high < b.low),
    "eq": _equal,
    "ne": lambda a, b: _not(_equal(a, b)),
    "and": lambda a, b: Enclosure(np.minimum(a.low, b.low), np.minimum(a.high, b.high)),
    "or": lambda a, b: Enclosure(np.maximum(a.low, b.low), np.maximum(a.high, b.high)),
    "not": _not,
}
"""Of numbers or truth values, by operator of an expression."""
