"""The types of versions 2 and 4: there and back, their layouts, and what is refused."""

import struct
import zlib
from dataclasses import replace

import pytest
from icc_samples import patched
from icc_types import COLORANT, ODD, TYPES

from brdfc.calc.samples import Samples
from brdfc.icc.plain_texts import INFLATED_LIMIT
from brdfc.icc.sequences import ProfileDescription
from brdfc.icc.types import (
    CompressedText,
    FixedArray,
    LocalizedText,
    PlainText,
    Record,
    TagArray,
    TextDescription,
    decode_tag,
)
from brdfc.source.errors import ProfileError


@pytest.mark.parametrize("name", TYPES)
def test_there_and_back(name):
    tag = TYPES[name]
    data = tag.encode()
    read = decode_tag(data, "tag")
    assert read == tag
    assert read.encode() == data
    assert name.startswith(read.type_signature)


def layout(name: str) -> str:
    return TYPES[name].encode()[8:].hex(" ", -4)


def test_layouts():
    """Bytes written out by hand from the specification's tables."""
    assert layout("sf32") == "00010000 ffff8000 00000001 80000000"
    assert TYPES["text"].encode() == b"text\0\0\0\0targets: \xe9\0"
    assert layout("dtim") == "07e80002 001d0017 003b003c"
    assert layout("meas") == "00000001 00008000 00010000 ffffc000 00000002 00000001 00000008"
    assert layout("cicp") == "09100001"
    assert layout("chrm") == "00020001 0000a000 00004000 00000001 00008000"
    assert layout("clro") == "00000003 0200ff"
    assert TYPES["clrt"].encode()[8:] == struct.pack(
        ">I32s3H32s3H", 2, b"Cyan", 1, 2, 65535, b"Orange", 0, 0, 0
    )
    assert TYPES["ncl2"].encode()[8:] == struct.pack(
        ">3I32s32s32s7H32s7H",
        *(0x80000001, 2, 4, b"PX ", b" C"),
        *(b"Orange", 1, 2, 3, 4, 5, 6, 65535),
        *(b"Green", *[0] * 7),
    )
    assert layout("gbd  without device") == "00030000 00000000 00000000"


