"""A program followed with an interval for every value, to see where releases may disagree.

Both branches of a condition are followed unless it is certain, each with what the condition says
there, and joined. Called calculators are followed with what they are given; of other elements it is
known what a table or a sampled curve can give. After MOST_FOLLOWED values nothing more is known, so
that time is in proportion to a program's length, however often it calls itself the same.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import repeat

from brdfc.calc.bounds import (
    BINARY,
    CONSTANTS,
    DEFINED,
    FOLDED,
    SCALED,
    UNARY,
    UNKNOWN,
    either,
    exactly,
    never,
    surely,
)
from brdfc.calc.conditions import LOOKED_THROUGH, assume
from brdfc.calc.curves import CurveSet, SampledCurve, calculator_curves
from brdfc.calc.disagreements import BY_OPERATOR
from brdfc.calc.moves import rearranged
from brdfc.calc.operators import Operand
from brdfc.calc.paths import NOTHING_KNOWN, Effort, State, Value
from brdfc.calc.program import Block, Element, If, Op, Program, Select, encoded_length, heads
from brdfc.calc.reach import reach
from brdfc.calc.tables import LookupTable
from brdfc.symbolic.bounds import TRUTH
from brdfc.symbolic.intervals import Interval

MOST_FOLLOWED = 1 << 18
"""Values, popped and pushed: those of the longest program that is not made of wide vectors."""
AGAIN = 8
"""What a value counts of a program that is followed again: a few hundred bytes may call each other
any number of times."""
OUTPUTS = 1 << 16
"""Output channels are kept as temporaries, behind those that a program can have."""


class Follower:
    """Findings by the identity of programs, then by the index of the operation."""

    def __init__(self, variables: Mapping[str, Interval]) -> None:
        self.findings: dict[int, dict[int, str]] = {}
        self.effort = Effort(MOST_FOLLOWED)
        self._declared = variables
        self._variables: dict[str, list[Value]] = {}
        self._exhausted: set[int] = set()
        self._followed: set[int] = set()
        self._ranges: dict[int, list[Interval]] = {}

    def follow(self, program: Program, inputs: Sequence[Interval] | None) -> list[Interval]:
        """The intervals of a program's outputs."""
        if self.effort.left <= 0:  # of one that is followed again, nothing new will be found
            if id(program) in self._exhausted:
                return [UNKNOWN] * program.outputs
            self._exhausted.add(id(program))
        given = inputs if inputs is not None else [UNKNOWN] * program.inputs
        run = _Run(self, program, [Value(interval) for interval in given])
        before = self.effort.each
        if id(program) in self._followed:
            self.effort.each = AGAIN
        self._followed.add(id(program))
        run.block(program.body)
        self.effort.each = before
        return [value.bounds for value in run.state.get(OUTPUTS, program.outputs)]

    def variable(self, signature: str) -> list[Value]:
        """Its value, and whether it is defined; it is 0 where it is not."""
        if signature not in self._variables:
            always = DEFINED.get(signature)
            declared = Value(self._declared.get(signature, UNKNOWN))
            value = Value(either(declared.bounds, exactly(0.0)))
            defined = Value(TRUTH, "env", (value, declared))
            if always is not None:
                value = defined = Value(exactly(always))
            self._variables[signature] = [value, defined]
        return self._variables[signature]

    def element(self, element: Element, operands: Sequence[Value]) -> list[Value]:
        """What a called element gives."""
        if isinstance(element, Program):
            found = self.follow(element, [value.bounds for value in operands])
            return [Value(interval) for interval in found]
        return [Value(interval) for interval in self.reach(element)]

    def reach(self, element: Element) -> list[Interval]:
        """What an element that is no calculator can give."""
        if id(element) not in self._ranges:
            for curve in calculator_curves(element).values():
                self.follow(curve.calculator, [Interval(curve.first, curve.last)])
            self._ranges[id(element)] = reach(element)
        return self._ranges[id(element)]


Way = tuple[Block, bool, Callable[[], None]]
"""A body, whether it may run, and what it narrows when it does."""


