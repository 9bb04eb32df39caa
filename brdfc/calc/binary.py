"""Elements as bytes, as a profile holds them: the calculator (`calc`) and the matrix (`matf`) here,
all others in modules of their own.

Bytes are not trusted: every count and offset is checked against what is there before it is
followed, and nesting has a limit, so that no input can exhaust stack or memory.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable

from brdfc.calc.appearance import AppearanceTransform, decode_appearance, encode_appearance
from brdfc.calc.curves import CurveSet, decode_curves, encode_curves
from brdfc.calc.function import decode_block, decode_function, encode_block, encode_function
from brdfc.calc.places import ENTRY, decode_parts, decode_places, encode_parts
from brdfc.calc.program import MAX_NESTING, Element, Matrix, OpaqueElement, Program
from brdfc.calc.tables import LookupTable, decode_table, encode_table
from brdfc.calc.tints import TintArray, decode_tint, encode_tint
from brdfc.source.errors import ProgramError

__all__ = ["decode_block", "decode_element", "encode_block", "encode_element"]


def encode_element(element: Element) -> bytes:
    """An element's bytes, from its own signature on.

    Raises ProgramError for what has no place in a file: too many channels, numbers beyond float32.
    """
    try:
        if isinstance(element, Program):
            return _encode_calculator(element)
        if isinstance(element, Matrix):
            return _encode_matrix(element)
        if isinstance(element, CurveSet):
            return encode_curves(element, encode_element)
        if isinstance(element, LookupTable):
            return encode_table(element)
        if isinstance(element, TintArray):
            return encode_tint(element)
        if isinstance(element, AppearanceTransform):
            return encode_appearance(element)
    except (struct.error, OverflowError) as error:
        raise ProgramError(f"an element cannot be encoded: {error}") from error
    if isinstance(element, OpaqueElement):
        return element.data
    raise TypeError(f"no encoding for {type(element).__name__}")


def _encode_matrix(matrix: Matrix) -> bytes:
    sizes = matrix.inputs * matrix.outputs, matrix.outputs
    if (len(matrix.values), len(matrix.offsets)) != sizes:
        raise ProgramError(f"a {matrix.outputs} x {matrix.inputs} matrix needs {sizes} numbers")
    head = struct.pack(">4sIHH", b"matf", 0, matrix.inputs, matrix.outputs)
    numbers = (*matrix.values, *matrix.offsets)
    return head + struct.pack(f">{len(numbers)}f", *numbers)


def _encode_calculator(program: Program) -> bytes:
    main = encode_function(program.body)
    offset = 16 + ENTRY * (len(program.elements) + 1)
    places, data = encode_parts(program.elements, encode_element, offset + len(main))
    head = struct.pack(
        ">4sIHHI", b"calc", 0, program.inputs, program.outputs, len(program.elements)
    )
    return head + struct.pack(">II", offset, len(main)) + places + main + data


def decode_element(data: bytes, where: str, depth: int = 0) -> Element:
    """The element that `data` begins with; where names it in errors.

    Raises ProgramError for anything malformed. Kinds that are not run come back opaque.
    """
    if depth > MAX_NESTING:
        raise ProgramError(f"elements nest deeper than {MAX_NESTING}", where=where)
    if len(data) < 12:
        raise ProgramError(f"an element needs 12 bytes, {len(data)} are left", where=where)
    signature, _, inputs, outputs = struct.unpack(">4sIHH", data[:12])

    def decode(part: bytes, name: str) -> Element:
        return decode_element(part, name, depth + 1)

    if signature == b"calc":
        return _decode_calculator(data, inputs, outputs, where, decode)
    if signature == b"cvst":
        return decode_curves(data, inputs, outputs, where, decode)
    if signature in _DECODERS:
        return _DECODERS[signature](data, inputs, outputs, where)
    return OpaqueElement(signature.decode("latin-1"), inputs, outputs, bytes(data))


def _decode_matrix(data: bytes, inputs: int, outputs: int, where: str) -> Matrix:
    count = inputs * outputs + outputs
    if len(data) < 12 + 4 * count:
        raise ProgramError(f"a {outputs} x {inputs} matrix does not fit its bytes", where=where)
    numbers = struct.unpack_from(f">{count}f", data, 12)
    if not all(map(math.isfinite, numbers)):
        raise ProgramError("the matrix holds NaN or infinity", where=where)
    return Matrix(inputs, outputs, numbers[: inputs * outputs], numbers[inputs * outputs :])


_DECODERS: dict[bytes, Callable[[bytes, int, int, str], Element]] = {
    b"matf": _decode_matrix,
    b"clut": decode_table,
    b"xclt": decode_table,
    b"tint": decode_tint,
    b"XtoJ": decode_appearance,
    b"JtoX": decode_appearance,
}
"""Elements without others inside."""


def _decode_calculator(
    data: bytes, inputs: int, outputs: int, where: str, decode: Callable[[bytes, str], Element]
) -> Program:
    if len(data) < 24:
        raise ProgramError("the calculator has no main function", where=where)
    (count,) = struct.unpack_from(">I", data, 12)
    if 16 + ENTRY * (count + 1) > len(data):
        raise ProgramError(f"{count} sub-elements are claimed, more than fit", where=where)
    (start, size), *places = decode_places(data, 16, count + 1, where)
    body = decode_function(data[start : start + size], f"{where}, main function")
    # Entries at the same place share one element, as they do for the reference.
    elements = decode_parts(data, places, decode, "sub-element", where)
    return Program(inputs, outputs, body, elements)
