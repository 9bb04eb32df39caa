"""What SymPy makes of an expression: its `simplify` and `fu`, as candidates like any other.

SymPy moves into identities that cancel in float32 as readily as out of them, so its results are
only proposals: they are measured, not trusted.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from brdfc.symbolic.expression import PI, Expression, const, make, quantity, walk

_FUNCTIONS = ("sin", "cos", "tan", "asin", "acos", "atan", "exp", "sqrt")
_ARITHMETIC = ("const", "pi", "quantity", "add", "sub", "mul", "div", "neg", "pow", "ln")
LARGEST = 60
"""Parts of an expression that is handed over; SymPy takes seconds for more."""


def proposals(expression: Expression) -> Iterator[tuple[str, Expression, Expression]]:
    """(name, part, replacement) for the greatest parts that SymPy understands."""
    import sympy

    for part in _greatest(expression):
        symbols: dict[Any, Expression] = {}
        formula = to_sympy(part, symbols)
        for name, function in (("SymPy simplify", sympy.simplify), ("SymPy fu", _fu)):
            try:
                back = from_sympy(function(formula), symbols)
            except (NotImplementedError, TypeError, ValueError, ArithmeticError):
                continue
            if back is not None and back is not part:
                yield name, part, back


def _fu(formula: Any) -> Any:
    from sympy.simplify.fu import TR22, fu

    return TR22(fu(formula))


def _greatest(expression: Expression) -> list[Expression]:
    """The greatest scalar parts made of arithmetic and known functions, of a moderate size."""
    found: list[Expression] = []

    def visit(e: Expression) -> None:
        parts = list(walk(e))
        known = all(p.operator in _ARITHMETIC + _FUNCTIONS and p.width == 1 for p in parts)
        if known and 3 < len(parts) <= LARGEST:
            if e not in found:
                found.append(e)
            return
        for argument in e.arguments:
            visit(argument)

    visit(expression)
    return found


def to_sympy(e: Expression, symbols: dict[Any, Expression]) -> Any:
    """SymPy's form of a scalar expression; symbols: gets what stands for what."""
    import sympy

    if e.operator == "const":
        # A constant of many digits says nothing to SymPy; a symbol keeps it exact and quick.
        if e.value.denominator > 10**6:
            symbol = sympy.Symbol(f"_c{len(symbols)}", positive=e.value > 0, real=True)
            symbols[symbol] = e
            return symbol
        return sympy.Rational(e.value.numerator, e.value.denominator)
    if e.operator == "pi":
        return sympy.pi
    if e.operator == "quantity":
        symbol = sympy.Symbol(e.name, real=True)
        symbols[symbol] = e
        return symbol
    arguments = [to_sympy(a, symbols) for a in e.arguments]
    match e.operator:
        case "add":
            return arguments[0] + arguments[1]
        case "sub":
            return arguments[0] - arguments[1]
        case "mul":
            return arguments[0] * arguments[1]
        case "div":
            return arguments[0] / arguments[1]
        case "neg":
            return -arguments[0]
        case "pow":
            return arguments[0] ** arguments[1]
        case "ln":
            return sympy.log(arguments[0])
        case "log10":
            return sympy.log(arguments[0]) / sympy.log(10)
    return getattr(sympy, e.operator)(*arguments)


def from_sympy(value: Any, symbols: dict[Any, Expression]) -> Expression | None:
    """The expression of SymPy's answer; None where it uses what the calculator has not."""
    import sympy

    if value.is_Rational:
        return const(Fraction(int(value.p), int(value.q)))
    if value == sympy.pi:
        return PI
    if value.is_Symbol:
        return symbols.get(value) or quantity(str(value), 1)
    if value.is_Pow and value.exp == sympy.Rational(1, 2):
        inner = from_sympy(value.base, symbols)
        return make("sqrt", inner) if inner is not None else None
    if isinstance(value, sympy.exp):
        inner = from_sympy(value.args[0], symbols)
        return make("exp", inner) if inner is not None else None
    arguments = [from_sympy(a, symbols) for a in value.args]
    if not arguments or any(a is None for a in arguments):
        return None
    given = [a for a in arguments if a is not None]
    if value.is_Add or value.is_Mul:
        operator = "add" if value.is_Add else "mul"
        result = given[0]
        for argument in given[1:]:
            result = make(operator, result, argument)
        return result
    if value.is_Pow:
        return make("pow", *given)
    name = {"log": "ln"}.get(value.func.__name__, value.func.__name__)
    return make(name, *given) if name in (*_FUNCTIONS, "ln") else None