class _Run:
    """One call of a program."""

    def __init__(self, follower: Follower, program: Program, inputs: list[Value]) -> None:
        self.follower = follower
        self.program = program
        self.inputs = inputs
        self.state = State(follower.effort)
        self.index = 0

    def block(self, block: Block) -> None:
        for instruction in block:
            if isinstance(instruction, Op):
                self.op(instruction)
                self.index += 1
            else:
                self.branches(instruction)

    def branches(self, instruction: If | Select) -> None:
        self.follower.effort.spend(1 + len(instruction.bodies))
        (condition,) = self.state.pop(1)
        if isinstance(instruction, If):
            ways = self.two_ways(instruction, condition)
        else:
            self.compare("sel", [(condition.bounds,)])
            ways = self.cases(instruction, condition)
        self.index += heads(instruction)
        paths = []
        for body, possible, narrow in ways:
            if not possible:
                self.index += encoded_length(body)
                continue
            self.state.enter()
            narrow()
            self.block(body)
            paths.append(self.state.leave())
        self.state.join(paths)

    def two_ways(self, instruction: If, condition: Value) -> list[Way]:
        bounds = condition.bounds
        holds = partial(assume, self.state, condition, True)
        fails = partial(assume, self.state, condition, False)
        return [
            (instruction.then, not never(bounds), holds),
            (instruction.otherwise or (), not surely(bounds), fails),
        ]

    def cases(self, instruction: Select, selector: Value) -> list[Way]:
        """Case k is taken by what rounds to k, and the first by NaN in newer releases."""
        bounds, count = selector.bounds, len(instruction.cases)
        ways: list[Way] = []
        for k, body in enumerate(instruction.cases):
            possible = bounds.low <= k + 0.5 and bounds.high >= k - 0.5
            narrow = partial(self.state.narrow, selector, Interval(k - 0.5, k + 0.5))
            ways.append((body, possible or bounds.undefined, narrow))
        inside = bounds.low > -0.5 and bounds.high < count - 0.5 and not bounds.undefined
        return [*ways, (instruction.default or (), not inside, lambda: None)]

    def op(self, op: Op) -> None:
        state, operator = self.state, op.operator
        if operator.operand is Operand.ELEMENT:
            element = self.program.elements[op.first]
            self.follower.effort.spend(1 + element.inputs + element.outputs)
            operands = state.pop(element.inputs)
            if isinstance(element, LookupTable):
                self.compare("clut", ((value.bounds,) for value in operands))
            elif isinstance(element, CurveSet):
                pairs = zip(operands, element.curves, strict=True)
                sampled = ((v.bounds,) for v, curve in pairs if isinstance(curve, SampledCurve))
                self.compare("curv", sampled)
            state.push(self.follower.element(element, operands))
            return
        assert operator.effect is not None
        popped, pushed = operator.effect(op.first, op.second)
        self.follower.effort.spend(1 + popped + pushed)
        operands = state.pop(popped)
        if op.name in BY_OPERATOR:
            self.compare(op.name, _components(op, operands))
        if not state.forgotten:
            state.push(self.results(op, operands, pushed))

    def results(self, op: Op, operands: list[Value], pushed: int) -> list[Value]:
        name = op.name
        if name in FOLDED:
            return [_made(name, FOLDED[name]([v.bounds for v in operands]), operands)]
        if name in UNARY or name in BINARY or name in SCALED:
            kernel = SCALED.get(name, name)
            rule = UNARY.get(kernel) or BINARY[kernel]
            return [
                _made(kernel, rule(*(value.bounds for value in component)), component)
                for component in _grouped(op, operands)
            ]
        if op.operator.operand is Operand.SPAN:
            return self.span(op, operands)
        if name == "data" or name in CONSTANTS:
            return [Value(exactly(CONSTANTS.get(name, op.value)))]
        if name == "env":
            return self.follower.variable(op.signature)
        if name == "scnt":
            return [Value(Interval(0.0, 65535.0))]
        if name == "solv":
            return [NOTHING_KNOWN] * (pushed - 1) + [Value(TRUTH)]
        if name in ("ctop", "ptoc", "tLab", "tXYZ"):
            return [NOTHING_KNOWN] * pushed
        return rearranged(op, operands)

    def span(self, op: Op, operands: list[Value]) -> list[Value]:
        """Channels and temporaries."""
        if op.name == "in":
            return self.inputs[op.first : op.first + op.second]
        if op.name == "tget":
            return self.state.get(op.first, op.second)
        self.state.put(op.first + (OUTPUTS if op.name == "out" else 0), operands)
        return operands if op.name == "tsav" else []

    def compare(self, name: str, components: Iterable[Sequence[Interval]]) -> None:
        """Note the first row of the table that applies to a component."""
        for component in components:
            for row in BY_OPERATOR[name]:
                if row.applies(*component):
                    found = self.follower.findings.setdefault(id(self.program), {})
                    found.setdefault(self.index, row.finding(name, component))
                    return


def _made(name: str, bounds: Interval, operands: Sequence[Value]) -> Value:
    return Value(bounds, name, operands) if name in LOOKED_THROUGH else Value(bounds)


def _grouped(op: Op, operands: list[Value]) -> Iterator[tuple[Value, ...]]:
    """The operands of each component of a vector's operator."""
    n = op.first
    if op.name in SCALED:
        return zip(operands[:n], repeat(operands[n]))
    if op.name in BINARY:
        return zip(operands[:n], operands[n:], strict=True)
    return zip(operands)


def _components(op: Op, operands: list[Value]) -> Iterator[tuple[Interval, ...]]:
    if op.name == "solv":
        matrix = operands[:9] if (op.first, op.second) == (3, 3) else []
        return iter([tuple(value.bounds for value in matrix)])
    return (tuple(value.bounds for value in component) for component in _grouped(op, operands))
