"""Coefficients come back, are as sure as is said, and fits that fail do not look like others."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fitted_cases import TRUTH, directions, made

from brdfc.colour.conditions import viewing_conditions
from brdfc.fit import fitting
from brdfc.fit.colours import to_xyz
from brdfc.fit.fit import fit, response_to
from brdfc.fit.fitting import Method, search
from brdfc.fit.formats import read_measurements
from brdfc.fit.measurements import Kind, Measurements, checked
from brdfc.fit.objectives import SCALES, ColourDifferences, Differences
from brdfc.fit.result import read_coefficients, with_defaults
from brdfc.lang.load import load
from brdfc.source.errors import FitError, ValueGivenError

CORNELL = Path(__file__).resolve().parents[3] / "shared" / "data" / "cornell"


@pytest.mark.parametrize("objective", ["de2000", *SCALES])
@pytest.mark.parametrize("name", TRUTH)
def test_exact_measurements_give_the_coefficients_back(name: str, objective: str) -> None:
    measured = made(name, TRUTH[name], directions())
    found = fit(load(name, "full"), measured, objective=objective)
    assert found.converged
    assert found.agreed >= found.starts - 2
    assert [e.value for e in found.estimates] == pytest.approx(TRUTH[name], rel=2e-3)
    assert found.difference is not None
    assert found.difference[2] < 0.05
    for estimate in found.estimates:
        assert estimate.low <= estimate.value <= estimate.high


def test_which_coefficients_are_linear() -> None:
    measured = made("ggx", TRUTH["ggx"], directions(20))
    response = response_to(load("ggx", "full"), measured)
    assert [c.name for c in response.coefficients if c.linear] == ["Rdx", "Rdy", "Rdz", "ks"]
    assert [c.name for c in response.coefficients if c.logarithmic] == ["alpha"]


def test_slopes_are_those_of_the_values() -> None:
    measured = made("cook_torrance", (0.1, 0.2, 0.6, 0.5, 0.2, 0.05), directions(40))
    response = response_to(load("cook_torrance", "full"), measured)
    at = np.array([0.2, 0.3, 0.4, 0.5, 0.3, 0.1])
    values, slopes = response.slopes(at)
    np.testing.assert_array_equal(values, response.values(at))
    for place in range(len(at)):
        step = np.eye(len(at))[place] * 1e-6
        expected = (response.values(at + step) - response.values(at - step)) / 2e-6
        np.testing.assert_allclose(slopes[..., place], expected, atol=1e-6, rtol=1e-5)


@pytest.mark.parametrize("noise", [0.01, 0.05])
def test_intervals_hold_the_truth_as_often_as_they_say(noise: float) -> None:
    """40 trials here; `python benchmarks/fitting.py intervals` makes 200 of each."""
    at = directions(200)
    inside = np.zeros(len(TRUTH["ward"]))
    for trial in range(40):
        measured = made("ward", TRUTH["ward"], at, noise, seed=trial)
        found = fit(load("ward", "full"), measured, objective="cube-root", starts=2)
        inside += [
            e.low <= t <= e.high for e, t in zip(found.estimates, TRUTH["ward"], strict=True)
        ]
    assert (inside / 40 >= 0.8).all()


def test_the_bootstrap_says_much_the_same() -> None:
    measured = made("ward", TRUTH["ward"], directions(150), 0.05)
    model = load("ward", "full")
    plain = fit(model, measured, objective="cube-root", starts=3)
    drawn = fit(model, measured, objective="cube-root", starts=3, bootstrap=60)
    assert drawn.bootstrap == 60
    for one, other in zip(plain.estimates, drawn.estimates, strict=True):
        assert one.value == other.value
        assert 0.5 < (other.high - other.low) / (one.high - one.low) < 2


def test_weights_count() -> None:
    """Two materials in one table: the one that has the weight is found."""
    at = directions(60)
    first, second = (made("lambert", rd, at) for rd in ((0.2, 0.2, 0.2), (0.7, 0.7, 0.7)))
    both = replace(
        first,
        directions=np.concatenate([at, at]),
        values=np.concatenate([first.values, second.values]),
        weights=np.repeat([1.0, 0.0], 60),
    )
    for objective in ("cube-root", "de2000"):
        found = fit(load("lambert", "full"), both, objective=objective)
        assert found.values["Rdy"] == pytest.approx(0.2, rel=1e-3)


def test_factors_of_the_difference() -> None:
    measured = made("ward", TRUTH["ward"], directions(80))
    values = response_to(load("ward", "full"), measured).values(
        np.array([0.2, 0.2, 0.6, 0.05, 0.2])
    )
    plain = ColourDifferences(measured).mean(values)
    loose = ColourDifferences(measured, (2.0, 2.0, 2.0)).mean(values)
    assert loose == pytest.approx(plain / 2)


def too_few() -> Measurements:
    return made("ward", TRUTH["ward"], directions(2))


def one_incidence() -> Measurements:
    return made("ward", TRUTH["ward"], directions(60, incidences=(45.0,)))


def away_from_the_mirror() -> Measurements:
    at = np.array([[0.7, z, 0.0, 0.0] for z in np.linspace(0.3, 1.2, 30)])
    return made("ward", TRUTH["ward"], at)


def saturated() -> Measurements:
    whole = made("ward", TRUTH["ward"], directions(200))
    return replace(whole, values=np.minimum(whole.values, 0.5))


def with_a_floor() -> Measurements:
    whole = made("ward", (0.001, 0.001, 0.001, 0.05, 0.1), directions(200))
    return replace(whole, values=np.maximum(whole.values, 1e-3))


def negative() -> Measurements:
    whole = made("ward", TRUTH["ward"], directions(100))
    values = whole.values.copy()
    values[:3] = -0.01
    return replace(whole, values=values)


def missing() -> Measurements:
    whole = made("ward", TRUTH["ward"], directions(100))
    values = whole.values.copy()
    values[:5, 1] = np.nan
    return replace(whole, values=values)


def matte() -> Measurements:
    return made("lambert", TRUTH["lambert"], directions(150), 0.01)


def mirror() -> Measurements:
    return made("ward", (0.01, 0.01, 0.01, 0.9, 0.001), directions(150))


@pytest.mark.parametrize(
    ("case", "message"),
    [
        (one_incidence, "all measurements are at one incidence, 45.0 degrees"),
        (away_from_the_mirror, "of the mirror direction: what is said of a highlight is a guess"),
        (saturated, "share the greatest value: peaks look saturated"),
        (with_a_floor, "share the least value: the instrument's floor"),
        (negative, "3 measurements have negative values, and are left out"),
        (missing, "5 measurements miss some of their values"),
        (matte, "m is not determined by these measurements"),
    ],
    ids=lambda c: getattr(c, "__name__", ""),
)
def test_what_a_fit_cannot_know_is_said(case: object, message: str) -> None:
    found = fit(load("ward", "full"), case(), objective="cube-root")  # type: ignore[operator]
    assert any(message in remark for remark in found.remarks), found.remarks


def test_a_mirror_is_narrower_than_what_was_measured() -> None:
    """No direction sees the highlight: nothing is known of its width."""
    found = fit(load("ward", "full"), mirror(), objective="cube-root")
    said = " ".join(found.remarks)
    assert "m is at the" in said or "m is not determined" in said


def test_tied_coefficients_are_named() -> None:
    """Near the normal GGX's ks and F0 are one number."""
    measured = made("ggx", TRUTH["ggx"], directions(150, incidences=(5.0, 10.0, 15.0)), 0.01)
    found = fit(load("ggx", "full"), measured, objective="cube-root")
    said = " ".join(found.remarks)
    assert "ks and F0 cannot be told apart" in said or "is not determined" in said


