"""The textbook formulas where much is known of them: swapped directions, special values."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from textbook import NUMPY, TEXTBOOK, Directions, directions, plane_directions, precise
from textbook_samples import RD, SAMPLES, Array, arrays, columns, somewhere


def swapped(where: Directions) -> Directions:
    return Directions(where.viewer, where.light)


def brdf(name: str, where: Directions, values: dict[str, Array]) -> Array:
    return np.asarray(TEXTBOOK[name](NUMPY, where, values) / where.light[2])


@pytest.mark.parametrize("name", [name for name in TEXTBOOK if name != "ward_printed"])
def test_a_brdf_is_reciprocal(name: str) -> None:
    where = directions(NUMPY, *columns(somewhere(20_000, 1)))
    values = arrays(SAMPLES[name])
    forth, back = brdf(name, where, values), brdf(name, swapped(where), values)
    np.testing.assert_allclose(forth, back, rtol=1e-10)


def test_what_is_not_reciprocal() -> None:
    """Ward's lobe as printed, and Phong's divided by the cosine of incidence: by a factor co/ci."""
    where = directions(NUMPY, *columns(somewhere(20_000, 1)))
    values = arrays({"Rd": 0, "ks": 1, "m": 0.2, "n": 50})
    for name, cosine in (("ward_printed", 1), ("phong", where.light[2])):
        back_cosine = where.viewer[2] if name == "phong" else 1
        forth = brdf(name, where, values) / cosine
        back = brdf(name, swapped(where), values) / back_cosine
        larger = np.maximum(forth, back)
        lit = larger > np.finfo(float).tiny
        worst = (abs(forth - back)[lit] / larger[lit]).max()
        assert worst == pytest.approx(0.98, abs=0.005)


EQUAL: list[tuple[str, dict[str, Any], str, dict[str, Any]]] = [
    ("ward_anisotropic", {"mx": 0.2, "my": 0.2}, "ward", {"m": 0.2}),
    ("ward_gmd_anisotropic", {"mx": 0.2, "my": 0.2}, "ward_gmd", {"m": 0.2}),
    ("ggx_anisotropic", {"alphax": 0.2, "alphay": 0.2}, "ggx", {"alpha": 0.2}),
    ("ashikhmin_shirley_anisotropic", {"nu": 60, "nv": 60}, "ashikhmin_shirley", {}),
    ("disney_anisotropic", {"anisotropic": 0}, "disney", {}),
    ("cook_torrance_ngan", {"ks": 0.1 * math.pi}, "cook_torrance", {"ks": 0.4}),
    ("cook_torrance_2", {"ks1": 0, "ks2": 1}, "cook_torrance", {"ks": 1, "m": 0.3, "F0": 0.5}),
    ("cook_torrance_3", {"ks3": 0}, "cook_torrance_2", {}),
    ("lafortune", {"ks": 31 / math.pi, "Cxy": -1, "Cz": 1, "n": 60}, "phong", {"ks": 1}),
    ("lafortune_2", {"ks2": 0}, "lafortune", {}),
    ("lafortune_3", {"ks3": 0}, "lafortune_2", {}),
    ("hapke", {"B0": 0, "w": 1e-9}, "lommel_seeliger", {"w": 1e-9}),
    ("oren_nayar", {"sigma": 0}, "lambert", {}),
    ("oren_nayar_qualitative", {"sigma": 0}, "lambert", {}),
    ("eon", {"r": 1e-6}, "lambert", {}),
    ("minnaert", {"k": 1}, "lambert", {}),
]


@pytest.mark.parametrize(("name", "values", "other", "others"), EQUAL, ids=lambda v: str(v)[:30])
def test_where_two_models_are_one(
    name: str, values: dict[str, Any], other: str, others: dict[str, Any]
) -> None:
    where = directions(NUMPY, *columns(somewhere(1000, 4)))
    one = brdf(name, where, arrays(SAMPLES[name] | values))
    two = brdf(other, where, arrays(SAMPLES[other] | others))
    np.testing.assert_allclose(one, two, rtol=1e-4 if name in ("eon", "hapke") else 1e-9)


def test_a_thick_layer_of_ink_hides_the_paper() -> None:
    """Kubelka and Munk: R = 1 + K/S - sqrt((K/S)^2 + 2 K/S)."""
    thick = SAMPLES["print_layer"] | {"SX": 20.0, "tone": 1, "ks": 0, "KS": 1, "Rg": RD}
    radiance = precise("print_layer", {"incident": 30, "reflection": 0}, thick)
    assert radiance[0] == pytest.approx(radiance[2])
    ink, index2 = 2 - math.sqrt(3), 1.5**2
    inside = 1 - (1 - 0.04 - 0.96 / 21) / index2
    assert precise("print_layer", {"incident": 0, "reflection": 0}, thick)[1] == pytest.approx(
        0.96**2 * ink / (1 - inside * ink) / (math.pi * index2)
    )


WIDE = [
    ("ward_anisotropic", {"mx": 0.4, "my": 0.1}, "ward", {"m": 0.4}),
    ("ward_gmd_anisotropic", {"mx": 0.4, "my": 0.1}, "ward_gmd", {"m": 0.4}),
    ("ggx_anisotropic", {"alphax": 0.4, "alphay": 0.1}, "ggx", {"alpha": 0.4}),
]


@pytest.mark.parametrize(("name", "widths", "other", "width"), WIDE, ids=str)
def test_along_the_tangent_only_the_first_width_counts(
    name: str, widths: dict[str, float], other: str, width: dict[str, float]
) -> None:
    """Save in the normalisation, which has the second as well."""
    lobe = {"Rd": 0, "ks": 1, "F0": 0.04}
    where = plane_directions(NUMPY, *columns(somewhere(1000, 5)[:, :2]))
    one = brdf(name, where, arrays(lobe | widths))
    two = brdf(other, where, arrays(lobe | width))
    np.testing.assert_allclose(one, two * 0.4 / 0.1, rtol=1e-9)


@pytest.mark.parametrize(
    ("name", "shape"),
    [("ashikhmin_shirley_anisotropic", {"nu": 5, "nv": 50}), ("disney_anisotropic", {})],
)
def test_the_lobe_is_longer_along_the_tangent(name: str, shape: dict[str, float]) -> None:
    along, across = (
        precise(name, {"incident": 40, "reflection": 0, "orientation": o}, SAMPLES[name] | shape)
        for o in (0, 90)
    )
    assert along[0] > 1.2 * across[0]


# Light and viewer along the normal, where most factors are simple.
FACING: list[tuple[str, dict[str, Any], float]] = [
    ("abc_microfacet", {"Rd": (0, 0, 0), "A": 3, "eta": 3}, 3 / 4 / math.pi),
    ("abc_smooth", {"Rd": (0, 0, 0), "A": 3, "eta": 3}, 3 / 4),
    ("disney", {"metallic": 0, "specular": 0, "clearcoat": 0}, 0.1 / math.pi),
    (
        "disney",
        {"metallic": 1, "roughness": 0.5, "clearcoat": 0},
        0.1 * 16 / math.pi / 4,  # D is 1/(pi r^4), G 1/4
    ),
    (
        "disney",
        {"base": (0, 0, 0), "specular": 0, "metallic": 0, "clearcoat": 1, "gloss": 0},
        # GTR1 with b = .1; the factors 1/4 of the coat and of G; F0 .04
        (1 / 0.01 - 1) / (math.pi * math.log(100)) / 4 * 0.04 / 4,
    ),
    ("lommel_seeliger", {"b": 0.5}, 0.2 / (8 * math.pi) * 0.75 / 1.5**3),
    (
        "hapke",
        {"w": (0.75, 0.75, 0.75), "b": 0.5, "B0": 1},
        0.75 / (8 * math.pi) * (2 * 0.75 / 1.5**3 + 1.5**2 - 1),
    ),
    ("cook_torrance", {"Rd": (0, 0, 0), "ks": 1, "m": 0.5, "F0": 0.3}, 0.3 / math.pi),
]


@pytest.mark.parametrize(("name", "values", "expected"), FACING, ids=lambda v: str(v)[:40])
def test_along_the_normal(name: str, values: dict[str, Any], expected: float) -> None:
    radiance = precise(name, {"incident": 0, "reflection": 0}, SAMPLES[name] | values)
    assert radiance[0] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("degrees", [0, 30, 60, 80])
def test_a_smooth_surface_mirrors_by_fresnel(degrees: float) -> None:
    """With A = 1 the value in the mirror direction is the reflectance."""
    values = {"Rd": (0, 0, 0), "A": 1, "B": 1000, "C": 1, "eta": 1.5}
    radiance = precise("abc_smooth", {"incident": degrees, "reflection": degrees}, values)
    cosine = math.cos(math.radians(degrees))
    assert radiance[0] / cosine == pytest.approx(fresnel(1.5, cosine), rel=1e-12)


# Light at 80 deg, viewer at 40 deg on the mirror's side, so that all follows from angles: the half
# angle is 20 deg, the difference angle 60 deg, the phase angle 120 deg.
COS_20, COS_40, COS_60, COS_80 = (math.cos(math.radians(x)) for x in (20, 40, 60, 80))
SIN_40, SIN_80 = math.sin(math.radians(40)), math.sin(math.radians(80))
CAVITY = 2 * COS_20 * COS_80 / COS_60  # the share that V-cavities let pass
FADE = (1 - COS_60) ** 5
BLACK = {"base": (0, 0, 0), "metallic": 0, "specular": 0, "sheen": 0, "clearcoat": 0, "gloss": 0.5}


def smith(width: float) -> float:
    """GGX masking of one direction and then of the other, over 4 cos cos."""
    one, other = (1 / (x + math.sqrt(width**2 * (1 - x**2) + x**2)) for x in (COS_40, COS_80))
    return one * other


def fresnel(index: float, cosine: float) -> float:
    """By the law of refraction."""
    refracted = math.sqrt(1 - (1 - cosine**2) / index**2)
    s = (cosine - index * refracted) / (cosine + index * refracted)
    p = (index * cosine - refracted) / (index * cosine + refracted)
    return (s**2 + p**2) / 2


def trowbridge_reitz(width: float) -> float:
    return width**2 / (math.pi * (1 - COS_20**2 + (width * COS_20) ** 2) ** 2)


def berry(width: float) -> float:
    """GTR1, the clear coat's distribution."""
    slope = width**2 - 1
    return slope / (math.pi * math.log(width**2) * (1 + slope * COS_20**2))


