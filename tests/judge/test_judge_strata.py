"""Points where reflectance models live and where they fail, in the plane and out of it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from stability_models import compiled

from brdfc.judge.directions import directions, wrapped
from brdfc.judge.failure_strata import STRATA, applicable, failure_points
from brdfc.judge.problem import Problem
from brdfc.judge.samples import sample
from brdfc.judge.strata import Points, points
from brdfc.lang.load import load, load_text
from brdfc.lang.model import Model
from brdfc.prepared import prepare, problem_of

RIGHT = float(np.float32(math.pi / 2))
EACH = 2_000


def problem(name: str) -> Problem:
    return compiled(name)[1]


def failing(name: str, stratum: str) -> dict[str, np.ndarray]:
    of = problem(name)
    shares = dict.fromkeys(STRATA, 0) | {stratum: EACH}
    at = failure_points(of.ranges.domain, of.quantities, shares)
    assert set(at.strata) == {stratum}
    return {n: v.astype(np.float64) for n, v in at.values.items()}


def half_vector_angle(at: dict[str, np.ndarray]) -> np.ndarray:
    """Between half vector and normal, in radians, from unit vectors."""
    ti, tr, ai, ar = (
        at[n][:, 0].astype(np.float64)
        for n in ("incident", "reflection", "incident_azimuth", "reflection_azimuth")
    )
    across = [np.sin(ti) * f(ai) + np.sin(tr) * f(ar) for f in (np.cos, np.sin)]
    return np.arctan2(np.hypot(*across), np.cos(ti) + np.cos(tr))


# ------------------------------------------------------------ which angle is what


def test_an_angle_of_a_whole_turn_is_an_azimuth_and_a_third_one_turns_the_surface() -> None:
    plane, full = directions(problem("ward").quantities), directions(problem("full").quantities)
    assert plane.zeniths == full.zeniths == ("incident", "reflection")
    assert plane.azimuths == ()
    assert full.azimuths == ("incident_azimuth", "reflection_azimuth")
    assert full.full
    assert not plane.full
    turned = directions(anisotropic().quantities)
    assert turned.zeniths == ("incident", "reflection")
    assert not turned.full


def test_azimuths_are_wrapped_into_the_range() -> None:
    given = np.array([0.0, 3.0, 4.0, -4.0, 10.0])
    found = wrapped(given)
    assert (np.abs(found) <= math.pi).all()
    np.testing.assert_allclose(np.cos(found), np.cos(given), atol=1e-12)
    np.testing.assert_allclose(np.sin(found), np.sin(given), atol=1e-12)


def anisotropic() -> Model:
    text = """model turned "Turned"
  cite "our own"

channel Rd : XYZ in 0..1 = 0.5 "diffuse reflectance"
env incident    : angle in -90deg..90deg = 45deg as inci "incidence"
env reflection  : angle in -90deg..90deg = 0deg  as refl "viewing"
env orientation : angle in -90deg..90deg = 0deg  as orie "tangent to the plane of incidence"

