"""Whole profiles of versions 2 and 4: there and back, and what validate says of them."""

from pathlib import Path

import pytest
from icc_profiles import BAD, GOOD, display, named, printer
from icc_types import TYPES

from brdfc.cmm import reference
from brdfc.icc.profile import Profile
from brdfc.icc.types import FixedArray, Opaque, XYZArray
from brdfc.icc.validate import validate


@pytest.mark.parametrize("name", GOOD)
def test_a_good_profile(name):
    data = GOOD[name].to_bytes()
    read = Profile.from_bytes(data)
    assert validate(read) == []
    assert read.tags == GOOD[name].tags
    assert Profile(read.header, read.tags).to_bytes() == data
    assert Profile(read.header, {tag: type_again(read, tag) for tag in read.tags}).tags == read.tags


def type_again(profile, signature):
    """The tag made anew, as its fields say."""
    tag = profile.tags[signature]
    assert not isinstance(tag, Opaque)
    return type(tag).decode(tag.encode(), signature)


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
