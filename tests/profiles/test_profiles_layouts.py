"""The same model in other encodings: what the reference engine can run it runs, what it can only
carry it validates, and our engine runs all of it."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import brdfc
from brdfc.cmm import reference
from brdfc.colour.conditions import viewing_conditions
from brdfc.colour.difference import D50
from brdfc.engine.runs import run
from brdfc.icc.profile import Profile
from brdfc.icc.types import NumberArray, Pipeline, Signature, Structure
from brdfc.icc.validate import validate
from brdfc.profiles.brdf_structure import REGISTERED
from brdfc.profiles.metadata import describe
from brdfc.source.errors import ValueGivenError

needs_reference = pytest.mark.skipif(
    not reference.available(), reason="the reference engine (extra `verify`) is not installed"
)
PIXELS = np.random.default_rng(8).uniform(0.05, 0.5, (30, 5)).astype(np.float32)
ANGLES = [(0.7, 0.3), (-0.4, -0.4), (0.2, -1.2), (1.5, 1.49)]


def compiled(encode: str, name: str = "ward", **options: object) -> brdfc.Compiled:
    geometry = "full" if encode == "brdf-function" else None
    spectral = options.pop("spectral", None)
    model = brdfc.load(name, geometry, spectral)  # type: ignore[arg-type]
    return brdfc.compile(model, encode=encode, effort=1, **options)  # type: ignore[arg-type]


def encoded(radians: np.ndarray, unit: str, low: float, high: float) -> np.ndarray:
    if unit == "unit":
        return (radians - low) / (high - low)
    return np.degrees(radians) if unit == "degrees" else radians


def test_a_variable_answers_to_its_signature_in_every_layout() -> None:
    for encode in ("ncolour", "mcs"):
        by_name = compiled(encode, set={"incident": "40deg"})
        assert compiled(encode, set={"inci": "40deg"}).mvis.to_bytes() == by_name.mvis.to_bytes()


# ---------------------------------------------------------------- n-colour


@pytest.mark.parametrize("unit", ["radians", "degrees", "unit"])
def test_angles_among_device_values_give_what_variables_give(unit: str, tmp_path: Path) -> None:
    made = compiled("ncolour", angles=unit)
    (path,) = made.save(tmp_path / "nc.icc")
    assert made.mvis.header.colour_space == b"nc\x00\x07"
    assert validate(Profile.load(path)) == []
    pair = compiled("mcs")
    single = brdfc.connect(path)
    assert single.channels == ("Rdx", "Rdy", "Rdz", "ks", "m", "incident", "reflection")
    for incident, reflection in ANGLES:
        expected = brdfc.connect(
            pair.mid, pair.mvis, env={"incident": incident, "reflection": reflection}
        ).apply(PIXELS)
        angles = encoded(np.array([incident, reflection]), unit, -math.pi / 2, math.pi / 2)
        device = np.hstack([PIXELS, np.tile(angles, (len(PIXELS), 1))]).astype(np.float32)
        np.testing.assert_allclose(single.apply(device), expected, rtol=2e-4)
        if reference.available():
            judged = reference.chain([path], device).xyz[0]
            np.testing.assert_allclose(single.apply(device), judged, rtol=2e-6)


@needs_reference
def test_every_encoding_validates(tmp_path: Path) -> None:
    for encode in ("ncolour", "brdf-function"):
        for spectral in (None, "400nm..700nm,50nm"):
            (path,) = compiled(encode, spectral=spectral).save(tmp_path / "p.icc")
            assert reference.validate(path) == ("OK", "")


# ---------------------------------------------------------------- BRDF functions


@pytest.mark.parametrize("unit", ["unit", "degrees", "radians"])
def test_a_brdf_function_takes_four_angles(unit: str, tmp_path: Path) -> None:
    """The viewer's azimuth and zenith, then the light's; azimuths from 0 to a whole turn."""
    made = compiled("brdf-function", angles=unit)
    (path,) = made.save(tmp_path / "b.icc")
    assert validate(Profile.load(path)) == []
    pair = brdfc.compile(brdfc.load("ward", "full"), effort=1)
    function = brdfc.connect(path, transform="bAB0")
    assert function.channels[:4] == (
        "reflection_azimuth",
        "reflection",
        "incident_azimuth",
        "incident",
    )
    random = np.random.default_rng(9)
    for _ in range(12):
        zeniths = random.uniform(0, 1.5, 2)
        turns = random.uniform(0, 2 * math.pi, 2)
        signed = np.where(turns > math.pi, turns - 2 * math.pi, turns)
        run = {"reflection": zeniths[0], "incident": zeniths[1]}
        run |= {"reflection_azimuth": signed[0], "incident_azimuth": signed[1]}
        expected = brdfc.connect(pair.mid, pair.mvis, env=run).apply(PIXELS)
        zenith = encoded(zeniths, unit, 0, math.pi / 2)
        azimuth = encoded(turns, unit, 0, 2 * math.pi)
        angles = [azimuth[0], zenith[0], azimuth[1], zenith[1]]
        device = np.hstack([np.tile(angles, (len(PIXELS), 1)), PIXELS]).astype(np.float32)
        np.testing.assert_allclose(function.apply(device), expected, rtol=5e-4, atol=1e-6)


@pytest.mark.parametrize("unit", ["unit", "degrees", "radians"])
def test_a_coefficient_that_is_an_angle_is_read_as_angles_are(unit: str, tmp_path: Path) -> None:
    path = tmp_path / "tilted.brdf"
    path.write_text(
        'model tilted "T"\nimport geometry (irradiance)\nchannel Rd : XYZ in 0..1 = 0.5 "d"\n'
        'channel tilt : angle in 0deg..60deg = 30deg "t"\nradiance = irradiance*Rd*cos(tilt)\n'
    )
    made = brdfc.compile(
        brdfc.load(str(path), "full"), encode="brdf-function", angles=unit, effort=1
    )
    (_, tilt) = describe(made.mvis, "channel")
    sample = encoded(np.array(0.5), unit, 0, math.radians(60))
    assert tilt.origin + tilt.step * sample == pytest.approx(0.5)
    pixel = np.array([[0.1, 0.2, 0.3, sample]], np.float32)
    found = brdfc.connect(made.mvis).apply(pixel)[0]
    lit = np.array([0.1, 0.2, 0.3]) * math.cos(0.5) * math.cos(math.radians(45))
    np.testing.assert_allclose(found, lit, rtol=1e-5)


def test_beside_a_brdf_function_is_an_ordinary_transform(tmp_path: Path) -> None:
    """Lit at 45 degrees, seen along the normal: the model's defaults."""
    made = compiled("brdf-function")
    (path,) = made.save(tmp_path / "b.icc")
    pair = brdfc.compile(brdfc.load("ward", "full"), effort=1)
    expected = brdfc.connect(pair.mid, pair.mvis).apply(PIXELS)
    found = brdfc.connect(path)
    assert found.channels == ("Rdx", "Rdy", "Rdz", "ks", "m")
    np.testing.assert_allclose(found.apply(PIXELS), expected, rtol=1e-6)
    if reference.available():
        np.testing.assert_allclose(reference.chain([path], PIXELS).xyz[0], expected, rtol=2e-6)


