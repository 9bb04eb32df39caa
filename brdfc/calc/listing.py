"""The text of a calculator and of the calculators inside it, each under a heading."""

from __future__ import annotations

from collections.abc import Iterator

from brdfc.calc.curves import calculator_curves
from brdfc.calc.price import operations
from brdfc.calc.program import Element, Program
from brdfc.calc.text import disassemble


def listing(element: Element, name: str) -> Iterator[str]:
    """One text a calculator: a comment that names it, then its main function."""
    for place, curve in calculator_curves(element).items():
        yield from listing(curve.calculator, f"{name}, curve {place}")
    if not isinstance(element, Program):
        return
    yield (
        f"; {name}: calculator, {element.inputs} channels in, {element.outputs} out, "
        f"{operations(element)} operators\n" + disassemble(element.body)
    )
    seen: set[int] = set()
    for index, inner in enumerate(element.elements):
        if id(inner) not in seen:
            seen.add(id(inner))
            yield from listing(inner, f"{name}, sub-element {index}")