radiance = cos(incident)*Rd/pi*cos(orientation)^2*cos(reflection)^2
"""
    found = load_text(text)
    assert isinstance(found, Model)
    return found


# ------------------------------------------------------------ points for the search


def lobe_points(of: Problem) -> tuple[Points, np.ndarray]:
    at = points(of.ranges.domain, of.quantities, 300)
    return at, np.isin(at.strata, ("lobe", "grazing lobe"))


def test_out_of_plane_the_lobe_is_hit_and_some_of_its_points_are_at_retro_reflection() -> None:
    at, lobe = lobe_points(problem("full"))
    values = {n: v[lobe] for n, v in at.values.items()}
    turn = values["reflection_azimuth"] - values["incident_azimuth"]
    retro = np.cos(turn.astype(np.float64))[:, 0] > 0.5
    zenith = values["incident"][:, 0]
    away = zenith > 0.1  # near the normal all azimuths are the lobe's
    assert 0.05 < np.mean(retro[away]) < 0.35
    tilt = np.tan(half_vector_angle(values)) / values["m"][:, 0]
    assert np.mean(tilt[~retro] < 6) > 0.9
    assert np.mean(tilt[~retro] < 1) > 0.1


def test_a_third_angle_is_no_ones_mirror() -> None:
    roles, ready = prepare(anisotropic(), {}, ())
    at, lobe = lobe_points(problem_of(roles, ready))
    apart = at.values["orientation"][lobe] - at.values["incident"][lobe]
    assert np.mean(np.abs(apart) > 0.5) > 0.4


# ------------------------------------------------------------ points of the self-check


def test_the_self_check_looks_at_the_lobe_out_of_plane() -> None:
    of = problem("full")
    channels, variables = of.quantities[:3], of.quantities[3:]
    found = sample(of.ranges.domain, channels, variables, runs=600)
    mirrored = [run for i, run in enumerate(found.runs) if i % 6 in (1, 3)]
    at = {n: np.array([[run[n]] for run in mirrored]) for n in mirrored[0]}
    assert (np.abs(at["reflection_azimuth"]) <= np.float32(math.pi)).all()
    assert np.mean(half_vector_angle(at) < 0.01) > 0.1
    same = np.cos(at["reflection_azimuth"] - at["incident_azimuth"])[:, 0] > 0.5
    assert 0.1 < np.mean(same) < 0.5


# ------------------------------------------------------------ points where methods fail


@pytest.mark.parametrize("name", ["ward", "full", "lambert"])
def test_failure_points_lie_in_the_domain_and_are_the_same_every_time(name: str) -> None:
    of = problem(name)
    shares = dict.fromkeys(STRATA, 300)
    at, again = (failure_points(of.ranges.domain, of.quantities, shares) for _ in range(2))
    assert list(dict.fromkeys(at.strata)) == applicable(of.quantities)
    for quantity, values in at.values.items():
        ends = of.ranges.domain[quantity]
        assert (values >= np.float32(ends.low)).all()
        assert (values <= np.float32(ends.high)).all()
        assert (values == again.values[quantity]).all()


def test_strata_that_say_nothing_of_a_model_are_left_out() -> None:
    assert applicable(problem("ward").quantities) == list(STRATA)
    roles, ready = prepare(load("lambert"), {}, ())
    one_angle = applicable(problem_of(roles, ready).quantities)
    assert not {"mirror", "grazing mirror", "retro", "shape low", "shape high"} & set(one_angle)
    assert {"grazing", "normal", "horizon", "corners", "uniform"} <= set(one_angle)


@pytest.mark.parametrize("name", ["ward", "full"])
def test_each_stratum_is_what_it_says(name: str) -> None:
    full = name == "full"
    mirror = failing(name, "mirror")
    if not full:
        half = np.abs(mirror["incident"] - mirror["reflection"])[:, 0] / 2
    else:
        half = half_vector_angle(mirror)
    assert np.mean(half < 3.1 * mirror["m"][:, 0] * (2 if full else 1)) > 0.6
    assert np.mean(half < 1e-6) > 0.02

    normal = failing(name, "normal")
    assert (np.minimum(np.abs(normal["incident"]), np.abs(normal["reflection"])) < 0.1).all()
    assert (normal["incident"] == 0).any()

    grazing = failing(name, "grazing")
    nearest = np.minimum(*(RIGHT - np.abs(grazing[n]) for n in ("incident", "reflection")))
    assert (nearest < 0.1).all()
    assert (nearest < 1e-5).any()

    horizon = failing(name, "horizon")
    at_end = np.abs(horizon["incident"]) == RIGHT
    assert np.mean(at_end) > 0.2
    assert np.mean(at_end & (np.abs(horizon["reflection"]) == RIGHT)) > 0.05

    retro = failing(name, "retro")
    if full:
        turn = np.cos(retro["reflection_azimuth"] - retro["incident_azimuth"])
        near = (np.abs(retro["reflection"] - retro["incident"]) < 0.3) & (turn > 0.9)
    else:
        near = np.abs(retro["reflection"] + retro["incident"]) < 0.3
    assert np.mean(near) > 0.5

    assert (failing(name, "shape low")["m"] == np.float32(0.001)).all()
    assert (failing(name, "shape high")["m"] == 1).all()
    assert 0.4 < np.mean(failing(name, "coefficients low")["ks"] == 0) < 0.6
    assert 0.4 < np.mean(failing(name, "coefficients high")["Rd"] == 1) < 0.6


def test_the_horizon_goes_beyond_where_the_range_does() -> None:
    text = """model beyond "Beyond"
  cite "our own"

channel Rd : XYZ in 0..1 = 0.5 "diffuse reflectance"
env incident : angle in -120deg..120deg = 45deg as inci "incidence"

radiance = cos(incident)*Rd/pi where cos(incident) > 0 else 0
"""
    beyond = load_text(text)
    assert isinstance(beyond, Model)
    roles, ready = prepare(beyond, {}, ())
    of = problem_of(roles, ready)
    at = failure_points(of.ranges.domain, of.quantities, dict.fromkeys(STRATA, 400))
    angle = np.abs(at.values["incident"][np.array(at.strata) == "horizon"])
    assert np.mean(angle > RIGHT + 0.01) > 0.1
    assert ((angle > RIGHT) & (angle < RIGHT + 1e-6)).any()
    assert ((angle < RIGHT) & (angle > RIGHT - 1e-6)).any()


def test_an_exponent_is_a_shape() -> None:
    roles, ready = prepare(load("ashikhmin_shirley"), {}, ())
    of = problem_of(roles, ready)
    at = failure_points(of.ranges.domain, of.quantities, dict.fromkeys(STRATA, 50))
    assert (at.values["n"][np.array(at.strata) == "shape high"] == 100_000).all()
