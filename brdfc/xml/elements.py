"""Elements as XML, and back: those that are run, and others as bytes."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable

import numpy as np

from brdfc.calc.appearance import AppearanceTransform
from brdfc.calc.binary import decode_element, encode_element
from brdfc.calc.curves import CurveSet
from brdfc.calc.disassembly import disassemble
from brdfc.calc.program import Element, Matrix, Program
from brdfc.calc.samples import Samples, Storage
from brdfc.calc.tables import LookupTable
from brdfc.icc.numbers import NUMBER_FORMATS, NumberArray
from brdfc.icc.signatures import signature_bytes
from brdfc.source.errors import ProfileError, ProgramError
from brdfc.xml.appearance import APPEARANCE, appearance_node, read_appearance
from brdfc.xml.arrays import array_node, read_array
from brdfc.xml.calculator import read_calculator
from brdfc.xml.curves import curve_nodes, read_curves
from brdfc.xml.document import Node
from brdfc.xml.folder import Folder
from brdfc.xml.names import TYPE_NAMES, TYPE_SIGNATURES, signature_name, signature_of_name
from brdfc.xml.naming import NO_NAMES, Names, declared, naming, variables
from brdfc.xml.values import channels, hexadecimal, integer, numbers, to_float32
from brdfc.xml.writing import hexadecimal as hexadecimal_lines
from brdfc.xml.writing import rows

HEADER = 12
"""Bytes before what an element holds: signature, 0, channels in and out."""


class ElementWriter:
    """Nodes of elements; an element that stands in several places has one node."""

    def __init__(self) -> None:
        self.known: dict[int, tuple[Element, Node]] = {}

    def node(self, element: Element, names: Names = NO_NAMES) -> Node:
        """The node of an element. names: of a calculator's channels, where they are known."""
        if id(element) not in self.known:
            self.known[id(element)] = element, self._node(element, names)
        return self.known[id(element)][1]

    def _node(self, element: Element, names: Names) -> Node:
        if isinstance(element, Program):
            return self._calculator(element, names)
        if isinstance(element, Matrix):
            values = Node("MatrixData", lines=rows(element.values, element.inputs))
            offsets = Node("ConstantData", lines=rows(element.offsets, len(element.offsets)))
            return Node("MatrixElement", _attributes(element), [values, offsets])
        if isinstance(element, LookupTable):
            return _table_node(element)
        if isinstance(element, CurveSet):
            nodes = curve_nodes(element, self.node)
            return Node("CurveSetElement", _attributes(element), nodes)
        if isinstance(element, AppearanceTransform):
            return appearance_node(element)
        if element.signature == "tint":
            return _tint_node(element)
        return _unknown_node(element)

    def _calculator(self, program: Program, names: Names) -> Node:
        temporaries = variables(program.body)
        attributes = _attributes(program)
        if names.inputs:
            attributes["InputNames"] = declared(names.inputs)
        if names.outputs:
            attributes["OutputNames"] = declared(names.outputs)
        children = []
        if temporaries:
            children.append(Node("Variables", {}, [_declare(*v) for v in temporaries.items()]))
        if program.elements:
            children.append(Node("SubElements", {}, [self.node(e) for e in program.elements]))
        text = disassemble(program.body, naming(names, temporaries))
        children.append(Node("MainFunction", lines=text.splitlines()))
        return Node("CalculatorElement", attributes, children)


def _declare(name: str, place: tuple[int, int]) -> Node:
    position, size = place
    attributes = {"Name": name} | ({"Size": str(size)} if size > 1 else {})
    return Node("Declare", attributes | {"Position": str(position)})


def _attributes(element: Element) -> dict[str, str]:
    return {"InputChannels": str(element.inputs), "OutputChannels": str(element.outputs)}


def _table_node(table: LookupTable) -> Node:
    attributes = _attributes(table)
    if table.extended:
        attributes["StorageType"] = str(table.samples.storage.code)
    grid = Node("GridPoints", text=" ".join(map(str, table.grid)))
    data = Node("TableData", lines=rows(table.samples.values.tolist(), table.outputs))
    return Node("ExtCLutElement" if table.extended else "CLutElement", attributes, [grid, data])


def _unknown_node(element: Element) -> Node:
    # The reference writes the attribute as Type and reads it as type.
    kind = signature_name(signature_bytes(element.signature))
    attributes = {"Type": kind, "type": kind, **_attributes(element)}
    lines = hexadecimal_lines(encode_element(element)[HEADER:])
    return Node("UnknownElement", attributes, lines=lines)


def _tint_node(element: Element) -> Node:
    try:
        array = NumberArray.decode(encode_element(element)[HEADER:], "tint")
    except (ProfileError, KeyError):  # an array that is carried, and not well-formed
        return _unknown_node(element)
    inside = Node(TYPE_NAMES[array.kind], {}, [array_node(array)])
    return Node("TintArrayElement", _attributes(element), [inside])


