"""Values of an expression with forty digits: the truth every compiled program is judged by.

What the formula leaves undefined (a division by zero, the root of a negative number) is NaN, never
an error. The numbers are mpmath's bare ones, as its own functions pass them on: its number objects
would take longer than what is computed with them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any

from brdfc.symbolic.expression import Expression, walk

DIGITS = 40
"""Decimal digits of the truth: a float32 result has 7, the worst cancellation here loses 15."""

_Number = Any
"""A finite number of mpmath's, (sign, mantissa, exponent, bits of the mantissa), the mantissa odd
or 0; a condition is 1 or 0; None where it is undefined."""
_Components = tuple[_Number, ...]
_Functions = Mapping[str, Callable[..., _Number]]

_LARGEST_EXPONENT = 33_220
"""A number of more binary digits than this (10,000 decimal ones) stands still, or a tower of powers
would not end."""
_LARGEST_ARGUMENT, _LEAST_ARGUMENT = 10**4, -(10**9)
"""Of exp: beyond them its value is as good as infinite, or 0."""
_LONGEST_PRODUCT = 1024
"""The largest whole exponent for which a power is a product."""

_DECIDED = {"and": 0, "or": 1}
"""What decides an operator on conditions, whatever the other is."""


class PreciseEvaluation:
    """The value of an expression at one point after another, computed with DIGITS digits.

    What rests only on quantities that are as they were at the point before is not computed again.
    """

    def __init__(self, expression: Expression) -> None:
        self._expression = expression
        self._functions = _functions()
        self._done: dict[Expression, _Components] = {}
        self._given: dict[str, tuple[float, ...]] = {}
        self._resting_on: dict[str, list[Expression]] = {}
        quantities: dict[Expression, frozenset[str]] = {}
        for e in walk(expression):
            own = {e.name} if e.operator == "quantity" else ()
            quantities[e] = frozenset(own).union(*(quantities[a] for a in e.arguments))
            for name in quantities[e]:
                self._resting_on.setdefault(name, []).append(e)

    def __call__(self, values: Mapping[str, Sequence[float]]) -> tuple[float, ...]:
        """The value at a point, rounded once to float64: one number a component.

        values: the same for every quantity. NaN stands for what is undefined there, and whatever
        rests on it is undefined too; but `a and b` is false where one of them is. Infinity is what
        float64 cannot hold.
        """
        for name, changed in self._resting_on.items():
            given = tuple(values[name])
            if self._given.get(name) != given:
                self._given[name] = given
                for e in changed:
                    self._done.pop(e, None)
        return tuple(_rounded(x) for x in self._components(self._expression))

    def _components(self, e: Expression) -> _Components:
        found = self._done.get(e)
        if found is None:
            found = self._done[e] = self._computed(e)
        return found

    def _computed(self, e: Expression) -> _Components:
        function = self._functions.get(e.operator)
        if function is None:
            return self._moved(e)
        columns = [self._components(a) for a in e.arguments]
        if e.width > 1:
            columns = [c * e.width if len(c) == 1 else c for c in columns]
        rows = zip(*columns, strict=True)
        return tuple(
            [_undefined(e.operator, row) if None in row else function(*row) for row in rows]
        )

    def _moved(self, e: Expression) -> _Components:
        """The components of what is no function of its arguments' values."""
        match e.operator:
            case "const":
                return (_fraction(e.value.numerator, e.value.denominator),)
            case "pi":
                return (_pi(),)
            case "quantity":
                return tuple(_exactly(x) for x in self._given[e.name])
            case "vector":
                return tuple(self._components(a)[0] for a in e.arguments)
            case "component":
                return (self._components(e.arguments[0])[e.index],)
        # Only the branch that counts, as the formula means it.
        condition, value, otherwise = e.arguments
        (truth,) = self._components(condition)
        if truth is None:
            return (None,) * e.width
        branch = self._components(otherwise if truth == _whole(0) else value)
        return branch * e.width if len(branch) == 1 else branch


def _undefined(operator: str, row: _Components) -> _Number:
    """What an operator makes of arguments some of which are undefined."""
    decided = _DECIDED.get(operator)
    return _whole(decided) if decided is not None and _whole(decided) in row else None


def _whole(x: int) -> _Number:
    from mpmath.libmp import from_int

    return from_int(x)


def _exactly(x: float) -> _Number:
    from mpmath.libmp import from_float

    return from_float(float(x))


def _fraction(numerator: int, denominator: int) -> _Number:
    from mpmath.libmp import from_rational

    return from_rational(numerator, denominator, _bits(), "n")


def _pi() -> _Number:
    from mpmath.libmp import mpf_pi

    return mpf_pi(_bits(), "n")


def _rounded(value: _Number) -> float:
    from mpmath.libmp import to_float

    return float("nan") if value is None else float(to_float(value, rnd="n"))


