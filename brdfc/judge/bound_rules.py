"""What errors come to: of a value, and through every operation."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from brdfc.symbolic.intervals import INF, SMALLEST, Interval

HALF_UNIT, LIBRARY = 2.0**-24, 2.0**-22
UNDERFLOW = 2.0**-149
SLACK = 1 + 1e-9
"""For the float64 arithmetic of the bounds themselves."""


@dataclass(frozen=True)
class Value:
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


def exact_value(relative: float, absolute: float, computed: Interval) -> Value:
    """What the exact values are, from the range of the computed ones."""
    if not computed.finite or not relative < 0.5 or not absolute < INF:
        return Value(INF, INF, -INF, INF, 0.0)
    low, high = computed.low - absolute, computed.high + absolute
    low /= (1 + relative) if low > 0 else (1 - relative)
    high /= (1 - relative) if high > 0 else (1 + relative)
    least = low if low > 0 else -high if high < 0 else computed.gap - absolute
    return Value(relative, absolute, low, high, max(least, 0.0) / (1 + relative) / SLACK)


ONE = Value(0.0, 0.0, 1.0, 1.0, 1.0)


def worst(values: list[Value]) -> tuple[float, float]:
    pairs = [(v.relative, v.absolute) for v in values] or [(0.0, 0.0)]
    return max(r for r, _ in pairs), max(a for _, a in pairs)


def _sum(a: Value, b: Value) -> tuple[float, float]:
    relative, absolute = max(a.relative, b.relative), a.absolute + b.absolute
    # |a| + |b| is |a + b| and twice what is of the other sign.
    other = min(max(-a.low, 0) + max(-b.low, 0), max(a.high, 0) + max(b.high, 0))
    least = max(a.low + b.low, -(a.high + b.high)) / SLACK
    if least > 0 and other > 0:
        relative = (a.relative * a.most + b.relative * b.most) / least
    elif relative:
        absolute += 2 * relative * other
    return relative + HALF_UNIT * (1 + relative), absolute * (1 + HALF_UNIT)


def _difference(a: Value, b: Value) -> tuple[float, float]:
    return _sum(a, Value(b.relative, b.absolute, -b.high, -b.low, b.least))


def _product(a: Value, b: Value) -> tuple[float, float]:
    relative = (1 + a.relative) * (1 + b.relative) * (1 + HALF_UNIT) - 1
    absolute = a.absolute * b.absolute
    for x, y in ((a, b), (b, a)):
        if y.absolute:
            absolute += x.most * (1 + x.relative) * y.absolute
    is_normal = a.least * b.least > 2 * SMALLEST
    return relative, absolute * (1 + HALF_UNIT) + (0.0 if is_normal else UNDERFLOW / 2)


def _times(a: Value, b: Value) -> Value:
    most = a.most * b.most
    return Value(*_product(a, b), -most, most, a.least * b.least)


def repeated(a: Value, n: int) -> Value:
    """A whole power, multiplied as a program does."""
    if n < 2:
        return a if n else ONE
    half = repeated(a, n // 2) if n % 2 == 0 else None
    return _times(half, half) if half else _times(repeated(a, n - 1), a)


def quotient(a: Value, b: Value) -> tuple[float, float]:
    below = b.as_relative
    if not below < 0.5:
        return INF, 0.0
    relative = (1 + a.relative) / (1 - below) * (1 + HALF_UNIT) - 1
    absolute = a.absolute / (b.least * (1 - below)) if a.absolute and b.least else a.absolute * INF
    if math.isnan(absolute):
        absolute = 0.0  # 0/0: there was none above
    is_normal = b.most > 0 and a.least / b.most > 2 * SMALLEST
    return relative, absolute * (1 + HALF_UNIT) + (0.0 if is_normal else UNDERFLOW / 2)


def _root(a: Value) -> tuple[float, float]:
    relative = 1 - math.sqrt(1 - min(a.as_relative, 1.0))
    return (relative + HALF_UNIT * (1 + relative) if a.as_relative < 1 else INF), 0.0


ARITHMETIC: dict[str, Callable[..., tuple[float, float]]] = {
    "add": _sum,
    "sub": _difference,
    "mul": _product,
    "div": quotient,
    "sqrt": _root,
}


def normal(of: Interval) -> bool:
    return of.low > 2 * SMALLEST or of.high < -2 * SMALLEST


def _moved(by: float, to: Interval) -> tuple[float, float]:
    """An absolute error, relative to the result where that is never near 0."""
    least = max(to.low, -to.high) / (1 + 2 * LIBRARY) - by
    return (by / least, 0.0) if least > 0 else (0.0, by)


def _exp(x: Value, _to: Interval) -> tuple[float, float]:
    return (math.expm1(x.as_absolute) if x.as_absolute < 100 else INF), 0.0


def _ln(x: Value, to: Interval) -> tuple[float, float]:
    return _moved(-math.log1p(-x.as_relative), to) if x.as_relative < 1 else (INF, 0.0)


def _sine(x: Value, to: Interval) -> tuple[float, float]:
    # Up to a right angle x/sin(x) <= pi/2, so the error stays relative at 0.
    small = x.absolute == 0 and _reach(x) <= math.pi / 2
    return (x.relative * math.pi / 2, 0.0) if small else _moved(x.as_absolute, to)


def _tangent(x: Value, to: Interval) -> tuple[float, float]:
    if _reach(x) > math.pi / 2 - 1e-9:
        return INF, 0.0
    slope = 1 / math.cos(_reach(x))
    if x.absolute == 0:
        return x.relative * math.pi / 2 * slope, 0.0
    return _moved(x.as_absolute * slope**2, to)


def _reach(x: Value) -> float:
    """The greatest size of the argument, exact or computed."""
    return x.most * (1 + x.relative) + x.absolute


FUNCTIONS: dict[str, Callable[[Value, Interval], tuple[float, float]]] = {
    "exp": _exp,
    "ln": _ln,
    "sin": _sine,
    "cos": lambda x, to: _moved(x.as_absolute * min(_reach(x), 1.0), to),
    "tan": _tangent,
    "atan": lambda x, to: _moved(x.as_absolute, to),
}
"""What an argument's error makes of the result, by operator; the others take exact ones only."""
