"""Directional albedos against closed forms and published figures."""

from __future__ import annotations

import math

import numpy as np
import pytest
from law_models import given, model, reflectance

from brdfc.laws.albedo import TOLERANCE, Albedos, albedos
from brdfc.laws.reflectance import Reflectance

INCIDENCES = (0.0, 30.0, 60.0, 80.0, 85.0, 89.0)
DARK, WHITE = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)


def at(of: Reflectance, *points: dict[str, tuple[float, ...]]) -> Albedos:
    columns = {name: np.array([point[name] for point in points]) for name in points[0]}
    return albedos(of, columns)


def curve(
    name: str, incidences: tuple[float, ...] = INCIDENCES, **values: float | tuple[float, ...]
) -> list[float]:
    """The albedos of a model at some incidences, each of which has to converge."""
    found = at(reflectance(name), *(given(name, incident=t, **values) for t in incidences))
    assert found.converged.all()
    assert (found.error <= TOLERANCE * np.maximum(1, found.value)).all()
    return [float(v) for v in found.value]


def test_lambert_reflects_its_coefficient_in_the_component_that_reflects_most() -> None:
    assert curve("lambert", (0, 45, 89, 89.99), Rd=(0.1, 0.7, 0.3)) == pytest.approx(
        [0.7] * 4, abs=1e-5
    )


@pytest.mark.parametrize(
    ("name", "published"),
    [
        ("ward", (0.895, 0.777, 0.459, 0.216, 0.182, 0.242)),
        ("ward_gmd", (0.960, 0.953, 0.898, 0.799, 0.806, 0.899)),
        ("ward_duer", (0.928, 0.928, 0.917, 0.918, 1.128, 3.375)),
    ],
)
def test_the_ward_family(name: str, published: tuple[float, ...]) -> None:
    assert curve(name, ks=1, m=0.2) == pytest.approx(published, abs=6e-4)


@pytest.mark.parametrize("k", [0.25, 0.5, 1.5, 2.0])
def test_minnaert_is_a_power_of_the_cosine(k: float) -> None:
    wanted = [math.cos(math.radians(t)) ** (k - 1) for t in INCIDENCES]
    assert curve("minnaert", Rd=WHITE, k=k) == pytest.approx(wanted, rel=1e-4, abs=1e-5)


@pytest.mark.parametrize("m", [0.001, 0.01, 0.1])
def test_a_narrow_lobe_is_not_missed(m: float) -> None:
    # At the normal the GMD lobe loses the mean square slope m^2, and nothing else.
    near, steep = curve("ward_gmd", (0, 60), ks=1, m=m)
    assert near == pytest.approx(1 - m**2, abs=2e-5)
    assert steep == pytest.approx(1, abs=0.03)


@pytest.mark.parametrize("n", [50.0, 10000.0])
def test_a_lobe_round_in_the_viewing_direction(n: float) -> None:
    # At the normal (n + 2)/(2 pi) normalises the power exactly; a narrow lobe falls as the cosine.
    normal, slanted = curve("phong", (0, 60), ks=1, n=n)
    assert normal == pytest.approx(1, abs=2e-5)
    assert slanted == pytest.approx(0.5, abs=2e-5)


@pytest.mark.parametrize("incident", [0.0, 1.0, 3.0, 10.0])
def test_a_narrow_lobe_towards_the_light(incident: float) -> None:
    # (l.v)^n with n large: its integral with the cosine is cos(ti) 2 pi/(n + 2).
    (found,) = curve("lafortune", (incident,), ks=100, Cxy=1, Cz=1, n=1000)
    assert found == pytest.approx(
        100 * 2 * math.pi / 1002 * math.cos(math.radians(incident)), rel=1e-3
    )


@pytest.mark.parametrize("turned", [0.0, 17.0, 90.0, -135.0])
@pytest.mark.parametrize(("mx", "my"), [(0.001, 0.2), (0.1, 0.001)])
def test_a_needle_along_an_axis_of_the_tangent_frame(mx: float, my: float, turned: float) -> None:
    (found,) = curve("ward_gmd_anisotropic", (0,), ks=1, mx=mx, my=my, incident_azimuth=turned)
    assert found == pytest.approx(1 - (mx**2 + my**2) / 2, abs=3e-5)


def test_a_needle_has_the_same_albedo_when_its_axes_are_exchanged() -> None:
    one = curve("ward_gmd_anisotropic", ks=1, mx=0.005, my=0.4, incident_azimuth=-20)
    other = curve("ward_gmd_anisotropic", ks=1, mx=0.4, my=0.005, incident_azimuth=70)
    assert one == pytest.approx(other, abs=2e-4)


def test_a_step_is_refined_until_it_converges() -> None:
    of = Reflectance(model("channel Rd : XYZ in 0..1 = 1\n", "Rd/pi*(1 where co > 0.5 else 0)"))
    found = at(of, *({"Rd": WHITE, "incident": (t,), "incident_azimuth": (0.0,)} for t in (0, 1)))
    assert found.converged.all()
    assert found.value == pytest.approx([0.75, 0.75], abs=1e-4)


def test_without_values_in_the_hemisphere_there_is_no_albedo() -> None:
    of = Reflectance(model("channel Rd : XYZ in 0..1 = 1\n", "Rd*sqrt(co - 0.5)"))
    found = at(of, {"Rd": WHITE, "incident": (0.3,), "incident_azimuth": (0.0,)})
    assert not found.converged[0]
    assert np.isnan(found.value[0])


def test_albedos_are_the_same_alone_and_side_by_side() -> None:
    points = [given("ggx", ks=1, F0=1, alpha=a, incident=t) for a in (0.01, 0.5) for t in (0, 70)]
    together = at(reflectance("ggx"), *points).value
    alone = [at(reflectance("ggx"), point).value[0] for point in points]
    assert list(together) == pytest.approx(alone, abs=1e-12)


def test_models_know_whether_they_are_isotropic() -> None:
    assert reflectance("ward_gmd").isotropic
    assert not reflectance("ward_gmd_anisotropic").isotropic
