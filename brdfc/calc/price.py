"""What a program costs: operators executed and the time they take on the reference engine."""

from __future__ import annotations

from collections.abc import Sequence

from brdfc.calc.curves import CurveSet
from brdfc.calc.operators import DISPATCH, Operand
from brdfc.calc.program import Block, Element, If, Op, Program, encoded_length
from brdfc.calc.tables import LookupTable

TABLE_CORNER = 0.48
"""Nanoseconds for the weight of a corner of a lookup table, and for each output there."""


def operations(program: Program) -> int:
    """Operators in the main function as a file counts them, control flow included."""
    return encoded_length(program.body)


def price(program: Program) -> float:
    """Nanoseconds a pixel on the reference engine, by the price column of the operator table."""
    return nanoseconds(program.body, program.elements)


def nanoseconds(block: Block, elements: Sequence[Element] = ()) -> float:
    """Time per pixel of a block's dearest path, by the price column of the operator table.

    A vector operator costs its price for each component, a curve set for each curve, a lookup table
    TABLE_CORNER besides. Without its elements, a block's calls count as if of one channel. What
    called calculators and matrices cost is not counted.
    """
    total = 0.0
    for instruction in block:
        if isinstance(instruction, Op):
            operator = instruction.operator
            components = instruction.first if operator.operand is Operand.VECTOR else 1
            total += DISPATCH + components * operator.price
            if operator.operand is Operand.ELEMENT and instruction.first < len(elements):
                total += _beyond_one(elements[instruction.first], operator.price)
        else:
            # The engine steps over `else`; it finds a case by its number.
            steps = len(instruction.bodies) if isinstance(instruction, If) else 1
            total += steps * DISPATCH + max(
                nanoseconds(body, elements) for body in instruction.bodies
            )
    return total


def _beyond_one(element: Element, price: float) -> float:
    """What an element costs beyond the price of its operator."""
    if isinstance(element, CurveSet):
        return (element.inputs - 1) * price
    if isinstance(element, LookupTable):
        return TABLE_CORNER * (1 + element.outputs) * (1 << element.inputs)
    return 0.0
