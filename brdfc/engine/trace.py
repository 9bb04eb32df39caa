"""A chain of elements followed once: what a run leaves to do for each pixel, as operations.

What does not depend on the pixel is computed there and then, branches on it are taken, and the rest
is written down. Where pixels may disagree about a condition both sides are followed and the right
one is chosen; nothing an operator does can fail, so that changes no value. Operations are those of
kernels.py, so that whatever carries them out knows nothing of stacks, branches or channels.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from brdfc.calc.appearance import AppearanceTransform
from brdfc.calc.curves import Curve, CurveSet
from brdfc.calc.operators import Operand
from brdfc.calc.program import Block, Element, If, Matrix, Op, Program, Select
from brdfc.calc.tables import LookupTable
from brdfc.calc.tints import TintArray
from brdfc.calc.verify import verify
from brdfc.engine.elements import Setting, apply_element, changes_nothing
from brdfc.engine.interpreter import calculate
from brdfc.engine.kernels import (
    BINARY,
    CONSTANTS,
    FOLDED,
    GROUPED,
    SCALED,
    UNARY,
    Values,
    compute,
    holds,
)
from brdfc.engine.linear import apply_matrix, solve
from brdfc.engine.moves import move, rearrange
from brdfc.engine.tables import Interpolation
from brdfc.engine.written import ELEMENT, Operation, Source, Value, identity

MOST_STEPS, MOST_FOLLOWED = 20_000, 1_000_000
"""A chain that comes to more is left to the interpreter: with both sides of every branch, nested
conditions double the work each. Instructions and values that are moved are followed, and are no
steps."""


class Crooked(Exception):
    """A chain that cannot be written down so: too many steps, a curve that is another for another
    pixel, or an element that is only carried."""


@dataclass(frozen=True)
class Route:
    """From the values of one element to the channels of another.

    sources: for each channel the index of the value, or None where it takes its default.
    """

    sources: tuple[int | None, ...]
    defaults: tuple[float, ...]


Chain = tuple[Element | Route, ...]


@dataclass
class Trace:
    """What has been written down: made, every operation in order, and the inputs that are read.

    inputs: channels of a pixel. differing: variables that differ between pixels, by signature; they
    are inputs too, after the channels.
    """

    channels: int
    environment: Mapping[str, Values]
    interpolation: Interpolation
    made: list[Operation] = field(default_factory=list)
    inputs: list[Source] = field(default_factory=list)
    differing: dict[str, Source] = field(default_factory=dict)
    known: dict[tuple[object, ...], Operation] = field(default_factory=dict)
    followed: int = 0

    def __post_init__(self) -> None:
        self.inputs = [Source(i) for i in range(self.channels)]

    def follow(self, chain: Chain) -> list[Value]:
        """The outputs of a chain of verified elements; Crooked where it cannot be written down."""
        values: list[Value] = list(self.inputs)
        with np.errstate(all="ignore"):
            for step in chain:
                if isinstance(step, Route):
                    values = [
                        np.float32(default) if source is None else values[source]
                        for source, default in zip(step.sources, step.defaults, strict=True)
                    ]
                else:
                    values = self.element(step, values)
        return values

    def element(self, element: Element, values: Sequence[Value]) -> list[Value]:
        if isinstance(element, Program):
            run = _Run(self, element, values)
            run.block(element.body)
            return [run.outputs[channel] for channel in range(element.outputs)]
        if isinstance(element, Matrix):
            return apply_matrix(element, values, self.apply)
        if isinstance(element, CurveSet):
            return [self.curve(c, x) for c, x in zip(element.curves, values, strict=True)]
        if isinstance(element, LookupTable | TintArray | AppearanceTransform):
            return self.call(element, element, values)
        if changes_nothing(element):
            return list(values)
        raise Crooked

    def curve(self, curve: Curve, value: Value) -> Value:
        """A curve that no variable makes another one for another pixel."""
        element = CurveSet((curve,))
        read = verify(element).variables
        if any(name in self.environment and self.environment[name].ndim for name in read):
            raise Crooked
        (result,) = self.call(curve, element, [value])
        return result

    def call(self, key: object, element: Element, values: Sequence[Value]) -> list[Value]:
        """An element that is no program, or its results where they are the same for all pixels.
        key: what the element is known by, and lives as long as the chain."""
        self.follow_more(10 * len(values))
        same = {name: v for name, v in self.environment.items() if not v.ndim}
        setting = Setting(same, BINARY, self.interpolation)

        def function(channels: Sequence[Values]) -> list[Values]:
            return apply_element(element, channels, setting, calculate)

        if not any(isinstance(v, Source) for v in values):
            return [np.float32(v) for v in function([np.asarray(v, np.float32) for v in values])]
        arguments = (ELEMENT, id(key), *map(identity, values))
        results = tuple(Source() for _ in range(element.outputs))
        return [*self.made_once(arguments, Operation(ELEMENT, tuple(values), results, function))]

    def apply(self, name: str, *arguments: Value) -> Value:
        """An operation, or its result where it is the same for all pixels."""
        self.follow_more(10)
        if not any(isinstance(a, Source) for a in arguments):
            return np.float32(compute(name, *(np.asarray(a, np.float32) for a in arguments)))
        if name == "mul" and any(a == 1 for a in arguments if not isinstance(a, Source)):
            return next(a for a in arguments if isinstance(a, Source))
        key = (name, *map(identity, arguments))
        (result,) = self.made_once(key, Operation(name, arguments, (Source(),)))
        return result

    def made_once(self, key: tuple[object, ...], operation: Operation) -> tuple[Source, ...]:
        """The results of an operation, which is written down where it is not known."""
        if key not in self.known:
            if len(self.made) >= MOST_STEPS:
                raise Crooked
            self.known[key] = operation
            self.made.append(operation)
        return self.known[key].results

    def follow_more(self, count: int) -> None:
        """Count what is followed; Crooked where it is too much."""
        self.followed += count
        if self.followed > MOST_FOLLOWED:
            raise Crooked

    def variable(self, signature: str) -> list[Value]:
        """A variable's value, and whether it is defined."""
        if signature in ("true", "ndef"):
            truth = np.float32(signature == "true")
            return [truth, truth]
        value = self.environment.get(signature)
        if value is None:
            return [np.float32(0), np.float32(0)]
        if value.ndim == 0:
            return [np.float32(value), np.float32(1)]
        if signature not in self.differing:
            place = self.channels + len(self.differing)
            self.differing[signature] = Source(place)
        return [self.differing[signature], np.float32(1)]


