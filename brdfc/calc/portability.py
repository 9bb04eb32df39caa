"""Where a program may depend on what releases of the reference engine do differently.

Some operators are unknown to older releases, and some empty blocks are wrong there, wherever they
stand. The rest is a matter of values: the program is followed with an interval for every value
(bounds.py), and where operands may lie at a place that releases disagree about
(disagreements.py), that is a finding.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from brdfc.calc.curves import calculator_curves
from brdfc.calc.follow import Follower
from brdfc.calc.program import Block, If, Op, Program, encoded_length, heads
from brdfc.symbolic.intervals import Interval


def portability(
    program: Program,
    where: str = "",
    inputs: Sequence[Interval] | None = None,
    variables: Mapping[str, Interval] | None = None,
) -> list[str]:
    """Findings, each with the index of the operation as the file counts, in the file's order.

    program: one that verify accepts. inputs: where its channels lie, and variables, by signature,
    where those lie that are defined; any others may have any value. A shared sub-element is looked
    at once for what stands in it, and its findings are those of all its calls.
    """
    follower = Follower(variables or {})
    follower.follow(program, inputs)
    return list(listed(program, where, follower.findings))


def listed(
    program: Program, where: str, by_value: Mapping[int, Mapping[int, str]]
) -> Iterator[str]:
    """Findings in the file's order. by_value: those of a Follower."""
    found = [*_standing(program.body, 0), *by_value.get(id(program), {}).items()]
    for index, finding in sorted(found):
        yield f"{where}op {index}: {finding}"
    seen: set[int] = set()
    for number, element in enumerate(program.elements):
        if id(element) not in seen:
            seen.add(id(element))
            inside = f"{where}sub-element {number}, "
            if isinstance(element, Program):
                yield from listed(element, inside, by_value)
            for place, curve in calculator_curves(element).items():
                yield from listed(curve.calculator, f"{inside}curve {place}, ", by_value)


def _standing(block: Block, index: int) -> Iterator[tuple[int, str]]:
    """What is wrong whatever the values are."""
    for position, instruction in enumerate(block):
        final = position == len(block) - 1
        if isinstance(instruction, Op):
            if not instruction.operator.portable:
                yield index, f"'{instruction.name}' is unknown to older releases"
            index += 1
            continue
        bodies = instruction.bodies
        if isinstance(instruction, If):
            if instruction.otherwise == () and final:
                yield index, "an empty 'else' at the end of a block fails in older releases"
        elif bodies[-1] == () and final:
            yield index, "an empty last case at the end of a block is rejected"
        index += heads(instruction)
        for body in bodies:
            yield from _standing(body, index)
            index += encoded_length(body)
