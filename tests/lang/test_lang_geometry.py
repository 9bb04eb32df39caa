"""The geometry a model is read with, and files taken with other quantities than their own."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from brdfc.lang.load import load, load_text
from brdfc.lang.model import Model
from brdfc.source.errors import BrdfcError, ModelError
from brdfc.symbolic.build import build
from brdfc.symbolic.evaluate import evaluate

HEADER = 'model mine "Mine"\n'
RADIANCE = "radiance = (1, 1, 1)\n"


def names(model: Model) -> list[str]:
    return [q.name for q in model.quantities]


def read(text: str, geometry: str | None = None) -> Model:
    found = load_text(HEADER + text, geometry=geometry)
    assert isinstance(found, Model)
    return found


def errors(text: str) -> str:
    with pytest.raises(ModelError) as raised:
        read(text)
    return str(raised.value)


def test_one_model_is_read_with_the_angles_of_either_geometry() -> None:
    plane, full = load("ward"), load("ward", "full")
    assert (plane.geometry, full.geometry) == ("plane", "full")
    assert names(plane) == ["Rd", "ks", "m", "incident", "reflection", "intensity", "mirror"]
    azimuths = ["incident_azimuth", "reflection_azimuth"]
    assert names(full) == ["Rd", "ks", "m", "incident", "reflection", *azimuths, "intensity"]


def test_only_what_the_radiance_needs_of_a_geometry_is_a_quantity() -> None:
    assert "reflection" not in names(load("lambert"))
    assert "orientation" in names(load("ward_anisotropic"))


def test_the_sign_of_the_mirror_direction_is_a_switch() -> None:
    model = load("ward")
    angle = math.radians(40)
    at = {"Rd": (0.0,) * 3, "ks": (1.0,), "m": (0.1,), "incident": (angle,)}
    same = build(model.radiance, {**at, "reflection": (angle,)})
    axis = build(model.radiance, {**at, "reflection": (-angle,), "mirror": (-1.0,)})
    retro = build(model.radiance, {**at, "reflection": (-angle,)})
    values = [evaluate(e, {}).ravel()[0] for e in (same, axis, retro)]
    assert values[0] == values[1] > 1e3 * values[2]


def test_a_geometry_of_ones_own(tmp_path: Path) -> None:
    own = tmp_path / "tilt.brdf"
    own.write_text(
        'module tilt "One angle"\nenv tilt : angle in 0deg..80deg = 10deg as tilt\n'
        "let cos_incident = cos(tilt)\nlet irradiance = cos(tilt)\n"
    )
    model = load("lambert", own)
    assert model.geometry == "tilt"
    assert names(model) == ["Rd", "tilt"]
    assert model.examples == ()


def test_a_model_with_angles_of_its_own_has_no_geometry_to_choose(tmp_path: Path) -> None:
    own = tmp_path / "own.brdf"
    own.write_text('model own "Own"\nchannel k : number in 0..1\nradiance = (k, k, k)\n')
    assert load(own).geometry == ""
    with pytest.raises(BrdfcError, match="imports no geometry"):
        load(own, "full")


def test_an_unknown_geometry() -> None:
    with pytest.raises(BrdfcError, match="there is no library geometry 'fulll'") as raised:
        load("ward", "fulll")
    assert raised.value.hint == "did you mean 'full'?"


def test_a_model_is_no_geometry() -> None:
    with pytest.raises(BrdfcError, match="this is a model, not a geometry"):
        load("ward", "ggx")


def test_facts_count_in_the_geometry_they_are_stated_in() -> None:
    text = (
        "import geometry (cos_incident)\nradiance = cos_incident\n"
        "example incident=60deg -> 0.5\n"
        "example in full incident=0deg -> 1\n"
        'breaks energy <= 1 incident=80deg -> 2 "why"\n'
    )
    plane, full = read(text), read(text, "full")
    assert [e.result for e in plane.examples] == [(0.5,)]
    assert plane.breaches == ()
    assert [e.result for e in full.examples] == [(1.0,)]
    (breach,) = full.breaches
    assert (str(breach.law), breach.figure, breach.note) == ("energy <= 1", 2.0, "why")
    assert breach.given["incident"] == (math.radians(80),)


def test_a_whole_model_under_another_name_with_a_parameter_fixed_and_one_tied() -> None:
    model = read(
        "channel gloss : number in 0..0.5\n"
        "import ward as coat with (Rd = 0, ks = 2*gloss, m = 0.05)\n"
        "import lambert\nradiance = coat + lambert\n"
    )
    assert names(model) == ["gloss", "incident", "reflection", "intensity", "mirror", "Rd"]
    angles = {"incident": (0.5,), "reflection": (0.45,)}
    mine = build(model.radiance, {"Rd": (0.2, 0.3, 0.4), "gloss": (0.2,), **angles})
    whole = {"Rd": (0.2, 0.3, 0.4), "ks": (0.4,), "m": (0.05,), **angles}
    theirs = build(load("ward").radiance, whole)
    np.testing.assert_allclose(evaluate(mine, {}), evaluate(theirs, {}), rtol=1e-14)


def test_one_lobe_taken_twice_has_two_sets_of_parameters() -> None:
    model = load("cook_torrance_2")
    assert {"ks1", "m1", "F01", "ks2", "m2", "F02"} <= set(names(model))
    assert not {"m", "F0"} & set(names(model))


@pytest.mark.parametrize(
    ("bindings", "message"),
    [
        ("(mm = 0.1)", "'ward' has no quantity 'mm'"),
        ("(m = 0.1, m = 0.2)", "'m' is bound twice"),
        ("(m = 2)", "'m' is outside its range"),
        ("(m = 10deg)", "a value of type roughness has no unit"),
        ("(Rd = (1, 0))", "takes 3 numbers"),
        ("(m = width)", "'width' is no quantity"),
        ("(m = widht)", "nothing here is called 'widht'"),
        ("(incident = m*1)", "'incident' is an angle, and this is a number"),
    ],
)
def test_a_binding_that_cannot_be(bindings: str, message: str) -> None:
    text = "let width = 0.1\nchannel k : number in 0..1\nimport ward with "
    assert message in errors(text + bindings + "\n" + RADIANCE)


def test_as_before_a_list_of_names() -> None:
    assert "'as' before a list" in errors("import ward as w (lobe)\n" + RADIANCE)


@pytest.mark.parametrize(
    ("law", "shown"),
    [
        ("law increasing Rd k", "increasing Rd k"),
        ("law bounded <= 50", "bounded <= 50"),
        ("law energy <= 1 where k + Rd.x <= 1", "energy <= 1 where k + Rd.x <= 1"),
    ],
)
def test_laws_of_every_form(law: str, shown: str) -> None:
    quantities = "channel Rd : XYZ in 0..1\nchannel k : number in 0..1\n"
    (found,) = read(quantities + RADIANCE + law + "\n").laws
    assert str(found) == shown


@pytest.mark.parametrize(
    ("law", "message"),
    [
        ("law increasing", "'increasing' is about quantities"),
        ("law increasing q", "this model has no quantity 'q'"),
        ("law reciprocal Rd", "'reciprocal' is not about single quantities"),
        ("law bounded", "'bounded' needs a bound"),
        ("law positive where 2", "a law holds where a condition does, and this is a number"),
        ("law positive where k < 1", "nothing here is called 'k'"),
        ("breaks lawful -> 1", "'lawful' is not a law"),
        ("breaks energy >= 1 -> 2", "a law's bound is an upper one"),
        ("breaks energy <= 1 k=1 -> 2", "this model has no quantity 'k'"),
    ],
)
def test_a_law_that_cannot_be(law: str, message: str) -> None:
    assert message in errors("channel Rd : XYZ in 0..1\n" + RADIANCE + law + "\n")
