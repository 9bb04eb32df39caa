"""Operators that only move values: channels, temporaries, and places on the stack.

What the values are does not matter: arrays of pixels, or what stands for them (trace.py).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from brdfc.calc.moves import rearranged
from brdfc.calc.program import Op


class State(Protocol):
    """What a program has at hand: its stack, top last."""

    stack: list[Any]
    temporaries: dict[int, Any]
    outputs: dict[int, Any]

    @property
    def inputs(self) -> Sequence[Any]: ...

    def pop(self, count: int) -> list[Any]: ...


def move(op: Op, state: State) -> None:
    """Channels and temporaries."""
    indices = range(op.first, op.first + op.second)
    if op.name == "in":
        state.stack += [state.inputs[i] for i in indices]
    elif op.name == "tget":
        state.stack += [state.temporaries[i] for i in indices]
    else:
        target = state.outputs if op.name == "out" else state.temporaries
        values = state.pop(op.second)
        target.update(zip(indices, values, strict=True))
        if op.name == "tsav":
            state.stack += values


def rearrange(op: Op, state: State) -> None:
    """Places on the stack."""
    assert op.operator.effect is not None
    popped, _ = op.operator.effect(op.first, op.second)
    state.stack += rearranged(op, state.pop(popped))
