"""Curve sets as XML, and back."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from brdfc.calc.calculator_curves import CalculatorCurve
from brdfc.calc.curves import (
    Curve,
    CurveSet,
    FormulaSegment,
    SampledCurve,
    SampledSegment,
    Segment,
    SegmentedCurve,
)
from brdfc.calc.program import Program
from brdfc.calc.samples import Samples, Storage
from brdfc.source.errors import ProgramError
from brdfc.xml.document import Node
from brdfc.xml.folder import Folder
from brdfc.xml.values import channels, integer, numbers, real, to_float32
from brdfc.xml.writing import number, rows

_ROW = 8
_UNSTORED = 0.0
"""What stands first in a sampled segment: the XML has a place for the value at the start, which a
profile does not store, because it is what the segment before gives there."""


def curve_nodes(curves: CurveSet, calculator: Callable[[Program], Node]) -> list[Node]:
    """A node a channel. calculator: the node of a calculator."""
    nodes, first = [], dict[int, int]()
    for index, curve in enumerate(curves.curves):
        if id(curve) in first:
            nodes.append(Node("DuplicateCurve", {"Index": str(first[id(curve)])}))
        else:
            first[id(curve)] = index
            nodes.append(_curve_node(curve, calculator))
    return nodes


def _curve_node(curve: Curve, calculator: Callable[[Program], Node]) -> Node:
    if isinstance(curve, SampledCurve):
        attributes = {
            "FirstEntry": number(curve.first),
            "LastEntry": number(curve.last),
            "StorageType": str(curve.samples.storage.code),
            "ExtensionType": str(int(curve.extend)),
        }
        lines = rows(curve.samples.values.tolist(), _ROW)
        return Node("SingleSampledCurve", attributes, lines=lines)
    if isinstance(curve, CalculatorCurve):
        attributes = {
            "FirstEntry": number(curve.first),
            "LastEntry": number(curve.last),
            "ExtensionType": str(int(curve.extend)),
            "DesiredSize": str(curve.size),
        }
        return Node("SampledCalculatorCurve", attributes, [calculator(curve.calculator)])
    ends = ["-infinity", *map(number, curve.breaks), "+infinity"]
    pieces = zip(curve.segments, ends, ends[1:], strict=False)
    return Node("SegmentedCurve", {}, [_segment_node(*piece) for piece in pieces])


def _segment_node(segment: Segment, start: str, end: str) -> Node:
    attributes = {"Start": start, "End": end}
    if isinstance(segment, SampledSegment):
        values = [_UNSTORED, *segment.samples.values.tolist()]
        return Node("SampledSegment", attributes, lines=rows(values, _ROW))
    attributes["FunctionType"] = str(segment.type)
    return Node("FormulaSegment", attributes, lines=rows(segment.parameters, _ROW))


def read_curves(node: Node, folder: Folder, calculator: Callable[[Node], Program]) -> CurveSet:
    """The curve set of a node. calculator: the program of a calculator's node."""
    count, outputs = channels(node)
    if outputs != count or len(node.children) != count:
        node.fail(f"{count} channels in, {outputs} out, {len(node.children)} curves")
    curves: list[Curve] = []
    for child in node.children:
        if child.tag == "DuplicateCurve":
            index = integer(child, "Index")
            if index >= len(curves):
                child.fail(f"no curve before this one has the index {index}")
            curves.append(curves[index])
        else:
            curves.append(_read_curve(child, folder, calculator))
    return CurveSet(tuple(curves))


def _read_curve(node: Node, folder: Folder, calculator: Callable[[Node], Program]) -> Curve:
    if node.tag == "SegmentedCurve":
        return _read_segmented(node, folder)
    first, last = to_float32([real(node, "FirstEntry"), real(node, "LastEntry")])
    extension = integer(node, "ExtensionType", 0, high=1)
    if node.tag == "SampledCalculatorCurve":
        if len(node.children) != 1:
            node.fail("one <CalculatorElement> stands in a sampled calculator curve")
        size = integer(node, "DesiredSize", high=0xFFFFFFFF)
        return CalculatorCurve(size, first, last, calculator(node.children[0]), bool(extension))
    storage = _storage(node)
    values = folder.samples(node, storage=storage)
    return SampledCurve(first, last, _samples(node, values, storage), bool(extension))


def _read_segmented(node: Node, folder: Folder) -> SegmentedCurve:
    segments: list[Segment] = []
    breaks: list[float] = []
    before = -math.inf
    for child in node.children:
        start, end = (_end(child, name) for name in ("Start", "End"))
        if start != before:
            child.fail(f"this segment starts at {start:g}, where {before:g} is expected")
        breaks.append(end)
        before = end
        if child.tag == "SampledSegment":
            storage = _storage(child)
            values = folder.samples(child, storage=storage)[1:]
            segments.append(SampledSegment(_samples(child, values, Storage.FLOAT32)))
        else:
            parameters = to_float32(numbers(child))
            segments.append(FormulaSegment(integer(child, "FunctionType"), parameters))
    if before != math.inf:
        node.fail("the last segment ends at +infinity")
    return SegmentedCurve(tuple(breaks[:-1]), tuple(segments))


def _end(node: Node, name: str) -> float:
    text = node.attributes[name].strip()
    if text in ("-inf", "-infinity"):
        return -math.inf
    if text in ("+inf", "+infinity"):
        return math.inf
    return to_float32([real(node, name)])[0]


def _storage(node: Node) -> Storage:
    return Storage.of_code(integer(node, "StorageType", 0, high=3), node.tag)


def _samples(node: Node, values: object, storage: Storage) -> Samples:
    try:
        return Samples.of(np.asarray(values), storage)
    except ProgramError as error:
        node.fail(error.message)
