"""What relations, truths and choices make of intervals: where two overlap, both answers may be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import reduce

import numpy as np
from disputed import mark
from intervals import (
    INF,
    ONE,
    ZERO,
    Flags,
    Floats,
    Interval,
    Rule,
    enclosing,
    exact,
    greatest,
    infinite,
    joined,
    least,
)

from brdfc.engine.kernels import UNARY

HALF = np.float32(0.5)
Relation = Callable[[Interval, Interval], Flags]


def truth(may: Flags, may_not: Flags) -> Interval:
    """1, 0, or all between them."""
    low, high = np.where(may_not, ZERO, ONE), np.where(may, ONE, ZERO)
    return Interval(low, high, np.zeros_like(np.asarray(may)))


def _relation(holds: Relation, fails: Relation) -> Rule:
    """NaN is in no relation to anything."""

    def rule(x: Interval, y: Interval) -> Interval:
        some = x.some & y.some
        return truth(some & holds(x, y), (some & fails(x, y)) | x.nan | y.nan)

    return rule


def _less(x: Interval, y: Interval) -> Flags:
    return x.low < y.high


def _at_most(x: Interval, y: Interval) -> Flags:
    return x.low <= y.high


def _greater(x: Interval, y: Interval) -> Flags:
    return x.high > y.low


def _at_least(x: Interval, y: Interval) -> Flags:
    return x.high >= y.low


def _equal(x: Interval, y: Interval) -> Interval:
    some = x.some & y.some
    may = some & _at_most(x, y) & _at_least(x, y)
    alone = x.single & y.single & (x.low == y.low)
    found = truth(may, (some & ~alone) | x.nan | y.nan)
    return replace(found, disputed=mark("eq", x.nan & y.nan))


def _unequal(x: Interval, y: Interval) -> Interval:
    same = _equal(x, y)
    return replace(same, low=ONE - same.high, high=ONE - same.low)


def near(apart: Interval) -> Interval:
    """Of |x - y|."""
    close = np.float64(1e-5)
    return truth(apart.some & (apart.low < close), (apart.some & (apart.high >= close)) | apart.nan)


def may_hold(x: Interval) -> Flags:
    return x.some & (x.high >= HALF)


def may_fail(x: Interval) -> Flags:
    return (x.some & (x.low < HALF)) | x.nan


def _and(x: Interval, y: Interval) -> Interval:
    return truth(may_hold(x) & may_hold(y), may_fail(x) | may_fail(y))


def _xor(x: Interval, y: Interval) -> Interval:
    return truth(
        (may_hold(x) & may_fail(y)) | (may_fail(x) & may_hold(y)),
        (may_hold(x) & may_hold(y)) | (may_fail(x) & may_fail(y)),
    )


def _all_hold(*values: Interval) -> Interval:
    """A NaN counts as true here and nowhere else."""
    may = reduce(np.logical_and, [may_hold(x) | x.nan for x in values])
    return truth(may, reduce(np.logical_or, [x.some & (x.low < HALF) for x in values]))


def _any_holds(*values: Interval) -> Interval:
    may = reduce(np.logical_or, [may_hold(x) for x in values])
    return truth(may, reduce(np.logical_and, [may_fail(x) for x in values]))


def _sign(x: Interval) -> Interval:
    ends = enclosing(UNARY["sign"](x.low), UNARY["sign"](x.high))
    return joined((ends, x.some), (exact(ZERO), x.nan))


def _finite(x: Interval) -> Interval:
    found = truth(x.some & (x.low < INF) & (x.high > -INF), infinite(x) | x.nan)
    return replace(found, disputed=mark("rnum", x.nan))


def _choose(condition: Interval, x: Interval, y: Interval) -> Interval:
    found = joined((x, may_hold(condition)), (y, may_fail(condition)))
    return replace(found, disputed=found.disputed | condition.disputed)


def _extreme(best: Callable[..., Floats], may_x: Relation, may_y: Relation) -> Rule:
    """X where it is beyond Y, else Y: so also where one of them is NaN."""

    def rule(x: Interval, y: Interval) -> Interval:
        some = x.some & y.some
        is_x, is_y = some & may_x(x, y), some & may_y(x, y)
        low, high = best(x.low, y.low), best(x.high, y.high)
        # Of two zeros it is Y, whatever the signs.
        low, high = np.where(low == 0, np.float32(-0.0), low), np.where(high == 0, ZERO, high)
        never = np.zeros_like(some)
        found = joined(
            (Interval(low, high, never), is_x & is_y),
            (replace(x, nan=never), is_x & ~is_y),
            (replace(y, nan=never), (is_y & ~is_x) | x.nan),
        )
        return replace(found, nan=y.nan)

    return rule


def _extreme_of(two: Rule) -> Rule:
    """Two values as `vmin` has them; of more, the deepest is kept until a better one is found."""

    def rule(*values: Interval) -> Interval:
        if len(values) == 2:
            return two(*values)
        return reduce(lambda kept, other: two(other, kept), values)

    return rule


_LEAST = _extreme(least, _less, _at_least)
_GREATEST = _extreme(greatest, _greater, _at_most)

RULES: dict[str, Rule] = {
    "lt": _relation(_less, _at_least),
    "le": _relation(_at_most, _greater),
    "gt": _relation(_greater, _at_most),
    "ge": _relation(_at_least, _less),
    "eq": _equal,
    "neq": _unequal,
    "vand": _and,
    "vor": _any_holds,
    "vxor": _xor,
    "and": _all_hold,
    "or": _any_holds,
    "not": lambda x: truth(may_fail(x), may_hold(x)),
    "sign": _sign,
    "rnum": _finite,
    "choose": _choose,
    "vmin": _LEAST,
    "vmax": _GREATEST,
    "min": _extreme_of(_LEAST),
    "max": _extreme_of(_GREATEST),
}
