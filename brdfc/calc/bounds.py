"""The interval of an operator's result from those of its operands: one rule an operator.

Where formulas have the same rule it is theirs (symbolic/bounds.py). What differs is not-a-number:
formulas are guarded against it, programs from outside may compute with it. `undefined` of an
interval says here that the value may be NaN; UNKNOWN is any value at all.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import reduce

from brdfc.symbolic.bounds import RULES, TRUTH, WHOLE_LIMIT, square, whole_power
from brdfc.symbolic.intervals import EVERYTHING, INF, Interval, outward, single
from brdfc.symbolic.trigonometry import holds_multiple, unit

UNKNOWN = EVERYTHING

LEAST_COSINE = 1.6e-9
"""No float32 comes nearer to a zero of the cosine (J.-M. Muller, Elementary Functions, 2016, table
11.1: 16367173 x 2^72 is 1.61e-9 away from one), and computed cosines are as good as exact ones."""

Rule = Callable[..., Interval]


def exactly(value: float) -> Interval:
    """A constant."""
    return UNKNOWN if math.isnan(value) else Interval(value, value)


def either(*intervals: Interval) -> Interval:
    """What holds them all, and whether 0 is none of them."""
    low, high = min(i.low for i in intervals), max(i.high for i in intervals)
    gap = min(least_size(i) for i in intervals) if low <= 0 <= high else 0.0
    return Interval(low, high, any(i.undefined for i in intervals), gap)


def least_size(a: Interval) -> float:
    """The least |x|."""
    return a.gap if a.low <= 0 <= a.high else min(abs(a.low), abs(a.high))


def surely(a: Interval) -> bool:
    """Whether a value holds, as a condition: at least one half."""
    return a.low >= 0.5 and not a.undefined


def never(a: Interval) -> bool:
    """Whether a value does not hold; NaN does not."""
    return a.high < 0.5


def truth(holds: bool, fails: bool) -> Interval:
    """Of a condition's result."""
    return Interval(float(holds), float(not fails))


# ---------------------------------------------------------------- two operands


def _add(a: Interval, b: Interval) -> Interval:
    opposite = (a.high == INF and b.low == -INF) or (a.low == -INF and b.high == INF)
    return UNKNOWN if opposite else RULES["add"](a, b)


def _mul(a: Interval, b: Interval) -> Interval:
    product = RULES["mul"](a, b)
    gap = single(least_size(a) * least_size(b)) * (1 - 2.0**-20)
    return replace(product, gap=gap) if gap > 0 and product.low <= 0 <= product.high else product


def _pow(a: Interval, b: Interval) -> Interval:
    """A negative base has a power where the exponent is a whole number; that of -0 may be minus
    infinity."""
    if a.low >= 0 and (a.low > 0 or b.low >= 0):
        return RULES["pow"](a, b)
    if not (b.low == b.high and b.low.is_integer()) or a.undefined or b.undefined:
        return UNKNOWN
    size: Interval = RULES["pow"](RULES["abs"](a), b)
    if b.low % 2 == 0:
        return size
    return RULES["neg"](size) if a.high < 0 else replace(size, low=-size.high, gap=size.low)


def _mod(a: Interval, b: Interval) -> Interval:
    """A remainder has the sign of what is divided, and is no greater than either."""
    if not (a.finite and b.finite):
        return UNKNOWN
    size = min(max(-a.low, a.high), max(-b.low, b.high))
    return Interval(-size if a.low < 0 else 0.0, size if a.high > 0 else 0.0)


def _lesser(x: Interval, y: Interval) -> Interval:
    """x where it is less than y, else y: so y where either is NaN."""
    high = y.high if x.undefined else min(x.high, y.high)
    return Interval(min(x.low, y.low), high, y.undefined)


def _greater(x: Interval, y: Interval) -> Interval:
    low = y.low if x.undefined else max(x.low, y.low)
    return Interval(low, max(x.high, y.high), y.undefined)


def _near(a: Interval, b: Interval) -> Interval:
    apart = RULES["abs"](_add(a, RULES["neg"](b)))
    if apart.undefined:
        return TRUTH
    return truth(apart.high < 0.99e-5, apart.low > 1.01e-5)


