"""Profiles that are damaged and can still be read: their XML gives them back."""

from __future__ import annotations

import struct

import pytest

from brdfc.calc.binary import encode_element
from brdfc.calc.curves import CurveSet, OpaqueCurve
from brdfc.calc.function import decode_block
from brdfc.calc.program import MAX_TEMPORARIES, Element, Op, OpaqueElement, Program
from brdfc.calc.text import assemble
from brdfc.icc.header import Header, SpectralRange
from brdfc.icc.numbers import NumberArray
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import multiplex_space
from brdfc.icc.texts import Utf8Array
from brdfc.icc.types import Pipeline
from brdfc.xml.profile import from_xml, to_xml

LAST = MAX_TEMPORARIES - 1


def again(profile: Profile) -> Profile:
    return from_xml(to_xml(profile).encode(), "x.xml")


def same(*elements: Element) -> None:
    profile = Profile(Header("scnr"), {"A2B1": Pipeline(1, 1, elements)})
    assert again(profile).tags == profile.tags


def test_the_half_of_an_operand_that_is_not_used_means_nothing() -> None:
    word = b"sin ", struct.pack(">HH", 2, 7)
    assert decode_block([word], "x") == assemble("{ sin[3] }")


@pytest.mark.parametrize(
    "spans",
    [
        [(LAST, 1)],
        [(0, MAX_TEMPORARIES)],
        [(LAST, MAX_TEMPORARIES)],
        [(0, 2), (LAST, 2), (LAST - 1, 2)],
    ],
)
def test_temporaries_at_the_end_and_beyond(spans: list[tuple[int, int]]) -> None:
    same(Program(1, 1, tuple(Op("tget", *span) for span in spans)))


@pytest.mark.parametrize(("inputs", "outputs"), [(0, 0), (1, 3), (3, 2), (2, 3)])
def test_a_calculator_of_fewer_channels_than_have_names(inputs: int, outputs: int) -> None:
    program = Program(inputs, outputs, assemble("{ in[0,3] out[0,3] }"))
    tags = {"M2B0": Pipeline(3, 3, (program,)), "mcta": Utf8Array(("a", "b", "c"))}
    profile = Profile(Header("mvis", pcs=b"XYZ ", mcs=multiplex_space(3)), tags)
    assert again(profile).tags == profile.tags


@pytest.mark.parametrize("kind", ["emtx", "tint", "XtoJ"])
def test_reserved_words_that_are_not_0(kind: str) -> None:
    inside = NumberArray("fl32", (0, 1, 2)).encode() if kind == "tint" else bytes(32)
    for reserved in (1, 2**32 - 1):
        head = struct.pack(">4sIHH", kind.encode(), reserved, 1, 3)
        same(OpaqueElement(kind, 1, 3, head + inside))


def test_reserved_words_and_bytes_after_the_end_of_an_array() -> None:
    head = struct.pack(">4sIHH", b"tint", 0, 1, 1)
    same(OpaqueElement("tint", 1, 1, head + b"fl32" + struct.pack(">I2f", 5, 0, 1)))


@pytest.mark.parametrize(
    "fields",
    [
        (0, 9, float("nan"), 1.0, 0, 0),
        (0, 9, 0.0, float("inf"), 0, 0),
        (0, 9, 0.0, 1.0, 256, 0),
        (3, 9, 0.0, 1.0, 0, 0),
        (0, 9, 0.0, 1.0, 0, 3),
    ],
)
def test_a_carried_curve_whose_fields_make_no_sense(fields: tuple[float, ...]) -> None:
    head = struct.pack(">4sIIffHH", b"clcf", *fields)
    curve = OpaqueCurve(head + encode_element(Program(1, 1, assemble("{ in out }"))))
    same(CurveSet((curve,)))


def test_a_carried_curve_whose_calculator_is_laid_out_otherwise() -> None:
    inner = encode_element(Program(1, 1, assemble("{ in out }"))) + bytes(8)
    same(CurveSet((OpaqueCurve(struct.pack(">4sIIffHH", b"clcf", 0, 9, 0, 1, 0, 0) + inner),)))


def test_a_spectral_range_of_minus_zeros() -> None:
    profile = Profile(Header("mvis", spectral_range=SpectralRange(-0.0, -0.0, 0)), {})
    assert again(profile).to_bytes(profile_id=False) == profile.to_bytes(profile_id=False)
