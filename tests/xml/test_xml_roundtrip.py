"""Profile to XML and back gives the same bytes; and the reference's names are what is written."""

from __future__ import annotations

import math
import struct
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import brdfc
from brdfc.calc.appearance import AppearanceTransform
from brdfc.calc.calculator_curves import CalculatorCurve
from brdfc.calc.curves import (
    CurveSet,
    FormulaSegment,
    SampledCurve,
    SampledSegment,
    SegmentedCurve,
)
from brdfc.calc.program import Element, Matrix, OpaqueElement, Program
from brdfc.calc.samples import Samples, Storage
from brdfc.calc.tables import LookupTable
from brdfc.calc.text import assemble
from brdfc.calc.tints import TintArray
from brdfc.icc.header import D50, Header, SpectralRange
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import multiplex_space, n_channel_space
from brdfc.icc.types import (
    CompressedText,
    Curve,
    Dictionary,
    FixedArray,
    LocalizedText,
    NumberArray,
    Opaque,
    ParametricCurve,
    Pipeline,
    PlainText,
    Record,
    Signature,
    SpectralViewingConditions,
    Structure,
    Tag,
    TextDescription,
    Utf8Array,
    Utf8Text,
    XYZArray,
    decode_tag,
)
from brdfc.source.errors import ProfileError
from brdfc.xml.profile import encoded, from_xml, to_xml

FLOATS = st.floats(width=32, allow_nan=False, allow_infinity=False)


DATE = ("year", "month", "day", "hour", "minute", "second")


def again(profile: Profile) -> Profile:
    return from_xml(to_xml(profile).encode(), "x.xml")


def holding(*tags: Tag, **header: object) -> Profile:
    """A profile of private tags."""
    fields = {"colour_space": n_channel_space(3), "pcs": b"XYZ "} | header
    return Profile(Header("scnr", **fields), {f"tag{i}": tag for i, tag in enumerate(tags)})  # type: ignore[arg-type]


def transform(*elements: Element) -> Profile:
    return holding(Pipeline(elements[0].inputs, elements[-1].outputs, elements))


def same(profile: Profile) -> None:
    read = again(profile)
    assert dict(read.tags) == dict(profile.tags)
    assert read.to_bytes() == profile.to_bytes()


# ---------------------------------------------------------------- what brdfc writes


@pytest.mark.parametrize(
    "how",
    [
        {},
        {"conditions": "lamp"},
        {"spectral": "400nm..700nm,50nm"},
        {"encode": "ncolour"},
        {"encode": "brdf-function"},
        {"encode": "brdf-struct"},
        {
            "encode": "clut:3",
            "max_error": "99dE",
            "set": {"incident": "40deg", "reflection": "0deg"},
        },
        {
            "encode": "curve:33",
            "max_error": "99dE",
            "set": {"incident": "40deg", "reflection": "0deg"},
        },
    ],
    ids=str,
)
def test_everything_that_is_compiled(how: dict[str, object], tmp_path: Path) -> None:
    options = dict(how)
    geometry = "full" if options.get("encode") == "brdf-function" else None
    if options.get("conditions"):
        from brdfc.colour.conditions import viewing_conditions

        options["conditions"] = viewing_conditions(white=(0.97, 1.0, 0.484))
    model = brdfc.load("ward", geometry, options.pop("spectral", None))  # type: ignore[arg-type]
    made = brdfc.compile(model, effort=1, **options)  # type: ignore[arg-type]
    for path in made.save(tmp_path / "x_mvis.icc"):
        profile = Profile.load(path)
        assert encoded(again(profile)) == path.read_bytes()


# ---------------------------------------------------------------- elements


def test_numbers_keep_every_bit() -> None:
    values = (math.pi, 1e-45, -3.4028234663852886e38, 0.1, -0.0, 1 / 3)
    values = tuple(struct.unpack("f", struct.pack("f", v))[0] for v in values)
    read = again(transform(Matrix(3, 2, values, (1e-30, -0.0))))
    (matrix,) = read.tags["tag0"].elements  # type: ignore[union-attr]
    packed = struct.pack("8f", *values, 1e-30, -0.0)
    assert struct.pack("8f", *matrix.values, *matrix.offsets) == packed  # type: ignore[attr-defined]


