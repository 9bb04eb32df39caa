"""What a program costs: operators executed and the time they take on the reference engine."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from brdfc.calc.operators import OPERATORS, Operand
from brdfc.calc.prices import prices
from brdfc.calc.program import Block, Element, If, Matrix, Op, Program, encoded_length
from brdfc.calc.tables import LookupTable

_KINDS = {
    "cvst": "curv",
    "matf": "mtx",
    "clut": "clut",
    "xclt": "clut",
    "tint": "tint",
    "XtoJ": "tJab",
    "JtoX": "fJab",
    "calc": "calc",
}
"""The operator that an element is priced as, whatever calls it."""


def operations(program: Program) -> int:
    """Operators in the main function as a file counts them, control flow included."""
    return encoded_length(program.body)


def price(program: Program) -> float:
    """Nanoseconds a pixel on the reference engine, beside what any program costs (`fixed`); of a
    program read from a file, those of its dearest path."""
    return nanoseconds(program.body, program.elements)


def fixed() -> float:
    """Nanoseconds a pixel takes before any operator of the program, its way through MID included.
    `price` is beyond this."""
    return prices().pixel


def cost(name: str, components: int = 1) -> float:
    """Nanoseconds one step takes: an operator, or one of prices.CONTROL without its blocks."""
    table = prices()
    row = table.operators[name]
    return table.dispatch + row.first + (components - 1) * row.more


def nanoseconds(
    block: Block,
    elements: Sequence[Element] = (),
    known: dict[tuple[int, int], float] | None = None,
) -> float:
    """Time per pixel: of both branches by their shares of the pixels where those are known, else
    of the dearest one. Variables count as defined: an `if` right after `env` runs its first block.
    Without its elements, a block's calls count as if of one channel. known: what blocks inside
    take, by identity: one that is called from many places is added up once.
    """
    known = {} if known is None else known
    total = 0.0
    for step in steps(block, elements):
        total += cost(step.name, step.components)
        times = []
        for inner, inner_elements in step.bodies:
            key = id(inner), id(inner_elements)
            if key not in known:
                known[key] = nanoseconds(inner, inner_elements, known)
            times.append(known[key])
        if step.share is not None:
            total += step.share * times[0] + (1 - step.share) * times[1]
        elif times:
            total += max(times)
    return total


class Step(NamedTuple):
    """One thing the engine does: the name of a price, how many components it is for, and the
    blocks of which one runs then, the first of two for a share of the pixels."""

    name: str
    components: int = 1
    bodies: tuple[tuple[Block, Sequence[Element]], ...] = ()
    share: float | None = None


def steps(block: Block, elements: Sequence[Element]) -> Iterator[Step]:
    """What the engine does one after the other."""
    constants, before = 0, ""
    for instruction in block:
        name = instruction.name if isinstance(instruction, Op) else ""
        if name == "data":  # a run of them is one step
            constants += 1
            continue
        if constants:
            yield Step("data", constants)
            constants, before = 0, "data"
        if isinstance(instruction, Op):
            if OPERATORS[name].operand is Operand.ELEMENT:
                yield _call(instruction, elements)
            else:
                yield Step(name, components(instruction))
        elif isinstance(instruction, If):
            bodies = instruction.bodies[:1] if before == "env" else instruction.bodies
            kind = "if_else" if instruction.complete else "if"
            share = instruction.share if len(bodies) == 2 else None
            yield Step(kind, 1, tuple((body, elements) for body in bodies), share)
        else:
            yield Step("sel", 1, tuple((body, elements) for body in instruction.bodies))
        before = name
    if constants:
        yield Step("data", constants)


def work(block: Block, elements: Sequence[Element] = ()) -> Counter[tuple[str, str]]:
    """How often each price counts, where the longest block of a choice is the one that runs."""
    found: Counter[tuple[str, str]] = Counter()
    for step in steps(block, elements):
        found[step.name, "first"] += 1
        found[step.name, "more"] += step.components - 1
        if step.bodies:
            found += work(*max(step.bodies, key=lambda body: encoded_length(body[0])))
    return found


def components(op: Op) -> int:
    """How many values an operator works on, at least one."""
    operand = OPERATORS[op.name].operand
    if operand in (Operand.SPAN, Operand.POSITION):
        return op.second
    if operand is Operand.FOLD:
        return op.first - 1
    if operand is Operand.COPIES or op.name == "tran":
        return op.first * op.second
    if operand in (Operand.VECTOR, Operand.ROTATION):
        return op.first
    return 1


def _call(op: Op, elements: Sequence[Element]) -> Step:
    """A call of an element: channels, entries of a matrix, or weights and values of a table's
    corners are its components; a calculator runs its function."""
    if op.first >= len(elements):
        return Step(op.name)
    element = elements[op.first]
    name = _KINDS.get(element.signature, op.name)
    if isinstance(element, Program):
        return Step(name, 1, ((element.body, element.elements),))
    if isinstance(element, LookupTable):
        return Step(name, (1 + element.outputs) << element.inputs)
    entries = element.inputs * element.outputs if isinstance(element, Matrix) else element.inputs
    return Step(name, max(entries, 1))