def test_too_few_geometries() -> None:
    with pytest.raises(FitError, match="2 geometries and 6 values for 5 coefficients of 'ward'"):
        fit(load("ward", "full"), too_few())
    assert fit(load("lambert", "full"), too_few()).converged


def test_a_search_that_is_cut_off_says_so(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(fitting, "POLISH_STEPS", 3)
    found = fit(load("ward", "full"), made("ward", TRUTH["ward"], directions(60), 0.05))
    assert not found.converged
    assert "did not converge: do not use" in found.remarks[0]
    (tmp_path / "fit.toml").write_text(found.to_toml())
    with pytest.raises(FitError, match="the fit did not converge"):
        read_coefficients(tmp_path / "fit.toml")


def test_what_is_no_colour_has_no_colour_difference() -> None:
    measured = made("ward", TRUTH["ward"], directions(60), kind=Kind.RGB)
    with pytest.raises(FitError, match="colour differences need X, Y, Z"):
        fit(load("ward", "full"), measured)
    found = fit(load("ward", "full"), measured, objective="cube-root")
    assert found.difference is None
    assert found.values["m"] == pytest.approx(0.15, rel=1e-3)


def test_wrong_names() -> None:
    measured = made("ward", TRUTH["ward"], directions(60))
    with pytest.raises(ValueGivenError, match="no objective 'de200'"):
        fit(load("ward", "full"), measured, objective="de200")
    with pytest.raises(ValueGivenError, match="'ward' has no 'alpha'"):
        fit(load("ward", "full"), measured, ranges={"alpha": (0.1, 0.2)})
    with pytest.raises(FitError, match="no zeniths and azimuths"):
        fit(load("ward"), measured)


def test_fixed_coefficients_and_ranges() -> None:
    measured = made("ggx", TRUTH["ggx"], directions(150))
    model = load("ggx", "full")
    found = fit(model, measured, fixed={"F0": (0.05,)}, ranges={"alpha": (0.05, 0.15)})
    assert "F0" not in found.values
    assert found.values["alpha"] == pytest.approx(0.15, rel=1e-3)
    assert any("alpha is at the greatest value" in remark for remark in found.remarks)
    assert "[fixed]\nF0 = [0.05]" in found.to_toml()


def test_a_file_is_read_back(tmp_path: Path) -> None:
    found = fit(load("ward", "full"), made("ward", TRUTH["ward"], directions(60)), starts=3)
    path = tmp_path / "fit.toml"
    path.write_text(found.to_toml())
    read = read_coefficients(path)
    assert read.model == "ward"
    assert read.values == pytest.approx(found.values)
    quantity = with_defaults(load("ward"), read).quantity("Rd")
    assert quantity is not None
    shares = [v / w for v, w in zip(TRUTH["ward"], read.white, strict=False)]
    assert quantity.default == pytest.approx(shares, rel=1e-3)
    with pytest.raises(FitError, match="fitted with 'ward', not 'lambert'"):
        with_defaults(load("lambert"), read)
    with pytest.raises(FitError, match=r"ks = 1.5 lies outside 0\.\.1, which 'ward' declares"):
        with_defaults(load("ward"), replace(read, values={**read.values, "ks": 1.5}))
    path.write_text("model = 3")
    with pytest.raises(FitError, match="no coefficients"):
        read_coefficients(path)


def test_the_simplex_alone_is_there_to_compare_with() -> None:
    measured = made("ward", TRUTH["ward"], directions(100))
    response = response_to(load("ward", "full"), measured)
    found = search(response, measured, starts=3, method=Method.SIMPLEX)
    assert found.starts == 3
    assert 1 <= found.agreed <= 3


def test_residuals_leave_out_what_is_missing_or_negative() -> None:
    measured = made("lambert", TRUTH["lambert"], directions(5))
    values = measured.values.copy()
    values[0, 0], values[1, 1] = np.nan, -1
    differences = Differences(replace(measured, values=values), SCALES["cube-root"])
    residuals = differences.residuals(measured.values * 2).reshape(5, 3)
    assert residuals[0, 0] == residuals[1, 1] == 0
    assert (residuals[2:] > 0).all()


@pytest.mark.skipif(not CORNELL.is_dir(), reason="no ../shared/data here")
@pytest.mark.parametrize(
    ("paint", "model", "ranges", "limit"),
    [
        ("garnet_red", "ward", {}, 5.0),
        ("garnet_red", "ggx", {"ks": (0.0, 10.0)}, 3.1),
        ("acryl_blue", "ward", {}, 2.9),
    ],
)
def test_paints(
    paint: str, model: str, ranges: dict[str, tuple[float, float]], limit: float
) -> None:
    measured = to_xyz(read_measurements(CORNELL / f"{paint}.brdf"), viewing_conditions())
    found = fit(load(model, "full"), measured, ranges=ranges)
    assert found.converged
    assert found.difference is not None
    assert found.difference[0] <= limit


def test_one_band() -> None:
    """A single value a direction is fitted as neutral."""
    at = directions(60)
    values = made("ward", (0.3, 0.3, 0.3, 0.05, 0.15), at, kind=Kind.RGB).values[:, :1]
    single = checked(at, values, Kind.SPECTRAL, wavelengths=(532.0,), name="laser")
    found = fit(load("ward", "full"), to_xyz(single, viewing_conditions()))
    assert found.values["Rdy"] == pytest.approx(0.3, rel=1e-2)
    assert found.values["m"] == pytest.approx(0.15, rel=1e-2)
