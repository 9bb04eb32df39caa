"""Exact constants: every part of an expression without quantities, evaluated by SymPy.

SymPy knows that cos(60deg) is 1/2 and that cos(90deg) is 0; what stays irrational is rounded once,
to DIGITS decimal digits, so that the only visible rounding is the last one, to float32.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import cache
from typing import Any

from brdfc.symbolic.expression import Expression, const, rebuild, vector, walk

DIGITS = 50
_LONGEST = 2000
"""Bits of a rational number, and operators of a symbolic one, beyond which it is rounded."""
_MOST_PARTS = 60
_LARGEST_POWER = 1000
_OUT_OF_REACH = 10_000
"""Decimal exponent at which a number is as good as infinite."""


def fold_constants(expression: Expression) -> Expression:
    """Every greatest constant part as one `const`; parts without a finite value are left alone."""
    values: dict[Expression, tuple[Any, ...]] = {}
    done: dict[Expression, Expression] = {}

    def folded(e: Expression) -> Expression:
        if e not in done:
            components = [_rational(v) for v in values[e]] if e in values else [None]
            constants = [const(c) for c in components if c is not None]
            if len(constants) == e.width:
                done[e] = constants[0] if e.width == 1 else vector(constants)
            else:
                done[e] = rebuild(e, [folded(a) for a in e.arguments])
        return done[e]

    for e in walk(expression):
        if e.operator != "quantity" and all(a in values for a in e.arguments):
            values[e] = _value(e, [values[a] for a in e.arguments])
        else:  # what is folded below it is folded already, so this goes one level deep
            done[e] = rebuild(e, [folded(a) for a in e.arguments])
    return folded(expression)


def _value(e: Expression, arguments: list[tuple[Any, ...]]) -> tuple[Any, ...]:
    """The components of a constant part from those of its arguments, as SymPy has them.

    A condition is True or False; None stands for what is undefined, not real, or beyond reach.
    """
    import sympy

    if e.operator == "const":
        return (sympy.Rational(e.value.numerator, e.value.denominator),)
    if e.operator == "pi":
        return (sympy.pi,)
    if e.operator == "vector":
        return tuple(a[0] for a in arguments)
    if e.operator == "component":
        return (arguments[0][e.index],)
    wide = [a * e.width if len(a) == 1 else a for a in arguments]
    return tuple(_apply(e.operator, row) for row in zip(*wide, strict=True))


def _apply(operator: str, row: tuple[Any, ...]) -> Any:
    if operator == "where":
        return None if row[0] is None else row[1] if row[0] else row[2]
    if any(x is None for x in row):
        return None
    return _tamed(_functions()[operator](*row))


def _tamed(value: Any) -> Any:
    """A number kept exact while it is short, else rounded; None where it is no finite number."""
    import sympy

    if value is None or isinstance(value, bool):
        return value
    if value.is_Rational:
        bits = max(abs(value.p).bit_length(), value.q.bit_length())
        return value if bits < _LONGEST else _rounded(value)
    if value.is_finite is False or value.is_real is False:
        return None
    rough = value.evalf(15)
    if not rough.is_Float or abs(rough) > _out_of_reach():
        return sympy.Integer(0) if rough.is_zero else None
    if abs(rough) * _out_of_reach() < 1:  # as good as 0, and its digits would fill the memory
        return sympy.Integer(0)
    long = len(list(sympy.preorder_traversal(value))) > _MOST_PARTS
    return _rounded(value) if long else value


def _rounded(value: Any) -> Any:
    """A number to DIGITS digits. Where all of them cancel it is 0: SymPy would give what is left
    of its working precision, and take that for the precision of all that is made of it."""
    import sympy

    rounded = value.evalf(DIGITS)
    return rounded if rounded._prec >= sympy.Float(1, DIGITS)._prec else sympy.Integer(0)


@cache
def _out_of_reach() -> Any:
    import sympy

    return sympy.Float(10) ** _OUT_OF_REACH


def _rational(value: Any) -> Fraction | None:
    if value is None or isinstance(value, bool):
        return None if value is None else Fraction(int(value))
    if value.is_Rational:
        return Fraction(int(value.p), int(value.q))
    return Fraction(str(_rounded(value)))


@cache
def _functions() -> dict[str, Callable[..., Any]]:
    """SymPy's function for every operator but `where`, on numbers or truths."""
    import sympy

    def power(x: Any, y: Any) -> Any:
        if x.is_Rational and abs(y) > _LARGEST_POWER:  # its digits would fill the memory
            x = sympy.Float(x, DIGITS)
        return x**y

    def truncated(x: Any) -> Any:
        return sympy.sign(x) * sympy.floor(sympy.Abs(x))

    def rounded(x: Any) -> Any:
        return sympy.sign(x) * sympy.floor(sympy.Abs(x) + sympy.Rational(1, 2))

    same = ("sqrt", "exp", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sign", "floor")
    return {
        "add": lambda x, y: x + y,
        "sub": lambda x, y: x - y,
        "mul": lambda x, y: x * y,
        "div": lambda x, y: None if y == 0 else x / y,
        "neg": lambda x: -x,
        "pow": power,
        "cbrt": lambda x: sympy.sign(x) * sympy.cbrt(sympy.Abs(x)),
        "ln": sympy.log,
        "log10": lambda x: sympy.log(x, 10),
        "abs": sympy.Abs,
        "ceil": sympy.ceiling,
        "trunc": truncated,
        "round": rounded,
        "min": lambda x, y: y if _order(x, y) > 0 else x,
        "max": lambda x, y: y if _order(x, y) < 0 else x,
        "lt": lambda x, y: _order(x, y) < 0,
        "le": lambda x, y: _order(x, y) <= 0,
        "gt": lambda x, y: _order(x, y) > 0,
        "ge": lambda x, y: _order(x, y) >= 0,
        "eq": lambda x, y: _order(x, y) == 0,
        "ne": lambda x, y: _order(x, y) != 0,
        "and": lambda x, y: bool(x and y),
        "or": lambda x, y: bool(x or y),
        "not": lambda x: not x,
        **{name: getattr(sympy, name) for name in same},
    }


def _order(x: Any, y: Any) -> int:
    """-1, 0 or 1 as x is below, at or above y; irrational numbers that agree to all but five of
    DIGITS digits are equal."""
    difference = x - y
    if not difference.is_Rational:
        slack = max(abs(x.evalf(15)), abs(y.evalf(15))) * 10 ** (5 - DIGITS)
        difference = difference.evalf(DIGITS, chop=True)
        if abs(difference) <= slack:
            return 0
    return int(bool(difference > 0)) - int(bool(difference < 0))
