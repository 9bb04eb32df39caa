"""Products and quotients in one tidy form: constants in one, scalars before vectors, one division.

    ks/sqrt(a) * lobe/(4*pi*m^2)   ->   0.0795... * ks * lobe / (sqrt(a) * m^2)

Exact over the reals, and harmless in float32: every factor is still rounded once. A product is
left as written where the joint factors might overflow or underflow and the written ones do not.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce

from brdfc.symbolic.expression import (
    ONE,
    Expression,
    const,
    make,
    rebuild,
    vector,
    walk,
    whole_exponent,
)
from brdfc.symbolic.ranges import Ranges

_PRODUCTS = ("mul", "div", "neg")
_OPENED = (*_PRODUCTS, "const", "pow")
_GREATEST_POWER = 4
"""(a b)^n becomes a^n b^n up to this n; beyond it the factors may leave float32's range though
their product does not."""
_GREATEST_COEFFICIENT = 2**60


@dataclass
class _Factors:
    """coefficient * product of above / product of below; the same base may occur with a power."""

    coefficient: Fraction = Fraction(1)
    above: dict[Expression, int] = field(default_factory=dict)
    below: dict[Expression, int] = field(default_factory=dict)


def tidy_products(expression: Expression, ranges: Ranges) -> Expression:
    """Every product and quotient of an expression in tidy form."""
    uses = Counter(argument for e in walk(expression) for argument in e.arguments)
    return _Tidier(uses).visit(expression, ranges)


@dataclass
class _Tidier:
    """uses: how often each expression occurs; one used twice stays whole, to be shared."""

    uses: Counter[Expression]
    done: dict[tuple[Expression, Ranges], Expression] = field(default_factory=dict)

    def visit(self, e: Expression, ranges: Ranges) -> Expression:
        key = (e, ranges)
        if key not in self.done:
            self.done[key] = self.visited(e, ranges)
        return self.done[key]

    def visited(self, e: Expression, ranges: Ranges) -> Expression:
        if e.operator == "where":
            condition, value, otherwise = e.arguments
            parts = (
                self.visit(condition, ranges),
                self.visit(value, ranges.assuming(condition, True)),
                self.visit(otherwise, ranges.assuming(condition, False)),
            )
            return rebuild(e, parts)
        if e.operator not in _PRODUCTS:
            return rebuild(e, [self.visit(a, ranges) for a in e.arguments])
        factors = _Factors()
        self.gather(e, 1, factors, ranges, root=True)
        written = rebuild(e, [self.visit(a, ranges) for a in e.arguments])
        if not 1 / _GREATEST_COEFFICIENT < abs(factors.coefficient) < _GREATEST_COEFFICIENT:
            return written
        tidy = product(factors.coefficient, factors.above, factors.below, e.width)
        before, after = ranges.of(e), ranges.of(tidy)
        overflows = before.finite and not after.finite
        underflows = after.has_zero and not before.has_zero
        return written if overflows or underflows else tidy

    def gather(
        self, e: Expression, power: int, into: _Factors, ranges: Ranges, *, root: bool = False
    ) -> None:
        """Add e to the given power (1 or -1 times a whole number) to the factors."""
        whole = e.operator in _PRODUCTS and (root or self.uses[e] == 1)
        if e.operator == "const" and (e.value != 0 or power > 0):
            into.coefficient *= e.value**power
        elif whole and e.operator == "neg":
            into.coefficient *= (-1) ** power
            self.gather(e.arguments[0], power, into, ranges)
        elif whole:
            self.gather(e.arguments[0], power, into, ranges)
            sign = 1 if e.operator == "mul" else -1
            self.gather(e.arguments[1], sign * power, into, ranges)
        elif e.operator == "pow" and self.opened(e):
            self.gather(e.arguments[0], power * (whole_exponent(e) or 1), into, ranges)
        else:
            side = into.above if power > 0 else into.below
            factor = self.visit(e, ranges)
            side[factor] = side.get(factor, 0) + abs(power)

    def opened(self, e: Expression) -> bool:
        """Whether a power becomes powers of its base's factors."""
        exponent = whole_exponent(e)
        if not exponent:
            return False
        return abs(exponent) <= _GREATEST_POWER or e.arguments[0].operator not in _OPENED


def product(
    coefficient: Fraction,
    above: Mapping[Expression, int],
    below: Mapping[Expression, int],
    width: int,
) -> Expression:
    """coefficient times powers of bases above the line, over those below it: scalars first, with
    the coefficient, one division, then vectors."""
    over = [_power(base, n) for base, n in above.items()]
    under = [_power(base, n) for base, n in below.items()]
    scalars = [f for f in over if f.width == 1]
    vectors = [f for f in over if f.width > 1]
    wide_below = [f for f in under if f.width > 1]
    scalars_below = [f for f in under if f.width == 1]
    if abs(coefficient) != 1:
        scalars.append(const(coefficient))
    result = _joined(scalars) if scalars else None
    if scalars_below:
        result = make("div", ONE if result is None else result, _joined(scalars_below))
    if vectors:
        result = _joined(vectors) if result is None else _scaled(_joined(vectors), result)
    if result is None:
        result = ONE
    if wide_below:
        result = make("div", result, _joined(wide_below))
    if result.width != width:
        result = vector([result] * width)
    return make("neg", result) if coefficient == -1 else result


def _scaled(vectors: Expression, scalar: Expression) -> Expression:
    """A vector times a scalar; a pure reciprocal divides instead."""
    if scalar.operator == "div" and scalar.arguments[0] is ONE:
        return make("div", vectors, scalar.arguments[1])
    return make("mul", vectors, scalar)


def _power(base: Expression, exponent: int) -> Expression:
    return base if exponent == 1 else make("pow", base, const(exponent))


def _joined(factors: list[Expression]) -> Expression:
    return reduce(lambda a, b: make("mul", a, b), factors)
