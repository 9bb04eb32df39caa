"""Spectral viewing conditions as XML, and back."""

from __future__ import annotations

import re

from brdfc.icc.header import SpectralRange
from brdfc.icc.viewing import XYZ, SpectralViewingConditions
from brdfc.xml.document import Node
from brdfc.xml.names import ILLUMINANTS, OBSERVERS, OBSERVERS_READ
from brdfc.xml.values import integer, numbers, only_number, real, to_float32
from brdfc.xml.writing import number, rows


def conditions_nodes(tag: SpectralViewingConditions) -> list[Node]:
    """What stands in the element of the tag's type."""
    nodes = [
        Node("StdObserver", text=_name(OBSERVERS, tag.observer)),
        _colour("IlluminantXYZ", tag.white),
    ]
    if tag.observer_range != SpectralRange():
        nodes.append(_spectrum("ObserverFuncs", tag.observer_range, tag.matching))
    nodes += [
        Node("StdIlluminant", text=_name(ILLUMINANTS, tag.illuminant)),
        Node("ColorTemperature", text=number(tag.temperature)),
    ]
    if tag.illuminant_range != SpectralRange():
        nodes.append(_spectrum("IlluminantSPD", tag.illuminant_range, tag.power))
    return [*nodes, _colour("SurroundXYZ", tag.surround)]


def read_conditions(node: Node) -> SpectralViewingConditions:
    """The conditions of a node; what is not there is zero."""
    observer, illuminant = node.child("StdObserver"), node.child("StdIlluminant")
    temperature = node.child("ColorTemperature")
    observer_range, matching = _read_spectrum(node.child("ObserverFuncs"), 3)
    illuminant_range, power = _read_spectrum(node.child("IlluminantSPD"), 1)
    return SpectralViewingConditions(
        observer=_code(observer, _OBSERVER_CODES),
        observer_range=observer_range,
        matching=matching,
        illuminant=_code(illuminant, _ILLUMINANT_CODES),
        temperature=to_float32([only_number(temperature) if temperature else 0.0])[0],
        illuminant_range=illuminant_range,
        power=power,
        white=_read_colour(node.child("IlluminantXYZ")),
        surround=_read_colour(node.child("SurroundXYZ")),
    )


_OBSERVER_CODES = {name: code for code, name in enumerate(OBSERVERS)} | OBSERVERS_READ
_ILLUMINANT_CODES = {
    text: code
    for code, name in enumerate(ILLUMINANTS)
    for text in (name, name.removeprefix("Illuminant "))
}


def _name(names: tuple[str, ...], code: int) -> str:
    return names[code] if code < len(names) else str(code)


def _code(node: Node | None, codes: dict[str, int]) -> int:
    if node is None:
        return 0
    text = node.text.strip()
    if text not in codes and not re.fullmatch("[0-9]{1,10}", text):
        node.fail(f"'{text}' is not known; one of: {', '.join(codes)}, or a number")
    return codes[text] if text in codes else int(text)


def _colour(tag: str, value: XYZ) -> Node:
    return Node(tag, {axis: number(v) for axis, v in zip("XYZ", value, strict=True)})


def _read_colour(node: Node | None) -> XYZ:
    if node is None:
        return 0.0, 0.0, 0.0
    x, y, z = to_float32([real(node, axis) for axis in "XYZ"])
    return x, y, z


def _spectrum(tag: str, at: SpectralRange, values: tuple[float, ...]) -> Node:
    ends = {"start": number(at.start), "end": number(at.end), "steps": str(at.steps)}
    return Node(tag, ends, lines=rows(values, 8))


def _read_spectrum(node: Node | None, curves: int) -> tuple[SpectralRange, tuple[float, ...]]:
    if node is None:
        return SpectralRange(), ()
    at = SpectralRange(real(node, "start"), real(node, "end"), integer(node, "steps"))
    values = numbers(node, curves * at.steps)
    return at, to_float32(values)