@cache
def _bits() -> int:
    from mpmath.libmp import dps_to_prec

    return int(dps_to_prec(DIGITS))


@cache
def _functions() -> _Functions:
    """The function for every operator on defined numbers."""
    from mpmath import libmp as m

    bits = _bits()
    zero, half, one, ten = m.fzero, m.from_float(0.5), m.fone, m.from_int(10)
    largest = m.from_man_exp(1, _LARGEST_EXPONENT)
    least_argument, largest_argument = m.from_int(_LEAST_ARGUMENT), m.from_int(_LARGEST_ARGUMENT)

    def of_one(function: Callable[..., _Number]) -> Callable[[_Number], _Number]:
        return lambda x: function(x, bits, "n")

    def of_two(function: Callable[..., _Number]) -> Callable[[_Number, _Number], _Number]:
        return lambda x, y: function(x, y, bits, "n")

    def tamed(x: _Number) -> _Number:
        sign, _, exponent, size = x
        if exponent + size <= _LARGEST_EXPONENT:
            return x
        return m.mpf_neg(largest) if sign else largest

    def multiply(x: _Number, y: _Number) -> _Number:
        return tamed(m.mpf_mul(x, y, bits, "n"))

    def divide(x: _Number, y: _Number) -> _Number:
        return None if y == zero else tamed(m.mpf_div(x, y, bits, "n"))

    def exp(x: _Number) -> _Number:
        if m.mpf_gt(x, largest_argument):
            return largest
        return m.mpf_exp(x, bits, "n") if m.mpf_gt(x, least_argument) else zero

    def power(x: _Number, y: _Number) -> _Number:
        negative, _, exponent, _ = y
        whole = exponent >= 0
        if x == zero:
            return None if negative else one if y == zero else zero
        if whole and m.mpf_le(m.mpf_abs(y), m.from_int(_LONGEST_PRODUCT)):
            return tamed(m.mpf_pow_int(x, m.to_int(y), bits, "n"))
        if x[0] and not whole:
            return None
        size = exp(multiply(y, m.mpf_log(m.mpf_abs(x), bits, "n")))
        return m.mpf_neg(size) if x[0] and exponent == 0 else size  # of an odd one

    def truth(condition: Callable[..., bool]) -> Callable[..., _Number]:
        return lambda *x: one if condition(*x) else zero

    def log10(x: _Number) -> _Number:
        if m.mpf_sign(x) <= 0:
            return None
        more = bits + 20
        return m.mpf_div(m.mpf_log(x, more, "n"), m.mpf_log(ten, more, "n"), bits, "n")

    def within_one(function: Callable[..., _Number]) -> Callable[[_Number], _Number]:
        return lambda x: function(x, bits, "n") if m.mpf_le(m.mpf_abs(x), one) else None

    def size_first(function: Callable[..., _Number]) -> Callable[[_Number], _Number]:
        return lambda x: m.mpf_neg(function(m.mpf_neg(x))) if x[0] else function(x)

    return {
        "add": of_two(m.mpf_add),
        "sub": of_two(m.mpf_sub),
        "mul": multiply,
        "div": divide,
        "neg": m.mpf_neg,
        "pow": power,
        "sqrt": lambda x: None if x[0] else m.mpf_sqrt(x, bits, "n"),
        "cbrt": size_first(of_one(m.mpf_cbrt)),
        "exp": exp,
        "ln": lambda x: m.mpf_log(x, bits, "n") if m.mpf_sign(x) > 0 else None,
        "log10": log10,
        "sin": of_one(m.mpf_sin),
        "cos": of_one(m.mpf_cos),
        "tan": of_one(m.mpf_tan),
        "asin": within_one(m.mpf_asin),
        "acos": within_one(m.mpf_acos),
        "atan": of_one(m.mpf_atan),
        "atan2": of_two(m.mpf_atan2),
        "abs": m.mpf_abs,
        "sign": lambda x: m.from_int(m.mpf_sign(x)),
        "floor": of_one(m.mpf_floor),
        "ceil": of_one(m.mpf_ceil),
        "trunc": size_first(of_one(m.mpf_floor)),
        "round": size_first(lambda x: m.mpf_floor(m.mpf_add(x, half, bits, "n"), bits, "n")),
        "min": lambda x, y: y if m.mpf_lt(y, x) else x,
        "max": lambda x, y: y if m.mpf_gt(y, x) else x,
        "lt": truth(m.mpf_lt),
        "le": truth(m.mpf_le),
        "gt": truth(m.mpf_gt),
        "ge": truth(m.mpf_ge),
        "eq": truth(m.mpf_eq),
        "ne": truth(lambda x, y: not m.mpf_eq(x, y)),
        "and": truth(lambda x, y: x != zero and y != zero),
        "or": truth(lambda x, y: x != zero or y != zero),
        "not": truth(lambda x: x == zero),
    }
