"""Whole profiles of versions 2 and 4: there and back, and what validate says of them."""

import random
from pathlib import Path

import pytest
from icc_profiles import BAD, GOOD, display, named, printer
from icc_types import TYPES

from brdfc.cmm import reference
from brdfc.icc.profile import Profile
from brdfc.icc.types import FixedArray, Opaque, XYZArray, decode_tag
from brdfc.icc.validate import validate
from brdfc.source.errors import ProfileError


@pytest.mark.parametrize("name", GOOD)
def test_a_good_profile(name):
    data = GOOD[name].to_bytes()
    read = Profile.from_bytes(data)
    assert validate(read) == []
    assert read.tags == GOOD[name].tags
    assert Profile(read.header, read.tags).to_bytes() == data
    assert not any(isinstance(tag, Opaque) for tag in read.tags.values())
    assert Profile(read.header, {tag: type_again(read, tag) for tag in read.tags}).tags == read.tags


def type_again(profile, signature):
    """The tag made anew, as its fields say."""
    return decode_tag(profile.tags[signature].encode(), signature)


@pytest.mark.parametrize("name", BAD)
def test_a_bad_profile(name):
    profile, tag, message = BAD[name]
    found = [f for f in validate(profile) if f.severity == "error"]
    assert {f.tag for f in found} == {tag}
    assert any(f.message.startswith(message) for f in found)


def test_what_readers_get_over():
    profiles = (
        (named(gamt=GOOD["printer 4"].tags["gamt"]), "gamt"),
        (printer(rTRC=GOOD["display 4"].tags["rTRC"]), "rTRC"),
        (printer(cicp=TYPES["cicp"]), "cicp"),
    )
    for profile, tag in profiles:
        assert [(f.severity, f.tag) for f in validate(profile)] == [("warning", tag)]


@pytest.mark.parametrize(
    ("tag", "value", "message"),
    [
        ("chad", FixedArray("sf32", (1.0,) * 8), "8 numbers, not 9"),
        ("rXYZ", XYZArray(()), "0 colours, not 1"),
    ],
)
def test_counts(tag, value, message):
    assert [f.message for f in validate(display(**{tag: value}))] == [message]


# Not all of them, as each takes a process of its own.
JUDGED = {
    **{name: GOOD[name] for name in GOOD if name[:-1] in ("printer ", "link ") or name[-1] == "2"},
    **{name: BAD[name][0] for name in list(BAD)[1::3]},
}


@pytest.mark.skipif(not reference.available(), reason="the reference engine is not installed")
@pytest.mark.parametrize("name", JUDGED)
def test_the_reference_says_the_same(name: str, tmp_path: Path):
    path = tmp_path / "x.icc"
    JUDGED[name].save(path)
    verdict, report = reference.validate(path)
    assert (verdict not in ("OK", "warning")) == (name in BAD), report


def test_random_mutations():
    """Bytes put over others: a profile that stays as it is, or one ProfileError."""
    chance = random.Random(4)
    originals = [GOOD[name].to_bytes() for name in ("display 4", "printer 4", "named 2", "link 2")]
    read = 0
    for _ in range(400):
        data = bytearray(chance.choice(originals))
        place, width = chance.randrange(128, len(data) - 4), chance.choice((1, 2, 4))
        data[place : place + width] = chance.choice((bytes(4), b"\xff" * 4, b"\0\1\2\3"))[:width]
        try:
            profile = Profile.from_bytes(bytes(data))
        except ProfileError:
            continue
        read += 1
        validate(profile)
        assert profile.to_bytes() == data
        for signature in profile.tags:
            assert type_again(profile, signature) == profile.tags[signature]
    assert 100 < read < 400