# ---------------------------------------------------------------- BRDF structures


def members(made: brdfc.Compiled, tag: str = "bcp0") -> dict[str, object]:
    written = Profile.from_bytes(made.mvis.to_bytes()).tags[tag]
    assert isinstance(written, Structure)
    assert written.kind == "brdf"
    return dict(written.members)


def parameters(made: brdfc.Compiled, pixel: np.ndarray, tag: str = "bcp0") -> np.ndarray:
    transform = members(made, tag)["xfrm"]
    assert isinstance(transform, Pipeline)
    return run(transform.elements, transform.inputs, pixel, {})


@pytest.mark.parametrize("name", REGISTERED)
def test_a_structure_names_the_model_and_its_parameters(name: str) -> None:
    made = compiled("brdf-struct", name)
    found = members(made)
    kind = REGISTERED[name]
    assert found["type"] == Signature(kind.type + "1")
    assert found["func"] == Signature("colr")
    assert found["nump"] == NumberArray("ui16", (len(kind.parameters),))
    transform = found["xfrm"]
    assert isinstance(transform, Pipeline)
    assert (transform.inputs, transform.outputs) == (
        len(made.roles.channel_names),
        3 * len(kind.parameters),
    )
    known = {q.name for q in made.model.quantities}
    assert set(kind.parameters) <= known
    assert set(kind.amplitudes) <= set(kind.parameters)


def test_parameters_go_by_channel_or_by_parameter() -> None:
    pixel = np.array([0.1, 0.2, 0.3, 0.05, 0.15], np.float32)
    x, y, z = (0.05 * w for w in D50)
    by_channel = parameters(compiled("brdf-struct"), pixel)
    expected = [0.1, x, 0.15, 0.2, y, 0.15, 0.3, z, 0.15]
    np.testing.assert_allclose(by_channel, expected, rtol=1e-6)
    by_parameter = parameters(compiled("brdf-struct", parameters="parameter"), pixel)
    expected = [0.1, 0.2, 0.3, x, y, z, 0.15, 0.15, 0.15]
    np.testing.assert_allclose(by_parameter, expected, rtol=1e-6)


