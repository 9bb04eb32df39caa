"""The reference interpreter: a verified program on arrays of pixels, one operator at a time.

It is meant to be read beside the operator table. The stack holds one array a value, so that every
operator runs on a whole block of pixels; where pixels disagree about a condition, each branch runs
on its own pixels and the stacks are joined again.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from brdfc.calc.operators import Operand
from brdfc.calc.program import Block, Element, If, Op, Program, Select
from brdfc.calc.verify import verify
from brdfc.engine.elements import Setting, apply_element
from brdfc.engine.kernels import (
    BINARY,
    CONSTANTS,
    FOLDED,
    GROUPED,
    IEEE,
    SCALED,
    UNARY,
    Values,
    compute,
    holds,
    selector,
)
from brdfc.engine.linear import solve
from brdfc.engine.moves import move, rearrange
from brdfc.engine.tables import Interpolation
from brdfc.source.errors import ProgramError

BLOCK = 32768
"""Pixels run at a time: their values stay in the processor's cache."""
HELD = 1 << 24
"""Float32 values held at a time, at most: a program that holds many gets fewer pixels at a time."""

_FIXED = {"true": 1.0, "ndef": 0.0}
"""Variables that are what they are whatever a run defines (ndef: undefined, always)."""


@dataclass
class _Machine:
    """The state of a set of pixels: channels, stack (top last), temporaries, outputs."""

    program: Program
    setting: Setting
    inputs: Sequence[Values]
    stack: list[Values] = field(default_factory=list)
    temporaries: dict[int, Values] = field(default_factory=dict)
    outputs: dict[int, Values] = field(default_factory=dict)

    def pop(self, count: int) -> list[Values]:
        taken = self.stack[len(self.stack) - count :]
        del self.stack[len(self.stack) - count :]
        return taken

    def select(self, chosen: NDArray[np.intp]) -> _Machine:
        """The same state for some of the pixels."""

        def part(values: Values) -> Values:
            return values[chosen] if values.ndim else values

        environment = {k: part(v) for k, v in self.setting.environment.items()}
        return _Machine(
            self.program,
            replace(self.setting, environment=environment),
            [part(v) for v in self.inputs],
            [part(v) for v in self.stack],
            {k: part(v) for k, v in self.temporaries.items()},
            {k: part(v) for k, v in self.outputs.items()},
        )


