"""Every rule of validate: a profile that breaks it, and what is said."""

from dataclasses import replace

import pytest
from icc_samples import COPY, MINIMAL_MID, entry_of, mid, mvis, patched

from brdfc.calc.program import Matrix
from brdfc.icc.header import Header, SpectralRange
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import counted_space, multiplex_space, n_channel_space
from brdfc.icc.types import (
    Dictionary,
    LocalizedText,
    NumberArray,
    Opaque,
    Pipeline,
    Utf8Array,
    Utf8Text,
    XYZArray,
)
from brdfc.icc.validate import validate

TWO_TO_THREE = Matrix(2, 3, (0.0,) * 6, (0.0,) * 3)


def with_header(profile, **fields):
    return replace(profile, header=replace(profile.header, **fields))


def spectral(**fields):
    fields = {
        "spectral_pcs": counted_space("rs", 31),
        "spectral_range": SpectralRange(400.0, 700.0, 31),
    } | fields
    return with_header(mvis(swpt=NumberArray("fl32", (1.0,) * 31)), **fields)


@pytest.mark.parametrize(
    "profile",
    [
        mid(),
        mvis(),
        mvis(M2B0=None, M2B3=COPY),
        with_header(mvis(), pcs=b"Lab ", version=0x05100000),
        with_header(mvis(), flags=1),
        spectral(),
        spectral(
            spectral_pcs=counted_space("bs", 62),
            bispectral_range=SpectralRange(300.0, 400.0, 2),
        ),
        with_header(mid(A2M0=None, M2A0=COPY), device_class="mlnk"),
        with_header(
            mid(A2M0=None, M2A0=COPY),
            device_class="mlnk",
            colour_space=bytes(4),
            pcs=n_channel_space(3),
        ),
    ],
)
def test_nothing_to_say(profile):
    assert validate(profile) == []
    assert validate(Profile.from_bytes(profile.to_bytes())) == []


@pytest.mark.parametrize(
    ("profile", "tag", "message"),
    [
        (with_header(mid(), device_class="what"), "", "unknown device class"),
        (with_header(mid(), version=0x07000000), "", "unknown version"),
        (with_header(mid(), version=0x04300000), "", "not in version 4"),
        (with_header(mid(), flags=0x10), "", "reserved flags"),
        (with_header(mid(), attributes=0x10), "", "reserved attributes"),
        (with_header(mid(), reserved=1), "", "reserved bytes"),
        (with_header(mvis(), rendering_intent=4), "", "intent 4"),
        (with_header(mid(), mcs=bytes(4)), "", "needs a multiplex space"),
        (with_header(mid(), mcs=n_channel_space(3)), "", "needs a multiplex space"),
        (with_header(mid(), pcs=b"XYZ "), "", "a MID has no PCS"),
        (with_header(mid(), colour_space=bytes(4)), "", "no known data colour space"),
        (with_header(mid(), colour_space=b"nc\0\0"), "", "no known data colour space: 'nc0000'"),
        (with_header(mvis(), pcs=b"Luv "), "", "XYZ or Lab"),
        (with_header(mvis(), pcs=bytes(4)), "", "neither a PCS nor a spectral PCS"),
        (Profile(Header("spac", b"RGB ", b"what"), {}), "", "unknown PCS 'what'"),
        (Profile(Header("spac", b"RGB ", b"XYZ ", multiplex_space(3)), {}), "", "no multiplex"),
        (spectral(spectral_pcs=b"XYZ "), "", "unknown spectral PCS"),
        (spectral(spectral_pcs=counted_space("rs", 30)), "", "30 channels, its range 31"),
        (spectral(spectral_range=SpectralRange(700.0, 400.0, 31)), "", "end above its start"),
        (spectral(spectral_pcs=counted_space("bs", 31)), "", "the bi-spectral range"),
        (spectral(bispectral_range=SpectralRange(1.0, 2.0, 2)), "", "without a bi-spectral PCS"),
        (mid(desc=None), "desc", "required: desc"),
        (mid(cprt=None), "cprt", "required: cprt"),
        (mid(A2M0=None), "A2M0", "required: A2M0"),
        (mid(mcta=None), "mcta", "required: mcta"),
        (mvis(mcta=None), "mcta", "required: mcta"),
        (mvis(M2B0=None), "M2B0", "required: M2B0 or M2B1"),
        (mvis(wtpt=None), "wtpt", "required: wtpt"),
        (Profile(Header("scnr", b"RGB ", b"XYZ "), {}), "A2B0", "rXYZ with gXYZ"),
        (mid(cprt=Utf8Text("me")), "cprt", "of type 'utf8', not mluc"),
        (mid(mdv=NumberArray("fl64", (0.0,) * 3)), "mdv ", "of type 'fl64'"),
        (mid(A2M0=Pipeline(2, 3, (TWO_TO_THREE,))), "A2M0", "2 channels in, the header says 3"),
        (mvis(M2B0=Pipeline(3, 2, ())), "M2B0", "2 channels out, the header says 3"),
        (mvis(M2S0=COPY), "M2S0", "3 channels out, the header says 0"),
        (mvis(c2sp=Pipeline(2, 3, (TWO_TO_THREE,))), "c2sp", "2 channels in"),
        (mid(bAB0=COPY), "bAB0", "3 channels in, the header says 7"),
        (mid(A2M0=Pipeline(3, 3, (TWO_TO_THREE,))), "A2M0", "3 channels arrive at element 0"),
        (mid(A2M0=Pipeline(3, 2, COPY.elements)), "A2M0", "3 channels leave, the tag says 2"),
        (mid(mcta=Utf8Array(("a", "b"))), "mcta", "2 names for 3 channels"),
        (mid(mcta=Utf8Array(("a", "", "b"))), "mcta", "an empty channel name"),
        (mid(mcta=Utf8Array(("a", "b", "a"))), "mcta", "two channels are called 'a'"),
        (mid(mcta=Opaque(b"tary\0\0\0\0mcta\0\0\0\0")), "mcta", "do not connect"),
        (mid(mdv=NumberArray("ui08", (1, 2))), "mdv ", "2 defaults for 3 channels"),
        (mvis(wtpt=XYZArray(())), "wtpt", "0 colours, not 1"),
    ],
)
def test_errors(profile, tag, message):
    found = [finding for finding in validate(profile) if message in finding.message]
    assert [(finding.severity, finding.tag) for finding in found] == [("error", tag)]


