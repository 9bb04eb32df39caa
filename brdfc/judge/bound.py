"""A bound on the error of a form that holds everywhere, not only at sampled points.

Errors go forward through the expression: a computed value is x (1 + r) + a for the exact value x,
with |r| <= relative, |a| <= absolute. Arithmetic adds half a unit (N. Higham, Accuracy and
Stability of Numerical Algorithms, 2.2), a library function two units, gradual underflow half the
least subnormal number. What a function makes of its argument's error follows from its derivative
over the range (bound_rules.py).
"""

from __future__ import annotations

import math
from fractions import Fraction

from brdfc.judge.bound_rules import (
    ARITHMETIC,
    FUNCTIONS,
    LIBRARY,
    ONE,
    SLACK,
    UNDERFLOW,
    Value,
    exact_value,
    normal,
    quotient,
    repeated,
    worst,
)
from brdfc.symbolic.bounds import LONGEST_CHAIN
from brdfc.symbolic.expression import ZERO, Expression, whole_exponent
from brdfc.symbolic.guards import guarded
from brdfc.symbolic.intervals import INF, single
from brdfc.symbolic.ranges import Ranges

_USELESS = 32
"""Bits from which on a bound says nothing."""


def error_bound(expression: Expression, ranges: Ranges) -> float | None:
    """Bits, log2(1 + units in the last place), that a float32 program of an expression can be wrong
    at most, guards included; None where no bound can be had. Quantities are exact."""
    value = _Bounder().value(guarded(expression, ranges)[0], ranges)
    # A number has at most 2^24 units, none of them less than the least subnormal number.
    units = value.relative * 2**24 + value.absolute / UNDERFLOW
    bits = math.log2(1 + units * SLACK) if units < INF else INF
    return bits if bits < _USELESS else None


class _Bounder:
    def __init__(self) -> None:
        self.done: dict[tuple[Expression, Ranges], Value] = {}

    def value(self, e: Expression, at: Ranges) -> Value:
        key = (e, at)
        if key not in self.done:
            relative, absolute = self.error(e, at)
            self.done[key] = exact_value(relative * SLACK, absolute * SLACK, at.of(e))
        return self.done[key]

    def error(self, e: Expression, at: Ranges) -> tuple[float, float]:
        if e.operator == "where":
            condition, *branches = e.arguments
            if not self.sure(condition, at):
                return INF, 0.0
            inside = [at.assuming(condition, holds) for holds in (True, False)]
            return worst([self.value(b, i) for b, i in zip(branches, inside, strict=True)])
        if e.operator in ("const", "pi"):
            exact = Fraction(math.pi) if e.operator == "pi" else e.value
            nearest = single(exact)
            if exact == nearest or math.isinf(nearest):
                return (0.0 if exact == nearest else INF), 0.0
            # The float64 of pi is off by less than 2^-52 of it.
            return float(abs(Fraction(nearest) - exact) / abs(exact)) + 2.0**-52, 0.0
        values = [self.value(a, at) for a in e.arguments]
        if e.operator in ("quantity", "neg", "abs", "vector", "component", "min", "max"):
            return worst(values)
        exponent = whole_exponent(e) if e.operator == "pow" else None
        if exponent is not None and abs(exponent) <= LONGEST_CHAIN:
            power = repeated(values[0], abs(exponent))
            error = power.relative, power.absolute
            return error if exponent >= 0 else quotient(ONE, power)
        if e.operator in ARITHMETIC:
            return ARITHMETIC[e.operator](*values)
        relative = absolute = 0.0
        # The sign of a zero turns an atan2 by half a turn.
        if e.operator == "atan2" or any(v.relative or v.absolute for v in values):
            change = FUNCTIONS.get(e.operator)
            relative, absolute = change(values[0], at.of(e)) if change else (INF, 0.0)
        relative += LIBRARY * (1 + relative)
        # No float32 is near enough to a zero of the cosine for it to underflow.
        is_normal = e.operator == "cos" or normal(at.of(e))
        return relative, absolute * (1 + LIBRARY) + (0.0 if is_normal else UNDERFLOW)

    def sure(self, e: Expression, at: Ranges) -> bool:
        """Whether a condition comes out the same in float32: what is compared is exact, or
        compared with 0 and so near the exact value that it has its sign."""
        if e.operator in ("and", "or", "not"):
            return all(self.sure(a, at) for a in e.arguments)
        values = [self.value(a, at) for a in e.arguments]
        if ZERO in e.arguments:
            return all(v.absolute == 0 and v.relative < 1 for v in values)
        return all(v.absolute == v.relative == 0 for v in values)
