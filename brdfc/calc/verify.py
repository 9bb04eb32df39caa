"""What can be proven of a program before it runs.

Stack depth on every path, reads of temporaries and writes of outputs on every path, channels in
range, sub-elements present and of the right kind, nesting, and how much work a pixel can take. A
program that fails is refused with the index of the operation, counted as the file does.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import reduce
from operator import and_

from brdfc.calc.operators import Operand
from brdfc.calc.portability import portability
from brdfc.calc.program import (
    MAX_NESTING,
    MAX_TEMPORARIES,
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


@dataclass(frozen=True)
class Facts:
    """What verification found.

    stack: the greatest depth; temporaries: how many are in use; variables: signatures read, those
    of called calculators included. held: values a pixel keeps at once (stack, temporaries,
    channels), and work: values popped and pushed on the dearest path, both with everything that is
    called. nesting: how deep blocks and calls stand in each other.
    """

    stack: int
    temporaries: int
    variables: tuple[str, ...]
    held: int
    work: int
    nesting: int


@dataclass
class _State:
    """What holds on every path to a point: depth (least and greatest), work so far (greatest),
    and bit sets of the temporaries and outputs that have been written."""

    least: int = 0
    greatest: int = 0
    work: int = 0
    temporaries: int = 0
    outputs: int = 0


def _joined(paths: list[_State]) -> _State:
    return _State(
        min(path.least for path in paths),
        max(path.greatest for path in paths),
        max(path.work for path in paths),
        reduce(and_, (path.temporaries for path in paths)),
        reduce(and_, (path.outputs for path in paths)),
    )


@dataclass
class _Checker:
    program: Program
    where: str
    level: int
    """How many blocks and calls stand around the instruction being checked."""
    known: dict[int, Facts]
    """Sub-elements proven already, by identity: a shared one is proven once."""
    index: int = 0
    deepest: int = 0
    peak: int = 0
    temporaries: int = 0
    held_by_called: int = 0
    variables: set[str] = field(default_factory=set)

    def run(self) -> Facts:
        start = self.deepest = self.level
        state = _State()
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

    def block(self, block: Block, state: _State) -> None:
        for instruction in block:
            if isinstance(instruction, Op):
                self.op(instruction, state)
                self.index += 1
            else:
                self.branches(instruction, state)

    def branches(self, instruction: If | Select, state: _State) -> None:
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
        vars(state).update(vars(_joined(paths)))

    def op(self, op: Op, state: _State) -> None:
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

    def span(self, op: Op, state: _State) -> None:
        bits = ((1 << op.second) - 1) << op.first
        end = op.first + op.second
        channels = {"in": self.program.inputs, "out": self.program.outputs}
        limit = channels.get(op.name, MAX_TEMPORARIES)
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

    def take(self, state: _State, popped: int, pushed: int, name: str) -> None:
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
        """The work a call takes; a calculator is proven first."""
        if isinstance(element, LookupTable):  # the corners of a cell, each with its weight
            return (element.inputs + element.outputs) << element.inputs
        if not isinstance(element, Program):
            return element.inputs * element.outputs
        self.enter(1)
        if id(element) not in self.known:
            where = f"{self.where}, sub-element {op.first}"
            self.known[id(element)] = _Checker(element, where, self.level + 1, self.known).run()
        facts = self.known[id(element)]
        self.enter(1 + facts.nesting)
        self.held_by_called = max(self.held_by_called, facts.held)
        self.variables.update(facts.variables)
        return facts.work


def _lowest(bits: int) -> int:
    return (bits & -bits).bit_length() - 1


def verify(program: Program, where: str = "calculator") -> Facts:
    """Prove a program safe to run, or raise ProgramError with the index of the operation."""
    return _Checker(program, where, level=0, known={}).run()
