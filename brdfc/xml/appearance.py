"""The elements of CIECAM02, XYZ to Jab and back, as XML: brdfc carries them as bytes."""

from __future__ import annotations

import struct

from brdfc.calc.program import OpaqueElement
from brdfc.xml.document import Node
from brdfc.xml.values import channels, only_number, real
from brdfc.xml.writing import number

APPEARANCE = {"XYZToJabElement": "XtoJ", "JabToXYZElement": "JtoX"}
_PARAMETERS = (
    *("Luminance", "BackgroundLuminance", "ImpactSurround"),
    *("ChromaticInductionFactor", "AdaptationFactor"),
)
"""What follows the white, in the order of the file."""
_LAYOUT = struct.Struct(">4sIHH8f")


def appearance_node(element: OpaqueElement) -> Node | None:
    """The node, or None where the bytes are not what they should be."""
    if len(element.data) != _LAYOUT.size or element.data[4:8] != bytes(4):
        return None
    white, values = (values := _LAYOUT.unpack(element.data)[4:])[:3], values[3:]
    if not all(abs(v) < float("inf") for v in (*white, *values)):
        return None
    tag = next(tag for tag, kind in APPEARANCE.items() if kind == element.signature)
    xyz = Node("XYZNumber", dict(zip("XYZ", map(number, white), strict=True)))
    parameters = [Node("WhitePoint", {}, [xyz])]
    for name, value in zip(_PARAMETERS, values, strict=True):
        parameters.append(Node(name, text=number(value)))
    attributes = {"InputChannels": str(element.inputs), "OutputChannels": str(element.outputs)}
    return Node(tag, attributes, [Node("ColorAppearanceParams", {}, parameters)])


def read_appearance(node: Node) -> OpaqueElement:
    """The element of a node."""
    inputs, outputs = channels(node)
    parameters = node.child("ColorAppearanceParams")
    white = parameters and parameters.child("WhitePoint")
    xyz = white and white.child("XYZNumber")
    if parameters is None or xyz is None:
        node.fail("this needs <ColorAppearanceParams>, with a <WhitePoint> of one <XYZNumber>")
    values = [real(xyz, name) for name in "XYZ"]
    for name in _PARAMETERS:
        child = parameters.child(name)
        if child is None:
            parameters.fail(f"<{name}> is missing")
        values.append(only_number(child))
    kind = APPEARANCE[node.tag]
    try:
        data = _LAYOUT.pack(kind.encode(), 0, inputs, outputs, *values)
    except (struct.error, OverflowError):
        node.fail("a number does not fit a 32-bit float")
    return OpaqueElement(kind, inputs, outputs, data)
