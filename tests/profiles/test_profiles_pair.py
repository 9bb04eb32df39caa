"""What is in the profiles: names, order, defaults, metadata; roles of quantities."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import brdfc
from brdfc.colour.difference import D50
from brdfc.icc.types import Dictionary, NumberArray, Utf8Array
from brdfc.icc.validate import validate
from brdfc.lang.load import load_text
from brdfc.profiles.metadata import describe
from brdfc.profiles.multiplex import mid_beside
from brdfc.roles import assign_roles
from brdfc.source.errors import BrdfcError, ValueGivenError


@pytest.fixture(scope="module")
def ward() -> brdfc.Compiled:
    return brdfc.compile(brdfc.load("ward"))


def test_channels_keep_the_order_of_their_declaration(ward: brdfc.Compiled) -> None:
    for profile in (ward.mid, ward.mvis):
        assert profile.tags["mcta"] == Utf8Array(("Rdx", "Rdy", "Rdz", "ks", "m"))
    assert ward.mid.header.colour_space == b"nc\x00\x05"
    assert ward.mvis.header.mcs == b"mc\x00\x05"
    curved = brdfc.compile(brdfc.load("ward"), channels=["reflection", "incident"])
    names = ("Rdx", "Rdy", "Rdz", "ks", "m", "incident", "reflection")
    assert curved.roles.channel_names == names


def test_defaults_are_the_models(ward: brdfc.Compiled) -> None:
    """A diffuse reflectance of one half is half of the white."""
    grey = tuple(0.5 * v for v in D50)
    assert ward.mvis.tags["mdv "] == NumberArray("fl32", (*grey, 0.05, 0.15))


def test_profiles_keep_the_rules(ward: brdfc.Compiled) -> None:
    assert validate(ward.mid) == []
    assert validate(ward.mvis) == []


def test_a_profile_explains_itself(ward: brdfc.Compiled) -> None:
    meta = ward.mvis.tags["meta"]
    assert isinstance(meta, Dictionary)
    assert meta.get("model") == "ward"
    assert "SIGGRAPH 1992" in (meta.get("citation.1") or "")
    assert meta.get("constant.1") == "intensity"
    assert meta.get("constant.1.value") == "1"
    channels, variables = describe(ward.mvis, "channel"), describe(ward.mvis, "env")
    assert [d.name for d in channels] == ["Rd", "ks", "m"]
    assert [(d.name, d.signature, d.range_text) for d in variables] == [
        ("incident", "inci", "-90deg..90deg"),
        ("reflection", "refl", "-90deg..90deg"),
    ]
    assert variables[0].default == (pytest.approx(math.pi / 4),)


def test_metadata_from_outside_that_makes_no_sense_is_passed_over(ward: brdfc.Compiled) -> None:
    from dataclasses import replace

    entries = (("env.1", "x"), ("env.1.type", "number"), ("env.1.range", "0..wide"))
    entries += (("env.2", "y"), ("env.2.type", "matrix"), ("env.2.range", "0..1"))
    tags = {**ward.mvis.tags, "meta": Dictionary(entries)}
    assert describe(replace(ward.mvis, tags=tags), "env") == ()
    link = brdfc.connect(ward.mid, replace(ward.mvis, tags=tags), env={"inci": 0.5})
    assert link.environment == {"inci": 0.5}


def test_roles_follow_set_and_channel() -> None:
    model = brdfc.load("ward")
    roles = assign_roles(model, {"m": 0.2, "inci": "40deg"}, ["intensity"])
    assert [q.name for q in roles.channels] == ["Rd", "ks", "intensity"]
    assert [q.name for q in roles.variables] == ["reflection"]
    incident = (pytest.approx(math.radians(40)),)
    assert roles.constants == {"m": (0.2,), "incident": incident, "mirror": (1.0,)}


def test_python_values_are_checked_like_texts() -> None:
    model = brdfc.load("ward")
    for value, message in [
        (5.0, "outside its range 0.001..1"),
        (math.nan, "finite"),
        ([0.1, 0.2], "takes 1 finite"),
    ]:
        with pytest.raises(ValueGivenError, match=message):
            brdfc.compile(model, set={"m": value})


def test_every_quantity_fixed_leaves_nothing_to_compile() -> None:
    with pytest.raises(ValueGivenError, match="no channel is left"):
        brdfc.compile(brdfc.load("lambert"), set={"Rd": 0.5})


def test_a_fixed_right_angle_is_exactly_dark() -> None:
    compiled = brdfc.compile(brdfc.load("ward"), set={"incident": "90deg"})
    link = brdfc.connect(compiled.mid, compiled.mvis)
    assert link.apply([0.5, 0.5, 0.5, 0.5, 0.1]).tolist() == [0, 0, 0]


def test_a_colourless_radiance_gets_a_hint() -> None:
    model = load_text('model grey "g"\nchannel a : number in 0..1\nradiance = a\n')
    with pytest.raises(BrdfcError, match=r"has 1 components.*\n?.*\(y, y, y\)"):
        brdfc.compile(model)


@pytest.mark.parametrize(
    ("mvis", "mid"),
    [("ward_mvis.icc", "ward_mid.icc"), ("a/mvis.icc", "a/mid.icc"), ("w.icc", "w_mid.icc")],
)
def test_where_the_mid_goes(mvis: str, mid: str) -> None:
    assert mid_beside(Path(mvis)) == Path(mid)
