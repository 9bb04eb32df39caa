"""Laws that models say they break: the figures they state are reproduced at the point."""

from __future__ import annotations

import pytest
from law_models import given, reflectance

from brdfc.laws.breaches import reproduce
from brdfc.laws.claims import Claim, shown
from brdfc.laws.reflectance import ANGLES

ENERGY = Claim("energy", 1, text="energy <= 1")


@pytest.mark.parametrize(
    ("name", "incident", "m", "stated"),
    [
        ("ward_duer", 85, 0.2, 1.128),
        ("ward_duer", 89, 0.2, 3.375),
        ("ward_duer", 89, 0.5, 5.14),
        ("ward_printed", 89, 0.2, 13.9),
    ],
)
def test_published_albedos_above_1(name: str, incident: float, m: float, stated: float) -> None:
    point = given(name, ks=1, m=m, incident=incident)
    found = reproduce(reflectance(name), ENERGY, point, stated, 5e-3)
    assert found.agrees
    assert found.breaks


def test_a_figure_that_is_not_there() -> None:
    point = given("ward_duer", ks=1, m=0.2, incident=85)
    found = reproduce(reflectance("ward_duer"), ENERGY, point, 1.2, 1e-2)
    assert not found.agrees
    assert found.breaks
    assert found.figure == pytest.approx(1.128, abs=1e-3)


def test_a_point_where_the_law_holds() -> None:
    point = given("ward_duer", ks=1, m=0.2, incident=60)
    found = reproduce(reflectance("ward_duer"), ENERGY, point, 0.917, 1e-3)
    assert found.agrees
    assert not found.breaks


def test_both_ways_of_the_formula_as_printed() -> None:
    # Without the diffuse part the ratio of both ways is that of the cosines: 1 - cos 60deg.
    point = given("ward_printed", ks=1, m=0.5, incident=0, reflection=60)
    found = reproduce(reflectance("ward_printed"), Claim("reciprocal"), point, 0.5, 1e-9)
    assert found.agrees
    assert found.breaks


def test_the_least_component_below_zero() -> None:
    of = reflectance("lambert", " - (0, 0.25, 0)")
    point = given("lambert", incident=60)
    found = reproduce(of, Claim("positive"), point, -0.125, 1e-9)
    assert found.agrees
    assert found.breaks


def test_a_reflectance_above_its_bound() -> None:
    point = given("minnaert", Rd=(1.0, 1.0, 1.0), k=0.5, incident=89, reflection=89)
    found = reproduce(reflectance("minnaert"), Claim("bounded", 10), point, 13.6791, 1e-5)
    assert found.agrees
    assert found.breaks


def test_points_are_shown_as_a_text_would_give_them() -> None:
    point = given("ward", Rd=(0.1, 0.2, 0.3), m=0.2, incident=80)
    names = {name: point[name] for name in ("Rd", "m", "incident", "reflection_azimuth")}
    assert (
        shown(names, ANGLES) == "incident=80deg reflection_azimuth=180deg Rd=(0.1, 0.2, 0.3) m=0.2"
    )