# --- read -----------------------------------------------------------------------------------------


def read_element(node: Node, folder: Folder, depth: int = 0) -> Element:
    """The element of a node; ProfileError or ProgramError shows the place of what is wrong.

    depth: how many calculators it stands in.
    """
    if node.tag == "CalculatorElement":
        return read_calculator(node, folder, lambda n, d: read_element(n, folder, d), depth)
    element = _read(node, folder, depth)
    try:  # what could not be read again is not written
        decode_element(encode_element(element), node.tag)
    except ProgramError as error:
        node.fail(error.message)
    return element


def _read(node: Node, folder: Folder, depth: int) -> Element:
    def calculator(inner: Node) -> Program:
        element = read_element(inner, folder, depth + 1)
        if not isinstance(element, Program):
            inner.fail("a curve is sampled from a <CalculatorElement> only")
        return element

    readers: dict[str, Callable[[], Element]] = {
        "MatrixElement": lambda: _read_matrix(node),
        "CLutElement": lambda: _read_table(node, folder),
        "ExtCLutElement": lambda: _read_table(node, folder),
        "CurveSetElement": lambda: read_curves(node, folder, calculator),
        "TintArrayElement": lambda: _read_tint(node, folder),
        "UnknownElement": lambda: _read_unknown(node),
        **dict.fromkeys(APPEARANCE, lambda: read_appearance(node)),
    }
    if node.tag not in readers:
        node.fail(f"<{node.tag}> is not read here; <UnknownElement> takes its bytes")
    return readers[node.tag]()


_MOST_ZEROS = 1 << 16
_LARGEST_INVERSE = 256


def _read_matrix(node: Node) -> Matrix:
    inputs, outputs = channels(node)
    data, constant = node.child("MatrixData"), node.child("ConstantData")
    if data is None and inputs * outputs > _MOST_ZEROS:
        node.fail(f"a matrix of zeros has at most {_MOST_ZEROS:,} of them")
    values = np.zeros(inputs * outputs) if data is None else numbers(data, inputs * outputs)
    if data is not None and data.attributes.get("InvertMatrix", "").lower() == "true":
        if inputs != outputs or inputs > _LARGEST_INVERSE:
            most = f"{_LARGEST_INVERSE} x {_LARGEST_INVERSE}"
            data.fail(f"only a square matrix is inverted, of {most} at most")
        try:
            inverse = np.linalg.inv(values.reshape(outputs, inputs))
        except np.linalg.LinAlgError:
            data.fail("this matrix has no inverse")
        values = np.asarray(inverse, dtype=np.float64).reshape(-1)
    offsets = np.zeros(outputs) if constant is None else numbers(constant, outputs)
    return Matrix(inputs, outputs, to_float32(values), to_float32(offsets))


def _read_table(node: Node, folder: Folder) -> LookupTable:
    inputs, outputs = channels(node)
    points, data = node.child("GridPoints"), node.child("TableData")
    if data is None:
        node.fail("a lookup table needs <TableData>")
    if points is not None:
        grid = tuple(int(n) for n in numbers(points, inputs).tolist())
    else:
        grid = (integer(node, "GridGranularity", high=255),) * min(inputs, 17)
    if len(grid) != inputs or not all(2 <= n <= 255 for n in grid):
        node.fail(f"a grid has 2 to 255 points for each of {inputs} inputs")
    extended = node.tag == "ExtCLutElement"
    storage = Storage.of_code(integer(node, "StorageType", 0, high=3), node.tag)
    values = folder.samples(data, math.prod(grid) * outputs)
    try:
        samples = Samples.of(values, storage if extended else Storage.FLOAT32)
    except ProgramError as error:
        data.fail(error.message)
    return LookupTable(inputs, outputs, grid, samples, extended)


def _read_tint(node: Node, folder: Folder) -> Element:
    inputs, outputs = channels(node)
    arrays = [child for child in node.children if TYPE_SIGNATURES.get(child.tag) in NUMBER_FORMATS]
    if len(arrays) != 1 or len(node.children) != 1:
        node.fail("one array of numbers stands in a tint array")
    try:
        data = read_array(arrays[0], folder).encode()
        return decode_element(struct.pack(">4sIHH", b"tint", 0, inputs, outputs) + data, node.tag)
    except (ProfileError, ProgramError) as error:
        if "\n" in error.message:
            raise
        arrays[0].fail(error.message)


def _read_unknown(node: Node) -> Element:
    inputs, outputs = channels(node)
    name = node.attributes.get("Type") or node.attributes.get("type") or ""
    try:
        kind = signature_of_name(name)
    except ProfileError as error:
        node.fail(error.message)
    head = struct.pack(">4sIHH", kind, 0, inputs, outputs)
    try:
        return decode_element(head + hexadecimal(node), f"'{name}'")
    except ProgramError as error:
        node.fail(str(error))