@dataclass
class _Run:
    """The state while a program is followed, as in the interpreter."""

    trace: Trace
    program: Program
    inputs: Sequence[Value]
    stack: list[Value] = field(default_factory=list)
    temporaries: dict[int, Value] = field(default_factory=dict)
    outputs: dict[int, Value] = field(default_factory=dict)

    def block(self, block: Block) -> None:
        for instruction in block:
            self.trace.follow_more(10)
            if isinstance(instruction, Op):
                self.operation(instruction)
            else:
                self.branches(instruction)

    def pop(self, count: int) -> list[Value]:
        taken = self.stack[len(self.stack) - count :]
        del self.stack[len(self.stack) - count :]
        return taken

    def operation(self, op: Op) -> None:
        name, n, stack, apply = op.name, op.first, self.stack, self.trace.apply
        if name in UNARY:
            stack += [apply(name, x) for x in self.pop(n)]
        elif name in BINARY:
            values = self.pop(2 * n)
            stack += [apply(name, x, y) for x, y in zip(values[:n], values[n:], strict=True)]
        elif name in SCALED:
            *several, scalar = self.pop(n + 1)
            stack += [apply(SCALED[name], x, scalar) for x in several]
        elif name in FOLDED:
            stack.append(apply(name, *self.pop(n)))
        elif name in GROUPED:
            blocks, function = GROUPED[name]
            values = self.pop(blocks * n)
            results = [function(apply, *values[i::n]) for i in range(n)]
            stack += [result[block] for block in range(blocks) for result in results]
        elif name == "solv":
            right = self.pop(n)
            stack += solve(self.pop(n * op.second), right, n, apply)
        elif op.operator.operand is Operand.SPAN:
            move(op, self)
        elif op.operator.operand is Operand.ELEMENT:
            element = self.program.elements[n]
            stack += self.trace.element(element, self.pop(element.inputs))
        elif name == "env":
            stack += self.trace.variable(op.signature)
        elif name == "data" or name in CONSTANTS:
            stack.append(np.float32(CONSTANTS.get(name, op.value)))
        elif name == "scnt":
            stack.append(np.float32(len(stack)))
        else:
            rearrange(op, self)

    def branches(self, instruction: If | Select) -> None:
        (condition,) = self.pop(1)
        blocks = instruction.bodies if instruction.complete else (*instruction.bodies, ())
        apply, last = self.trace.apply, len(blocks) - 1
        # Of every body but the last, whether it is taken.
        taken = [condition]
        if isinstance(instruction, Select):
            number = apply("rond", condition)
            taken = [apply("eq", number, np.float32(k)) for k in range(last)]
        self.cases(taken, blocks)

    def cases(self, taken: Sequence[Value], blocks: Sequence[Block]) -> None:
        """The first block whose condition holds, or the last, with one condition fewer.

        Blocks that some pixels may take are followed one after the other, each from here, and
        joined from the last one back.
        """
        ends = []
        last = blocks[-1]
        for condition, block in zip(taken, blocks, strict=False):
            if not isinstance(condition, Source):
                if not holds(np.asarray(condition)):
                    continue
                last = block
                break
            before = self.state()
            self.block(block)
            ends.append((condition, self.state()))
            self.stack, self.temporaries, self.outputs = before
        self.block(last)
        for condition, (stack, temporaries, outputs) in reversed(ends):
            depth = min(len(stack), len(self.stack))  # as the interpreter joins them
            self.trace.follow_more(depth)
            tops = (values[len(values) - depth :] for values in (stack, self.stack))
            self.stack = [self.chosen(condition, a, b) for a, b in zip(*tops, strict=True)]
            self.temporaries = self.joined(condition, temporaries, self.temporaries)
            self.outputs = self.joined(condition, outputs, self.outputs)

    def state(self) -> tuple[list[Value], dict[int, Value], dict[int, Value]]:
        """A copy of the state."""
        self.trace.follow_more(len(self.stack) + len(self.temporaries) + len(self.outputs))
        return list(self.stack), dict(self.temporaries), dict(self.outputs)

    def joined(
        self, condition: Value, taken: dict[int, Value], otherwise: dict[int, Value]
    ) -> dict[int, Value]:
        common = sorted(taken.keys() & otherwise.keys())
        return {k: self.chosen(condition, taken[k], otherwise[k]) for k in common}

    def chosen(self, condition: Value, a: Value, b: Value) -> Value:
        return a if identity(a) == identity(b) else self.trace.apply("choose", condition, a, b)