@given(st.lists(FLOATS, min_size=3, max_size=3))
def test_any_numbers(values: list[float]) -> None:
    same(transform(Matrix(3, 1, tuple(values), (0.0,)), Matrix(1, 3, tuple(values), tuple(values))))


@pytest.mark.parametrize("storage", list(Storage))
def test_tables(storage: Storage) -> None:
    samples = Samples.of([i / 17 for i in range(18)], storage)
    same(transform(LookupTable(2, 3, (2, 3), samples, extended=True)))


def test_curves() -> None:
    samples = Samples.of([0.1, 0.25, 1 / 3])
    segments = (
        FormulaSegment(0, (2.5, 1.0, 0.0, 0.0)),
        SampledSegment(samples),
        FormulaSegment(6, (1.0, 1.0, 0.5, 0.25, 1.0, 2.0, 0.125)),
    )
    first = SegmentedCurve((0.0, 0.75), segments)
    calculator = Program(1, 1, assemble("{ in sq out }"))
    for curve in (
        SampledCurve(-1.0, 2.0, Samples.of([0, 1], Storage.UINT8), extend=True),
        SampledCurve(0.0, 1.0, Samples.of([0, 0.5, 1], Storage.FLOAT16)),
        CalculatorCurve(64, 0.0, 1.0, calculator, extend=True),
    ):
        same(transform(CurveSet((first, curve, first))))


def carried(kind: str, data: bytes) -> OpaqueElement:
    head = struct.pack(">4sIHH", kind.encode(), 0, 1, 1)
    return OpaqueElement(kind, 1, 1, head + data)


@pytest.mark.parametrize(
    ("element", "tag"),
    [
        (AppearanceTransform("XtoJ", D50, 80.0, 20.0, 0.6875, 1.0, 1.0), "XYZToJabElement"),
        (AppearanceTransform("JtoX", D50, 80.0, 20.0, 0.6875, 1.0, 1.0), "JabToXYZElement"),
        *((TintArray(2, Samples.of([0, 0.25, 0.5, 1], s)), "TintArrayElement") for s in Storage),
        (carried("tint", NumberArray("fl64", (0.1, 1 / 3)).encode()), "TintArrayElement"),
        (carried("tint", b"what"), "UnknownElement"),
        (carried("emtx", bytes(range(50))), "UnknownElement"),
    ],
    ids=lambda value: getattr(value, "signature", value),
)
def test_elements_of_other_kinds(element: Element, tag: str) -> None:
    profile = transform(element)
    assert f"<{tag} " in to_xml(profile)
    same(profile)


def test_calculators_and_their_sub_elements() -> None:
    inner = Program(1, 1, assemble("{ in sq out }"))
    matrix = Matrix(1, 1, (2.0,), (1.0,))
    body = assemble(
        "{ in[0,3] rotl(3,1) rotr(3,2) tput[4,3] tget[4] calc(0) mtx(1) 0.1 1e-20 posd(2,3) "
        "env(inci) if { } else { pop 0.5 } tsav[9] sel case { 1 } case { } dflt { 2 tput[5] } "
        "env(00017fff) pop pop pop pop +INF -INF NaN pop(3) tget[4,3] out[0,3] }"
    )
    profile = transform(Program(3, 3, body, (inner, matrix)))
    text = to_xml(profile)
    assert '<Declare Name="t4" Size="3" Position="4"/>' in text
    assert '<Declare Name="t9" Position="9"/>' in text
    assert "tput{t5" not in text
    assert "tput{t4[1]}" in text
    assert "rotl(3,1) rotr(3,2)" in text
    same(profile)


def test_a_shared_element_is_written_where_it_stands() -> None:
    element = Program(1, 1, assemble("{ in out }"))
    read = again(transform(element, element))
    assert read.tags["tag0"] == Pipeline(1, 1, (element, element))


# ---------------------------------------------------------------- tags and header


