"""Derivatives of expressions, as expressions: the chain rule on the graph, so that what a value and
its derivative share stays shared.

How each operator changes with its arguments is asked of SymPy, once. Where a function has a kink
(abs, min, max, a condition) the derivative is that of the side which is taken; of steps it is 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from brdfc.symbolic.expression import (
    ONE,
    ZERO,
    Expression,
    component,
    const,
    make,
    quantity,
    substituted,
    vector,
    walk,
)
from brdfc.symbolic.sympy_forms import from_sympy, to_sympy

_SMOOTH = (
    *("neg", "sqrt", "cbrt", "exp", "ln", "log10"),
    *("sin", "cos", "tan", "asin", "acos", "atan"),
    *("add", "sub", "mul", "div", "pow", "atan2"),
)
"""Operators that SymPy is asked about."""


def derivative(expression: Expression, name: str, index: int | None = None) -> Expression:
    """The derivative of an expression by a quantity, or by one component of it.

    Of the expression's width, or a scalar where it is the same for all components.
    """
    done: dict[Expression, Expression] = {}
    for e in walk(expression):
        match e.operator:
            case "const" | "pi":
                done[e] = ZERO
            case "quantity" if e.name != name:
                done[e] = ZERO
            case "quantity":
                wanted = range(e.width) if index is None else (index,)
                ones = [const(int(k in wanted)) for k in range(e.width)]
                done[e] = ONE if e.width == 1 else vector(ones)
            case "vector":
                parts = [done[a] for a in e.arguments]
                done[e] = ZERO if all(p is ZERO for p in parts) else vector(parts)
            case "component":
                whole = done[e.arguments[0]]
                done[e] = component(whole, e.index) if whole.width > 1 else whole
            case "abs":
                done[e] = _product(make("sign", e.arguments[0]), done[e.arguments[0]])
            case "min" | "max":
                relation = "le" if e.operator == "min" else "ge"
                condition = make(relation, *e.arguments)
                done[e] = _chosen(condition, [done[a] for a in e.arguments])
            case "where":
                done[e] = _chosen(e.arguments[0], [done[a] for a in e.arguments[1:]])
            case operator if operator in _SMOOTH:
                done[e] = _chained(e, [done[a] for a in e.arguments])
            case _:  # steps and truths
                done[e] = ZERO
    return done[expression]


def _chained(e: Expression, inner: Sequence[Expression]) -> Expression:
    """The sum of the operator's own derivatives times those of its arguments."""
    total = ZERO
    for place, slope in enumerate(inner):
        if slope is ZERO:
            continue
        # Constants stand as they are: the derivative of x^2 is 2 x, not 2 x^2/x.
        stand_in = tuple(
            a if a.operator == "const" else quantity(f"_{k}", 1) for k, a in enumerate(e.arguments)
        )
        own = substituted(
            _own(e.operator, stand_in, place), dict(zip(stand_in, e.arguments, strict=True))
        )
        total = _sum(total, _product(own, slope))
    return total


@cache
def _own(operator: str, arguments: tuple[Expression, ...], place: int) -> Expression:
    """The derivative of an operator by one of its arguments."""
    import sympy

    symbols: dict[object, Expression] = {}
    value = to_sympy(make(operator, *arguments), symbols)
    by = to_sympy(arguments[place], symbols)
    found = from_sympy(sympy.diff(value, by), symbols)
    if found is None:
        raise NotImplementedError(f"the derivative of '{operator}'")
    return found


def _product(a: Expression, b: Expression) -> Expression:
    if ZERO in (a, b):
        return ZERO
    if a is ONE:
        return b
    return a if b is ONE else make("mul", a, b)


def _sum(a: Expression, b: Expression) -> Expression:
    return b if a is ZERO else make("add", a, b)


def _chosen(condition: Expression, slopes: Sequence[Expression]) -> Expression:
    if all(slope is slopes[0] for slope in slopes):
        return slopes[0]
    return make("where", condition, *slopes)