# A model, values, what is added to them, and by how much that raises the BRDF.
LEANING: list[tuple[str, dict[str, Any], dict[str, Any], float]] = [
    (
        "abc_microfacet",
        {"Rd": (0, 0, 0), "A": 0, "B": 50, "C": 1.3, "eta": 1.5},
        {"A": 2},
        2
        * (1 + 50 * (1 - COS_20)) ** -1.3
        * fresnel(1.5, COS_60)
        * CAVITY
        / (math.pi * COS_40 * COS_80),
    ),
    (
        "abc_smooth",
        {"Rd": (0, 0, 0), "A": 0, "B": 50, "C": 1.3, "eta": 1.5},
        {"A": 2},
        2
        * (1 + 50 * (SIN_80 - SIN_40) ** 2) ** -1.3
        * fresnel(1.5, math.sqrt(1 - (SIN_80 + SIN_40) ** 2 / 4)),
    ),
    ("disney", BLACK | {"roughness": 0.4}, {"sheen": 1}, FADE),
    (
        "disney",
        BLACK | {"roughness": 0.4},
        {"clearcoat": 1},
        0.25 * berry(0.0505) * (0.04 + 0.96 * FADE) * smith(0.25),
    ),
    (
        "disney",
        BLACK | {"roughness": 0.4},
        {"specular": 1},
        trowbridge_reitz(0.16) * 0.08 * (1 - FADE) * smith(0.49),
    ),
    (
        "hapke",
        {"w": (0.5, 0.5, 0.5), "b": 0.3, "B0": 0, "h": 0.2},
        {"B0": 1},
        0.5
        / (4 * math.pi * (COS_40 + COS_80))
        * (0.91 / (1.09 + 0.6 * -COS_60) ** 1.5)
        / (1 + math.tan(math.radians(60)) / 0.2),
    ),
]


@pytest.mark.parametrize(
    ("name", "values", "added", "expected"), LEANING, ids=lambda v: str(v)[:40]
)
def test_away_from_the_mirror_direction(
    name: str, values: dict[str, Any], added: dict[str, Any], expected: float
) -> None:
    angles = {"incident": 80, "reflection": 40}
    less, more = (precise(name, angles, v)[0] / COS_80 for v in (values, values | added))
    assert more - less == pytest.approx(expected, rel=1e-12)
