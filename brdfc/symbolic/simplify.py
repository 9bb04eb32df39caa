"""What the ranges make needless is dropped: dead branches, guards that cannot act, zeros and ones.

Every rule keeps the exact value of the expression everywhere in its range. None reorders float32
arithmetic in a way that cancels; choosing among equivalent forms is another stage's work.
"""

from __future__ import annotations

from collections.abc import Callable

from brdfc.symbolic.expression import ONE, ZERO, Expression, make, vector
from brdfc.symbolic.ranges import Ranges


def simplified(e: Expression, ranges: Ranges) -> Expression:
    """One expression, its arguments simplified already; a rule for `rewrite`."""
    rule = _RULES.get(e.operator)
    return rule(e, ranges) if rule else e


def _wide(e: Expression, width: int) -> Expression:
    """e with a width: a scalar repeated."""
    return e if e.width == width else vector([e] * width)


def _where(e: Expression, ranges: Ranges) -> Expression:
    condition, value, otherwise = e.arguments
    truth = ranges.of(condition)
    if truth.low >= 1 or value is otherwise:
        return _wide(value, e.width)
    return _wide(otherwise, e.width) if truth.high <= 0 else e


def _add(e: Expression, _ranges: Ranges) -> Expression:
    a, b = e.arguments
    if a is ZERO:
        return _wide(b, e.width)
    if b is ZERO:
        return _wide(a, e.width)
    if b.operator == "neg":
        return make("sub", a, b.arguments[0])
    return make("sub", b, a.arguments[0]) if a.operator == "neg" else e


def _sub(e: Expression, ranges: Ranges) -> Expression:
    a, b = e.arguments
    if b is ZERO:
        return _wide(a, e.width)
    if a is ZERO:
        return _neg(make("neg", _wide(b, e.width)), ranges)
    return make("add", a, b.arguments[0]) if b.operator == "neg" else e


def _neg(e: Expression, _ranges: Ranges) -> Expression:
    (a,) = e.arguments
    if a.operator == "neg":
        return a.arguments[0]
    if a.operator == "sub":
        return make("sub", a.arguments[1], a.arguments[0])
    return e


def _mul(e: Expression, ranges: Ranges) -> Expression:
    for factor, other in (e.arguments, e.arguments[::-1]):
        if factor is ONE:
            return _wide(other, e.width)
        if factor is ZERO and ranges.of(other).finite:
            return _wide(ZERO, e.width)
    return e


def _div(e: Expression, ranges: Ranges) -> Expression:
    a, b = e.arguments
    if b is ONE:
        return _wide(a, e.width)
    return _wide(ZERO, e.width) if a is ZERO and not ranges.of(b).has_zero else e


def _pow(e: Expression, _ranges: Ranges) -> Expression:
    base, exponent = e.arguments
    if exponent is ONE:
        return base
    if exponent is ZERO:
        return _wide(ONE, e.width)
    return make("sqrt", base) if exponent.operator == "const" and exponent.value * 2 == 1 else e


def _extreme(first_wins: Callable[[float, float], bool]) -> Callable[..., Expression]:
    """min and max: an argument whose whole range lies on the right side wins."""

    def rule(e: Expression, ranges: Ranges) -> Expression:
        a, b = e.arguments
        of_a, of_b = ranges.of(a), ranges.of(b)
        if a is b:
            return a
        if of_a.undefined or of_b.undefined:
            return e
        pairs = ((of_a.low, of_a.high), (of_b.low, of_b.high))
        if all(first_wins(x, y) for x in pairs[0] for y in pairs[1]):
            return _wide(a, e.width)
        if all(first_wins(y, x) for x in pairs[0] for y in pairs[1]):
            return _wide(b, e.width)
        return e

    return rule


def _abs(e: Expression, ranges: Ranges) -> Expression:
    (a,) = e.arguments
    return a if ranges.of(a).low >= 0 else e


def _and(e: Expression, ranges: Ranges) -> Expression:
    """A part known to hold is dropped; two bounds of the same kind become one on the lesser."""
    a, b = e.arguments
    for part, other in ((a, b), (b, a)):
        truth = ranges.of(part)
        if truth.low >= 1:
            return other
        if truth.high <= 0:
            return ZERO
    for relation, extreme in (("gt", "min"), ("ge", "min"), ("lt", "max"), ("le", "max")):
        if a.operator == b.operator == relation and a.arguments[1] is b.arguments[1]:
            return make(relation, make(extreme, a.arguments[0], b.arguments[0]), a.arguments[1])
    return e


def _or(e: Expression, ranges: Ranges) -> Expression:
    a, b = e.arguments
    for part, other in ((a, b), (b, a)):
        truth = ranges.of(part)
        if truth.high <= 0:
            return other
        if truth.low >= 1:
            return ONE
    return e


def _condition(e: Expression, ranges: Ranges) -> Expression:
    truth = ranges.of(e)
    if truth.low >= 1:
        return ONE
    return ZERO if truth.high <= 0 else e


_RULES: dict[str, Callable[[Expression, Ranges], Expression]] = {
    "where": _where,
    "add": _add,
    "sub": _sub,
    "neg": _neg,
    "mul": _mul,
    "div": _div,
    "pow": _pow,
    "min": _extreme(lambda x, y: x <= y),
    "max": _extreme(lambda x, y: x >= y),
    "abs": _abs,
    "and": _and,
    "or": _or,
    **dict.fromkeys(("lt", "le", "gt", "ge", "eq", "ne", "not"), _condition),
}