def test_highlights_of_a_structure_have_the_light_or_are_equal() -> None:
    pixel = np.array([0.1, 0.2, 0.3, 0.05, 0.15], np.float32)
    lamp = viewing_conditions(white=(0.97, 1, 0.484))
    found = parameters(compiled("brdf-struct", conditions=lamp), pixel)
    np.testing.assert_allclose(found[1::3], [0.05 * 0.97, 0.05, 0.05 * 0.484], rtol=1e-6)
    equal = parameters(compiled("brdf-struct", conditions=lamp, highlight="equal"), pixel)
    np.testing.assert_allclose(equal[1::3], [0.05] * 3, rtol=1e-6)


def test_fixed_parameters_are_offsets() -> None:
    made = compiled("brdf-struct", set={"m": 0.25})
    found = parameters(made, np.array([0.1, 0.2, 0.3, 0.05], np.float32))
    np.testing.assert_allclose(found[2::3], [0.25] * 3, rtol=1e-6)


def test_a_highlight_has_the_lights_colour_where_nothing_else_has_one() -> None:
    made = compiled("brdf-struct", set={"Rd": (0.5, 0.5, 0.5)})
    found = parameters(made, np.array([0.05, 0.15], np.float32))
    np.testing.assert_allclose(found[1::3], [0.05 * w for w in D50], rtol=1e-6)
    grey = compiled("brdf-struct", set={"Rd": (0.5, 0.5, 0.5)}, highlight="equal")
    assert members(grey)["func"] == Signature("mono")


def test_a_structure_of_wavelengths() -> None:
    made = compiled("brdf-struct", spectral="400nm..700nm,50nm")
    pixel = np.array([*np.linspace(0.1, 0.7, 7), 0.05, 0.15], np.float32)
    found = parameters(made, pixel, "bsp0").reshape(7, 3)
    np.testing.assert_allclose(found[:, 0], np.linspace(0.1, 0.7, 7), rtol=1e-6)
    np.testing.assert_allclose(found[:, 1:], [[0.05, 0.15]] * 7, rtol=1e-6)
    assert "bcp0" not in made.mvis.tags


@needs_reference
def test_the_reference_engine_carries_structures_and_runs_what_is_beside_them(
    tmp_path: Path,
) -> None:
    (path,) = compiled("brdf-struct").save(tmp_path / "s.icc")
    verdict, report = reference.validate(path)
    assert verdict == "warning"
    # It does not know its own member `xfrm`; that is all it remarks.
    assert all(
        "Unknown 'xfrm'" in line or "Cannot validate" in line for line in report.split("! -")[1:]
    )
    run = {"inci": 0.7, "refl": 0.3}
    judged = reference.chain([path], PIXELS, [run]).xyz[0]
    np.testing.assert_allclose(brdfc.connect(path, env=run).apply(PIXELS), judged, rtol=2e-6)


# ---------------------------------------------------------------- what cannot be


@pytest.mark.parametrize(
    ("encode", "options", "message"),
    [
        ("ncolor", {}, "did you mean 'ncolour'?"),
        ("ncolour,brdf-struct", {}, "says two things"),
        ("clut:9,curve:9", {}, "says two things"),
        ("ncolour", {"angles": "radian"}, "did you mean 'radians'?"),
        ("mcs", {"angles": "unit"}, "no angles among its device values"),
        ("mcs", {"parameters": "channel"}, "no parameters in an order"),
        ("brdf-struct", {"parameters": "chanel"}, "did you mean 'channel'?"),
    ],
)
def test_mistakes_are_explained(encode: str, options: dict[str, str], message: str) -> None:
    with pytest.raises(ValueGivenError) as caught:
        compiled(encode, **options)
    assert message in str(caught.value)


def test_a_brdf_function_needs_directions_in_space() -> None:
    with pytest.raises(ValueGivenError, match="--geometry full"):
        brdfc.compile(brdfc.load("ward"), encode="brdf-function", effort=1)


def test_only_registered_models_have_a_structure() -> None:
    with pytest.raises(ValueGivenError, match="'ggx' has no registered BRDF type"):
        compiled("brdf-struct", "ggx")


def test_a_model_that_has_a_registered_ones_name_is_not_that_model(tmp_path: Path) -> None:
    path = tmp_path / "ward.brdf"
    path.write_text('model ward "W"\nchannel Rd : XYZ in 0..1 = 0.5 "d"\nradiance = Rd\n')
    with pytest.raises(ValueGivenError, match="has no registered BRDF type"):
        brdfc.compile(brdfc.load(str(path)), encode="brdf-struct", effort=1)


def test_a_single_profile_has_no_mid(tmp_path: Path) -> None:
    with pytest.raises(ValueGivenError, match="has one profile and no MID"):
        compiled("ncolour").save(tmp_path / "p.icc", tmp_path / "mid.icc")
    assert not list(tmp_path.iterdir())
