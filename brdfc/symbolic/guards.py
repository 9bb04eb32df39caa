"""Guards where the domain reaches a place at which a formula breaks, and only there.

Engines disagree about x/0 and make NaN of roots and logarithms of negative numbers, so a compiled
program never gets there: each operation whose argument can reach such a value (by its range) gets
an argument that cannot. Inside the formula's own domain a guard changes nothing. How each
operation is guarded is one row of _CURES.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from brdfc.symbolic.bounds import WHOLE_LIMIT
from brdfc.symbolic.expression import ONE, ZERO, Expression, const, make, whole_exponent
from brdfc.symbolic.intervals import LARGEST, Interval
from brdfc.symbolic.ranges import Ranges
from brdfc.symbolic.rewrite import rewrite

TINY = const(Fraction(2) ** -100)
"""What a denominator is kept from falling below: small enough to change no finite result that
float32 could tell, large enough for the quotient to stay far from overflow."""
SMALLEST_NORMAL = const(Fraction(2) ** -126)
HUGE = const(Fraction(2) ** 100)
"""What stands for infinity where infinity would become NaN."""
WHOLE = const(2**23)
"""From here on every float32 is a whole number."""


@dataclass(frozen=True)
class Guard:
    """A guard that was put in: the operation, and why it was needed."""

    operation: str
    reason: str

    def __str__(self) -> str:
        return f"{self.operation}: {self.reason}"


def guarded(expression: Expression, ranges: Ranges) -> tuple[Expression, tuple[Guard, ...]]:
    """The expression with the guards its domain needs, and a remark on each.

    It is never NaN in the domain. Where a guard stands in for a pole, it is not infinite either;
    overflow at points that the formula itself defines is left for the self-check to refuse.
    """
    found: dict[Guard, None] = {}

    def rule(e: Expression, at: Ranges) -> Expression:
        cure = _CURES.get(e.operator)
        cured = cure(e, at) if cure else None
        if cured is None:
            return e
        replacement, reason = cured
        found[Guard(str(e), reason)] = None
        return replacement

    safe = rewrite(expression, ranges, rule)
    of = ranges.of(safe)
    bounded = _bounded(safe, of, _LARGEST) if found else safe
    if bounded is not safe:
        found[Guard(str(expression), f"the result is {of}, beyond float32")] = None
    return bounded, tuple(found)


_LARGEST = const(Fraction(LARGEST))
_Cure = Callable[[Expression, Ranges], tuple[Expression, str] | None]


def _root(e: Expression, ranges: Ranges) -> tuple[Expression, str] | None:
    of = ranges.of(e.arguments[0])
    if of.low >= 0:
        return None
    return make("sqrt", make("max", e.arguments[0], ZERO)), f"the root's argument is {of}"


def _logarithm(e: Expression, ranges: Ranges) -> tuple[Expression, str] | None:
    of = ranges.of(e.arguments[0])
    if of.low > 0:
        return None
    floor = make("max", e.arguments[0], SMALLEST_NORMAL)
    return make(e.operator, floor), f"the logarithm's argument is {of}"


def _arc(e: Expression, ranges: Ranges) -> tuple[Expression, str] | None:
    of = ranges.of(e.arguments[0])
    if of.low >= -1 and of.high <= 1:
        return None
    inside = make("min", make("max", e.arguments[0], const(-1)), ONE)
    return make(e.operator, inside), f"the argument is {of}, rounding included"


def _quotient(e: Expression, ranges: Ranges) -> tuple[Expression, str] | None:
    above, below = e.arguments
    of = ranges.of(below)
    if not of.has_zero:
        return _finite(e, ranges)
    reason = f"the denominator is {of}"
    if of.low >= 0:
        return make("div", above, _lifted(below, ranges)), reason
    if of.high <= 0:
        return make("div", above, make("min", below, make("neg", TINY))), reason
    if below.width > 1:
        # Component by component, so without a branch: a/b = a b/b^2.
        square = make("max", make("mul", below, below), TINY)
        return make("div", make("mul", above, below), square), reason
    small = make("lt", make("abs", below), TINY)
    return make("where", small, ZERO, make("div", above, below)), reason


def _lifted(e: Expression, ranges: Ranges) -> Expression:
    """An expression that is never negative, kept away from 0: at its factors, where they reach it.

    Under a root that is guarded against negative values already, one guard does both.
    """
    if not ranges.of(e).has_zero:
        return e
    lifted = make("max", e, TINY)
    if e.operator == "sqrt":
        (inner,) = e.arguments
        if inner.operator == "max" and inner.arguments[1] is ZERO:
            inner = inner.arguments[0]
        lifted = make("sqrt", make("max", inner, TINY))
    elif e.operator == "mul" and all(ranges.of(a).low >= 0 for a in e.arguments):
        lifted = make("mul", *(_lifted(a, ranges) for a in e.arguments))
    return lifted if not ranges.of(lifted).has_zero else make("max", e, TINY)


def _power(e: Expression, ranges: Ranges) -> tuple[Expression, str] | None:
    """A power of a negative base has a value only where the exponent is a whole constant."""
    base, exponent = e.arguments
    of, power = ranges.of(base), ranges.of(exponent)
    whole = whole_exponent(e)
    if whole is not None:
        if whole >= 0 or not ranges.of(e).undefined:
            return None
        reciprocal = make("div", ONE, make("pow", base, const(-whole)))
        return _quotient(reciprocal, ranges) or (reciprocal, f"the base is {of}")
    if not ranges.of(e).undefined:
        return None
    reason = f"the base is {of}"
    above = make("pow", make("max", base, ZERO), exponent)
    if power.low >= 0:
        return above, reason
    lifted = make("pow", make("max", base, TINY), exponent)
    if power.high > 0 and exponent.width == 1:  # 0 to a positive power is 0
        return make("where", make("gt", exponent, ZERO), above, lifted), reason
    return lifted, reason  # of a vector of exponents, 0 to a positive power is only nearly 0


def _finite(e: Expression, ranges: Ranges) -> tuple[Expression, str] | None:
    """Keep infinity away from where it would become NaN (infinity times 0, minus infinity)."""
    intervals = [ranges.of(a) for a in e.arguments]
    if not ranges.of(e).undefined or all(i.finite for i in intervals):
        return None
    arguments = [_bounded(a, i) for a, i in zip(e.arguments, intervals, strict=True)]
    return make(e.operator, *arguments), "an argument may overflow"


def _angle(e: Expression, ranges: Ranges) -> tuple[Expression, str] | None:
    """An infinite angle has no sine."""
    (angle,) = e.arguments
    of = ranges.of(angle)
    bounded = _bounded(angle, of)
    return None if bounded is angle else (make(e.operator, bounded), f"the angle is {of}")


def _whole(e: Expression, ranges: Ranges) -> tuple[Expression, str] | None:
    """Rounding passes through an int on some engines; large numbers are whole anyway."""
    (x,) = e.arguments
    of = ranges.of(x)
    if of.low > -WHOLE_LIMIT and of.high < WHOLE_LIMIT:
        return None
    bounded = make("max", make("min", x, WHOLE), make("neg", WHOLE))
    # x - (x within bounds) is 0 wherever there is anything to round.
    if x.width > 1:
        rest = make("sub", x, bounded)
        return make("add", make(e.operator, bounded), rest), f"the argument is {of}"
    small = make("lt", make("abs", x), WHOLE)
    return make("where", small, e, x), f"the argument is {of}"


def _bounded(e: Expression, of: Interval, bound: Expression = HUGE) -> Expression:
    """The same without infinities; itself where its range has none."""
    if of.high > LARGEST:
        e = make("min", e, bound)
    return make("max", e, make("neg", bound)) if of.low < -LARGEST else e


_CURES: dict[str, _Cure] = {
    "sqrt": _root,
    "ln": _logarithm,
    "log10": _logarithm,
    "asin": _arc,
    "acos": _arc,
    "div": _quotient,
    "pow": _power,
    "add": _finite,
    "sub": _finite,
    "mul": _finite,
    "sin": _angle,
    "cos": _angle,
    "tan": _angle,
    "trunc": _whole,
    "round": _whole,
}
