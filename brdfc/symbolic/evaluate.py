"""The value of an expression: in float64 on arrays, or in high precision at one point."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.symbolic.expression import Expression, nearest, walk
from brdfc.symbolic.precise import PreciseEvaluation

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
    parts = list(walk(expression))
    last_use = {argument: e for e in parts for argument in e.arguments}
    done: dict[Expression, NDArray[np.float64]] = {}
    with np.errstate(all="ignore"):
        for e in parts:
            done[e] = _step(e, done, values)
            for argument in set(e.arguments):  # its memory is still in the cache for what follows
                if last_use[argument] is e:
                    del done[argument]
    result = done[expression]
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


def evaluate_precisely(
    expression: Expression, values: Mapping[str, Sequence[float]]
) -> tuple[float, ...]:
    """The value at one point in high precision, as PreciseEvaluation gives it."""
    return PreciseEvaluation(expression)(values)
