"""What every operation of a program makes of intervals: the values of any good engine.

Arithmetic is rounded to nearest, which is monotone, so that the rounded ends enclose all values
between. Functions are those of a library within one unit in the last place (interval_functions.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import reduce

import interval_functions
import interval_truth
import numpy as np
from disputed import mark
from interval_functions import size
from intervals import (
    INF,
    ZERO,
    Flags,
    Floats,
    Interval,
    Rule,
    clipped,
    corners,
    enclosing,
    exact,
    has,
    infinite,
    propagating,
)

from brdfc.engine.kernels import INNER, UNARY


def bound(name: str, *arguments: Interval) -> Interval:
    """The values that an operation may have, for those that its arguments may have."""
    found = RULES[name](*arguments)
    if name == "choose":  # rests on what is chosen only
        return found
    every = reduce(np.bitwise_or, [x.disputed for x in arguments], found.disputed)
    return replace(found, disputed=every)


def _monotone(kernel: Callable[..., Floats], *signs: int) -> Rule:
    """A function of one or two numbers that grows (1) or falls (-1) with each."""

    def rule(*arguments: Interval) -> Interval:
        ends = [(x.low, x.high)[::sign] for x, sign in zip(arguments, signs, strict=True)]
        low, high = (kernel(*(pair[k] for pair in ends)) for k in (0, 1))
        nan = np.isnan(low) | np.isnan(high)
        if len(ends) == 2:  # infinities cancel at one of the corners
            (a, b), (c, d) = ends
            nan = nan | np.isnan(kernel(a, d)) | np.isnan(kernel(b, c))
        first, last = np.where(np.isnan(low), high, low), np.where(np.isnan(high), low, high)
        none = np.isnan(first)
        return Interval(np.where(none, INF, first), np.where(none, -INF, last), nan)

    return propagating(rule)


def _square(x: Interval) -> Interval:
    sizes = size(x)
    return enclosing(sizes.low * sizes.low, sizes.high * sizes.high)


def _absolute(x: Interval) -> Interval:
    """-0 stays -0."""
    ends = enclosing(UNARY["abs"](x.low), UNARY["abs"](x.high))
    low = np.where((x.low < 0) & (x.high >= 0), np.float32(-0.0), ends.low)
    return replace(ends, low=low)


def _root(x: Interval) -> Interval:
    real = clipped(x, -0.0, np.inf)
    ends = enclosing(np.sqrt(real.low), np.sqrt(real.high))
    low, high = np.where(real.some, ends.low, INF), np.where(real.some, ends.high, -INF)
    return Interval(low, high, real.nan)


def _product(x: Interval, y: Interval) -> Interval:
    found = corners(lambda x, y: exact(x * y), x, y)
    lost = (has(x, 0) & infinite(y)) | (infinite(x) & has(y, 0))
    return replace(found, nan=found.nan | lost)


def _quotient(x: Interval, y: Interval) -> Interval:
    found = corners(lambda x, y: exact(x / y), x, y)
    nan = found.nan | (infinite(x) & infinite(y))
    return replace(found, nan=nan, disputed=mark("div", has(y, 0)))


def _remainder(x: Interval, y: Interval) -> Interval:
    """Exact where the quotient's whole part is known, else below the divisor and the dividend."""
    by, of = size(y), size(x)
    far = ~(of.high.astype(np.float64) < by.low.astype(np.float64) * 2**24)
    odd = ~(x.some & y.some) | x.nan | y.nan | infinite(x) | infinite(y) | far | (by.low < 1e-12)
    first, last = (np.fmod(v, y.low) for v in (x.low, x.high))
    turns = (x.low.astype(np.float64) - first) / y.low, (x.high.astype(np.float64) - last) / y.low
    same = y.single & (np.rint(turns[0]) == np.rint(turns[1]))
    same &= np.signbit(x.low) == np.signbit(x.high)
    reach = np.minimum(by.high, of.high)
    low = np.where(same, first, np.where(x.low >= 0, ZERO, -reach))
    high = np.where(same, last, np.where(x.high <= 0, ZERO, reach))
    return Interval(low, high, np.zeros_like(odd), mark("mod", odd))


def _whole(name: str) -> Rule:
    def rule(x: Interval) -> Interval:
        far: Flags = x.some & ((x.high >= 2.0**31) | (x.low <= -(2.0**31)))
        ends = enclosing(UNARY[name](x.low), UNARY[name](x.high))
        return replace(ends, disputed=mark(name, far | x.nan))

    return rule


_ADD, _SUB, _MUL = _monotone(np.add, 1, 1), _monotone(np.subtract, 1, -1), propagating(_product)
_ABS = propagating(_absolute)

RULES: dict[str, Rule] = {
    **interval_functions.RULES,
    **interval_truth.RULES,
    "add": _ADD,
    "sub": _SUB,
    "mul": _MUL,
    "div": propagating(_quotient),
    "mod": _remainder,
    "near": lambda x, y: interval_truth.near(_ABS(_SUB(x, y))),
    "neg": _monotone(np.negative, -1),
    "sq": propagating(_square),
    "cb": _monotone(UNARY["cb"], 1),
    "sqrt": propagating(_root),
    "abs": _ABS,
    "flor": _monotone(np.floor, 1),
    "ceil": _monotone(np.ceil, 1),
    "trnc": _whole("trnc"),
    "rond": _whole("rond"),
    "sum": lambda *values: reduce(_ADD, values),
    "prod": lambda *values: reduce(_MUL, values),
    "lab lightness": _monotone(INNER["lab lightness"], 1),
    "lab fx": _monotone(INNER["lab fx"], 1, 1),
    "lab fz": _monotone(INNER["lab fz"], -1, 1),
}
"""Of every operation of kernels.py, by name."""