@pytest.mark.parametrize(
    ("profile", "tag", "message"),
    [
        (with_header(mvis(), creation_date=(1980, 1, 1, 0, 0, 0)), "", "creation date"),
        (with_header(mvis(), creation_date=(2020, 13, 1, 0, 0, 0)), "", "creation date"),
        (replace(spectral(), tags=mvis().tags), "swpt", "white point"),
        (with_header(mvis(), illuminant=(0.97, 1.0, 0.48)), "svcn", "illuminant is not D50"),
        (with_header(mvis(), illuminant=(0.97, 1.0, 0.48)), "c2sp", "illuminant is not D50"),
        (mid(pseq=Opaque(b"pseq\0\0\0\0")), "pseq", "has no meaning"),
        (mid(A2M0=Pipeline(3, 3, ())), "A2M0", "without elements"),
        (mid(meta=Dictionary((("", "x"),))), "meta", "without a name"),
        (mid(meta=Dictionary((("a", "x"), ("a", "y")))), "meta", "two entries are called 'a'"),
    ],
)
def test_warnings(profile, tag, message):
    found = [f for f in validate(profile) if message in f.message and f.tag == tag]
    assert [finding.severity for finding in found] == ["warning"]


def messages(data):
    return [str(finding) for finding in validate(Profile.from_bytes(data))]


def test_a_wrong_profile_id():
    data = patched(mid().to_bytes(), 84, "16s", bytes(range(16)))
    assert messages(data) == ["error: header: the profile ID is not the MD5 of the contents"]


def test_a_tag_off_the_grid():
    data = MINIMAL_MID[:0xF0] + b"\0\0" + MINIMAL_MID[0xF0:] + b"\0\0"
    data = patched(data, 0, "I", len(data))
    for entry in ("A2M0", "mcta"):
        place = entry_of(data, entry) + 4
        data = patched(data, place, "I", int.from_bytes(data[place : place + 4], "big") + 2)
    assert messages(data) == [
        "error: tag 'A2M0': begins at byte 246, not a multiple of 4",
        "error: tag 'mcta': begins at byte 338, not a multiple of 4",
    ]


def test_a_size_off_the_grid():
    data = patched(MINIMAL_MID + b"\0", 0, "I", len(MINIMAL_MID) + 1)
    assert messages(data) == ["error: header: a size of 373 bytes is not a multiple of 4"]


def test_a_tag_that_stands_twice_counts_once():
    data = patched(MINIMAL_MID, entry_of(MINIMAL_MID, "cprt"), "4s", b"desc")
    assert Profile.from_bytes(data).tags["desc"] == LocalizedText.english("x")
    assert messages(data) == [
        "error: tag 'cprt': required: cprt",
        "warning: tag 'desc': stands twice in the tag table",
    ]


def test_thousands_of_signatures_for_one_long_pipeline():
    step = Matrix(1, 1, (1.0,), (0.0,))
    pipeline = Pipeline(1, 1, (step,) * 60_000)
    tags = {f"{number:04x}": pipeline for number in range(20_000)}
    profile = Profile.from_bytes(Profile(Header("mid "), tags).to_bytes())
    assert all(finding.tag in ("", "desc", "cprt", "A2M0", "mcta") for finding in validate(profile))
