"""Matching the two sides of a rule against expressions.

A pattern is itself an expression whose quantities are the rule's variables. Products match as sets
of factors: `x^2/y^2` is found in 3*a^2*c/b^2, and what is left over (3*c) stays.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction

from brdfc.forms.products import Factors, factors, is_product, product
from brdfc.symbolic.expression import Expression, const, rebuild

CONSTANT = "k"
"""The variable that stands for the positive constant factor of a product."""

Bindings = Mapping[str, Expression]


def match(pattern: Expression, e: Expression, bound: Bindings) -> Iterator[Bindings]:
    """Every way the whole of an expression is an instance of a pattern."""
    if pattern.operator == "quantity":
        known = bound.get(pattern.name)
        if known is None:
            yield {**bound, pattern.name: e}
        elif known is e:
            yield bound
    elif pattern.operator in ("const", "pi"):
        if pattern is e:
            yield bound
    elif is_product(pattern):
        for found, rest in match_product(pattern, e, bound, whole=True):
            if rest.empty:
                yield found
    elif pattern.operator == e.operator and len(pattern.arguments) == len(e.arguments):
        yield from _arguments(pattern.arguments, e.arguments, bound)
        if pattern.operator in ("add", "min", "max"):
            yield from _arguments(pattern.arguments, e.arguments[::-1], bound)


def _arguments(
    patterns: tuple[Expression, ...], arguments: tuple[Expression, ...], bound: Bindings
) -> Iterator[Bindings]:
    if not patterns:
        yield bound
        return
    for found in match(patterns[0], arguments[0], bound):
        yield from _arguments(patterns[1:], arguments[1:], found)


@dataclass(frozen=True)
class _Wanted:
    """A factor of a pattern: base to a power, above or below the line."""

    base: Expression
    power: int
    above: bool


def match_product(
    pattern: Expression, e: Expression, bound: Bindings, *, whole: bool
) -> Iterator[tuple[Bindings, Factors]]:
    """Every way a product contains a pattern's factors, with the factors left over.

    whole: the pattern must account for everything, so its last free variable takes all that the
    others leave.
    """
    wanted_factors, have = factors(pattern), factors(e)
    coefficient = have.coefficient / wanted_factors.coefficient
    if wanted_factors.coefficient < 0 and coefficient < 0:
        return  # a sign in the pattern is matched by a sign, not made up
    if any(base.name == CONSTANT for base, _ in wanted_factors.above):
        if coefficient <= 0 or coefficient == 1:
            return
        bound, coefficient = {**bound, CONSTANT: const(coefficient)}, Fraction(1)
    wanted = [_Wanted(b, n, True) for b, n in wanted_factors.above if b.name != CONSTANT]
    wanted += [_Wanted(b, n, False) for b, n in wanted_factors.below]
    # What says most is matched first; variables last.
    wanted.sort(key=lambda w: w.base.operator == "quantity")
    yield from _assign(wanted, have.with_coefficient(coefficient), bound, whole, e.width)


def _assign(
    wanted: list[_Wanted], have: Factors, bound: Bindings, whole: bool, width: int
) -> Iterator[tuple[Bindings, Factors]]:
    if not wanted:
        yield bound, have
        return
    first, *others = wanted
    free = first.base.operator == "quantity" and first.base.name not in bound
    if whole and free and not others and first.above and first.power == 1:
        if have.empty and have.coefficient == 1:
            return
        yield {**bound, first.base.name: product(have, width)}, Factors(Fraction(1), (), ())
        return
    for base, power in have.above if first.above else have.below:
        if power >= first.power:
            for found in match(first.base, base, bound):
                yield from _assign(
                    others, have.without(base, first.power, above=first.above), found, whole, width
                )


def instantiate(pattern: Expression, bound: Bindings) -> Expression:
    """A pattern with its variables replaced."""
    done: dict[Expression, Expression] = {}

    def fill(e: Expression) -> Expression:
        if e.operator == "quantity":
            return bound[e.name]
        if e not in done:
            new = rebuild(e, [fill(a) for a in e.arguments])
            done[e] = product(factors(new), new.width) if is_product(new) else new
        return done[e]

    return fill(pattern)
