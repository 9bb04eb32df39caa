"""`svcn` and `tstr`: to bytes and back, their layout, and what they refuse."""

from __future__ import annotations

import struct
from dataclasses import replace

import pytest
from icc_samples import COPY

from brdfc.icc.header import SpectralRange
from brdfc.icc.types import (
    NumberArray,
    Opaque,
    Signature,
    SpectralViewingConditions,
    Structure,
    decode_tag,
)
from brdfc.source.errors import ProfileError

VIEWING = SpectralViewingConditions(
    observer=1,
    observer_range=SpectralRange(400, 700, 2),
    matching=(1.0, 2.0, 3.0, 4.0, 5.0, 6.0),
    illuminant=6,
    temperature=0.0,
    illuminant_range=SpectralRange(380, 780, 3),
    power=(0.5, 1.0, 0.25),
    white=(100.0, 200.0, 50.0),
    surround=(0.0, 0.0, 0.0),
)
BRDF = Structure(
    "brdf",
    {
        "type": Signature("War1"),
        "func": Signature("colr"),
        "nump": NumberArray("ui16", (3,)),
        "xfrm": COPY,
    },
)


@pytest.mark.parametrize(
    "tag", [VIEWING, BRDF, Structure("brdf", {}), Structure("outr", {"in  ": BRDF})]
)
def test_there_and_back(tag: SpectralViewingConditions | Structure) -> None:
    assert decode_tag(tag.encode(), "tag") == tag


def test_layout_of_viewing_conditions() -> None:
    data = VIEWING.encode()
    assert data[:12] == b"svcn\0\0\0\0\0\0\0\1"
    assert data[12:20].hex() == "5e40" + "6178" + "0002" + "0000"
    assert struct.unpack(">6f", data[20:44]) == VIEWING.matching
    assert struct.unpack(">If", data[44:52]) == (6, 0.0)
    assert data[52:60].hex() == "5df0" + "6218" + "0003" + "0000"
    assert struct.unpack(">9f", data[60:]) == (0.5, 1.0, 0.25, 100, 200, 50, 0, 0, 0)


def test_layout_of_a_structure() -> None:
    data = BRDF.encode()
    assert data[:16] == b"tstr\0\0\0\0brdf\0\0\0\4"
    assert struct.unpack(">4sII", data[16:28]) == (b"type", 64, 12)
    assert data[64:76] == b"sig \0\0\0\0War1"


@pytest.mark.parametrize(
    "changes",
    [
        {"matching": (1.0,)},
        {"power": ()},
        {"white": (float("nan"), 1.0, 1.0)},
        {"observer_range": SpectralRange(400, 1e6, 2)},
        {"power": (0.5, float("inf"), 0.25)},
    ],
)
def test_what_cannot_be_written(changes: dict[str, object]) -> None:
    with pytest.raises(ProfileError):
        replace(VIEWING, **changes).encode()  # type: ignore[arg-type]


@pytest.mark.parametrize("length", range(8, len(VIEWING.encode()), 3))
def test_truncated_conditions_are_refused(length: int) -> None:
    with pytest.raises(ProfileError, match="bytes where"):
        decode_tag(VIEWING.encode()[:length], "svcn")


def test_conditions_that_claim_more_than_there_is() -> None:
    data = bytearray(VIEWING.encode())
    data[16:18] = b"\xff\xff"
    with pytest.raises(ProfileError, match="bytes where"):
        decode_tag(bytes(data), "svcn")


def test_a_nan_among_the_spectra_is_refused() -> None:
    data = bytearray(VIEWING.encode())
    data[60:64] = struct.pack(">f", float("nan"))
    with pytest.raises(ProfileError, match="not a finite number"):
        decode_tag(bytes(data), "svcn")


def nested(depth: int) -> bytes:
    """Structures in structures."""
    data = Signature("mono").encode()
    for _ in range(depth):
        data = Structure("brdf", {"in  ": Opaque(data)}).encode()
    return data


def test_structures_nest_no_deeper_than_anyone_needs() -> None:
    assert isinstance(decode_tag(nested(8), "tag"), Structure)
    with pytest.raises(ProfileError, match="more than 8 deep"):
        decode_tag(nested(9), "tag")
    with pytest.raises(ProfileError, match="more than 8 deep"):
        decode_tag(nested(2000), "tag")


def test_a_structure_that_holds_itself_is_refused() -> None:
    data = bytearray(BRDF.encode())
    data[20:28] = struct.pack(">II", 0, len(data))
    with pytest.raises(ProfileError, match="overlaps"):
        decode_tag(bytes(data), "tag")


def test_members_beyond_the_end_are_refused() -> None:
    data = bytearray(BRDF.encode())
    data[12:16] = b"\xff\xff\xff\xff"
    with pytest.raises(ProfileError):
        decode_tag(bytes(data), "tag")
