"""Programs without jumps: what a run leaves to do for each pixel, as a list of array operations.

A program is followed once with the variables of a run. What does not depend on the pixel is
computed there and then, branches on it are taken, and the rest becomes steps on registers: planar
blocks of pixels that stay in the processor's cache, reused as soon as nothing reads them any more.
Where pixels may disagree about a condition both sides are computed and the right one is selected;
nothing an operator does can fail, so that changes no value.

The steps use the interpreter's own kernels, so that every result is the same to the last bit.
Programs with what has no straight form (see Crooked) are left to the interpreter.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from brdfc.calc.operators import Operand
from brdfc.calc.program import Block, If, Op, Program, Select
from brdfc.engine.kernels import BINARY, CONSTANTS, FOLDED, GROUPED, SCALED, UNARY, Values, holds
from brdfc.engine.moves import move, rearrange

MOST_STEPS = 20_000
"""A program that comes to more is left to the interpreter: with both sides of every branch, nested
conditions double the work each."""


class Crooked(Exception):
    """A program that has no straight form."""


@dataclass(frozen=True, eq=False)
class Source:
    """A value of each pixel: an input by its place, or what an operation gives."""

    name: str
    arguments: tuple[Source | np.float32, ...] = ()
    place: int = 0


Value = Source | np.float32


@dataclass(frozen=True)
class Step:
    """An operation on registers: constants stand as they are."""

    name: str
    arguments: tuple[int | np.float32, ...]
    target: int


@dataclass(frozen=True)
class Straight:
    """steps: on registers, of which the first ones are the inputs, then the variables that differ
    between pixels, by name. outputs: registers, or constants. registers: how many there are."""

    steps: tuple[Step, ...]
    variables: tuple[str, ...]
    outputs: tuple[int | np.float32, ...]
    registers: int


def straighten(program: Program, environment: Mapping[str, Values]) -> Straight:
    """The straight form of a verified program in a run; Crooked where it has none."""
    trace = _Trace(program, environment)
    with np.errstate(all="ignore"):
        trace.block(program.body)
    outputs = [trace.outputs[channel] for channel in range(program.outputs)]
    return _allocated(trace, outputs)


@dataclass
class _Trace:
    """The state while a program is followed, as in the interpreter; made: every step, in order."""

    program: Program
    environment: Mapping[str, Values]
    stack: list[Value] = field(default_factory=list)
    temporaries: dict[int, Value] = field(default_factory=dict)
    outputs: dict[int, Value] = field(default_factory=dict)
    made: list[Source] = field(default_factory=list)
    known: dict[tuple[object, ...], Source] = field(default_factory=dict)
    inputs: list[Source] = field(default_factory=list)
    differing: dict[str, Source] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.inputs = [Source("in", (), i) for i in range(self.program.inputs)]

    def block(self, block: Block) -> None:
        for instruction in block:
            if isinstance(instruction, Op):
                self.operation(instruction)
            elif isinstance(instruction, If):
                self.branch(instruction)
            else:
                self.cases(instruction)

    def pop(self, count: int) -> list[Value]:
        taken = self.stack[len(self.stack) - count :]
        del self.stack[len(self.stack) - count :]
        return taken

    def apply(self, name: str, *arguments: Value) -> Value:
        """A step, or its result where it is the same for all pixels."""
        if not any(isinstance(a, Source) for a in arguments):
            kernel = BINARY.get(name) or UNARY.get(name)
            if kernel is not None:
                return np.float32(kernel(*(np.asarray(a, np.float32) for a in arguments)))
            if name in FOLDED:
                return np.float32(FOLDED[name]([np.asarray(a, np.float32) for a in arguments]))
        # Constants by their bits: 0 and -0 are two.
        key = (name, *(a if isinstance(a, Source) else a.tobytes() for a in arguments))
        if key not in self.known:
            if len(self.made) >= MOST_STEPS:
                raise Crooked
            self.known[key] = Source(name, arguments)
            self.made.append(self.known[key])
        return self.known[key]

    def operation(self, op: Op) -> None:
        name, n, stack = op.name, op.first, self.stack
        if name in UNARY:
            stack += [self.apply(name, x) for x in self.pop(n)]
        elif name in BINARY:
            values = self.pop(2 * n)
            stack += [self.apply(name, x, y) for x, y in zip(values[:n], values[n:], strict=True)]
        elif name in SCALED:
            *several, scalar = self.pop(n + 1)
            stack += [self.apply(SCALED[name], x, scalar) for x in several]
        elif name in FOLDED:
            stack.append(self.apply(name, *self.pop(n)))
        elif op.operator.operand is Operand.SPAN:
            move(op, self)
        elif name == "env":
            stack += self.variable(op.signature)
        elif name == "data" or name in CONSTANTS:
            stack.append(np.float32(CONSTANTS.get(name, op.value)))
        elif name == "scnt":
            stack.append(np.float32(len(stack)))
        elif name in GROUPED or name == "solv" or op.operator.operand is Operand.ELEMENT:
            raise Crooked
        else:
            rearrange(op, self)

    def variable(self, signature: str) -> list[Value]:
        if signature in ("true", "ndef"):
            truth = np.float32(signature == "true")
            return [truth, truth]
        value = self.environment.get(signature)
        if value is None:
            return [np.float32(0), np.float32(0)]
        if value.ndim == 0:
            return [np.float32(value), np.float32(1)]
        if signature not in self.differing:
            place = self.program.inputs + len(self.differing)
            self.differing[signature] = Source("in", (), place)
        return [self.differing[signature], np.float32(1)]

    def branch(self, instruction: If) -> None:
        (condition,) = self.pop(1)
        blocks = instruction.bodies if instruction.complete else (*instruction.bodies, ())
        if not isinstance(condition, Source):
            self.block(blocks[0 if holds(np.asarray(condition)) else -1])
            return
        state = (list(self.stack), dict(self.temporaries), dict(self.outputs))
        self.block(blocks[0])
        taken = (self.stack, self.temporaries, self.outputs)
        self.stack, self.temporaries, self.outputs = state
        self.block(blocks[-1])
        depth = min(len(taken[0]), len(self.stack))  # as the interpreter joins them
        one, other = taken[0][len(taken[0]) - depth :], self.stack[len(self.stack) - depth :]
        self.stack = [self.chosen(condition, a, b) for a, b in zip(one, other, strict=True)]
        self.temporaries = self.joined(condition, taken[1], self.temporaries)
        self.outputs = self.joined(condition, taken[2], self.outputs)

    def cases(self, instruction: Select) -> None:
        raise Crooked

    def joined(
        self, condition: Value, taken: dict[int, Value], otherwise: dict[int, Value]
    ) -> dict[int, Value]:
        common = sorted(taken.keys() & otherwise.keys())
        return {k: self.chosen(condition, taken[k], otherwise[k]) for k in common}

    def chosen(self, condition: Value, a: Value, b: Value) -> Value:
        same = a is b if isinstance(a, Source) else _same(a, b)
        return a if same else self.apply("choose", condition, a, b)


def _same(a: Value, b: Value) -> bool:
    return not isinstance(a, Source) and not isinstance(b, Source) and a.tobytes() == b.tobytes()


def _allocated(trace: _Trace, outputs: Sequence[Value]) -> Straight:
    """Registers for what is needed, each free again after its last use."""
    needed: set[Source] = {o for o in outputs if isinstance(o, Source)}
    for source in reversed(trace.made):
        if source in needed:
            needed |= {a for a in source.arguments if isinstance(a, Source)}
    made = [s for s in trace.made if s in needed]
    last: dict[Source, int] = {}
    for i, source in enumerate(made):
        for argument in source.arguments:
            if isinstance(argument, Source):
                last[argument] = i
    last |= {o: len(made) for o in outputs if isinstance(o, Source)}
    inputs = [*trace.inputs, *trace.differing.values()]
    place = {source: source.place for source in inputs}
    count, free = len(inputs), [s.place for s in inputs if s not in last]
    steps = []
    for i, source in enumerate(made):
        arguments = [place[a] if isinstance(a, Source) else a for a in source.arguments]
        # A target of its own: kernels may read an argument after they have begun to write.
        if not free:
            free.append(count)
            count += 1
        place[source] = free.pop()
        steps.append(Step(source.name, tuple(arguments), place[source]))
        read = dict.fromkeys(a for a in source.arguments if isinstance(a, Source))
        free += [place[a] for a in read if last[a] == i]
    found = tuple(place[o] if isinstance(o, Source) else o for o in outputs)
    return Straight(tuple(steps), tuple(trace.differing), found, count)
