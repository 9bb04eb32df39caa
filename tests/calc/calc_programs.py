"""Random programs that verification accepts, for the tests of the calculator and its engine.

`programs()` is a hypothesis strategy; `random_program(seed)` gives one program a seed, the same on
every machine. Both draw through the same small interface, a function from a list to one of its
members, so there is one generator.
"""

import random
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from calc.random_elements import ELEMENTS, TAME, Choose, singles
from hypothesis import strategies as st

from brdfc.calc.operators import OPERATORS, Operand
from brdfc.calc.program import Block, If, Instruction, Matrix, Op, Program, Select

INPUTS, OUTPUTS, TEMPORARIES = 4, 3, 6
DEEPEST = 12

# Subnormals, the largest, both zeros, numbers that need nine digits, halves.
CONSTANTS = singles(
    *(0.0, -0.0, 1.0, -1.0, 0.5, -0.5, 1.5, 2.0, 3.0, 0.1, -0.7, 100.0, 1e-5, 0.333333343),
    *(1e-45, -1e-45, 1.17549421e-38, 3.40282347e38, -3.40282347e38, 16777217.0, 0.785398185),
    *(8388608.5, 2147483648.0, 123456.789, 1.00000012, 0.999999940, 6.10351562e-05),
)
VARIABLES = ("thti", "azi", "x", "ä", "a b", "12", "deadbeef"[:4], "true", "ndef", "")

MATRICES = (
    Matrix(3, 3, singles(0.5, 0.25, -1.0, 0.1, 0.0, 2.0, -0.75, 0.3, 1.0), singles(0, 0.125, -0.3)),
    Matrix(2, 1, singles(0.7, -0.2), singles(0.1)),
)
INNER = Program(
    2, 3, (Op("in", 0, 2), Op("copy", 2, 1), Op("mul", 1), Op("tsav", 0, 3), Op("out", 0, 3))
)
SHARED = (*MATRICES, INNER, INNER)
"""Elements that every program has; the others are drawn."""
CALLS = {"matf": "mtx", "cvst": "curv", "clut": "clut", "xclt": "clut", "calc": "calc"}
KINDS = ("matf", "cvst", "clut", "calc")
NESTING = 2
"""Levels of calculators in calculators."""

MOVES = ("copy", "rotl", "rotr", "posd", "flip", "pop", "tran")
EVERY = tuple(
    name
    for name, operator in OPERATORS.items()
    if operator.operand not in (Operand.SPAN, Operand.ELEMENT) and name not in MOVES
)


