"""Lights, observers and whites, held against colour-science; and what cannot be one."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from brdfc.colour.adaptation import adaptation_matrix
from brdfc.colour.conditions import ViewingConditions, viewing_conditions
from brdfc.colour.difference import D50
from brdfc.colour.spectrum import Grid
from brdfc.source.errors import BrdfcError, SpectrumError, ValueGivenError

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import colour

OBSERVER = "CIE 1931 2 Degree Standard Observer"


@pytest.mark.parametrize("observer", ["1931-2", "1964-10"])
@pytest.mark.parametrize("light", ["A", "D65", "D55", "FL2", "FL11", "E", "LED-B3"])
@pytest.mark.filterwarnings("ignore")
def test_whites_are_those_of_colour_science(light: str, observer: str) -> None:
    functions = {"1931-2": OBSERVER, "1964-10": OBSERVER.replace("1931 2", "1964 10")}[observer]
    found = viewing_conditions(light, observer)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        xyz = colour.sd_to_XYZ(colour.SDS_ILLUMINANTS[light], colour.MSDS_CMFS[functions])
    np.testing.assert_allclose(found.white, xyz / xyz[1], atol=3e-5)
    assert not found.standard


def test_d50_for_the_1931_observer_is_the_space_profiles_connect_through() -> None:
    assert viewing_conditions().white == D50
    assert viewing_conditions().standard
    assert not viewing_conditions(observed_by="1964-10").standard
    assert not viewing_conditions("D50", white=(0.97, 1, 0.484)).standard


def test_a_black_body_of_2856_kelvin_is_nearly_illuminant_a() -> None:
    named, made = viewing_conditions("A"), viewing_conditions("blackbody:2856K")
    np.testing.assert_allclose(made.white, named.white, atol=2e-4)
    assert (made.illuminant, made.temperature) == ("blackbody", 2856)
    daylight = viewing_conditions("daylight:6504K")
    np.testing.assert_allclose(daylight.white, viewing_conditions("D65").white, atol=5e-4)


@pytest.mark.parametrize("name", ["F2", "fl2", "FL2"])
def test_names_are_taken_as_people_write_them(name: str) -> None:
    assert viewing_conditions(name).illuminant == "FL2"


def integrated(conditions: ViewingConditions, reflectance: np.ndarray) -> np.ndarray:
    """XYZ by colour-science, over the same steps as the light's."""
    grid = conditions.grid.wavelengths
    sample = colour.SpectralDistribution(reflectance, grid)
    light = colour.SpectralDistribution(conditions.power, grid)
    eye = colour.MSDS_CMFS[OBSERVER].copy().align(sample.shape)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return colour.colorimetry.sd_to_XYZ_integration(sample, eye, light) / 100


@pytest.mark.parametrize("light", ["A", "D65", "FL11"])
def test_reflectances_have_the_colours_of_colour_science(light: str) -> None:
    conditions = viewing_conditions(light)
    grid = conditions.grid
    matrix = conditions.reflectances_to_xyz(grid)
    for seed in range(3):
        reflectance = np.random.default_rng(seed).uniform(0, 1, grid.steps)
        expected = integrated(conditions, reflectance)
        np.testing.assert_allclose(matrix @ reflectance, expected, rtol=1e-4)


def test_a_perfect_diffuser_has_the_white_on_any_grid() -> None:
    for conditions in (viewing_conditions("A"), viewing_conditions("FL2", white=(0.99, 1, 0.7))):
        for grid in (Grid(400, 700, 31), Grid(380, 780, 81), Grid(500, 600, 2)):
            xyz = conditions.reflectances_to_xyz(grid) @ np.ones(grid.steps)
            np.testing.assert_allclose(xyz, conditions.white, rtol=1e-12)


@pytest.mark.parametrize(
    "white", [(0.97, 1, 0.484), (97, 100, 48.4), (0.9642, 1, 0.8249), (1.8, 1, 0.02), (0.5, 1, 0.1)]
)
def test_a_lamp_is_made_for_a_white(white: tuple[float, float, float]) -> None:
    found = viewing_conditions(white=white)
    expected = np.array(white) / white[1]
    np.testing.assert_allclose(found.white, expected)
    summed = found.matching @ found.power
    np.testing.assert_allclose(summed / summed[1], expected, rtol=1e-9)
    assert (found.power > 0).all()
    assert found.lamp_made
    turns = np.sign(np.diff(np.diff(np.log(found.power))))
    assert len(set(turns.tolist())) == 1, "the logarithm of its spectrum is a parabola"


def test_a_measured_white_stands_beside_a_named_light() -> None:
    found = viewing_conditions("A", white=(1.09, 1, 0.36))
    assert found.white == (1.09, 1.0, 0.36)
    assert found.illuminant == "custom"  # what is called A has another white
    assert viewing_conditions("A", white=viewing_conditions("A").white).illuminant == "A"
    assert not found.lamp_made


def test_the_surround_is_a_share_of_the_white() -> None:
    found = viewing_conditions("A", surround="dim", luminance=200)
    np.testing.assert_allclose(found.surround, np.array(found.white) * 20)
    assert viewing_conditions(surround="1,2,3").surround == (1, 2, 3)
    assert viewing_conditions(surround="dark").surround == (0, 0, 0)


def spectrum(tmp_path: Path, low: int, high: int, step: int = 10, columns: int = 1) -> str:
    path = tmp_path / f"{low}_{high}_{columns}.csv"
    rows = (f"{w}," + ",".join(["1"] * columns) for w in range(low, high + 1, step))
    path.write_text("\n".join(rows))
    return str(path)


