"""Products as sets of factors: coefficient times what is above the line, over what is below."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache

from brdfc.symbolic import products
from brdfc.symbolic.expression import Expression, whole_exponent

Powers = tuple[tuple[Expression, int], ...]


@dataclass(frozen=True)
class Factors:
    """A rational coefficient and bases with positive whole powers, in the order written."""

    coefficient: Fraction
    above: Powers
    below: Powers

    @property
    def empty(self) -> bool:
        return not self.above and not self.below and self.coefficient == 1

    @property
    def reciprocal(self) -> Factors:
        """One over the product; its coefficient is never 0."""
        return Factors(1 / self.coefficient, self.below, self.above)

    def with_coefficient(self, coefficient: Fraction) -> Factors:
        return replace(self, coefficient=coefficient)

    def without(self, base: Expression, power: int, *, above: bool) -> Factors:
        """The factors less one base to a power."""
        kept = tuple(
            (b, n - power if b is base else n)
            for b, n in (self.above if above else self.below)
            if b is not base or n > power
        )
        return replace(self, above=kept) if above else replace(self, below=kept)


def is_product(e: Expression) -> bool:
    """Whether an expression is a product, a quotient or a whole power."""
    return e.operator in ("mul", "div", "neg") or (
        e.operator == "pow" and (whole_exponent(e) or 0) > 0
    )


@lru_cache(maxsize=65536)
def factors(e: Expression) -> Factors:
    """The factors of an expression; any other than a product is its own single factor."""
    if e.operator == "const" and e.value != 0:
        return Factors(e.value, (), ())
    if e.operator == "neg":
        of = factors(e.arguments[0])
        return of.with_coefficient(-of.coefficient)
    if e.operator in ("mul", "div"):
        left, right = map(factors, e.arguments)
        return joined(left, right if e.operator == "mul" else right.reciprocal)
    exponent = whole_exponent(e) if e.operator == "pow" else None
    if exponent is None or exponent <= 0:
        return Factors(Fraction(1), ((e, 1),), ())
    base = e.arguments[0]
    if base.operator == "const" and base.value != 0:
        return Factors(base.value**exponent, (), ())
    # The base stays whole: (x/y)^2 is a factor of its own, not x^2 over y^2.
    return Factors(Fraction(1), ((base, exponent),), ())


def joined(a: Factors, b: Factors) -> Factors:
    """The factors of a product of two."""

    def merged(x: Powers, y: Powers) -> Powers:
        powers = dict(x)
        for base, n in y:
            powers[base] = powers.get(base, 0) + n
        return tuple(powers.items())

    return Factors(
        a.coefficient * b.coefficient, merged(a.above, b.above), merged(a.below, b.below)
    )


def product(of: Factors, width: int) -> Expression:
    """The expression, in tidy form."""
    return products.product(of.coefficient, dict(of.above), dict(of.below), width)
