"""Formulas as they are printed in papers, in the characters of a terminal."""

from __future__ import annotations

from typing import Any

from brdfc.lang import tree

_RENAMED = {"ln": "log", "abs": "Abs", "min": "Min", "max": "Max", "ceil": "ceiling"}
_KNOWN = ("sin", "cos", "tan", "asin", "acos", "atan", "exp", "sqrt", "cbrt", "sign", "floor")


def typeset(expression: tree.Expr, width: int = 100) -> str:
    """An expression drawn over several lines, as SymPy draws it; at most so many columns."""
    if isinstance(expression, tree.Where):  # the condition below, not beside a tall brace
        condition, otherwise = (
            typeset(part, width) for part in (expression.condition, expression.otherwise)
        )
        if "\n" not in condition + otherwise:
            return f"{typeset(expression.value, width)}\nwhere {condition}, else {otherwise}"
    import sympy

    with sympy.evaluate(False):
        formula = _to_sympy(expression)
    return str(sympy.pretty(formula, use_unicode=True, order="none", num_columns=width))


def _to_sympy(node: tree.Expr) -> Any:
    """The same formula for SymPy's printer only: nothing is evaluated or reordered."""
    import sympy

    match node:
        case tree.Number(value=value, unit=unit):
            number = sympy.Rational(value.numerator, value.denominator)
            mark = {"deg": "°", "": ""}.get(unit, unit)
            text = number if value.denominator == 1 else sympy.Float(float(value))
            return sympy.Symbol(f"{text}{mark}") if unit else text
        case tree.Name(name=name):
            return sympy.pi if name == "pi" else sympy.Symbol(_spaced(name))
        case tree.Unary(operator=operator, operand=operand):
            inner = _to_sympy(operand)
            return sympy.Mul(-1, inner) if operator == "-" else sympy.Not(inner)
        case tree.Binary():
            return _binary(node)
        case tree.Where(value=value, condition=condition, otherwise=otherwise):
            return sympy.Piecewise(
                (_to_sympy(value), _to_sympy(condition)), (_to_sympy(otherwise), True)
            )
        case tree.Vector(components=components):
            return sympy.Tuple(*map(_to_sympy, components))
        case tree.Component(vector=vector, index=index):
            return sympy.Symbol(f"{_to_sympy(vector)}.{'xyz'[index]}")
        case tree.LetIn(name=name, value=value, body=body):
            return sympy.Function("let")(
                sympy.Eq(sympy.Symbol(name), _to_sympy(value)), _to_sympy(body)
            )
        case tree.Call(function=function, arguments=arguments):
            given = list(map(_to_sympy, arguments))
            name = _RENAMED.get(function, function)
            known = function in _KNOWN or function in _RENAMED
            return (getattr(sympy, name) if known else sympy.Function(_spaced(function)))(*given)
    raise TypeError(f"unknown node {node!r}")


def _spaced(name: str) -> str:
    """SymPy sets what follows an underscore as an index, which only short parts survive."""
    return name if all(len(part) < 3 for part in name.split("_")[1:]) else name.replace("_", " ")


def _binary(node: tree.Binary) -> Any:
    import sympy

    a, b = _to_sympy(node.left), _to_sympy(node.right)
    match node.operator:
        case "+":
            return sympy.Add(a, b)
        case "-":
            return sympy.Add(a, sympy.Mul(-1, b))
        case "*":
            return sympy.Mul(a, b)
        case "/":
            return sympy.Mul(a, sympy.Pow(b, -1))
        case "^":
            return sympy.Pow(a, b)
        case "<":
            return sympy.Lt(a, b)
        case "<=":
            return sympy.Le(a, b)
        case ">":
            return sympy.Gt(a, b)
        case ">=":
            return sympy.Ge(a, b)
        case "==":
            return sympy.Eq(a, b)
        case "!=":
            return sympy.Ne(a, b)
        case "and":
            return sympy.And(a, b)
    return sympy.Or(a, b)