BINARY: dict[str, Rule] = {
    "add": _add,
    "sub": lambda a, b: _add(a, RULES["neg"](b)),
    "mul": _mul,
    "div": RULES["div"],
    "mod": _mod,
    "pow": _pow,
    "atn2": lambda x, y: RULES["atan2"](y, x),
    **{name: RULES[name] for name in ("lt", "le", "eq", "ge", "gt")},
    "neq": RULES["ne"],
    "near": _near,
    "vmin": _lesser,
    "vmax": _greater,
    "vand": lambda a, b: truth(surely(a) and surely(b), never(a) or never(b)),
    "vor": lambda a, b: truth(surely(a) or surely(b), never(a) and never(b)),
    "vxor": lambda a, b: TRUTH,
}
"""(x, y) to one result, y the one nearer the top."""


SCALED = {"gama": "pow", "sadd": "add", "ssub": "sub", "smul": "mul", "sdiv": "div"}
"""A vector with one scalar on top: the operator of BINARY that is repeated."""

# ---------------------------------------------------------------- one operand


def _cos(a: Interval) -> Interval:
    if not a.finite:
        return Interval(-1.0, 1.0, undefined=True)
    ends = math.cos(a.low), math.cos(a.high)
    low = -1.0 if holds_multiple(a, math.pi, 2 * math.pi) else min(ends)
    high = 1.0 if holds_multiple(a, 0.0, 2 * math.pi) else max(ends)
    return unit(low, high, undefined=a.undefined, gap=LEAST_COSINE if low <= 0 <= high else 0.0)


def _tan(a: Interval) -> Interval:
    if not a.finite:
        return UNKNOWN
    if _cos(a).gap > 0:
        return Interval(-1 / LEAST_COSINE, 1 / LEAST_COSINE)
    return outward(math.tan(a.low), math.tan(a.high))


def _sign(a: Interval) -> Interval:
    low, high = (float((v > 0) - (v < 0)) for v in (a.low, a.high))
    return Interval(min(low, 0.0), max(high, 0.0)) if a.undefined else Interval(low, high)


def _through_int(rule: Rule) -> Rule:
    """What does not fit an int becomes another number, never NaN."""

    def bounded(a: Interval) -> Interval:
        whole: Interval = rule(a)
        return Interval(-WHOLE_LIMIT, WHOLE_LIMIT) if whole.undefined else whole

    return bounded


UNARY: dict[str, Rule] = {
    "neg": RULES["neg"],
    "sq": square,
    "sqrt": RULES["sqrt"],
    "cb": lambda a: whole_power(a, 3),
    "cbrt": RULES["cbrt"],
    "sign": _sign,
    "abs": RULES["abs"],
    "flor": RULES["floor"],
    "ceil": RULES["ceil"],
    "trnc": _through_int(RULES["trunc"]),
    "rond": _through_int(RULES["round"]),
    "exp": RULES["exp"],
    "log": RULES["log10"],
    "ln": RULES["ln"],
    "sin": RULES["sin"],
    "cos": _cos,
    "tan": _tan,
    "asin": RULES["asin"],
    "acos": RULES["acos"],
    "atan": RULES["atan"],
    "rnum": lambda a: truth(a.finite, False),
    "not": lambda a: truth(never(a), surely(a)),
}
"""x to one result."""

# ---------------------------------------------------------------- many operands


def _and(values: Sequence[Interval]) -> Interval:
    """A NaN counts as true here, and as false everywhere else."""
    holds = all(v.low >= 0.5 for v in values)
    return truth(holds, any(never(v) and not v.undefined for v in values))


FOLDED: dict[str, Callable[[Sequence[Interval]], Interval]] = {
    "sum": lambda values: reduce(_add, values),
    "prod": lambda values: reduce(_mul, values),
    # Two values are compared as `vmin` compares them; of more, the deepest is the last to stay.
    "min": lambda v: _lesser(*v) if len(v) == 2 else reduce(lambda x, y: _lesser(y, x), v),
    "max": lambda v: _greater(*v) if len(v) == 2 else reduce(lambda x, y: _greater(y, x), v),
    "and": _and,
    "or": lambda values: truth(any(map(surely, values)), all(map(never, values))),
}
"""Many values, deepest first, to one."""

CONSTANTS = {"pi": single(math.pi), "+INF": INF, "-INF": -INF, "NaN": math.nan}
"""Operators that push a number."""

DEFINED = {"true": 1.0, "ndef": 0.0}
"""Variables that are always, or never, defined; their value is the same number."""


def result(name: str, *operands: Interval) -> Interval:
    """Of an operator of BINARY or UNARY, by its name."""
    rule = BINARY.get(name) or UNARY[name]
    return rule(*operands)
