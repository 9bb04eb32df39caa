"""A bound on the error of a form that holds everywhere, not only at sampled points.

Errors go forward through the expression: a computed value is x (1 + r) + a for the exact value x,
with |r| <= relative, |a| <= absolute. Arithmetic adds half a unit (N. Higham, Accuracy and
Stability of Numerical Algorithms, 2.2), a library function two units, gradual underflow half the
least subnormal number. What a function makes of its argument's error follows from its derivative
over the range.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from brdfc.symbolic.bounds import LONGEST_CHAIN
from brdfc.symbolic.expression import ZERO, Expression, whole_exponent
from brdfc.symbolic.guards import guarded
from brdfc.symbolic.intervals import INF, SMALLEST, Interval, single
from brdfc.symbolic.ranges import Ranges

HALF_UNIT, LIBRARY = 2.0**-24, 2.0**-22
_UNDERFLOW = 2.0**-149
_USELESS = 32
"""Bits from which on a bound says nothing."""
_SLACK = 1 + 1e-9
"""For the float64 arithmetic of the bounds themselves."""


@dataclass(frozen=True)
class _Value:
    """The error of a computed value, and least and greatest exact value and size."""

    relative: float
    absolute: float
    low: float
    high: float
    least: float

    @property
    def most(self) -> float:
        return max(abs(self.low), abs(self.high))

    @property
    def as_relative(self) -> float:
        """The whole error, relative to the exact value."""
        if self.absolute == 0:
            return self.relative
        return self.relative + self.absolute / self.least if self.least else INF

    @property
    def as_absolute(self) -> float:
        return self.relative * self.most + self.absolute if self.relative else self.absolute


def error_bound(expression: Expression, ranges: Ranges) -> float | None:
    """Bits, log2(1 + units in the last place), that a float32 program of an expression can be wrong
    at most, guards included; None where no bound can be had. Quantities are exact."""
    value = _Bounder().value(guarded(expression, ranges)[0], ranges)
    # A number has at most 2^24 units, none of them less than the least subnormal number.
    units = value.relative * 2**24 + value.absolute / _UNDERFLOW
    bits = math.log2(1 + units * _SLACK) if units < INF else INF
    return bits if bits < _USELESS else None


class _Bounder:
    def __init__(self) -> None:
        self.done: dict[tuple[Expression, Ranges], _Value] = {}

    def value(self, e: Expression, at: Ranges) -> _Value:
        key = (e, at)
        if key not in self.done:
            relative, absolute = self.error(e, at)
            self.done[key] = _exact(relative * _SLACK, absolute * _SLACK, at.of(e))
        return self.done[key]

    def error(self, e: Expression, at: Ranges) -> tuple[float, float]:
        if e.operator == "where":
            condition, *branches = e.arguments
            if not self.sure(condition, at):
                return INF, 0.0
            inside = [at.assuming(condition, holds) for holds in (True, False)]
            return _worst([self.value(b, i) for b, i in zip(branches, inside, strict=True)])
        if e.operator in ("const", "pi"):
            exact = Fraction(math.pi) if e.operator == "pi" else e.value
            nearest = single(exact)
            if exact == nearest or math.isinf(nearest):
                return (0.0 if exact == nearest else INF), 0.0
            # The float64 of pi is off by less than 2^-52 of it.
            return float(abs(Fraction(nearest) - exact) / abs(exact)) + 2.0**-52, 0.0
        values = [self.value(a, at) for a in e.arguments]
        if e.operator in ("quantity", "neg", "abs", "vector", "component", "min", "max"):
            return _worst(values)
        exponent = whole_exponent(e) if e.operator == "pow" else None
        if exponent is not None and abs(exponent) <= LONGEST_CHAIN:
            power = _repeated(values[0], abs(exponent))
            error = power.relative, power.absolute
            return error if exponent >= 0 else _quotient(_ONE, power)
        if e.operator in _ARITHMETIC:
            return _ARITHMETIC[e.operator](*values)
        relative = absolute = 0.0
        if any(v.relative or v.absolute for v in values):
            change = _FUNCTIONS.get(e.operator)
            relative, absolute = change(values[0], at.of(e)) if change else (INF, 0.0)
        relative += LIBRARY * (1 + relative)
        # No float32 is near enough to a zero of the cosine for it to underflow.
        normal = e.operator == "cos" or _normal(at.of(e))
        return relative, absolute * (1 + LIBRARY) + (0.0 if normal else _UNDERFLOW)

    def sure(self, e: Expression, at: Ranges) -> bool:
        """Whether a condition comes out the same in float32: what is compared is exact, or
        compared with 0 and so near the exact value that it has its sign."""
        if e.operator in ("and", "or", "not"):
            return all(self.sure(a, at) for a in e.arguments)
        values = [self.value(a, at) for a in e.arguments]
        if ZERO in e.arguments:
            return all(v.absolute == 0 and v.relative < 1 for v in values)
        return all(v.absolute == v.relative == 0 for v in values)


def _exact(relative: float, absolute: float, computed: Interval) -> _Value:
    """What the exact values are, from the range of the computed ones."""
    if not computed.finite or not relative < 0.5 or not absolute < INF:
        return _Value(INF, INF, -INF, INF, 0.0)
    low, high = computed.low - absolute, computed.high + absolute
    low /= (1 + relative) if low > 0 else (1 - relative)
    high /= (1 - relative) if high > 0 else (1 + relative)
    least = low if low > 0 else -high if high < 0 else computed.gap - absolute
    return _Value(relative, absolute, low, high, max(least, 0.0) / (1 + relative) / _SLACK)


_ONE = _Value(0.0, 0.0, 1.0, 1.0, 1.0)


def _worst(values: list[_Value]) -> tuple[float, float]:
    pairs = [(v.relative, v.absolute) for v in values] or [(0.0, 0.0)]
    return max(r for r, _ in pairs), max(a for _, a in pairs)


def _sum(a: _Value, b: _Value) -> tuple[float, float]:
    relative, absolute = max(a.relative, b.relative), a.absolute + b.absolute
    # |a| + |b| is |a + b| and twice what is of the other sign.
    other = min(max(-a.low, 0) + max(-b.low, 0), max(a.high, 0) + max(b.high, 0))
    least = max(a.low + b.low, -(a.high + b.high)) / _SLACK
    if least > 0 and other > 0:
        relative = (a.relative * a.most + b.relative * b.most) / least
    elif relative:
        absolute += 2 * relative * other
    return relative + HALF_UNIT * (1 + relative), absolute * (1 + HALF_UNIT)


def _difference(a: _Value, b: _Value) -> tuple[float, float]:
    return _sum(a, _Value(b.relative, b.absolute, -b.high, -b.low, b.least))


def _product(a: _Value, b: _Value) -> tuple[float, float]:
    relative = (1 + a.relative) * (1 + b.relative) * (1 + HALF_UNIT) - 1
    absolute = a.absolute * b.absolute
    for x, y in ((a, b), (b, a)):
        if y.absolute:
            absolute += x.most * (1 + x.relative) * y.absolute
    normal = a.least * b.least > 2 * SMALLEST
    return relative, absolute * (1 + HALF_UNIT) + (0.0 if normal else _UNDERFLOW / 2)


def _times(a: _Value, b: _Value) -> _Value:
    most = a.most * b.most
    return _Value(*_product(a, b), -most, most, a.least * b.least)


def _repeated(a: _Value, n: int) -> _Value:
    """A whole power, multiplied as a program does."""
    if n < 2:
        return a if n else _ONE
    half = _repeated(a, n // 2) if n % 2 == 0 else None
    return _times(half, half) if half else _times(_repeated(a, n - 1), a)


def _quotient(a: _Value, b: _Value) -> tuple[float, float]:
    below = b.as_relative
    if not below < 0.5:
        return INF, 0.0
    relative = (1 + a.relative) / (1 - below) * (1 + HALF_UNIT) - 1
    absolute = a.absolute / (b.least * (1 - below)) if a.absolute and b.least else a.absolute * INF
    if math.isnan(absolute):
        absolute = 0.0  # 0/0: there was none above
    normal = b.most > 0 and a.least / b.most > 2 * SMALLEST
    return relative, absolute * (1 + HALF_UNIT) + (0.0 if normal else _UNDERFLOW / 2)


def _root(a: _Value) -> tuple[float, float]:
    relative = 1 - math.sqrt(1 - min(a.as_relative, 1.0))
    return (relative + HALF_UNIT * (1 + relative) if a.as_relative < 1 else INF), 0.0


_ARITHMETIC: dict[str, Callable[..., tuple[float, float]]] = {
    "add": _sum,
    "sub": _difference,
    "mul": _product,
    "div": _quotient,
    "sqrt": _root,
}


def _normal(of: Interval) -> bool:
    return of.low > 2 * SMALLEST or of.high < -2 * SMALLEST


def _moved(by: float, to: Interval) -> tuple[float, float]:
    """An absolute error, relative to the result where that is never near 0."""
    least = max(to.low, -to.high) / (1 + 2 * LIBRARY) - by
    return (by / least, 0.0) if least > 0 else (0.0, by)


def _exp(x: _Value, _to: Interval) -> tuple[float, float]:
    return (math.expm1(x.as_absolute) if x.as_absolute < 100 else INF), 0.0


def _ln(x: _Value, to: Interval) -> tuple[float, float]:
    return _moved(-math.log1p(-x.as_relative), to) if x.as_relative < 1 else (INF, 0.0)


def _sine(x: _Value, to: Interval) -> tuple[float, float]:
    # Up to a right angle x/sin(x) <= pi/2, so the error stays relative at 0.
    small = x.absolute == 0 and _reach(x) <= math.pi / 2
    return (x.relative * math.pi / 2, 0.0) if small else _moved(x.as_absolute, to)


def _tangent(x: _Value, to: Interval) -> tuple[float, float]:
    if _reach(x) > math.pi / 2 - 1e-9:
        return INF, 0.0
    slope = 1 / math.cos(_reach(x))
    if x.absolute == 0:
        return x.relative * math.pi / 2 * slope, 0.0
    return _moved(x.as_absolute * slope**2, to)


def _reach(x: _Value) -> float:
    """The greatest size of the argument, exact or computed."""
    return x.most * (1 + x.relative) + x.absolute


_FUNCTIONS: dict[str, Callable[[_Value, Interval], tuple[float, float]]] = {
    "exp": _exp,
    "ln": _ln,
    "sin": _sine,
    "cos": lambda x, to: _moved(x.as_absolute * min(_reach(x), 1.0), to),
    "tan": _tangent,
    "atan": lambda x, to: _moved(x.as_absolute, to),
}
"""What an argument's error makes of the result, by operator; the others take exact ones only."""
