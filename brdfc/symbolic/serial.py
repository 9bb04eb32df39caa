"""Expressions as plain data (for JSON) and back: the graph, shared parts once."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from brdfc.lang.limits import MAX_LEVELS
from brdfc.symbolic.expression import (
    PI,
    Expression,
    component,
    const,
    make,
    quantity,
    vector,
    walk,
)

_ARGUMENTS = {
    **dict.fromkeys(("neg", "not", "abs", "sign", "floor", "ceil", "trunc", "round"), 1),
    **dict.fromkeys(("sqrt", "cbrt", "exp", "ln", "log10"), 1),
    **dict.fromkeys(("sin", "cos", "tan", "asin", "acos", "atan"), 1),
    **dict.fromkeys(("add", "sub", "mul", "div", "pow", "atan2", "min", "max"), 2),
    **dict.fromkeys(("lt", "le", "gt", "ge", "eq", "ne", "and", "or"), 2),
    "where": 3,
}
_DEEPEST = 2 * MAX_LEVELS
"""Levels of an expression that later stages walk by recursion; forms go deeper than formulas."""


def to_data(expression: Expression) -> list[list[Any]]:
    """One row an expression, arguments before what uses them, the whole last."""
    rows: list[list[Any]] = []
    index: dict[Expression, int] = {}
    for e in walk(expression):
        leaf: Any = {
            "const": [e.value.numerator, e.value.denominator],
            "quantity": [e.name, e.width],
            "component": e.index,
        }.get(e.operator)
        index[e] = len(rows)
        rows.append([e.operator, [index[a] for a in e.arguments], leaf])
    return rows


def from_data(rows: Sequence[Sequence[Any]]) -> Expression:
    """The expression of to_data's rows; LookupError, TypeError or ValueError for rows that are
    none, whoever wrote them."""
    made: list[Expression] = []
    levels: list[int] = []
    for operator, arguments, leaf in rows:
        if not all(type(i) is int and 0 <= i < len(made) for i in arguments):
            raise ValueError("an argument that does not come before")
        made.append(_made(operator, [made[i] for i in arguments], leaf))
        levels.append(1 + max((levels[i] for i in arguments), default=0))
    if max(levels, default=0) > _DEEPEST:
        raise ValueError("deeper than any formula")
    return made[-1]


def _made(operator: str, given: list[Expression], leaf: Any) -> Expression:
    count = {"component": 1, "vector": len(given)}.get(operator, _ARGUMENTS.get(operator, 0))
    if len(given) != count:
        raise ValueError(f"{operator} of {len(given)} arguments")
    match operator:
        case "const":
            numerator, denominator = leaf
            if denominator == 0:
                raise ValueError("a fraction over 0")
            return const(Fraction(numerator, denominator))
        case "pi":
            return PI
        case "quantity":
            name, width = leaf
            if type(name) is not str or width not in (1, 3):
                raise ValueError(f"{leaf} is no quantity")
            return quantity(name, width)
        case "component":
            if type(leaf) is not int or not 0 <= leaf < given[0].width:
                raise ValueError(f"no component {leaf}")
            return component(given[0], leaf)
        case "vector":
            if not given or any(e.width != 1 for e in given):
                raise ValueError("a vector of anything but scalars")
            return vector(given)
    if operator not in _ARGUMENTS or len({e.width for e in given} - {1}) > 1:
        raise ValueError(f"no operator {operator} of such widths")
    return make(operator, *given)
