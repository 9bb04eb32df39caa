"""Writing and reading whole profiles."""

import hashlib
import struct
from dataclasses import replace

import pytest
from icc_samples import COPY, MINIMAL_MID, entry_of, mid, mvis, tag_start

from brdfc.calc.program import Op, Program
from brdfc.icc.header import D50, Header, SpectralRange
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import counted_space, multiplex_space, n_channel_space
from brdfc.icc.types import (
    Curve,
    Dictionary,
    LocalizedText,
    Opaque,
    Pipeline,
    PlainText,
    TextDescription,
    Utf8Array,
    XYZArray,
)
from brdfc.icc.validate import validate
from brdfc.source.errors import BrdfcError, ProfileError


def test_the_minimal_mid_is_read():
    profile = Profile.from_bytes(MINIMAL_MID)
    assert profile.header == Header(
        "mid ",
        colour_space=n_channel_space(1),
        mcs=multiplex_space(1),
        creation_date=(2025, 1, 2, 3, 4, 5),
    )
    half = Program(1, 1, (Op("in", 0, 1), Op("data", value=0.5), Op("mul", 1), Op("out", 0, 1)))
    assert profile.tags == {
        "desc": LocalizedText.english("x"),
        "cprt": LocalizedText.english("x"),
        "A2M0": Pipeline(1, 1, (half,)),
        "mcta": Utf8Array(("A",)),
    }
    assert validate(profile) == []


def test_the_minimal_mid_is_written_byte_for_byte():
    assert len(MINIMAL_MID) == 372
    assert Profile.from_bytes(MINIMAL_MID).to_bytes(profile_id=False) == MINIMAL_MID


@pytest.mark.parametrize("profile", [mid(), mvis(), mvis(M2B1=COPY), Profile(Header("spac"), {})])
@pytest.mark.parametrize("profile_id", [True, False])
def test_read_then_write_gives_the_same_bytes(profile, profile_id):
    data = profile.to_bytes(profile_id=profile_id)
    read = Profile.from_bytes(data)
    assert read.to_bytes(profile_id=profile_id) == data
    assert read.tags == profile.tags
    assert list(read.tags) == list(profile.tags)
    assert len(data) % 4 == 0


def test_a_file_goes_out_and_comes_back(tmp_path):
    mvis().save(tmp_path / "mvis.icc")
    assert Profile.load(tmp_path / "mvis.icc").tags == mvis().tags
    assert [path.name for path in tmp_path.iterdir()] == ["mvis.icc"]


def test_a_missing_file_is_an_error_of_the_family(tmp_path):
    with pytest.raises(BrdfcError, match="cannot be read"):
        Profile.load(tmp_path / "none.icc")


def test_the_profile_id_leaves_out_flags_intent_and_itself():
    data = mvis().to_bytes()
    zeroed = bytearray(data)
    for start, end in ((44, 48), (64, 68), (84, 100)):
        zeroed[start:end] = bytes(end - start)
    assert data[84:100] == hashlib.md5(zeroed).digest()
    other = replace(mvis(), header=replace(mvis().header, flags=1, rendering_intent=2))
    assert other.to_bytes()[84:100] == data[84:100]


def test_version_2_has_no_profile_id():
    old = replace(mvis(), header=replace(mvis().header, version=0x02400000))
    assert not any(old.to_bytes()[84:100])


def test_one_tag_under_two_signatures_is_written_once():
    data = mvis(M2B1=COPY).to_bytes()
    places = [struct.unpack_from(">II", data, entry_of(data, tag) + 4) for tag in ("M2B0", "M2B1")]
    assert places[0] == places[1]
    assert len(data) == len(mvis().to_bytes()) + 12
    read = Profile.from_bytes(data)
    assert read.tags["M2B0"] is read.tags["M2B1"]


