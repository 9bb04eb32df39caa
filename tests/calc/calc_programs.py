"""Random programs that verification accepts, for the tests of the calculator and its engine.

`programs()` is a hypothesis strategy; `random_program(seed)` gives one program a seed, the same on
every machine. Both draw through the same small interface, a function from a list to one of its
members, so there is one generator.
"""

import random
import struct
from collections.abc import Callable, Sequence
from typing import Any

from hypothesis import strategies as st

from brdfc.calc.operators import OPERATORS, Operand
from brdfc.calc.program import Block, If, Instruction, Matrix, Op, Program, Select

Choose = Callable[[Sequence[Any]], Any]

INPUTS, OUTPUTS, TEMPORARIES = 4, 3, 6
DEEPEST = 12

# Subnormals, the largest, both zeros, numbers that need nine digits, halves.
CONSTANTS = tuple(
    struct.unpack("f", struct.pack("f", value))[0]
    for value in (
        *(0.0, -0.0, 1.0, -1.0, 0.5, -0.5, 1.5, 2.0, 3.0, 0.1, -0.7, 100.0, 1e-5, 0.333333343),
        *(1e-45, -1e-45, 1.17549421e-38, 3.40282347e38, -3.40282347e38, 16777217.0, 0.785398185),
        *(8388608.5, 2147483648.0, 123456.789, 1.00000012, 0.999999940, 6.10351562e-05),
    )
)
VARIABLES = ("thti", "azi", "x", "ä", "a b", "12", "deadbeef"[:4], "true", "ndef", "")

MATRICES = (
    Matrix(3, 3, (0.5, 0.25, -1.0, 0.1, 0.0, 2.0, -0.75, 0.3, 1.0), (0.0, 0.125, -0.3)),
    Matrix(2, 1, (0.7, -0.2), (0.1,)),
)
MATRICES = tuple(
    Matrix(
        m.inputs,
        m.outputs,
        tuple(struct.unpack("f", struct.pack("f", v))[0] for v in m.values),
        tuple(struct.unpack("f", struct.pack("f", v))[0] for v in m.offsets),
    )
    for m in MATRICES
)
INNER = Program(
    2, 3, (Op("in", 0, 2), Op("copy", 2, 1), Op("mul", 1), Op("tsav", 0, 3), Op("out", 0, 3))
)
ELEMENTS = (*MATRICES, INNER, INNER)
CALLS = (("mtx", 0), ("mtx", 1), ("elem", 0), ("elem", 1), ("calc", 2), ("calc", 3), ("elem", 3))

MOVES = ("copy", "rotl", "rotr", "posd", "flip", "pop", "tran")
EVERY = tuple(
    name
    for name, operator in OPERATORS.items()
    if operator.operand not in (Operand.SPAN, Operand.ELEMENT) and name not in (*MOVES, "scnt")
)


class _Generator:
    """Draws instructions while it knows how deep the stack is on every path."""

    def __init__(self, choose: Choose, names: Sequence[str]) -> None:
        self.choose = choose
        self.names = names
        self.depth = 0
        self.written: set[int] = set()

    def number(self, low: int, high: int) -> int:
        return int(self.choose(range(low, high + 1)))

    def block(self, length: int, nesting: int) -> Block:
        return tuple(self.instruction(nesting) for _ in range(self.number(0, length)))

    def instruction(self, nesting: int) -> Instruction:
        kinds = ["push", "push", "operator", "operator", "operator", "move", "temporary", "call"]
        if nesting:
            kinds += ["if", "select"]
        kind = self.choose(kinds)
        if self.depth > DEEPEST:
            return self.take("pop", self.number(1, self.depth), 0)
        if self.depth < 1 or kind == "push":
            return self.push()
        return getattr(self, f"_{kind}")(nesting)

    def take(self, name: str, first: int, second: int) -> Op:
        popped, pushed = OPERATORS[name].effect(first, second)
        assert popped <= self.depth
        self.depth += pushed - popped
        return Op(name, first, second)

    def push(self) -> Op:
        if self.choose((True, False)):
            start = self.number(0, INPUTS - 1)
            return self.take("in", start, self.number(1, INPUTS - start))
        self.depth += 1
        return Op("data", value=self.choose(CONSTANTS))

    def _operator(self, _nesting: int) -> Op:
        name = self.choose(self.names)
        operand = OPERATORS[name].operand
        if operand is Operand.CONSTANT:
            return self.push()
        if operand is Operand.SIGNATURE:
            self.depth += 2
            return Op(name, signature=self.choose(VARIABLES))
        if operand is Operand.NONE:
            return self.take(name, 0, 0)
        effect = OPERATORS[name].effect
        if operand is Operand.SHAPE:
            return self.take(name, 3, 3) if effect(3, 3)[0] <= self.depth else self.push()
        counts = range(2 if operand is Operand.FOLD else 1, 6)
        fitting = [n for n in counts if effect(n, 0)[0] <= self.depth]
        return self.take(name, self.choose(fitting), 0) if fitting else self.push()

    def _move(self, _nesting: int) -> Op:
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

    def _temporary(self, _nesting: int) -> Op:
        start = self.number(0, TEMPORARIES - 1)
        count = self.number(1, min(TEMPORARIES - start, self.depth))
        name = self.choose(("tput", "tsav", "tget"))
        if name == "tget":
            if not self.written:
                return self.push()
            return self.take("tget", self.choose(sorted(self.written)), 1)
        self.written |= set(range(start, start + count))
        return self.take(name, start, count)

    def _call(self, _nesting: int) -> Op:
        name, index = self.choose(CALLS)
        element = ELEMENTS[index]
        if element.inputs > self.depth:
            return self.push()
        self.depth += element.outputs - element.inputs
        return Op(name, index)

    def _bodies(self, count: int, nesting: int, *, complete: bool) -> list[Block]:
        before, written = self.depth, self.written
        depths, sets, bodies = [], [], []
        for _ in range(count):
            self.depth, self.written = before, set(written)
            bodies.append(self.block(5, nesting - 1))
            depths.append(self.depth)
            sets.append(self.written)
        if not complete:
            depths.append(before)
            sets.append(written)
        self.depth, self.written = min(depths), set.intersection(*sets)
        return bodies

    def _if(self, nesting: int) -> If:
        self.depth -= 1
        otherwise = self.choose((True, False))
        bodies = self._bodies(1 + otherwise, nesting, complete=otherwise)
        return If(bodies[0], bodies[1] if otherwise else None)

    def _select(self, nesting: int) -> Select:
        self.depth -= 1
        cases, default = self.number(1, 4), self.choose((True, False))
        bodies = self._bodies(cases + default, nesting, complete=default)
        return Select(tuple(bodies[:cases]), bodies[cases] if default else None)

    def program(self, length: int) -> Program:
        body = list(self.block(length, 3))
        while self.depth < OUTPUTS:
            body.append(self.push())
        body.append(Op("out", 0, OUTPUTS))
        return Program(INPUTS, OUTPUTS, tuple(body), ELEMENTS)


@st.composite
def programs(draw: st.DrawFn, names: Sequence[str] = EVERY) -> Program:
    """Programs of 4 channels in and 3 out, with sub-elements."""
    return _Generator(lambda options: draw(st.sampled_from(options)), names).program(20)


def random_program(seed: int, names: Sequence[str] = EVERY, length: int = 30) -> Program:
    """The program of a seed."""
    return _Generator(random.Random(seed).choice, names).program(length)