def test_layout_of_a_description():
    data = TYPES["desc"].encode()
    wide = "Wärd 𝛾\0".encode("utf-16-be")
    assert data == (
        b"desc"
        + struct.pack(">II5sII", 0, 5, b"Ward", 7, len(wide) // 2)
        + wide
        + struct.pack(">HB67s", 3, 5, b"W\x8ard")
    )


def test_a_description_may_end_after_any_of_its_parts():
    data = TextDescription("Ward", "W", 7, b"xy", 1).encode()
    assert decode_tag(data[:17], "tag") == TextDescription("Ward")
    assert decode_tag(data[:29], "tag") == TextDescription("Ward", "W", 7)
    assert decode_tag(data[:34], "tag") == TextDescription("Ward", "W", 7, b"xy", 1)


def test_a_sequence_is_read_with_and_without_padding():
    """The format does not say whether a text inside is padded; writers differ."""
    head, odd = b"pseq" + struct.pack(">II", 0, 2), ODD.encode()
    record = struct.pack(">4s4sQ4s", b"appl", b"mod1", 1, b"vidm")
    packed = decode_tag(head + (record + odd + odd) * 2, "tag")
    padded = decode_tag(head + (record + odd + b"\0\0" + odd + b"\0\0") * 2, "tag")
    assert packed == padded
    assert packed.profiles == (ProfileDescription("appl", "mod1", 1, "vidm", ODD, ODD),) * 2


def test_entries_are_shared_as_they_were():
    read = decode_tag(TYPES["tary"].encode(), "tag")
    assert read.entries[0] is read.entries[2]
    assert read.entries[1] is None


def test_a_compressed_text_is_inflated_when_asked():
    assert TYPES["zut8"].text == "spectra ρ"
    with pytest.raises(ProfileError, match="no compressed text"):
        _ = TYPES["zxml"].text
    with pytest.raises(ProfileError, match="ends within"):
        _ = CompressedText("zut8", zlib.compress(b"x" * 100)[:-4]).text
    bomb = zlib.compress(bytes(INFLATED_LIMIT + 1))
    with pytest.raises(ProfileError, match="goes on beyond"):
        _ = CompressedText("zut8", bomb).text


def of(name: str, offset: int, form: str, *values: object) -> bytes:
    """A good tag with fields put over its bytes."""
    return patched(TYPES[name].encode(), offset, form, *values)


def nested(count: int) -> bytes:
    tag = COLORANT
    for _ in range(count):
        tag = TagArray("cinf", (tag,))
    return tag.encode()


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (TYPES["sf32"].encode()[:-1], "no whole count of 'sf32'"),
        (b"text\0\0\0\0abc", "no terminating NUL"),
        (of("desc", 8, "I", 2**32 - 1), "are needed"),
        (of("desc", 21, "I", 2**31), "UTF-16 codes"),
        (b"desc" + bytes(4), "12 are needed"),
        (TYPES["dtim"].encode()[:-1], "20 are needed"),
        (of("ehim", 16, "f", float("nan")), "minimum: a value is not a finite number"),
        (of("ehim", 20, "f", float("-inf")), "maximum: a value is not a finite number"),
        (TYPES["enim"].encode()[:12], "16 are needed"),
        (of("chrm", 8, "H", 3), "3 rows of 8 bytes"),
        (of("clro", 8, "I", 2**32 - 1), "more than 65536"),
        (of("clro", 8, "I", 65536), "65536 rows"),
        (of("clrt", 8, "I", 3), "3 rows of 38 bytes"),
        (of("clrt", 12, "32s", b"x" * 32), "row 0, name: a name without a terminating NUL"),
        (of("ncl2", 12, "I", 2**32 - 1), "more than 65536"),
        (of("ncl2", 12, "I", 3), "3 entries of 46 bytes"),
        (of("ncl2", 16, "I", 5), "2 entries of 48 bytes"),
        (of("ncl2", 16, "I", 2**32 - 1), "4294967295 device coordinates"),
        (of("ncl2", 20, "32s", b"x" * 32), "prefix: a name without"),
        (of("pseq", 8, "I", 3), "profile 2"),
        (of("pseq", 8, "I", 2**32 - 1), "more than 65536"),
        (of("pseq", 32, "4s", b"text"), "profile 0: "),
        (of("pseq", 32 + 8, "I", 60_000), "profile 0: 60000 entries"),
        (of("pseq", 32 + 20, "I", 2**32 - 1), "takes bytes"),
        (of("psid", 8, "I", 2**32 - 1), "more than 65536"),
        (of("psid", 12, "I", 4), "profile 0 at byte 4 overlaps"),
        (of("psid", 16, "I", 2**32 - 4), "past the end"),
        (of("psid", 28 + 16, "4s", b"text"), "no 'mluc' after the profile ID"),
        (of("gbd ", 12, "I", 2**32 - 1), "numbers (FLOAT32) are claimed"),
        (of("gbd ", 16, "I", 2**32 - 1), "4294967295 triangles"),
        (of("gbd ", 20, "I", 4), "a triangle of vertex 4, of 4"),
        (of("gbd ", 8, "H", 65535), "numbers (FLOAT32) are claimed"),
        (of("gbd ", 44, "f", float("nan")), "NaN or infinite"),
        (of("tary", 12, "I", 2**32 - 1), "more than 65536"),
        (of("tary", 16, "I", 0), "entry 0 at byte 0 overlaps"),
        (of("tary", 20, "I", 2**32 - 1), "entry 0 takes bytes"),
        (of("tary", 48, "4s", b"curv"), "entry 0"),
        (nested(9), "more than 8 deep"),
    ],
)
def test_refused(data, message):
    with pytest.raises(ProfileError) as caught:
        decode_tag(data, "tag 'what'")
    assert message in str(caught.value)
    assert str(caught.value).startswith("tag 'what'")


def changed(name: str, **values: object) -> Record:
    tag = TYPES[name]
    return replace(tag, values={**tag.values, **values})


NCL2, GBD = TYPES["ncl2"], TYPES["gbd "]


@pytest.mark.parametrize(
    "tag",
    [
        FixedArray("sf32", (32768.0,)),
        FixedArray("uf32", (-1.0,)),
        FixedArray("uf32", (float("nan"),)),
        PlainText("α"),
        PlainText("a\0b"),
        TextDescription("α"),
        TextDescription("", script=bytes(68)),
        TextDescription("", language=-1),
        changed("dtim", year=65536),
        changed("meas", flare=float("nan")),
        changed("meas", backing=(1.0, 2.0)),
        changed("meas", what=1),
        changed("ehim", minimum=float("inf")),
        replace(TYPES["clrt"], rows=(("x" * 32, (0, 0, 0)),)),
        replace(TYPES["clrt"], rows=(("x", (0, 0)),)),
        replace(TYPES["clro"], rows=((256,),)),
        replace(TYPES["dtim"], rows=((1,),)),
        replace(TYPES["dtim"], payload=b"x"),
        replace(NCL2, coordinates=3),
        replace(NCL2, coordinates=256),
        replace(NCL2, prefix="α"),
        replace(GBD, vertices=5),
        replace(GBD, triangles=b"\0\0\0\4" * 3),
        replace(GBD, pcs=Samples.of((0.0,))),
        replace(TYPES["psid"], profiles=((bytes(15), ODD),)),
        TagArray("toolong", ()),
        TagArray("cinf", (LocalizedText.english("\ud800"),)),
    ],
    ids=lambda tag: repr(tag)[:60],
)
def test_not_written(tag):
    with pytest.raises(ProfileError):
        tag.encode()