@dataclass
class _Generator:
    """Draws instructions while it knows how deep the stack is on every path.

    names: operators, drawn as often as they stand there. kinds: of the sub-elements that are drawn.
    depth: the least on any path; even: whether all paths have it. written: temporaries that all
    paths have written.
    """

    choose: Choose
    names: Sequence[str]
    kinds: Sequence[str]
    nesting: int = NESTING
    inputs: int = INPUTS
    depth: int = 0
    even: bool = True
    written: set[int] = field(default_factory=set)
    elements: tuple[Any, ...] = SHARED

    def number(self, low: int, high: int) -> int:
        return int(self.choose(range(low, high + 1)))

    def program(self, outputs: int, length: int) -> Program:
        kinds = self.kinds if self.nesting else [k for k in self.kinds if k != "calc"]
        if kinds:
            self.elements += tuple(
                self.element(self.choose(kinds)) for _ in range(self.number(0, 3))
            )
        body = list(self.block(length, 3))
        while self.depth < outputs:
            body.append(self.push())
        body.append(Op("out", 0, outputs))
        return Program(self.inputs, outputs, tuple(body), self.elements)

    def element(self, kind: str) -> Any:
        if kind != "calc":
            return ELEMENTS[kind](self.choose)
        inputs, outputs = self.number(1, 3), self.number(1, 3)
        inner = _Generator(self.choose, self.names, self.kinds, self.nesting - 1, inputs)
        return inner.program(outputs, 6)

    def block(self, length: int, levels: int) -> Block:
        """Up to so many steps: whether there is another is drawn before each, so that any of them
        can be left out of what fails."""
        found: list[Instruction] = []
        for _ in range(length):
            if not self.choose((False, *(True,) * length)):
                break
            found += self.step(levels)
        return tuple(found)

    def step(self, levels: int) -> Sequence[Instruction]:
        kinds = ["push", "push", "operator", "operator", "operator", "move", "temporary", "call"]
        if levels:
            kinds += ["if", "select"]
        kind = self.choose(kinds)
        if self.depth > DEEPEST:
            return [self.take("pop", self.number(1, self.depth), 0)]
        if kind == "push" or self.depth < 1:
            return [self.push()]
        if kind == "call":
            return self.call()
        if kind in ("if", "select"):
            return [getattr(self, f"_{kind}")(levels)]
        return [getattr(self, f"_{kind}")()]

    def take(self, name: str, first: int, second: int) -> Op:
        popped, pushed = OPERATORS[name].effect(first, second)
        assert popped <= self.depth
        self.depth += pushed - popped
        return Op(name, first, second)

    def push(self) -> Op:
        if self.choose((True, False)):
            start = self.number(0, self.inputs - 1)
            return self.take("in", start, self.number(1, self.inputs - start))
        return self.constant(self.choose(self.choose((TAME, TAME, TAME, CONSTANTS))))

    def constant(self, value: float) -> Op:
        self.depth += 1
        return Op("data", value=value)

    def _operator(self) -> Op:
        name = self.choose(self.names)
        operand, effect = OPERATORS[name].operand, OPERATORS[name].effect
        if operand is Operand.CONSTANT or (name == "scnt" and not self.even):
            return self.push()
        if operand is Operand.SIGNATURE:
            self.depth += 2
            return Op(name, signature=self.choose(VARIABLES))
        if operand is Operand.NONE:
            return self.take(name, 0, 0)
        if operand is Operand.SHAPE:
            return self.take(name, 3, 3) if effect(3, 3)[0] <= self.depth else self.push()
        counts = range(2 if operand is Operand.FOLD else 1, 6)
        fitting = [n for n in counts if effect(n, 0)[0] <= self.depth]
        return self.take(name, self.choose(fitting), 0) if fitting else self.push()

    def _move(self) -> Op:
        name = self.choose(MOVES)
        top = self.number(1, self.depth)
        if name in ("copy", "posd"):
            return self.take(name, top, self.number(1, 3))
        if name in ("rotl", "rotr"):
            return self.take(name, top, self.number(1, 9))
        if name == "tran":
            columns = self.number(1, self.depth // top)
            return self.take(name, top, columns)
        if name == "flip":
            return self.take(name, top, 0) if top > 1 else self.push()
        return self.take(name, top, 0)

    def _temporary(self) -> Op:
        start = self.number(0, TEMPORARIES - 1)
        count = self.number(1, min(TEMPORARIES - start, self.depth))
        name = self.choose(("tput", "tsav", "tget"))
        if name == "tget":
            if not self.written:
                return self.push()
            return self.take("tget", self.choose(sorted(self.written)), 1)
        self.written |= set(range(start, start + count))
        return self.take(name, start, count)

    def call(self) -> Sequence[Instruction]:
        """A call; inputs of a lookup table are clamped before, which not all releases do."""
        index = self.number(0, len(self.elements) - 1)
        element = self.elements[index]
        n = element.inputs
        if n > self.depth:
            return [self.push()]
        clamps: list[Instruction] = []
        if CALLS[element.signature] == "clut":
            for bound, name in ((0.0, "vmax"), (1.0, "vmin")):
                clamps += [Op("data", value=bound), Op("copy", 1, n - 1)][: min(n, 2)]
                clamps.append(Op(name, n))
        self.depth += element.outputs - n
        return [*clamps, Op(self.choose((CALLS[element.signature], "elem")), index)]

    def _bodies(self, count: int, levels: int, *, complete: bool) -> list[Block]:
        before, written = self.depth, self.written
        depths, sets, bodies = [], [], []
        for _ in range(count):
            self.depth, self.written = before, set(written)
            bodies.append(self.block(5, levels - 1))
            depths.append(self.depth)
            sets.append(self.written)
        if not complete:
            depths.append(before)
            sets.append(written)
        self.even &= len(set(depths)) == 1
        self.depth, self.written = min(depths), set.intersection(*sets)
        return bodies

    def _if(self, levels: int) -> If:
        self.depth -= 1
        otherwise = self.choose((True, False))
        bodies = self._bodies(1 + otherwise, levels, complete=otherwise)
        return If(bodies[0], bodies[1] if otherwise else None)

    def _select(self, levels: int) -> Select:
        self.depth -= 1
        cases, default = self.number(1, 4), self.choose((True, False))
        bodies = self._bodies(cases + default, levels, complete=default)
        return Select(tuple(bodies[:cases]), bodies[cases] if default else None)


@st.composite
def programs(
    draw: st.DrawFn, names: Sequence[str] = EVERY, kinds: Sequence[str] = KINDS, length: int = 20
) -> Program:
    """Programs of 4 channels in and 3 out, with sub-elements."""

    def choose(options: Sequence[Any]) -> Any:
        return options[draw(st.integers(0, len(options) - 1))]

    return _Generator(choose, names, kinds).program(OUTPUTS, length)


def random_program(
    seed: int, names: Sequence[str] = EVERY, kinds: Sequence[str] = KINDS, length: int = 30
) -> Program:
    """The program of a seed."""
    return _Generator(random.Random(seed).choice, names, kinds).program(OUTPUTS, length)
