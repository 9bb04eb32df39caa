"""Building blocks that no judge has, against what defines them, from unit vectors."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from library import Array, composed
from unit_vectors import diffuse_light, pairs

Definition = Callable[[Any], Array]
"""Of a namespace: l, v, h unit vectors, ci, co cosines, c = h.z, d = l.h."""


def azimuths(g: Any) -> Array:
    """max(0, cos of the azimuth difference)."""
    inside = (g.l[:, :2] * g.v[:, :2]).sum(axis=1)
    return np.maximum(0.0, inside / np.hypot(*g.l.T[:2]) / np.hypot(*g.v.T[:2]))


def oren_nayar(g: Any) -> Array:
    """M. Oren, S. Nayar, SIGGRAPH 1994, the qualitative model, sigma = 0.4."""
    ti, tr = np.arccos(g.ci), np.arccos(g.co)
    a, b = 1.0 - 0.5 * 0.16 / (0.16 + 0.33), 0.45 * 0.16 / (0.16 + 0.09)
    rest = azimuths(g) * np.sin(np.maximum(ti, tr)) * np.tan(np.minimum(ti, tr))
    return (a + b * rest) / math.pi


def coupled(g: Any) -> Array:
    """M. Ashikhmin, P. Shirley, JGT 5(2), 2000, equation 5 for Rd = 1 and Rs = 0."""
    fades = [1.0 - (1.0 - x / 2.0) ** 5 for x in (g.ci, g.co)]
    return 28.0 / (23.0 * math.pi) * fades[0] * fades[1]


def anisotropic_exponent(g: Any) -> Array:
    """nu cos² + nv sin² of the half vector's azimuth."""
    return (20.0 * g.h[:, 0] ** 2 + 300.0 * g.h[:, 1] ** 2) / (g.h[:, :2] ** 2).sum(axis=1)


def masking(cosine: Array, m: float) -> Array:
    """Smith's G1 for Gaussian slopes (B. Walter et al., EGSR 2007, equation 26)."""
    a = cosine / (m * np.sqrt(1.0 - cosine**2))
    erf = np.array([math.erf(x) for x in a.tolist()])
    return 2.0 / (1.0 + erf + np.exp(-(a**2)) / (a * math.sqrt(math.pi)))


def correlated(g: Any) -> Array:
    """E. Heitz, JCGT 3(2), 2014: 1/(1 + Li + Lo) with G1 = 1/(1 + L), over ci co."""
    return 1.0 / ((1.0 / masking(g.ci, 0.5) + 1.0 / masking(g.co, 0.5) - 1.0) * g.ci * g.co)


BLOCKS: dict[str, tuple[Definition, float]] = {
    "neumann": (lambda g: np.minimum(g.ci, g.co) / (g.ci * g.co), 1e-12),
    "kelemen": (lambda g: g.ci * g.co / g.d**2 / (g.ci * g.co), 1e-9),
    "gaussian(0.2)": (lambda g: np.exp(-((np.arccos(g.c) / 0.2) ** 2)), 1e-9),
    "abc(2000, 1.1)": (lambda g: (1.0 + 2000.0 * (1.0 - g.c)) ** -1.1, 1e-9),
    "blinn_phong(60)": (lambda g: g.c**60, 1e-9),
    "blinn_phong(1e4)": (lambda g: g.c**1e4, 1e-9),
    "blinn_phong_anisotropic(20, 300)": (lambda g: g.c ** anisotropic_exponent(g), 1e-9),
    "oren_nayar_qualitative(0.4)": (oren_nayar, 1e-9),
    "coupled": (coupled, 1e-12),
    "log_cosine(half_cosine2, half_sine2)": (lambda g: 2.0 * np.log(g.c), 1e-9),
    "lambertian": (lambda g: np.full(len(g.l), 1.0 / math.pi), 1e-12),
    "transmitted(0.04)": (
        lambda g: (
            (1.0 - (0.04 + 0.96 * (1.0 - g.ci) ** 5)) * (1.0 - (0.04 + 0.96 * (1.0 - g.co) ** 5))
        ),
        1e-9,
    ),
    # the rational form of G1 is within 0.35 % of the error function's
    "smith_separable_beckmann(0.5)": (
        lambda g: masking(g.ci, 0.5) * masking(g.co, 0.5) / (g.ci * g.co),
        7e-3,
    ),
    "smith_correlated_beckmann(0.5)": (correlated, 7e-3),
}


@pytest.mark.parametrize("block", BLOCKS)
def test_a_building_block_is_what_defines_it(block: str) -> None:
    light, viewer = pairs(width=0.3)
    half = (light + viewer) / np.linalg.norm(light + viewer, axis=1, keepdims=True)
    d = (light * half).sum(axis=1)
    directions = {"l": light, "v": viewer, "h": half}
    cosines = {"ci": light[:, 2], "co": viewer[:, 2], "c": half[:, 2], "d": d}
    defined, tolerance = BLOCKS[block]
    value = composed(block)(light, viewer)[:, 0]
    expected = defined(SimpleNamespace(**directions, **cosines))
    np.testing.assert_allclose(value, expected, rtol=tolerance, atol=1e-15)


LAYERS = [0.0, 1e-6, 0.01, 1.0, 50.0, 1000.0]


@pytest.mark.parametrize("KS", LAYERS)
def test_an_opaque_layer_fulfils_what_defines_k_over_s(KS: float) -> None:
    """K/S = (1 - R)²/(2 R) (P. Kubelka, F. Munk, 1931)."""
    up = np.array([[0.0, 0.0, 1.0]])
    R = composed("kubelka_munk(KS)")(up, up, KS=KS)[0, 0]
    ratio = (1.0 - R) ** 2 / (2.0 * R)
    assert ratio == pytest.approx(KS, rel=1e-6, abs=1e-15)


@pytest.mark.parametrize("F0", [0.0, 0.04, 0.5])
def test_an_index_reflects_its_f0_and_a_mean_is_the_mean(F0: float) -> None:
    light = diffuse_light(200_000)
    mean = composed("schlick(F0, cos_incident)")(light, light, F0=F0).mean()
    assert composed("schlick_average(F0)")(light, light, F0=F0)[0, 0] == pytest.approx(mean)
    at_normal = composed("dielectric(index(F0), 1)")(light, light, F0=F0)[0, 0]
    assert at_normal == pytest.approx(F0, rel=1e-12)
