"""Tag types: what a tag's bytes are, by the signature they begin with.

Each type is a frozen value with encode and decode side by side. Types that brdfc has no use for
are carried as they are (Opaque).
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from brdfc.calc.binary import decode_element, encode_element
from brdfc.calc.program import Element
from brdfc.icc.curves import Curve, ParametricCurve
from brdfc.icc.layout import profile_errors, read_parts, unpack, unpack_records, write_parts
from brdfc.icc.luts import StagedLut, TableLut
from brdfc.icc.numbers import NUMBER_FORMATS, NumberArray, Signature, XYZArray
from brdfc.icc.signatures import signature_text
from brdfc.icc.structures import Structure
from brdfc.icc.texts import Dictionary, LocalizedText, Utf8Array, Utf8Text
from brdfc.icc.viewing import SpectralViewingConditions
from brdfc.source.errors import ProfileError

__all__ = [
    "Curve",
    "Dictionary",
    "LocalizedText",
    "NumberArray",
    "Opaque",
    "ParametricCurve",
    "Pipeline",
    "Signature",
    "SpectralViewingConditions",
    "StagedLut",
    "Structure",
    "TableLut",
    "Tag",
    "Utf8Array",
    "Utf8Text",
    "XYZArray",
    "decode_tag",
]


@dataclass(frozen=True)
class Pipeline:
    """`mpet`: elements applied one after the other; without elements, the identity.

    An element that stands twice as the same object is written once.
    """

    type_signature: ClassVar[str] = "mpet"
    inputs: int
    outputs: int
    elements: tuple[Element, ...]

    def encode(self) -> bytes:
        places, body = write_parts(
            self.elements, encode_element, key=id, start=16 + 8 * len(self.elements)
        )
        try:
            head = struct.pack(">4sIHHI", b"mpet", 0, self.inputs, self.outputs, len(self.elements))
        except struct.error as error:
            raise ProfileError(f"{self.inputs} or {self.outputs} channels: {error}") from error
        return head + b"".join(struct.pack(">II", *place) for place in places) + body

    @staticmethod
    def decode(data: bytes, where: str) -> Pipeline:
        inputs, outputs, count = unpack("HHI", data, 8, where)
        places = unpack_records("II", count, data, 16, where)
        labels = [f"element {index}" for index in range(count)]
        elements = read_parts(data, places, labels, 16 + 8 * count, where, _element)
        return Pipeline(inputs, outputs, tuple(elements))


def _element(data: bytes, where: str) -> Element:
    with profile_errors():
        return decode_element(data, where)


@dataclass(frozen=True)
class Opaque:
    """A type that is carried, not understood: its bytes from the type signature on."""

    data: bytes

    @property
    def type_signature(self) -> str:
        return signature_text(self.data[:4])

    def encode(self) -> bytes:
        return self.data


Tag = (
    LocalizedText
    | Utf8Text
    | Utf8Array
    | Dictionary
    | NumberArray
    | XYZArray
    | Signature
    | Pipeline
    | SpectralViewingConditions
    | Structure
    | Curve
    | ParametricCurve
    | TableLut
    | StagedLut
    | Opaque
)


def _array(data: bytes, where: str) -> Tag:
    """Arrays of other things than utf8 are carried."""
    if unpack("4s", data, 8, where)[0] == b"utf8":
        return Utf8Array.decode(data, where)
    return Opaque(data)


DECODERS: dict[bytes, Callable[[bytes, str], Tag]] = {
    b"mluc": LocalizedText.decode,
    b"utf8": Utf8Text.decode,
    b"tary": _array,
    b"dict": Dictionary.decode,
    b"XYZ ": XYZArray.decode,
    b"sig ": Signature.decode,
    b"mpet": Pipeline.decode,
    b"curv": Curve.decode,
    b"para": ParametricCurve.decode,
    b"mft1": TableLut.decode,
    b"mft2": TableLut.decode,
    b"mAB ": StagedLut.decode,
    b"mBA ": StagedLut.decode,
    b"svcn": SpectralViewingConditions.decode,
    **{kind.encode(): NumberArray.decode for kind in NUMBER_FORMATS},
}


MAX_DEPTH = 8
"""Structures in structures: the format's own go two deep."""


def decode_tag(data: bytes, where: str, depth: int = 0) -> Tag:
    """A tag from exactly its bytes; depth: how many structures it stands in."""
    if len(data) < 8:
        raise ProfileError(f"{len(data)} bytes are too few for a tag type", where=where)
    if data[:4] == b"tstr":
        if depth == MAX_DEPTH:
            raise ProfileError(f"structures more than {MAX_DEPTH} deep in another", where=where)
        return Structure.decode(data, where, lambda part, at: decode_tag(part, at, depth + 1))
    decode = DECODERS.get(data[:4])
    return decode(data, where) if decode else Opaque(data)