TAGS: dict[str, Tag] = {
    "text": LocalizedText((("enUS", "α < β & ]]> \r\n\t 'q' \"d\" "), ("deDE", ""))),
    "text that XML cannot hold": LocalizedText.english("a\x01b"),
    "utf8": Utf8Text("  with space around  "),
    "names": Utf8Array(("a", "", "Process Cyan", "𝛾")),
    "names that XML cannot hold": Utf8Array(("a\x02",)),
    "dictionary": Dictionary((("a\nb", "\tc\r"), ("", "<&'\">"))),
    "colours": XYZArray((D50, (-1.5, 32768 - 2**-16, 2**-16))),
    "signature": Signature("War0"),
    "no signature": Signature(""),
    "odd signature": Signature("\x00a\xff "),
    "halves": NumberArray("fl16", (0.5, 65504.0)),
    "floats": NumberArray("fl32", (struct.unpack("f", struct.pack("f", 0.1))[0], -0.0)),
    "doubles": NumberArray("fl64", (0.1, math.pi, 5e-324)),
    "whole numbers": NumberArray("ui64", (0, 2**64 - 1)),
    "no numbers": NumberArray("ui08", ()),
    "conditions": SpectralViewingConditions(
        observer=2,
        observer_range=SpectralRange(400, 700, 2),
        matching=(0.5,) * 6,
        illuminant=9,
        temperature=2856.0,
        illuminant_range=SpectralRange(),
        power=(),
        white=(96.5, 100.0, 82.5),
        surround=(0.0, 0.0, 0.0),
    ),
    "unknown codes": SpectralViewingConditions(
        observer=77,
        observer_range=SpectralRange(),
        matching=(),
        illuminant=2**32 - 1,
        temperature=0.0,
        illuminant_range=SpectralRange(0.0, 1.5, 0),
        power=(),
        white=(0.0, 0.0, 0.0),
        surround=(0.0, 0.0, 0.0),
    ),
    "structure": Structure("brdf", {"type": Signature("War0"), "nump": NumberArray("ui16", (3,))}),
    "nested structure": Structure(
        "a\x01cd", {"in  ": Structure("efgh", {"ab\xffd": Utf8Text("b")})}
    ),
    "carried": Opaque(b"ncpi" + bytes(4) + struct.pack(">IH", 1, 0x0233)),
    "curve": Curve(gamma=2.25),
    "curve, identity": Curve(),
    "curve, samples": Curve(samples=Samples.of([i / 40 for i in range(40)], Storage.UINT16)),
    "parametric curve": ParametricCurve(3, (2.4000091552734375, 1 / 65536, -0.5, 0.25, 32767.0)),
    "fixed": FixedArray("sf32", (1.0, -1 / 65536, 0.5) * 5),
    "fixed, positive": FixedArray("uf32", (65535.0, 1 / 65536)),
    "plain text": PlainText("  a <b> & é "),
    "plain text that XML cannot hold": PlainText("a\x01b"),
    "description": TextDescription("a", "ä 𝛾", 7, b"a\0\xff", 0x1F),
    "description, ASCII only": TextDescription("a"),
    "compressed": CompressedText("zut8", bytes(range(40))),
    "compressed XML": CompressedText("ZXML", b""),
    "date": Record("dtim", dict(zip(DATE, (24, 2, 9, 0, 59, 60000), strict=True))),
    "video": Record("cicp", {"primaries": 9, "transfer": 16, "matrix": 0, "full_range": 255}),
    "order": Record("clro", {}, ((2,), (0,), (1,))),
    "data": Record("data", {"flag": 1}, payload=b"\0\1"),
    "data, neither kind": Record("data", {"flag": 2}, payload=b"\0\1"),
    "table": Opaque(b"rcs2" + bytes(9)),
    "identity": Pipeline(3, 3, ()),
}


def test_bytes_beyond_the_fields_stay() -> None:
    """A tag of version 2 with filling that no field stands for goes as bytes."""
    data = TextDescription("Ward").encode()[:-67] + b"\xaa" * 67
    same(holding(decode_tag(data, "tag"), decode_tag(TextDescription("Ward").encode(), "tag")))
    text = to_xml(holding(decode_tag(data, "tag")))
    assert "<PrivateType" in text
    assert "<textDescriptionType>" in to_xml(holding(TextDescription("Ward")))


