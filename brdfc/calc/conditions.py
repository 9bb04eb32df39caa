"""What a branch may rely on: the bounds of values where a condition holds, or does not.

A condition is looked through to the values it was made of, so that after `cos ... vmin ceil if`
the cosines are known to be positive, and their angles to lie within a quarter turn of 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from brdfc.calc.paths import State, Value
from brdfc.symbolic.intervals import INF, Interval, above, below
from brdfc.symbolic.trigonometry import widest_above

DEEPEST = 12
"""How many operations a condition is looked through."""

_NEGATED = {"lt": "ge", "le": "gt", "gt": "le", "ge": "lt"}
_MIRRORED = {"lt": "gt", "le": "ge", "gt": "lt", "ge": "le"}
_ALL, _ANY = ("and", "vand"), ("or", "vor")
_LESSER, _GREATER = ("min", "vmin"), ("max", "vmax")

LOOKED_THROUGH = {*_NEGATED, *_ALL, *_ANY, *_LESSER, *_GREATER} | {
    *("not", "ceil", "flor", "cos", "abs", "neg", "env")
}
"""Operators whose operands are of use here: others need not be remembered."""


def assume(state: State, condition: Value, holds: bool, deep: int = 0) -> None:
    """Narrow what is known in a branch. A condition holds where it is at least one half; NaN does
    not."""
    if deep > DEEPEST:
        return
    name, operands = condition.name, condition.operands
    if name == "not":
        assume(state, operands[0], not holds, deep + 1)
    elif (name in _ALL and holds) or (name in _ANY and not holds):
        for operand in operands:
            if not (name == "and" and operand.bounds.undefined):  # where NaN counts as true
                assume(state, operand, holds, deep + 1)
    elif name in _NEGATED:
        relation = name if holds else _NEGATED[name]
        left, right = operands
        bound(state, left, relation, right.bounds, holds, deep + 1)
        bound(state, right, _MIRRORED[relation], left.bounds, holds, deep + 1)
    elif name == "env":
        value, declared = operands
        state.narrow(value, declared.bounds if holds else Interval(0.0, 0.0))
    elif holds:
        bound(state, condition, "ge", Interval(0.5, 0.5), True, deep + 1)
    else:
        bound(state, condition, "lt", Interval(0.5, 0.5), False, deep + 1)


def bound(
    state: State, value: Value, relation: str, other: Interval, number: bool, deep: int
) -> None:
    """A relation of a value to another. number: neither is NaN; else it holds, or one is NaN."""
    if deep > DEEPEST or (other.undefined and not number):
        return
    known = _RELATIONS[relation](other)
    state.narrow(value, known, number)
    from_below = relation in ("gt", "ge")
    end = known.low if from_below else known.high
    if not math.isfinite(end):
        return
    match value.name, value.operands:
        case ("ceil" | "flor") as name, (x,):
            inner, whole = _STEPS[name, from_below](end)
            bound(state, x, inner, Interval(whole, whole), number, deep + 1)
        case "neg", (x,):
            bound(
                state, x, _MIRRORED[relation], Interval(-other.high, -other.low), number, deep + 1
            )
        case "cos", (x,) if from_below and other.low >= 0:
            # Elsewhere other periods are in reach.
            if -1.5 * math.pi < x.bounds.low and x.bounds.high < 1.5 * math.pi:
                widest = widest_above(other.low)
                state.narrow(x, Interval(-widest, widest), number)
        case "abs", (x,):
            size = value.bounds
            state.narrow(x, Interval(-size.high, size.high, gap=max(size.low, 0.0)), number)
        case name, operands if name in (_LESSER if from_below else _GREATER):
            # Of two values the nearer to the top is not NaN if the result is not; of more, the
            # deepest.
            if number or not value.bounds.undefined:
                sure = 1 if len(operands) == 2 else 0
                for index, operand in enumerate(operands):
                    bound(state, operand, relation, other, number and index == sure, deep + 1)


_STEPS: dict[tuple[str, bool], Callable[[float], tuple[str, float]]] = {
    ("ceil", True): lambda end: ("gt", math.ceil(end) - 1.0),
    ("ceil", False): lambda end: ("le", float(math.floor(end))),
    ("flor", True): lambda end: ("ge", float(math.ceil(end))),
    ("flor", False): lambda end: ("lt", math.floor(end) + 1.0),
}
"""What a bound from below (True) or above of a whole number says of the number it is from."""

_RELATIONS: dict[str, Callable[[Interval], Interval]] = {
    "lt": lambda other: Interval(-INF, below(other.high)),
    "le": lambda other: Interval(-INF, other.high),
    "gt": lambda other: Interval(above(other.low), INF),
    "ge": lambda other: Interval(other.low, INF),
}
