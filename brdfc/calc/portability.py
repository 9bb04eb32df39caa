"""Where a program leans on what releases of the reference engine do differently."""

from __future__ import annotations

from collections.abc import Iterator

from brdfc.calc.curves import calculator_curves
from brdfc.calc.program import Block, If, Op, Program, encoded_length, heads

_UNSETTLED = ("mod", "solv", "trnc", "rond", "rnum")
"""Operators whose results at their extremes changed from one release to the next."""


def portability(program: Program, where: str = "") -> list[str]:
    """Findings, with the index of the operation; a shared sub-element is looked at once."""
    findings = [f"{where}op {index}: {finding}" for index, finding in _findings(program.body, 0)]
    inner = {id(e): (i, e) for i, e in reversed(list(enumerate(program.elements)))}
    for index, element in sorted(inner.values(), key=lambda pair: pair[0]):
        if isinstance(element, Program):
            findings += portability(element, f"{where}sub-element {index}, ")
        for place, curve in calculator_curves(element).items():
            inside = f"{where}sub-element {index}, curve {place}, "
            findings += portability(curve.calculator, inside)
    return findings


def _findings(block: Block, index: int) -> Iterator[tuple[int, str]]:
    for position, instruction in enumerate(block):
        final = position == len(block) - 1
        if isinstance(instruction, Op):
            if not instruction.operator.portable:
                yield index, f"'{instruction.name}' is unknown to older releases"
            elif instruction.name in _UNSETTLED:
                yield index, f"'{instruction.name}' gives different results at its extremes"
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
            yield from _findings(body, index)
            index += encoded_length(body)
