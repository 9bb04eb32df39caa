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
from brdfc.icc.arrays import TagArray
from brdfc.icc.colorants import NamedColours
from brdfc.icc.curves import Curve, ParametricCurve
from brdfc.icc.gamut import GamutBoundary
from brdfc.icc.layout import profile_errors, read_parts, unpack, unpack_records, write_parts
from brdfc.icc.luts import StagedLut, TableLut
from brdfc.icc.numbers import NUMBER_FORMATS, FixedArray, NumberArray, Signature, XYZArray
from brdfc.icc.plain_texts import CompressedText, PlainText, TextDescription
from brdfc.icc.records import RECORDS, Record
from brdfc.icc.sequences import ProfileIdentifiers, ProfileSequence
from brdfc.icc.signatures import signature_text
from brdfc.icc.structures import Structure
from brdfc.icc.tag import Tag
from brdfc.icc.texts import Dictionary, LocalizedText, Utf8Array, Utf8Text
from brdfc.icc.viewing import SpectralViewingConditions
from brdfc.source.errors import ProfileError

__all__ = [
    "CompressedText",
    "Curve",
    "Dictionary",
    "FixedArray",
    "GamutBoundary",
    "LocalizedText",
    "NamedColours",
    "NumberArray",
    "Opaque",
    "ParametricCurve",
    "Pipeline",
    "PlainText",
    "ProfileIdentifiers",
    "ProfileSequence",
    "Record",
    "Signature",
    "SpectralViewingConditions",
    "StagedLut",
    "Structure",
    "TableLut",
    "Tag",
    "TagArray",
    "TextDescription",
    "Utf8Array",
    "Utf8Text",
    "XYZArray",
    "decode_tag",
]


@dataclass(frozen=True)
class Pipeline(Tag):
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
class Opaque(Tag):
    """A type that is carried, not understood: its bytes from the type signature on."""

    data: bytes

    @property
    def type_signature(self) -> str:
        return signature_text(self.data[:4])

    def encode(self) -> bytes:
        return self.data


DECODERS: dict[bytes, Callable[[bytes, str], Tag]] = {
    b"mluc": LocalizedText.decode,
    b"utf8": Utf8Text.decode,
    **dict.fromkeys((b"zut8", b"zxml", b"ZXML"), CompressedText.decode),
    b"text": PlainText.decode,
    b"desc": TextDescription.decode,
    b"dict": Dictionary.decode,
    b"XYZ ": XYZArray.decode,
    b"sf32": FixedArray.decode,
    b"uf32": FixedArray.decode,
    b"sig ": Signature.decode,
    b"mpet": Pipeline.decode,
    b"curv": Curve.decode,
    b"para": ParametricCurve.decode,
    b"mft1": TableLut.decode,
    b"mft2": TableLut.decode,
    b"mAB ": StagedLut.decode,
    b"mBA ": StagedLut.decode,
    b"ncl2": NamedColours.decode,
    b"pseq": ProfileSequence.decode,
    b"psid": ProfileIdentifiers.decode,
    b"gbd ": GamutBoundary.decode,
    b"svcn": SpectralViewingConditions.decode,
    **{kind.encode(): NumberArray.decode for kind in NUMBER_FORMATS},
    **{kind.encode(): Record.decode for kind in RECORDS},
}
"""Types that hold no tags, and of which every tag is read the same way."""


MAX_DEPTH = 8
"""Structures and arrays in one another: the format's own go three deep."""


def decode_tag(data: bytes, where: str, depth: int = 0) -> Tag:
    """A tag from exactly its bytes; depth: how many structures and arrays it stands in."""
    if len(data) < 8:
        raise ProfileError(f"{len(data)} bytes are too few for a tag type", where=where)
    if data[:4] in (b"tstr", b"tary"):
        if depth == MAX_DEPTH:
            raise ProfileError(f"structures more than {MAX_DEPTH} deep in another", where=where)
        tag = _composite(data, where, lambda part, at: decode_tag(part, at, depth + 1))
    else:
        decode = DECODERS.get(data[:4])
        tag = decode(data, where) if decode else Opaque(data)
    object.__setattr__(tag, "read_from", data)
    return tag


def _composite(data: bytes, where: str, inner: Callable[[bytes, str], Tag]) -> Tag:
    if data[:4] == b"tstr":
        return Structure.decode(data, where, inner)
    if unpack("4s", data, 8, where)[0] == b"utf8":
        return Utf8Array.decode(data, where)
    return TagArray.decode(data, where, inner)