def test_curves_as_the_reference_writes_them() -> None:
    text = to_xml(holding(Curve(gamma=2.25), ParametricCurve(0, (2.5,))))
    assert "<curveType>\n        <Curve>\n          576\n" in text
    assert '<ParametricCurve FunctionType="0">\n          2.5\n' in text
    ramp = to_xml(holding(Curve(gamma=2.25))).replace("<Curve>", '<Curve IdentitySize="3">')
    (tag,) = from_xml(ramp.encode(), "x.xml").tags.values()
    assert tag == Curve(samples=Samples.of((0, 0.5, 1), Storage.UINT16))


@pytest.mark.parametrize("name", TAGS)
def test_tags(name: str) -> None:
    same(holding(TAGS[name]))


def test_shared_tags_stay_shared() -> None:
    tag = LocalizedText.english("once")
    member = Signature("abcd")
    profile = holding(tag, tag, Structure("brdf", {"type": member, "func": member}))
    profile = replace(profile, tags={"desc": tag, **profile.tags})
    same(profile)
    read = again(profile)
    assert read.tags["tag0"] is read.tags["desc"] is read.tags["tag1"]


def test_every_field_of_the_header() -> None:
    header = Header(
        "mvis",
        colour_space=b"\x01\x02\x03\x04",
        pcs=b"Lab ",
        mcs=multiplex_space(300),
        spectral_pcs=b"rs\x00\x1f",
        spectral_range=SpectralRange(400, 700, 31),
        bispectral_range=SpectralRange(360.5, 400, 3),
        version=0x05100203,
        creation_date=(2021, 12, 31, 23, 59, 58),
        flags=0x00030005,
        attributes=0x0000000A0000000D,
        rendering_intent=3,
        illuminant=(0.5, 1.0, 1.5),
        cmm="ABCD",
        platform="APPL",
        manufacturer="a b ",
        model="\x00\x01\x02\x03",
        creator="<&'\"",
        device_subclass="osim",
        reserved=0x01020304,
    )
    profile = Profile(header, {})
    assert again(profile).header == header
    assert again(replace(profile, header=replace(header, rendering_intent=9))).header != header
    assert encoded(again(profile)) == profile.to_bytes(profile_id=False)


def test_what_the_multiplex_channels_are_called_names_the_calculator() -> None:
    program = Program(5, 3, assemble("{ in[0,3] in[3] in[4] mul smul[3] in[1] pop out[0,3] }"))
    names = Utf8Array(("Rdx", "Rdy", "Rdz", "Process Cyan", "1st"))
    header = Header("mvis", pcs=b"XYZ ", mcs=multiplex_space(5))
    profile = Profile(header, {"M2B0": Pipeline(5, 3, (program,)), "mcta": names})
    text = to_xml(profile)
    assert 'InputNames="Rd[3] Process_Cyan _1st" OutputNames="XYZ[3]"' in text
    assert "in{Rd} in{Process_Cyan} in{_1st} mul smul[3] in{Rd[1]} pop out{XYZ}" in text
    same(profile)


def test_a_tag_that_cannot_be_written_is_named() -> None:
    with pytest.raises(ProfileError) as caught:
        to_xml(holding(Dictionary((("a\0b", "c"),))))
    assert str(caught.value) == "tag 'tag0': a text with a NUL inside: 'a\\x00b'"


def test_a_tag_without_a_signature_and_a_comment_that_xml_cannot_hold() -> None:
    entries = [("env.1", "a--\x01b"), ("env.1.type", "number"), ("env.1.range", "0..1")]
    entries += [("env.1.default", "0"), ("env.1.signature", "abcd")]
    tags: dict[str, Tag] = {"": Pipeline(3, 3, ()), "meta": Dictionary(tuple(entries))}
    profile = replace(holding(), tags=tags)
    assert "<!-- env(abcd): a- -?b in 0..1,  -->" in to_xml(profile)
    same(profile)