def test_tags_begin_at_multiples_of_4_and_sizes_leave_the_padding_out():
    data = mid(desc=LocalizedText.english("odd")).to_bytes()
    assert struct.unpack_from(">I", data, entry_of(data, "desc") + 8) == (28 + 6,)
    assert all(tag_start(data, tag) % 4 == 0 for tag in mid().tags)


def test_header_fields_come_back():
    header = Header(
        "mvis",
        colour_space=b"CMYK",
        pcs=b"Lab ",
        mcs=multiplex_space(260),
        spectral_pcs=counted_space("bs", 36),
        spectral_range=SpectralRange(380.0, 730.5, 4),
        bispectral_range=SpectralRange(400.0, 700.0, 9),
        version=0x05100000,
        creation_date=(1999, 12, 31, 23, 59, 58),
        flags=0xFFFF0003,
        attributes=0x0123456700000005,
        rendering_intent=3,
        illuminant=(-1.5, 32767.5, 1 / 65536),
        cmm="cmm1",
        platform="APPL",
        manufacturer="\x00\x01\xfeé",
        model="mod ",
        creator="crea",
        device_subclass="osim",
        profile_id=bytes(range(16)),
        reserved=7,
    )
    data = header.encode(1234)
    assert len(data) == 128
    assert data[:4] == struct.pack(">I", 1234)
    assert data[104:110].hex() == "5df061b50004"
    assert Header.decode(data, "here") == header


def test_header_holds_what_the_format_says():
    data = Header("mid ", n_channel_space(5), mcs=multiplex_space(5)).encode(0)
    assert data[12:20].hex() == "6d6964206e630005"
    assert data[116:120].hex() == "6d630005"
    assert data[68:80].hex() == "0000f6d6000100000000d32d"


def test_before_version_5_the_spectral_fields_are_reserved():
    data = bytearray(Header("mntr", b"RGB ", b"XYZ ", version=0x02400000).encode(0))
    data[100:128] = b"\xff" * 28
    assert Header.decode(bytes(data), "here").spectral_range == SpectralRange()


@pytest.mark.parametrize(
    "change",
    [
        {"device_class": "mid"},
        {"creator": "Ωmeg"},
        {"colour_space": b"nc"},
        {"profile_id": b""},
        {"flags": -1},
        {"illuminant": (40000.0, 1.0, 1.0)},
        {"illuminant": (float("nan"), 1.0, 1.0)},
        {"spectral_range": SpectralRange(1e9, 1e9, 2)},
        {"creation_date": (2020, 1, 1)},
    ],
    ids=str,
)
def test_a_header_that_no_file_can_hold(change):
    with pytest.raises(ProfileError):
        replace(mid().header, **change).encode(128)


def test_an_unknown_type_is_carried_as_it_is():
    tag = Opaque(b"vcgt\0\0\0\1whatever it is")
    read = Profile.from_bytes(mid(vcgt=tag).to_bytes())
    assert read.tags["vcgt"] == tag
    assert read.tags["vcgt"].type_signature == "vcgt"


def test_what_cannot_be_written_is_named():
    with pytest.raises(ProfileError) as caught:
        mid(meta=Dictionary((("formula", "x" * 500),))).to_bytes()
    assert caught.value.where == "tag 'meta'"
    assert caught.value.hint == "split long text over numbered entries"
    with pytest.raises(ProfileError, match="four Latin-1 characters"):
        Profile(mid().header, {"toolong": COPY}).to_bytes()


def test_a_version_2_profile_is_read():
    curve = Curve(gamma=2.5)
    white = XYZArray((D50,))
    colorants = dict.fromkeys(("wtpt", "rXYZ", "gXYZ", "bXYZ"), white)
    curves = dict.fromkeys(("rTRC", "gTRC", "bTRC"), curve)
    texts = {"desc": TextDescription("a display"), "cprt": PlainText("free")}
    header = Header("mntr", b"RGB ", b"XYZ ", version=0x02100000)
    data = Profile(header, texts | colorants | curves).to_bytes()
    read = Profile.from_bytes(data)
    assert read.tags["bTRC"] == curve
    assert validate(read) == []
    assert read.to_bytes() == data