def run(
    element: Element,
    pixels: ArrayLike,
    environment: Mapping[str, ArrayLike],
    *,
    ieee: bool = False,
    interpolation: Interpolation = Interpolation.LINEAR,
) -> Values:
    """Apply an element, usually a calculator, to pixels.

    pixels: (..., inputs), taken as float32. environment: variables by signature (four letters,
    spaces at the end left out), a number each, or an array (...) of one for each pixel; `env` finds
    the others undefined. ieee: x/0 is an infinity or NaN,
    as on engines that leave it to the processor. interpolation: of tables of three inputs. Returns
    (..., outputs), float32.
    Raises ProgramError when a program cannot be proven safe or the channels do not fit.
    """
    step = max(1, min(BLOCK, HELD // max(1, verify(element).held)))
    array = np.asarray(pixels, dtype=np.float32)
    if array.ndim == 0 or array.shape[-1] != element.inputs:
        raise ProgramError(f"{element.inputs} channels are needed, the array is {array.shape}")
    flat = array.reshape(math.prod(array.shape[:-1]), element.inputs)
    variables = {name: variable(v, array.shape[:-1]) for name, v in environment.items()}
    result = np.empty((len(flat), element.outputs), dtype=np.float32)
    binary = IEEE if ieee else BINARY
    with np.errstate(all="ignore"):
        for start in range(0, len(flat), step):
            block = flat[start : start + step]
            channels = [np.ascontiguousarray(block[:, c]) for c in range(element.inputs)]
            here = {n: v[start : start + step] if v.ndim else v for n, v in variables.items()}
            outputs = _apply(element, channels, Setting(here, binary, interpolation))
            for channel, values in enumerate(outputs):
                result[start : start + step, channel] = values
    return result.reshape(*array.shape[:-1], element.outputs)


def variable(value: ArrayLike, shape: tuple[int, ...]) -> Values:
    """A number, or one for each pixel."""
    array = np.asarray(value, dtype=np.float32)
    return np.broadcast_to(array, shape).ravel() if array.ndim else array


def _apply(element: Element, inputs: Sequence[Values], setting: Setting) -> list[Values]:
    """Any element on a list of channels."""
    if isinstance(element, Program):
        return calculate(element, inputs, setting)
    return apply_element(element, inputs, setting, calculate)


def calculate(program: Program, inputs: Sequence[Values], setting: Setting) -> list[Values]:
    """A verified program on a list of channels."""
    machine = _Machine(program, setting, inputs)
    _run_block(program.body, machine)
    return [machine.outputs[channel] for channel in range(program.outputs)]


def _run_block(block: Block, machine: _Machine) -> None:
    for instruction in block:
        if isinstance(instruction, Op):
            _run_op(instruction, machine)
        else:
            _run_branches(instruction, machine)


def _run_branches(instruction: If | Select, machine: _Machine) -> None:
    (condition,) = machine.pop(1)
    blocks = instruction.bodies if instruction.complete else (*instruction.bodies, ())
    last = len(blocks) - 1
    if isinstance(instruction, If):
        taken = np.where(holds(condition), 0, last)
    else:
        number = selector(condition)
        taken = np.where((number >= 0) & (number < last), number, last)
    used = np.unique(taken)
    if len(used) == 1:
        _run_block(blocks[int(used[0])], machine)
        return
    parts = []
    for branch in used:
        chosen = np.flatnonzero(taken == branch)
        part = machine.select(chosen)
        _run_block(blocks[int(branch)], part)
        parts.append((chosen, part))
    _join(machine, parts, len(taken))


def _join(machine: _Machine, parts: list[tuple[NDArray[np.intp], _Machine]], pixels: int) -> None:
    """Put the branches' states together, stacks aligned at their tops.

    Branches need not leave the same depth. What verification proved to be read lies within the
    least of them, counted from the top; values deeper than that are never read.
    """
    depth = min(len(part.stack) for _, part in parts)

    def joined(values: list[Values]) -> Values:
        whole = np.empty(pixels, dtype=np.float32)
        for (chosen, _), value in zip(parts, values, strict=True):
            whole[chosen] = value
        return whole

    machine.stack = [
        joined([part.stack[len(part.stack) - depth + i] for _, part in parts]) for i in range(depth)
    ]
    for name in ("temporaries", "outputs"):
        states: list[dict[int, Values]] = [getattr(part, name) for _, part in parts]
        common = set.intersection(*(set(state) for state in states))
        # What only some paths wrote cannot be read again (verified), so it is dropped.
        setattr(machine, name, {k: joined([s[k] for s in states]) for k in sorted(common)})


def _run_op(op: Op, machine: _Machine) -> None:
    name, n, stack = op.name, op.first, machine.stack
    if name in UNARY:
        stack += [UNARY[name](x) for x in machine.pop(n)]
    elif name in BINARY:
        values = machine.pop(2 * n)
        kernel = machine.setting.binary[name]
        stack += [kernel(x, y) for x, y in zip(values[:n], values[n:], strict=True)]
    elif name in SCALED:
        *vector, scalar = machine.pop(n + 1)
        kernel = machine.setting.binary[SCALED[name]]
        stack += [kernel(x, scalar) for x in vector]
    elif name in FOLDED:
        stack.append(FOLDED[name](machine.pop(n)))
    elif name in GROUPED:
        blocks, function = GROUPED[name]
        values = machine.pop(blocks * n)
        results = [function(compute, *values[i::n]) for i in range(n)]
        stack += [result[block] for block in range(blocks) for result in results]
    elif op.operator.operand is Operand.SPAN:
        move(op, machine)
    elif op.operator.operand is Operand.ELEMENT:
        element = machine.program.elements[n]
        inputs = machine.pop(element.inputs)
        stack += _apply(element, inputs, machine.setting)
    elif name == "env":
        value = _FIXED.get(op.signature, machine.setting.environment.get(op.signature))
        defined = value is not None and op.signature != "ndef"
        stack += [np.asarray(v, np.float32) for v in (0.0 if value is None else value, defined)]
    elif name == "data" or name in CONSTANTS:
        stack.append(np.asarray(CONSTANTS.get(name, op.value), dtype=np.float32))
    else:
        _other(op, machine)


def _other(op: Op, machine: _Machine) -> None:
    """What needs the values, or the stack itself, and is no arithmetic."""
    stack = machine.stack
    if op.name == "solv":
        right = machine.pop(op.first)
        matrix = machine.pop(op.first * op.second)
        stack += [np.asarray(v) for v in solve(matrix, right, op.first, compute)]
    elif op.name == "scnt":
        stack.append(np.asarray(len(stack), dtype=np.float32))
    else:
        rearrange(op, machine)
