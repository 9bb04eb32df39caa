"""Operators that only move values: channels, temporaries, and places on the stack.

What the values are does not matter: arrays of pixels, or what stands for them (trace.py).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

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
    name, first, second, stack = op.name, op.first, op.second, state.stack
    if name == "copy":
        stack += stack[len(stack) - first :] * second
    elif name in ("rotl", "rotr"):
        values = state.pop(first)
        places = (second if name == "rotl" else -second) % first
        stack += values[places:] + values[:places]
    elif name == "posd":
        stack += [stack[-first]] * second
    elif name == "flip":
        stack += reversed(state.pop(first))
    elif name == "pop":
        state.pop(first)
    elif name == "tran":
        values = state.pop(first * second)
        stack += [values[r * second + c] for c in range(second) for r in range(first)]
    else:
        assert name == "noop", name