# ---------------------------------------------------------------- unchanged


def loose(data: bytes) -> bytes:
    """The MINIMAL_MID with a layout of its own: tags in another order, gaps between them, a gap
    inside a text and a reserved word that is not zero."""
    text = bytearray(LocalizedText.english("x").encode())
    text[4:8] = b"\1\2\3\4"
    text[20:] = struct.pack(">II", 2, 32) + b"gap!" + b"\0x"
    old = {tag: data[tag_start(data, tag) :] for tag in ("desc", "cprt", "A2M0", "mcta")}
    sizes = {"desc": 34, "cprt": 30, "A2M0": 92, "mcta": 36}
    parts = {"mcta": old["mcta"], "desc": bytes(text), "A2M0": old["A2M0"], "cprt": old["cprt"]}
    table, body = b"", b""
    starts = {}
    for tag, part in parts.items():
        starts[tag] = 128 + 4 + 48 + len(body)
        body += part[: sizes[tag]].ljust(sizes[tag] + 10, b"\xaa")
        body += b"\xaa" * (-len(body) % 4)
    for tag in old:
        table += tag.encode() + struct.pack(">II", starts[tag], sizes[tag])
    size = struct.pack(">I", 132 + len(table) + len(body))
    return size + data[4:132] + table + body


@pytest.mark.parametrize("data", [MINIMAL_MID, loose(MINIMAL_MID)], ids=["regular", "loose"])
def test_what_is_not_changed_stays_as_it_is(data):
    """Byte for byte, with its identity: none here."""
    profile = Profile.from_bytes(data)
    assert profile.to_bytes() == data
    assert any(profile.to_bytes(profile_id=True)[84:100])
    assert profile.to_bytes(profile_id=True)[100:] == data[100:]


def test_a_wrong_identity_stays_unless_it_is_asked_for():
    data = MINIMAL_MID[:84] + b"x" * 16 + MINIMAL_MID[100:]
    profile = Profile.from_bytes(data)
    assert profile.to_bytes() == data
    assert profile.to_bytes(profile_id=False) == MINIMAL_MID
    assert Profile.from_bytes(profile.to_bytes(profile_id=True)).tags == profile.tags


def test_a_tag_that_is_not_changed_stays_as_it_is():
    """When another one is: its reserved bytes and its gap too, though nobody reads them."""
    profile = Profile.from_bytes(loose(MINIMAL_MID))
    tags = {**profile.tags, "cprt": LocalizedText.english("free")}
    again = Profile.from_bytes(replace(profile, tags=tags).to_bytes())
    assert again.tags == tags
    assert again.tags["desc"].to_bytes() == profile.tags["desc"].to_bytes()
    assert b"gap!" in again.tags["desc"].to_bytes()
    anew = replace(profile.tags["desc"], records=(("enUS", "x"),))
    assert b"gap!" not in anew.to_bytes()
    assert again.header.profile_id != bytes(16)


def test_version_2_has_no_identity():
    header = Header("mntr", b"RGB ", b"XYZ ", version=0x02400000)
    data = Profile(header, {"cprt": PlainText("free")}).to_bytes(profile_id=True)
    assert data[84:100] == bytes(16)
    read = Profile.from_bytes(data)
    assert read.to_bytes(profile_id=True) == data


@pytest.mark.parametrize("name", ["sRGB", "LAB", "XYZ"])
def test_profiles_of_another_writer(name):
    """Those that LittleCMS makes, of versions 2 and 4: each tag, and the whole."""
    cms = pytest.importorskip("PIL.ImageCms")
    data = cms.ImageCmsProfile(cms.createProfile(name)).tobytes()
    profile = Profile.from_bytes(data)
    assert profile.to_bytes() == data
    assert not any(isinstance(tag, Opaque) for tag in profile.tags.values())
    for tag in profile.tags.values():
        assert type(tag).decode(tag.encode(), "again") == tag
