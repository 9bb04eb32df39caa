"""The appearance transforms, XYZ to Jab and back, as XML."""

from __future__ import annotations

from brdfc.calc.appearance import BACKWARD, FORWARD, AppearanceTransform
from brdfc.xml.document import Node
from brdfc.xml.values import channels, only_number, real, to_float32
from brdfc.xml.writing import number

APPEARANCE = {"XYZToJabElement": FORWARD, "JabToXYZElement": BACKWARD}
_PARAMETERS = (
    *("Luminance", "BackgroundLuminance", "ImpactSurround"),
    *("ChromaticInductionFactor", "AdaptationFactor"),
)
"""What follows the white, in the order of the file."""


def appearance_node(transform: AppearanceTransform) -> Node:
    """The node of a transform."""
    tag = next(tag for tag, kind in APPEARANCE.items() if kind == transform.signature)
    xyz = Node("XYZNumber", dict(zip("XYZ", map(number, transform.white), strict=True)))
    parameters = [Node("WhitePoint", {}, [xyz])]
    for name, value in zip(_PARAMETERS, transform.conditions, strict=True):
        parameters.append(Node(name, text=number(value)))
    attributes = {"InputChannels": "3", "OutputChannels": "3"}
    return Node(tag, attributes, [Node("ColorAppearanceParams", {}, parameters)])


def read_appearance(node: Node) -> AppearanceTransform:
    """The transform of a node."""
    if channels(node) != (3, 3):
        node.fail("an appearance transform takes 3 channels to 3")
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
    x, y, z, luminance, background, impact, induction, degree = to_float32(values)
    return AppearanceTransform(
        APPEARANCE[node.tag], (x, y, z), luminance, background, impact, induction, degree
    )
