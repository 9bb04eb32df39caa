"""What can be proven of an element before it runs.

Of a program: stack depth on every path, reads of temporaries and writes of outputs on every path,
channels in range, sub-elements present and of the right kind, nesting, and how much work a pixel
can take. A program that fails is refused with the index of the operation, counted as the file does.
Curves that are sampled from programs are as safe as those; other elements always are.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from brdfc.calc.curves import CurveSet, calculator_curves
from brdfc.calc.facts import Facts, State, joined
from brdfc.calc.operators import Operand
from brdfc.calc.portability import portability
from brdfc.calc.program import (
    MAX_NESTING,
    Block,
    Element,
    If,
    Op,
    Program,
    Select,
    heads,
)
from brdfc.calc.tables import LookupTable
from brdfc.source.errors import ProgramError

__all__ = ["Facts", "portability", "verify"]

STACK_LIMIT = 65535
WORK_LIMIT = 10_000_000
"""Values popped and pushed for one pixel. A shared sub-element that calls a shared one, and so on,
lets a file of a few hundred bytes stand for more work than there is time."""

_KIND_OF_ELEMENT = {
    "curv": ("cvst",),
    "mtx": ("matf",),
    "clut": ("clut", "xclt"),
    "tint": ("tint",),
    "tJab": ("XtoJ",),
    "fJab": ("JtoX",),
    "calc": ("calc",),
}


@dataclass
class _Checker:
    program: Program
    where: str
    level: int
    """How many blocks and calls stand around the instruction being checked."""
    known: dict[int, Facts]
    """Programs proven already, by identity: a shared one is proven once."""
    index: int = 0
    deepest: int = 0
    peak: int = 0
    temporaries: int = 0
    held_by_called: int = 0
    variables: set[str] = field(default_factory=set)

    def run(self) -> Facts:
        start = self.deepest = self.level
        state = State()
        self.block(self.program.body, state)
        missing = ((1 << self.program.outputs) - 1) & ~state.outputs
        if missing:
            raise ProgramError(
                f"output {_lowest(missing)} is not written on every path", where=self.where
            )
        channels = self.program.inputs + self.program.outputs
        return Facts(
            self.peak,
            self.temporaries,
            tuple(sorted(self.variables)),
            self.peak + self.temporaries + channels + self.held_by_called,
            state.work,
            self.deepest - start,
        )

    def fail(self, message: str) -> ProgramError:
        return ProgramError(message, where=f"{self.where}, op {self.index}")

    def enter(self, levels: int) -> None:
        """Blocks or calls that stand inside the present level."""
        self.deepest = max(self.deepest, self.level + levels)
        if self.deepest > MAX_NESTING:
            raise self.fail(f"blocks and calculators nest deeper than {MAX_NESTING}")

    def block(self, block: Block, state: State) -> None:
        for instruction in block:
            if isinstance(instruction, Op):
                self.op(instruction, state)
                self.index += 1
            else:
                self.branches(instruction, state)

    def branches(self, instruction: If | Select, state: State) -> None:
        self.take(state, 1, 0, "if" if isinstance(instruction, If) else "sel")
        self.enter(1)
        bodies = instruction.bodies
        self.index += heads(instruction)
        self.level += 1
        # Where there is no `else` or `dflt`, none of the bodies may run.
        paths = [replace(state) for _ in bodies] + ([] if instruction.complete else [state])
        for body, path in zip(bodies, paths, strict=False):
            self.block(body, path)
        self.level -= 1
        vars(state).update(vars(joined(paths)))

    def op(self, op: Op, state: State) -> None:
        operator = op.operator
        if operator.operand is Operand.ELEMENT:
            element = self.element(op)
            state.work += self.call(element, op)
            self.take(state, element.inputs, element.outputs, op.name)
            return
        assert operator.effect is not None
        if operator.operand is Operand.SPAN:
            self.span(op, state)
        elif operator.operand is Operand.SIGNATURE:
            self.variables.add(op.signature)
        elif op.name == "solv" and (op.first == 1 or op.second == 1):
            raise self.fail("'solv' of one row or column is undefined in the reference engine")
        elif op.name == "scnt" and state.least != state.greatest:
            raise self.fail("'scnt' where the paths leave different depths has no one result")
        popped, pushed = operator.effect(op.first, op.second)
        self.take(state, popped, pushed, op.name)

    def span(self, op: Op, state: State) -> None:
        bits = ((1 << op.second) - 1) << op.first
        end = op.first + op.second
        limit = {"in": self.program.inputs, "out": self.program.outputs}.get(op.name, 65536)
        if end > limit:
            what = "temporary" if op.name.startswith("t") else "channel"
            raise self.fail(f"'{op.name}' reaches {what} {end - 1}; there are {limit}")
        if op.name == "out":
            state.outputs |= bits
        elif op.name in ("tput", "tsav"):
            state.temporaries |= bits
            self.temporaries = max(self.temporaries, end)
        elif op.name == "tget" and bits & ~state.temporaries:
            missing = _lowest(bits & ~state.temporaries)
            raise self.fail(f"temporary {missing} is read, and on some path nothing was written")

    def take(self, state: State, popped: int, pushed: int, name: str) -> None:
        if state.least < popped:
            raise self.fail(f"'{name}' needs {popped} values, {state.least} are on the stack")
        state.least += pushed - popped
        state.greatest += pushed - popped
        state.work += 1 + popped + pushed
        self.peak = max(self.peak, state.greatest)
        if self.peak > STACK_LIMIT:
            raise self.fail(f"the stack grows beyond {STACK_LIMIT} values")
        if state.work > WORK_LIMIT:
            raise self.fail(f"a pixel may take more than {WORK_LIMIT:,} steps up to here")

    def element(self, op: Op) -> Element:
        elements = self.program.elements
        if op.first >= len(elements):
            raise self.fail(f"'{op.name}' calls sub-element {op.first}; there are {len(elements)}")
        element = elements[op.first]
        kinds = _KIND_OF_ELEMENT.get(op.name)
        if kinds is not None and element.signature not in kinds:
            raise self.fail(
                f"'{op.name}' needs a '{kinds[0]}' element, sub-element {op.first} is a "
                f"'{element.signature}'"
            )
        return element

    def call(self, element: Element, op: Op) -> int:
        """The work a call takes; what it runs is proven first."""
        if not isinstance(element, Program) and not calculator_curves(element):
            return _work(element)
        self.enter(1)
        where = f"{self.where}, sub-element {op.first}"
        facts = _facts(element, where, self.level + 1, self.known)
        self.enter(1 + facts.nesting)
        self.held_by_called = max(self.held_by_called, facts.held)
        self.variables.update(facts.variables)
        return facts.work


def _facts(element: Element, where: str, level: int, known: dict[int, Facts]) -> Facts:
    """What is proven of an element that stands in so many blocks and calls."""
    if isinstance(element, Program):
        if id(element) not in known:
            known[id(element)] = _Checker(element, where, level, known).run()
        return known[id(element)]
    held, work, nesting = element.inputs + element.outputs, _work(element), 0
    variables: set[str] = set()
    for index, curve in calculator_curves(element).items():
        facts = _facts(curve.calculator, f"{where}, curve {index}", level + 1, known)
        held, nesting = max(held, facts.held), max(nesting, 1 + facts.nesting)
        variables.update(facts.variables)
        work += curve.size * facts.work
        if work > WORK_LIMIT:
            raise ProgramError(
                f"the curve is sampled {curve.size:,} times, and a sample may take {facts.work:,} "
                f"steps; {WORK_LIMIT:,} is the limit",
                where=f"{where}, curve {index}",
            )
    return Facts(0, 0, tuple(sorted(variables)), held, work, nesting)


def _work(element: Element) -> int:
    """Of an element that runs no program, or of a curve set without its programs."""
    if isinstance(element, LookupTable):  # the corners of a cell, each with its weight
        return (element.inputs + element.outputs) << element.inputs
    return element.inputs if isinstance(element, CurveSet) else element.inputs * element.outputs


def _lowest(bits: int) -> int:
    return (bits & -bits).bit_length() - 1


def verify(element: Element, where: str = "calculator") -> Facts:
    """Prove an element safe to run, or raise ProgramError with the index of the operation."""
    return _facts(element, where, level=0, known={})