def test_a_light_from_a_file(tmp_path: Path) -> None:
    found = viewing_conditions(spectrum(tmp_path, 380, 780))
    assert (found.illuminant, found.grid) == ("custom", Grid(380, 780, 81))
    np.testing.assert_allclose(found.white, (1, 1, 1), atol=2e-3)
    assert found.power.max() == pytest.approx(100)


def test_a_coarse_table_is_read_between_its_wavelengths(tmp_path: Path) -> None:
    """What an observer sees changes within a step."""
    path = tmp_path / "e.csv"
    path.write_text("380 2e-60\n580 2e-60\n780 2e-60\n")
    np.testing.assert_allclose(viewing_conditions(str(path)).white, (1, 1, 1), atol=2e-3)


@pytest.mark.parametrize("name", ["2015-2", "2015-10"])
def test_standard_observers_end_where_they_are_defined_to(name: str) -> None:
    assert viewing_conditions("D65", name).grid.start == 390


def test_another_light_or_observer_leaves_the_rest() -> None:
    own = viewing_conditions("A", "1964-10")
    for found in (own.seen_with("A", None), own.seen_with(None, "1964-10")):
        np.testing.assert_allclose(found.white, own.white, rtol=1e-12)
    assert own.seen_with("D65", None).observer == "1964-10"
    assert own.seen_with(None, "1931-2").white == viewing_conditions("A").white


def test_a_light_is_cut_to_what_the_observer_sees(tmp_path: Path) -> None:
    assert viewing_conditions(spectrum(tmp_path, 300, 1000)).grid == Grid(360, 830, 95)


@pytest.mark.parametrize(
    ("asked", "error", "message"),
    [
        ({"light": "D56"}, ValueGivenError, "did you mean 'D55'?"),
        ({"light": "candle"}, ValueGivenError, "blackbody:2856K"),
        ({"light": "blackbody:20K"}, ValueGivenError, "outside 1000K..100000K"),
        ({"light": "daylight:3000K"}, ValueGivenError, "outside 4000K..25000K"),
        ({"observed_by": "1931"}, ValueGivenError, "did you mean '1931-2'?"),
        ({"white": (0.97, 0, 0.484)}, ValueGivenError, "the white's Y is 0"),
        ({"white": (0.97, -1, 0.484)}, ValueGivenError, "the white's Y is -1"),
        ({"white": (0.97, float("nan"), 0.484)}, ValueGivenError, "three finite numbers"),
        ({"white": (0.0, 1, 0.484)}, ValueGivenError, "not above 0"),
        ({"white": (1, 1e-320, 1)}, ValueGivenError, "X and Z are near Y"),
        ({"luminance": 1e-50}, ValueGivenError, "it has to be 1e-06..1e+09 cd/m2"),
        ({"adaptation": "cat16"}, ValueGivenError, "there is nothing to adapt"),
        ({"white": (10.0, 1, 10.0)}, ValueGivenError, "no lamp has the white 10,1,10"),
        ({"surround": "dimm"}, ValueGivenError, "did you mean 'dim'?"),
        ({"surround": "1,2"}, ValueGivenError, "is no surround"),
        ({"surround": "1,2,-3"}, ValueGivenError, "is no surround"),
        ({"luminance": 0.0}, ValueGivenError, "the luminance is 0"),
        ({"adaptation": "bradfrod"}, ValueGivenError, "did you mean 'bradford'?"),
    ],
)
def test_what_cannot_be_is_said(
    asked: dict[str, object], error: type[BrdfcError], message: str
) -> None:
    with pytest.raises(error) as caught:
        viewing_conditions(**asked)  # type: ignore[arg-type]
    assert message in str(caught.value)


def test_spectra_that_do_not_fit(tmp_path: Path) -> None:
    short = spectrum(tmp_path, 450, 650)
    with pytest.raises(SpectrumError, match=r"the illuminant covers 450\.\.650 nm; 400\.\.700"):
        viewing_conditions(short)
    blind = spectrum(tmp_path, 450, 650, columns=3)
    with pytest.raises(SpectrumError, match=r"the observer covers 450\.\.650 nm"):
        viewing_conditions("A", blind)
    open_ended = spectrum(tmp_path, 390, 710, columns=3)
    with pytest.raises(SpectrumError, match="not at an end there"):
        viewing_conditions("A", open_ended)
    with pytest.raises(SpectrumError, match="3 values are needed"):
        viewing_conditions("A", spectrum(tmp_path, 380, 780))


def test_bradford_from_d65_to_d50_is_the_published_matrix() -> None:
    """B. Lindbloom's, for the whites of ASTM E308."""
    matrix = adaptation_matrix((0.95047, 1, 1.08883), (0.96422, 1, 0.82521))
    published = [
        [1.0478112, 0.0228866, -0.0501270],
        [0.0295424, 0.9904844, -0.0170491],
        [-0.0092345, 0.0150436, 0.7521316],
    ]
    np.testing.assert_allclose(matrix, published, atol=5e-7)


@pytest.mark.parametrize("transform", ["bradford", "cat02", "cat16", "vonkries", "xyz"])
def test_every_transform_takes_white_to_white(transform: str) -> None:
    white = (0.97, 1, 0.484)
    matrix = adaptation_matrix(white, D50, transform)
    np.testing.assert_allclose(matrix @ white, D50, rtol=1e-12)
