"""Profiles that are damaged and can still be read: their XML gives them back."""

from __future__ import annotations

import struct

import pytest

from brdfc.calc.function import decode_block
from brdfc.calc.program import MAX_TEMPORARIES, Element, Op, OpaqueElement, Program
from brdfc.calc.text import assemble
from brdfc.icc import texts
from brdfc.icc.header import Header, SpectralRange
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import multiplex_space
from brdfc.icc.texts import Dictionary, Utf8Array
from brdfc.icc.types import Pipeline, decode_tag
from brdfc.source.errors import ProfileError
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


def test_reserved_words_that_are_not_0() -> None:
    for reserved in (1, 2**32 - 1):
        head = struct.pack(">4sIHH", b"emtx", reserved, 1, 3)
        same(OpaqueElement("emtx", 1, 3, head + bytes(32)))


def test_a_text_that_is_longer_than_brdfc_writes(monkeypatch: pytest.MonkeyPatch) -> None:
    """A file may hold it; it goes as bytes."""
    with monkeypatch.context() as patched:
        patched.setattr(texts, "DICTIONARY_TEXT_LIMIT", 1000)
        data = Dictionary((("long", "&" * 100),)).encode()
    found = decode_tag(data, "meta")
    with pytest.raises(ProfileError, match="is over 200"):
        found.encode()
    profile = Profile(Header("mvis"), {"meta": found})
    assert again(profile).tags == profile.tags


def test_a_spectral_range_of_minus_zeros() -> None:
    profile = Profile(Header("mvis", spectral_range=SpectralRange(-0.0, -0.0, 0)), {})
    assert again(profile).to_bytes(profile_id=False) == profile.to_bytes(profile_id=False)
