"""Operators that only move values on the stack, whatever the values are."""

from __future__ import annotations

from typing import TypeVar

from brdfc.calc.program import Op

Item = TypeVar("Item")


def rearranged(op: Op, values: list[Item]) -> list[Item]:
    """What an operator leaves of the values it pops, deepest first."""
    first, second = op.first, op.second
    match op.name:
        case "copy":
            return values * (second + 1)
        case "rotl" | "rotr":
            places = (second if op.name == "rotl" else -second) % first
            return values[places:] + values[:places]
        case "posd":
            return values + values[:1] * second
        case "flip":
            return values[::-1]
        case "tran":
            return [values[r * second + c] for c in range(second) for r in range(first)]
        case "pop":
            return []
        case _:
            assert op.name == "noop", op.name
            return values
