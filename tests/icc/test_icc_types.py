"""Tag types: to bytes and back, and what they refuse to write."""

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st
from icc_samples import COPY, META, NAMES

from brdfc.calc.program import Matrix, OpaqueElement
from brdfc.icc.types import (
    Dictionary,
    LocalizedText,
    NumberArray,
    Opaque,
    Pipeline,
    Signature,
    Utf8Array,
    Utf8Text,
    XYZArray,
    decode_tag,
)
from brdfc.source.errors import ProfileError

MATRIX = Matrix(3, 3, (1.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, -2.0), (0.0, 0.25, 0.0))
UNKNOWN = OpaqueElement("emtx", 3, 3, b"emtx" + bytes(4) + struct.pack(">HH", 3, 3) + b"curvy")
TAGS = {
    "mluc": LocalizedText((("enUS", "colour"), ("deDE", "Farbe"), ("enGB", "colour"))),
    "mluc without text": LocalizedText(()),
    "utf8": Utf8Text("reflectance ρ"),
    "utf8 empty": Utf8Text(""),
    "tary": NAMES,
    "tary empty": Utf8Array(()),
    "dict": META,
    "XYZ ": XYZArray(((0.5, 1.0, -0.25), (0.0, 1 / 65536, 32767.0))),
    "fl16": NumberArray("fl16", (0.5, -2.0, 65504.0)),
    "fl32": NumberArray("fl32", (0.5, 2.0**-149, -0.0)),
    "fl64": NumberArray("fl64", (0.1, 1e308)),
    "ui08": NumberArray("ui08", (0, 255)),
    "ui16": NumberArray("ui16", (0, 65535)),
    "ui32": NumberArray("ui32", (2**32 - 1,)),
    "ui64": NumberArray("ui64", (2**64 - 1,)),
    "sig ": Signature("mono"),
    "mpet": Pipeline(3, 3, (*COPY.elements, MATRIX)),
    "mpet unknown": Pipeline(3, 3, (UNKNOWN, MATRIX)),
    "mpet identity": Pipeline(4, 4, ()),
    "gbd ": Opaque(b"gbd " + bytes(9)),
}


@pytest.mark.parametrize("name", TAGS)
def test_there_and_back(name):
    tag = TAGS[name]
    data = tag.encode()
    read = decode_tag(data, "tag")
    assert read == tag or "unknown" in name  # elements are padded to 4 bytes
    assert read.encode() == data
    assert data.startswith(tag.type_signature.encode())
    assert name.startswith(read.type_signature)


def test_layout_of_localized_text():
    data = LocalizedText.english("x").encode()
    assert data.hex() == "6d6c756300000000000000010000000c656e5553000000020000001c0078"


def test_layout_of_names():
    data = Utf8Array(("ab", "c")).encode()
    assert data[:16] == b"tary\0\0\0\0utf8\0\0\0\2"
    assert struct.unpack(">4I", data[16:32]) == (32, 11, 44, 10)
    assert data[32:] == b"utf8\0\0\0\0ab\0\0utf8\0\0\0\0c\0\0\0"


def test_layout_of_a_dictionary():
    data = Dictionary((("a", "𝛾"), ("b", ""))).encode()
    assert data[:16] == b"dict" + struct.pack(">III", 0, 2, 16)
    assert struct.unpack(">8I", data[16:48]) == (48, 2, 52, 4, 56, 2, 60, 0)
    assert data[48:] == b"\0a\0\0" + "𝛾".encode("utf-16-be") + b"\0b\0\0"


@pytest.mark.parametrize("width", [24, 32])
def test_a_dictionary_with_display_names_is_read(width):
    head = b"dict" + struct.pack(">III", 0, 1, width)
    record = struct.pack(">4I", 16 + width, 2, 18 + width, 4).ljust(width, b"\0")
    read = decode_tag(head + record + "nvw".encode("utf-16-be"), "meta")
    assert read == Dictionary((("n", "vw"),))
    assert read.get("n") == "vw"
    assert read.get("v") is None


def test_a_text_prefers_english():
    assert TAGS["mluc"].text == "colour"
    assert LocalizedText((("deDE", "Farbe"), ("enUS", "colour"))).text == "colour"
    assert LocalizedText((("deDE", "Farbe"),)).text == "Farbe"
    assert LocalizedText(()).text == ""


def test_an_element_that_stands_twice_is_written_once():
    once, twice = Pipeline(3, 3, (MATRIX,)), Pipeline(3, 3, (MATRIX, MATRIX))
    assert len(twice.encode()) == len(once.encode()) + 8
    assert decode_tag(twice.encode(), "tag") == twice


def test_trailing_nuls_of_a_text_are_padding():
    assert decode_tag(b"utf8\0\0\0\0name\0\0\0\0", "tag") == Utf8Text("name")


def test_an_array_of_something_else_is_carried():
    data = b"tary\0\0\0\0cinf" + bytes(20)
    assert decode_tag(data, "tag") == Opaque(data)


def test_an_absent_entry_reads_as_an_empty_name():
    assert decode_tag(b"tary\0\0\0\0utf8\0\0\0\1" + bytes(8), "tag") == Utf8Array(("",))


@pytest.mark.parametrize(
    "tag",
    [
        Utf8Text("a\0b"),
        Utf8Text("\ud800"),
        Utf8Array(("a", "b\0")),
        LocalizedText.english("\ud800"),
        LocalizedText((("en", "no country"),)),
        Dictionary((("long", "x" * 201),)),
        Dictionary((("x" * 201, "long"),)),
        Dictionary((("escaped", "&" * 41),)),
        Dictionary((("utf-8", "ä" * 101),)),
        Dictionary((("nul", "a\0b"),)),
        NumberArray("fl32", (float("nan"),)),
        NumberArray("fl32", (float("inf"),)),
        NumberArray("fl32", (1e39,)),
        NumberArray("fl16", (1e6,)),
        NumberArray("ui08", (256,)),
        NumberArray("ui16", (0.5,)),
        XYZArray(((float("nan"), 0.0, 0.0),)),
        XYZArray(((32768.0, 0.0, 0.0),)),
        Signature("toolong"),
        Pipeline(65536, 3, ()),
    ],
    ids=repr,
)
def test_refused_on_writing(tag):
    with pytest.raises(ProfileError):
        tag.encode()


def test_a_long_dictionary_text_comes_with_advice():
    with pytest.raises(ProfileError, match="hint: split long text"):
        Dictionary((("formula", "x" * 500),)).encode()


texts = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=20)


@given(st.lists(texts, max_size=5), st.lists(st.floats(width=32, allow_nan=False)))
def test_any_text_and_any_finite_number_comes_back(names, numbers):
    finite = tuple(number for number in numbers if abs(number) != float("inf"))
    pairs = tuple(zip(names, reversed(names), strict=True))
    for tag in (
        Utf8Array(tuple(names)),
        Dictionary(pairs),
        LocalizedText(tuple(("enUS", name) for name in names)),
        NumberArray("fl32", finite),
    ):
        assert decode_tag(tag.encode(), "tag") == tag
