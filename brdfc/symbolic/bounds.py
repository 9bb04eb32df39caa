"""The interval of each operator's result from the intervals of its arguments: one table, RULES.

The arithmetic operators round correctly, so their bounds are the rounded bounds; the results of
library functions are widened by a few units in the last place.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from brdfc.symbolic.intervals import EVERYTHING, INF, Interval, outward, rounded, single
from brdfc.symbolic.trigonometry import TRIGONOMETRY

TRUTH = Interval(0.0, 1.0)
WHOLE_LIMIT = 2.0**31
"""From here on engines disagree about rounding to whole numbers (they pass through an int)."""
LONGEST_CHAIN = 64
"""Greatest whole exponent that becomes multiplications; beyond it the power operator is cheaper."""


def _add(a: Interval, b: Interval) -> Interval:
    return rounded(a.low + b.low, a.high + b.high, undefined=a.undefined or b.undefined)


def _neg(a: Interval) -> Interval:
    return Interval(-a.high, -a.low, a.undefined, a.gap)


def _products(a: Interval, b: Interval, function: Callable[[float, float], float]) -> Interval:
    corners = [function(x, y) for x in (a.low, a.high) for y in (b.low, b.high)]
    if any(map(math.isnan, corners)):
        return EVERYTHING
    return rounded(min(corners), max(corners), undefined=a.undefined or b.undefined)


def _mul(a: Interval, b: Interval) -> Interval:
    # Infinity times 0 is NaN also where the two are not corners of the same box.
    poisonous = (not a.finite and b.has_zero) or (not b.finite and a.has_zero)
    if poisonous:
        return EVERYTHING
    return _products(a, b, lambda x, y: 0.0 if x == 0 or y == 0 else x * y)


def _div(a: Interval, b: Interval) -> Interval:
    if b.low <= 0 <= b.high:
        if b.has_zero or not a.finite:
            return EVERYTHING
        bound = max(abs(a.low), abs(a.high)) / b.gap
        return outward(-bound, bound, undefined=a.undefined or b.undefined)
    if not a.finite and not b.finite:
        return EVERYTHING
    return _products(a, b, lambda x, y: 0.0 if math.isinf(y) else x / y)


def square(a: Interval) -> Interval:
    """x times itself."""
    edges = [INF if abs(v) > 1e100 else v * v for v in (a.low, a.high)]
    low = a.gap**2 if a.low <= 0 <= a.high else min(edges)
    return rounded(low, max(edges), undefined=a.undefined)


def whole_power(a: Interval, exponent: int) -> Interval:
    """A constant whole exponent: repeated multiplication, as programs have it."""
    if exponent < 0:
        return _div(Interval(1.0, 1.0), whole_power(a, -exponent))
    if exponent == 0:
        return Interval(1.0, 1.0)
    sizes = [_repeated(abs(v), exponent) for v in (a.low, a.high)]
    if exponent % 2 == 0:
        low = _repeated(a.gap, exponent) if a.low <= 0 <= a.high else min(sizes)
        high = max(sizes)
    else:
        low, high = (math.copysign(x, v) for x, v in zip(sizes, (a.low, a.high), strict=True))
    if exponent > LONGEST_CHAIN:
        return outward(low, high, undefined=a.undefined)
    return rounded(low, high, undefined=a.undefined)


def _repeated(x: float, exponent: int) -> float:
    """x >= 0 to a whole power, rounded where a program rounds; monotone, as each step is."""
    if exponent > LONGEST_CHAIN:
        return _pow(x, exponent)
    if exponent == 1:
        return x
    if exponent == 3:
        return single(single(x * x) * x)
    if exponent % 2 == 0:
        half = _repeated(x, exponent // 2)
        return single(half * half)
    return single(_repeated(x, exponent - 1) * x)


def _power(a: Interval, b: Interval) -> Interval:
    """x^y is monotone in x and in y, so its bounds are at corners. 0^0 is 1 on every engine."""
    undefined = a.undefined or b.undefined or a.low < 0 or (a.low == 0 and b.low < 0)
    bases = (max(a.low, 0.0), max(a.high, 0.0))
    corners = [_pow(x, y) for x in bases for y in (b.low, b.high)]
    if bases[0] == 0 and b.low <= 0 <= b.high:
        corners += [0.0, 1.0]
    if any(map(math.isnan, corners)):
        return EVERYTHING
    return outward(min(corners), max(corners), undefined=undefined)


def _pow(x: float, y: float) -> float:
    try:
        return float(x**y)
    except (OverflowError, ZeroDivisionError):
        return INF


def _monotone(function: Callable[[float], float]) -> Callable[[Interval], Interval]:
    return lambda a: outward(function(a.low), function(a.high), undefined=a.undefined)


def _exp(a: Interval) -> Interval:
    def exp(x: float) -> float:
        return INF if x > 709 else math.exp(x)

    return _monotone(exp)(a)


def _sqrt(a: Interval) -> Interval:
    low, high = math.sqrt(max(a.low, 0.0)), math.sqrt(max(a.high, 0.0))
    return rounded(low, high, undefined=a.undefined or a.low < 0)


def _log(function: Callable[[float], float]) -> Callable[[Interval], Interval]:
    def rule(a: Interval) -> Interval:
        low = function(a.low) if a.low > 0 else -INF
        high = function(a.high) if a.high > 0 else -INF
        return outward(low, high, undefined=a.undefined or a.low <= 0)

    return rule


def _abs(a: Interval) -> Interval:
    low = a.gap if a.low <= 0 <= a.high else min(abs(a.low), abs(a.high))
    return Interval(low, max(abs(a.low), abs(a.high)), a.undefined, a.gap)


def _step(function: Callable[[float], float]) -> Callable[[Interval], Interval]:
    def rule(a: Interval) -> Interval:
        bounds = [float(function(v)) if math.isfinite(v) else v for v in (a.low, a.high)]
        return Interval(bounds[0], bounds[1], a.undefined)

    return rule


def _through_int(function: Callable[[float], float]) -> Callable[[Interval], Interval]:
    def rule(a: Interval) -> Interval:
        stepped = _step(function)(a)
        large = a.low < -WHOLE_LIMIT or a.high > WHOLE_LIMIT
        return Interval(stepped.low, stepped.high, a.undefined or large)

    return rule


def _sign(a: Interval) -> Interval:
    bounds = [float((v > 0) - (v < 0)) for v in (a.low, a.high)]
    return Interval(bounds[0], bounds[1], a.undefined)


def _round_away(x: float) -> float:
    return math.trunc(x + math.copysign(0.5, x))


def _min(a: Interval, b: Interval) -> Interval:
    return Interval(min(a.low, b.low), min(a.high, b.high), a.undefined or b.undefined)


def _max(a: Interval, b: Interval) -> Interval:
    return Interval(max(a.low, b.low), max(a.high, b.high), a.undefined or b.undefined)


def _compare(
    surely: Callable[[Interval, Interval], bool], never: Callable[[Interval, Interval], bool]
) -> Callable[[Interval, Interval], Interval]:
    def rule(a: Interval, b: Interval) -> Interval:
        if a.undefined or b.undefined:
            return TRUTH
        if surely(a, b):
            return Interval(1.0, 1.0)
        return Interval(0.0, 0.0) if never(a, b) else TRUTH

    return rule


def _apart(a: Interval, b: Interval) -> bool:
    return a.high < b.low or b.high < a.low


def _same(a: Interval, b: Interval) -> bool:
    return a.single and b.single and a.low == b.low


RULES: dict[str, Callable[..., Interval]] = {
    "add": _add,
    "sub": lambda a, b: _add(a, _neg(b)),
    "mul": _mul,
    "div": _div,
    "neg": _neg,
    "pow": _power,
    "sqrt": _sqrt,
    "cbrt": _monotone(lambda x: math.copysign(abs(x) ** (1 / 3), x)),
    "exp": _exp,
    "ln": _log(math.log),
    "log10": _log(math.log10),
    **TRIGONOMETRY,
    "abs": _abs,
    "sign": _sign,
    "floor": _step(math.floor),
    "ceil": _step(math.ceil),
    "trunc": _through_int(math.trunc),
    "round": _through_int(_round_away),
    "min": _min,
    "max": _max,
    "lt": _compare(lambda a, b: a.high < b.low, lambda a, b: a.low >= b.high),
    "le": _compare(lambda a, b: a.high <= b.low, lambda a, b: a.low > b.high),
    "gt": _compare(lambda a, b: a.low > b.high, lambda a, b: a.high <= b.low),
    "ge": _compare(lambda a, b: a.low >= b.high, lambda a, b: a.high < b.low),
    "eq": _compare(_same, _apart),
    "ne": _compare(_apart, _same),
    "and": lambda a, b: Interval(min(a.low, b.low), min(a.high, b.high)),
    "or": lambda a, b: Interval(max(a.low, b.low), max(a.high, b.high)),
    "not": lambda a: Interval(1 - a.high, 1 - a.low),
}
"""By the operator names of expressions; each takes one interval an argument."""
