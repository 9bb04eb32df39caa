"""What a picture is of: sources as users write them, models and profiles side by side."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import brdfc
from brdfc.colour.adaptation import adaptation_matrix
from brdfc.colour.conditions import viewing_conditions
from brdfc.colour.difference import D50
from brdfc.pictures.sources import angle_of, angles_of, open_subjects, source
from brdfc.pictures.sweep import in_plane, measured_sweeps, quantity, sweeps
from brdfc.source.errors import BrdfcError, ValueGivenError

LAMP = viewing_conditions(white=(0.97, 1, 0.484))
ANGLES = np.radians([-60.0, -10, 0, 30, 44, 75])


@pytest.mark.parametrize(
    ("text", "reference", "values", "label"),
    [
        ("ward", "ward", {}, "ward"),
        ("ward with m=0.2", "ward", {"m": "0.2"}, "ward"),
        ("ward with m=0.2, ks=0.1 as matt print", "ward", {"m": "0.2", "ks": "0.1"}, "matt print"),
        ("ward with Rd=(0.1,0.2,0.3) m=0.2", "ward", {"Rd": "(0.1,0.2,0.3)", "m": "0.2"}, "ward"),
        ("folder/a b.icc as x", "folder/a b.icc", {}, "x"),
        ("folder/gloss.brdf", "folder/gloss.brdf", {}, "gloss"),
    ],
)
def test_sources_as_users_write_them(
    text: str, reference: str, values: dict[str, str], label: str
) -> None:
    found = source(text, {})
    assert (found.reference, dict(found.values), found.label) == (reference, values, label)


def test_values_for_all_give_way_to_a_sources_own() -> None:
    assert source("ward with m=0.2", {"m": "0.1", "ks": "0.3"}).values == {"m": "0.2", "ks": "0.3"}


@pytest.mark.parametrize("text", ["ward with m", "ward with m=", "ward with =2", "ward with m=(1"])
def test_sources_that_are_none(text: str) -> None:
    with pytest.raises(ValueGivenError, match="no NAME=VALUE"):
        source(text, {})


def test_ranges_of_angles() -> None:
    np.testing.assert_allclose(np.degrees(angles_of("-80deg..80deg,5deg")), np.arange(-80, 81, 5))
    np.testing.assert_allclose(np.degrees(angles_of("0..1,0.25")), [0, 0.25, 0.5, 0.75, 1])
    assert angle_of("-30deg") == pytest.approx(-math.pi / 6)
    for text in ("80deg..-80deg,5deg", "0..90", "0..90,0", "0deg..90deg,1e-9deg", "0..1e9,1"):
        with pytest.raises(ValueGivenError):
            angles_of(text)


def profile(tmp_path: Path, name: str, **options: object) -> str:
    geometry = options.pop("geometry", None)
    model = brdfc.load("ward", geometry)  # type: ignore[arg-type]
    path = tmp_path / f"{name}.icc"
    brdfc.compile(model, effort=1, conditions=LAMP, **options).save(path)  # type: ignore[arg-type]
    return str(path)


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"channels": ["incident", "reflection"]},
        {"channels": ["reflection"]},
        {"encode": "ncolour"},
        {"encode": "ncolour", "angles": "degrees"},
        {"encode": "ncolour", "angles": "unit", "set": {"m": 0.2}},
        {"geometry": "full"},
        {"geometry": "full", "channels": ["incident", "incident_azimuth"]},
        {"set": {"m": 0.2}},
    ],
    ids=str,
)
def test_a_profile_shows_what_its_model_shows(options: dict[str, object], tmp_path: Path) -> None:
    """Angles as variables or as channels, in the plane or in full."""
    path = profile(tmp_path, "w", **options)
    own = "" if "set" in options else "m=0.2 "
    values = f"with {own}ks=0.3 Rd=(0.1,0.2,0.05)"
    from_model = source("ward with m=0.2 ks=0.3 Rd=(0.1,0.2,0.05)", {})
    both = open_subjects([from_model, source(f"{path} {values} as p", {})], None, LAMP, None)
    for incident in (0.7, -0.3, 0.0):
        colours = [s.colours(in_plane(s, incident, ANGLES)) for s in both]
        np.testing.assert_allclose(colours[0], colours[1], rtol=3e-4)
        assert both[1].white == pytest.approx(both[0].white, rel=1e-6)


def test_both_geometries_of_a_model_show_the_same_in_the_plane() -> None:
    plane, full = (
        open_subjects([source("ward_anisotropic", {})], g, LAMP, None)[0] for g in ("plane", "full")
    )
    for incident in (0.7, -0.3):
        one, other = (s.colours(in_plane(s, incident, ANGLES)) for s in (plane, full))
        np.testing.assert_allclose(one, other, rtol=1e-9)


def test_colours_are_adapted_alike(tmp_path: Path) -> None:
    path = profile(tmp_path, "w")
    subjects = open_subjects([source("ward", {}), source(f"{path} as p", {})], None, LAMP, None)
    found = sweeps(subjects, [0.7], ANGLES, [None, "D65"], exposure=2.0)
    assert [(s.label, s.adapt) for s in found] == [
        ("ward", None),
        ("ward", "D65"),
        ("p", None),
        ("p", "D65"),
    ]
    own, adapted, p_own, p_adapted = (s.xyz for s in found)
    d65 = viewing_conditions("D65").white
    both = adaptation_matrix(D50, d65) @ adaptation_matrix(LAMP.white, D50)
    np.testing.assert_allclose(adapted, own @ both.T, rtol=1e-12)
    np.testing.assert_allclose(p_own, own, rtol=1e-5)
    np.testing.assert_allclose(p_adapted, adapted, rtol=1e-5)


def test_quantities_of_a_sweep() -> None:
    (found,) = sweeps(open_subjects([source("ward", {})], None, None, None), [0.7], ANGLES)
    np.testing.assert_array_equal(found.values("Y"), found.xyz[:, 1])
    lightness, a, b = (found.values(name) for name in "Lab")
    np.testing.assert_allclose(found.values("C"), np.hypot(a, b))
    assert (np.abs(a) < 1e-9).all(), "a grey is grey, and so is its highlight"
    assert lightness.min() > 0
    assert quantity("L*") == "L"
    with pytest.raises(ValueGivenError, match="nothing to draw"):
        quantity("H")


def test_values_of_a_profile_stay_in_its_range(tmp_path: Path) -> None:
    path = profile(tmp_path, "w")
    with pytest.raises(ValueGivenError, match=r"ks=-5 lies outside the profile.s range 0\.\.1"):
        open_subjects([source(f"{path} with ks=-5", {})], None, None, None)


def test_angles_stay_in_their_ranges() -> None:
    subjects = open_subjects([source("ward", {})], None, None, None)
    with pytest.raises(ValueGivenError, match=r"incident=100deg lies outside .* -90deg\.\.90deg"):
        sweeps(subjects, [math.radians(100)], ANGLES)


def test_measured_points_of_other_incidences_are_missed(tmp_path: Path) -> None:
    (tmp_path / "m.csv").write_text("# a comment\n\nincident,reflection,Y\n30,10,0.2\n")
    with pytest.raises(BrdfcError, match="no point at the incidence 45 deg"):
        measured_sweeps(tmp_path / "m.csv", [math.radians(45)], D50)


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (["ward", "ward with m=0.2"], "two sources are called 'ward'"),
        (["ward with rough=0.2"], "no quantity 'rough'"),
        (["ward with m=2"], "lies outside its range"),
        (["wrd"], "did you mean 'ward'?"),
    ],
)
def test_what_cannot_be_opened(texts: list[str], message: str) -> None:
    with pytest.raises(BrdfcError) as caught:
        open_subjects([source(t, {}) for t in texts], None, None, None)
    assert message in str(caught.value)


def test_a_profile_without_angles_cannot_be_turned(tmp_path: Path) -> None:
    path = profile(tmp_path, "w", set={"incident": "40deg", "reflection": "10deg"})
    with pytest.raises(ValueGivenError, match="no angle 'incident' or 'reflection' to turn"):
        open_subjects([source(path, {})], None, None, None)
    whole = profile(tmp_path, "v")
    with pytest.raises(ValueGivenError, match="has no quantity 'mm'"):
        open_subjects([source(f"{whole} with mm=2", {})], None, None, None)


# ---------------------------------------------------------------- measured points


def table(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "points.csv"
    path.write_text(text)
    return path


def test_measured_points_by_incidence(tmp_path: Path) -> None:
    path = table(
        tmp_path,
        "# made for this test\nincident,reflection,X,Y,Z\n30,10,0.1,0.2,0.3\n"
        "60,0,1,1,1\n30,-10,0.4,0.5,0.6\n45,0,9,9,9\n",
    )
    found = measured_sweeps(path, np.radians([30.0, 60.0]), D50)
    assert [(s.incident, s.reflection.tolist()) for s in found] == [(30, [-10, 10]), (60, [0])]
    assert found[0].xyz.tolist() == [[0.4, 0.5, 0.6], [0.1, 0.2, 0.3]]
    assert all(s.measured for s in found)
    bare = table(tmp_path, "incident,reflection,Y\n30,10,0.5\n")
    (grey,) = measured_sweeps(bare, np.radians([30.0]), D50)
    np.testing.assert_allclose(grey.xyz, [0.5 * np.array(D50)])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("incident,Y\n30,1\n", "no column 'reflection'; the columns are incident, Y"),
        ("", "no column 'incident'"),
        ("incident,reflection,Y\n30,10,x\n", "line 2: not all numbers"),
        ("incident,reflection,Y\n30,10\n", "line 2: not all numbers"),
        ("incident,reflection,Y\n30,10,nan\n", "line 2: no finite number"),
    ],
)
def test_tables_that_are_none(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(BrdfcError) as caught:
        measured_sweeps(table(tmp_path, text), [0.5], D50)
    assert message in str(caught.value)
