"""The value of an expression: in float64 on arrays, or in high precision at one point.

High precision is the truth every compiled program is judged by. There, what the formula leaves
undefined (a division by zero, the root of a negative number) is NaN, never an error.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.symbolic.expression import Expression, nearest, walk

DIGITS = 40
"""Decimal digits of the truth: a float32 result has 7, the worst cancellation here loses 15."""

_Table = Mapping[str, Callable[..., Any]]

_FLOAT64: _Table = {
    "add": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "div": np.divide,
    "neg": np.negative,
    "pow": np.power,
    "sqrt": np.sqrt,
    "cbrt": np.cbrt,
    "exp": np.exp,
    "ln": np.log,
    "log10": np.log10,
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": np.arctan2,
    "abs": np.abs,
    "sign": np.sign,
    "floor": np.floor,
    "ceil": np.ceil,
    "trunc": np.trunc,
    "round": lambda x: np.trunc(x + np.copysign(0.5, x)),
    "min": np.minimum,
    "max": np.maximum,
    "lt": np.less,
    "le": np.less_equal,
    "gt": np.greater,
    "ge": np.greater_equal,
    "eq": np.equal,
    "ne": np.not_equal,
    "and": np.logical_and,
    "or": np.logical_or,
    "not": np.logical_not,
    "where": np.where,
}


def evaluate(
    expression: Expression, values: Mapping[str, NDArray[np.float64]]
) -> NDArray[np.float64]:
    """Float64 values of an expression.

    values: an array (..., components) for every quantity, broadcast against each other; angles in
    radians. Returns (..., width).
    """
    result = evaluate_parts(expression, values)[expression]
    shape = np.broadcast_shapes(result.shape, *((*np.shape(v)[:-1], 1) for v in values.values()))
    return np.broadcast_to(result, (*shape[:-1], expression.width)).astype(np.float64)


def evaluate_parts(
    expression: Expression,
    values: Mapping[str, NDArray[np.float64]],
    known: Mapping[Expression, NDArray[np.float64]] | None = None,
) -> dict[Expression, NDArray[np.float64]]:
    """Float64 values of every part of an expression, as for evaluate, but not broadcast.

    known: values of some of them, of another expression at the same points.
    """
    done = dict(known or {})
    with np.errstate(all="ignore"):
        for e in walk(expression):
            if e not in done:
                done[e] = _step(e, done, values)
    return done


def _step(
    e: Expression,
    done: Mapping[Expression, NDArray[np.float64]],
    values: Mapping[str, NDArray[np.float64]],
) -> NDArray[np.float64]:
    """The value of an expression whose arguments are done."""
    match e.operator:
        case "const":
            return np.array([nearest(e.value)])
        case "pi":
            return np.array([np.pi])
        case "quantity":
            return np.asarray(values[e.name], dtype=np.float64)
    arguments = [done[a] for a in e.arguments]
    match e.operator:
        case "vector":
            return np.concatenate(np.broadcast_arrays(*arguments), axis=-1)
        case "component":
            return arguments[0][..., e.index : e.index + 1]
    return np.asarray(_FLOAT64[e.operator](*arguments))


class Evaluation:
    """Float64 values of several expressions, again and again at the same points.

    points: arrays (..., components) of the quantities that stay the same; what depends on nothing
    else is computed once.
    """

    def __init__(
        self, roots: Sequence[Expression], points: Mapping[str, NDArray[np.float64]]
    ) -> None:
        self.roots = tuple(roots)
        every = dict.fromkeys(e for root in roots for e in walk(root))
        fixed: dict[Expression, bool] = {}
        for e in every:
            here = e.operator != "quantity" or e.name in points
            fixed[e] = here and all(fixed[a] for a in e.arguments)
        self._known: dict[Expression, NDArray[np.float64]] = {}
        for e in every:
            if fixed[e]:
                self._known |= evaluate_parts(e, points, self._known)
        changing = [e for e in every if not fixed[e]]
        used = {a for e in changing for a in e.arguments} | set(roots)
        self._known = {e: v for e, v in self._known.items() if e in used}
        self._changing = changing

    def __call__(self, values: Mapping[str, NDArray[np.float64]]) -> list[NDArray[np.float64]]:
        """An array (..., width or 1) for each root, not broadcast; values: as for evaluate, of the
        quantities that are left."""
        done = dict(self._known)
        with np.errstate(all="ignore"):
            for e in self._changing:
                done[e] = _step(e, done, values)
        return [done[root] for root in self.roots]


_Number = Any
"""A finite mpmath number, or True or False for a condition; None for either where it is undefined.
"""
_LARGEST_EXPONENT = 10**4
"""A number of more decimal digits than this stands still, or a tower of powers would not end."""
_GROWING = ("mul", "div", "pow", "exp")


@cache
def _precise() -> tuple[Any, _Table]:
    """The context of DIGITS digits, and the function for every operator on defined numbers."""
    from mpmath import mp

    context = mp.clone()
    context.dps = DIGITS
    largest = context.mpf(10) ** _LARGEST_EXPONENT

    def real(function: Callable[..., Any], good: Callable[..., bool]) -> Callable[..., Any]:
        return lambda *x: function(*x) if good(*x) else None

    def exp(x: _Number) -> _Number:
        if x > _LARGEST_EXPONENT:
            return largest
        return context.exp(x) if x > -(10**9) else context.zero

    def power(x: _Number, y: _Number) -> _Number:
        whole = context.isint(y)
        if x == 0:
            return None if y < 0 else context.mpf(y == 0)
        if whole and abs(y) <= 1024:
            return x ** int(y)
        if x < 0 and not whole:
            return None
        size = exp(y * context.ln(abs(x)))
        return -size if x < 0 and int(y) % 2 else size

    def away(x: _Number) -> _Number:
        return context.sign(x) * context.floor(abs(x) + context.mpf("0.5"))

    return context, {
        "add": lambda x, y: x + y,
        "sub": lambda x, y: x - y,
        "mul": lambda x, y: x * y,
        "div": real(lambda x, y: x / y, lambda _x, y: y != 0),
        "neg": lambda x: -x,
        "pow": power,
        "sqrt": real(context.sqrt, lambda x: x >= 0),
        "cbrt": lambda x: context.sign(x) * context.cbrt(abs(x)),
        "exp": exp,
        "ln": real(context.ln, lambda x: x > 0),
        "log10": real(context.log10, lambda x: x > 0),
        "sin": context.sin,
        "cos": context.cos,
        "tan": context.tan,
        "asin": real(context.asin, lambda x: abs(x) <= 1),
        "acos": real(context.acos, lambda x: abs(x) <= 1),
        "atan": context.atan,
        "atan2": context.atan2,
        "abs": abs,
        "sign": context.sign,
        "floor": context.floor,
        "ceil": context.ceil,
        "trunc": lambda x: context.sign(x) * context.floor(abs(x)),
        "round": away,
        "min": min,
        "max": max,
        "lt": lambda x, y: x < y,
        "le": lambda x, y: x <= y,
        "gt": lambda x, y: x > y,
        "ge": lambda x, y: x >= y,
        "eq": lambda x, y: x == y,
        "ne": lambda x, y: x != y,
        "and": lambda x, y: x and y,
        "or": lambda x, y: x or y,
        "not": lambda x: not x,
    }


def evaluate_precisely(
    expression: Expression, values: Mapping[str, Sequence[float]]
) -> tuple[float, ...]:
    """The value at one point, computed with DIGITS digits and rounded once to float64.

    values: one number a component for every quantity. NaN stands for what is undefined there, and
    whatever rests on it is undefined too; but `a and b` is false where one of them is. Infinity
    is what float64 cannot hold.
    """
    context, table = _precise()
    done: dict[Expression, tuple[_Number, ...]] = {}
    largest = context.mpf(10) ** _LARGEST_EXPONENT

    def components(e: Expression) -> tuple[_Number, ...]:
        if e not in done:
            done[e] = compute(e)
        return done[e]

    def compute(e: Expression) -> tuple[_Number, ...]:
        if e.operator == "const":
            return (context.mpf(e.value.numerator) / e.value.denominator,)
        if e.operator == "pi":
            return (+context.pi,)
        if e.operator == "quantity":
            return tuple(context.mpf(float(v)) for v in values[e.name])
        if e.operator == "vector":
            return tuple(components(a)[0] for a in e.arguments)
        if e.operator == "component":
            return (components(e.arguments[0])[e.index],)
        if e.operator == "where":  # only the branch that counts, as the formula means it
            return chosen(e)
        columns = [components(a) for a in e.arguments]
        wide = [c * e.width if len(c) == 1 else c for c in columns]
        return tuple(apply(e.operator, row) for row in zip(*wide, strict=True))

    def chosen(e: Expression) -> tuple[_Number, ...]:
        condition, value, otherwise = e.arguments
        (truth,) = components(condition)
        branch = (None,) if truth is None else components(value if truth else otherwise)
        return branch * e.width if len(branch) == 1 else branch

    def apply(operator: str, row: tuple[_Number, ...]) -> _Number:
        if any(x is None for x in row):
            decided = {"and": False, "or": True}.get(operator)
            known = [bool(x) for x in row if x is not None]
            return decided if decided in known else None
        value = table[operator](*row)
        if operator in _GROWING and value is not None and abs(value) > largest:
            return largest * context.sign(value)
        return value

    return tuple(_rounded(value) for value in components(expression))


def _rounded(value: _Number) -> float:
    if value is None:
        return float("nan")
    try:
        return float(value)
    except OverflowError:
        return float("inf") if value > 0 else float("-inf")
