"""A calculator program in memory, and the elements it may call.

Blocks are nested here, as in the text form; the flat encoding with its jump lengths exists only in
binary.py, so that a jump out of range cannot be represented.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Protocol

from brdfc.calc.operators import OPERATORS, Operator

MAX_NESTING = 64
"""How deep blocks may stand in blocks and calculators in calculators, so that no program from
outside exhausts Python's stack."""

MAX_OPERATIONS = 1 << 17
"""How many operations a main function may have, so that none from outside exhausts memory; the
largest of the ICC's samples has 80,000."""


MAX_TEMPORARIES = 65536
"""Temporaries of a calculator: their numbers have 16 bits."""


@dataclass(frozen=True)
class Op:
    """One operator with its operand.

    first and second are the arguments as the text form writes them (counts, not counts minus one;
    start channel and count for `in`): see Operator.operand. value is a constant's, already a
    float32; signature the environment variable's four characters.
    """

    name: str
    first: int = 0
    second: int = 0
    value: float = 0.0
    signature: str = ""

    @property
    def operator(self) -> Operator:
        return OPERATORS[self.name]


@dataclass(frozen=True)
class If:
    """Pops a condition (true: >= 0.5). otherwise is None where there is no `else`. share: the part
    of the pixels that runs `then`, where a compiler knows; no part of what a file holds."""

    then: Block
    otherwise: Block | None = None
    share: float | None = field(default=None, compare=False, repr=False)

    @property
    def bodies(self) -> tuple[Block, ...]:
        """The blocks in the order of the encoding."""
        return (self.then,) if self.otherwise is None else (self.then, self.otherwise)

    @property
    def complete(self) -> bool:
        """Whether one of the bodies always runs."""
        return self.otherwise is not None


@dataclass(frozen=True)
class Select:
    """Pops a selector, rounds it half away from zero and runs that case, else the default."""

    cases: tuple[Block, ...]
    default: Block | None = None

    @property
    def bodies(self) -> tuple[Block, ...]:
        """The blocks in the order of the encoding."""
        return self.cases if self.default is None else (*self.cases, self.default)

    @property
    def complete(self) -> bool:
        """Whether one of the bodies always runs."""
        return self.default is not None


Instruction = Op | If | Select
Block = tuple[Instruction, ...]


class Element(Protocol):
    """Anything a calculator may call: an element with channels in and out."""

    @property
    def inputs(self) -> int: ...

    @property
    def outputs(self) -> int: ...

    @property
    def signature(self) -> str:
        """The four letters of its kind, as in a file."""
        ...


@dataclass(frozen=True)
class Program:
    """A calculator element: channels in, channels out, a main function and sub-elements."""

    inputs: int
    outputs: int
    body: Block
    elements: tuple[Element, ...] = ()

    @property
    def signature(self) -> str:
        return "calc"


@dataclass(frozen=True)
class Matrix:
    """A `matf` element: y = values x + offsets.

    values holds outputs rows of inputs numbers, float32; offsets one number a row.
    """

    inputs: int
    outputs: int
    values: tuple[float, ...]
    offsets: tuple[float, ...]

    @property
    def signature(self) -> str:
        return "matf"


@dataclass(frozen=True)
class OpaqueElement:
    """An element of a kind that is carried but not run; data are its bytes, header included."""

    signature: str
    inputs: int
    outputs: int
    data: bytes


def walk(block: Block) -> Iterator[Instruction]:
    """All instructions of a block and of the blocks inside it, in the order of the encoding."""
    for instruction in block:
        yield instruction
        if not isinstance(instruction, Op):
            for body in instruction.bodies:
                yield from walk(body)


def heads(instruction: If | Select) -> int:
    """How many operations stand before the bodies: `if`, `else`, `sel`, `case` and `dflt`."""
    return len(instruction.bodies) + isinstance(instruction, Select)


def encoded_length(block: Block) -> int:
    """How many 8-byte operations the block takes in a file, those of inner blocks included."""
    return sum(1 if isinstance(i, Op) else heads(i) for i in walk(block))
