"""Formulas against two programs that nobody here wrote: Mitsuba 3 and SCATMECH.

A case is a judge, the formula it is said to coincide with, and the parameters of both. Any callable
f(light, viewer, **parameters) may stand in the formula's place.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import expected_blocks as blocks
import expected_brdf as expected
import mitsuba_bsdf as mitsuba
import numpy as np
import pytest
import scatmech_bsdf as scatmech
from numpy.typing import DTypeLike, NDArray

Array = NDArray[np.float64]
Function = Callable[..., Array]

PAIRS = 4000
LOWEST_COSINE = 0.001
FLOOR = 1e-15
"""1/sr; below it values are not compared, for Mitsuba sets distributions under 1e-20 to zero."""


@dataclass(frozen=True)
class Case:
    judge: Function
    formula: Function
    parameters: dict[str, Any]
    width: float
    """Slope around which half of the directions are drawn: that of the lobe."""
    tolerance: float
    """Relative, of every single value."""

    def __str__(self) -> str:
        values = "-".join(f"{name}={value}" for name, value in self.parameters.items())
        return f"{self.judge.__name__}-{values}"


ALPHAS = [(0.001, 0.001), (0.01, 0.01), (0.1, 0.1), (0.3, 0.3), (1.0, 1.0), (0.1, 0.4), (0.5, 0.05)]
METALS = [(0.2, 3.9), (1.4, 1.6)]
"""Complex indices; those of dielectrics have k = 0, and eta + ik = i reflects all."""


def mitsuba_cases() -> list[Case]:
    cases: list[Case] = []

    def add(
        judge: Function,
        formula: Function,
        width: float = 0.3,
        tolerance: float = 5e-5,
        **parameters: Any,
    ) -> None:
        cases.append(Case(judge, formula, parameters, width, tolerance))

    add(mitsuba.diffuse, expected.expected_lambert, Rd=0.7)
    for x, y in ALPHAS:
        lobe = {"width": max(x, y), "alphax": x, "alphay": y}
        add(mitsuba.ward_gmd, expected.expected_ward_gmd, **lobe)
        add(mitsuba.height_correlated, expected.expected_height_correlated, **lobe)
        for name in blocks.DISTRIBUTIONS:
            add(mitsuba.rough_conductor, expected.expected_smith, distribution=name, **lobe)
    for name in blocks.DISTRIBUTIONS:
        rough: dict[str, Any] = {"distribution": name, "alphax": 0.3, "alphay": 0.2}
        for eta, k in METALS:
            add(mitsuba.rough_conductor, expected.expected_smith, **rough, eta=eta, k=k)
        for n in (1.05, 1.5, 2.5):
            add(mitsuba.rough_dielectric, expected.expected_smith_dielectric, **rough, n=n)
            plastic: dict[str, Any] = {"distribution": name, "alpha": 0.2, "n": n}
            add(mitsuba.rough_plastic, expected.expected_smith_plastic, **plastic)
    for n in (1.2, 1.5, 1.9):
        add(mitsuba.plastic, expected.expected_plastic, R=0.8, n=n)
    for roughness in (0.2, 0.5, 1.0):
        for anisotropic in (0.0, 0.7):
            metal = {"base": 0.6, "roughness": roughness, "anisotropic": anisotropic}
            formula = expected.expected_principled_metal
            add(mitsuba.principled_metal, formula, width=roughness**2, **metal)
        body = {"base": 0.4, "roughness": roughness, "sheen": 0.6}
        add(mitsuba.principled_diffuse, expected.expected_disney_diffuse, **body)
    for metallic, specular, sheen in ((0.0, 0.5, 0.0), (0.3, 0.8, 0.5), (1.0, 0.5, 0.0)):
        weights = {"base": 0.4, "metallic": metallic, "specular": specular, "sheen": sheen}
        # only at roughness 1 do the lobes of 2012 and of 2015 have the same G
        add(mitsuba.principled_tinted, expected.expected_disney, 1.0, roughness=1.0, **weights)
    # Mitsuba forms 1 + (b² - 1) c² in single precision, which cancels at the peak as b gets small
    for gloss, tolerance in ((0.0, 5e-5), (0.5, 2e-4), (0.9, 3e-3)):
        coat = {"clearcoat": 0.8, "gloss": gloss, "tolerance": tolerance}
        add(mitsuba.principled_clearcoat, expected.expected_disney_clearcoat, 0.1, **coat)
    return cases


def scatmech_cases() -> list[Case]:
    cases: list[Case] = []

    def add(judge: Function, formula: Function, width: float = 0.3, **parameters: Any) -> None:
        cases.append(Case(judge, formula, parameters, width, 1e-9))

    add(scatmech.lambertian, expected.expected_lambert, Rd=0.7)
    for KS, SX, Rg in ((0.0001, 0.01, 0.8), (0.01, 2.0, 0.8), (1.0, 0.5, 0.8), (10.0, 0.1, 0.3)):
        ink = {"KS": KS, "SX": SX, "Rg": Rg}
        add(scatmech.kubelka_munk, expected.expected_kubelka_munk, **ink)
        for n in (1.2, 1.5, 2.5):
            add(scatmech.under_interface, expected.expected_layer_under_interface, **ink, n=n)
    for shadow in ("", "V", "Smith"):
        mirrors = [(m, 0.0, 1.0) for m in (0.003, 0.03, 0.1, 0.3, 0.8)]
        for m, eta, k in [*mirrors, (0.3, 1.5, 0.0), *((0.3, eta, k) for eta, k in METALS)]:
            facets = {"m": m, "eta": eta, "k": k, "shadow": shadow}
            add(scatmech.gaussian_facets, expected.expected_gaussian_facets, m, **facets)
    for F0 in (0.0006, 0.04, 0.5, 0.9):
        add(scatmech.cook_torrance_1982, expected.expected_cook_torrance_1982, m=0.3, F0=F0)
    for x, y in ALPHAS:
        for shadow in ("", "V"):
            facets = {"alphax": x, "alphay": y, "eta": 1.5, "k": 0.0, "shadow": shadow}
            add(scatmech.ellipsoid_facets, expected.expected_ellipsoid_facets, max(x, y), **facets)
    for eta, k in ((1.5, 0.0), (4.05, 0.0), *METALS):
        index = {"eta": eta, "k": k}
        add(scatmech.even_facets, expected.expected_even_facets, **index)
        two = {"m1": 0.1, "m2": 0.4, "fraction": 0.3, **index}
        add(scatmech.two_gaussian_facets, expected.expected_cook_torrance_2, **two)
        both = {"Rd": 0.5, "ks": 0.3, "m": 0.3, **index}
        add(scatmech.diffuse_and_facets, expected.expected_lambert_facets, **both)
    for B, C in ((100.0, 2.0), (1e4, 0.3), (1e6, 0.8)):
        add(scatmech.abc_lobe, expected.expected_abc_lobe, 0.1, B=B, C=C)
    for w, b in ((0.9, 0.5), (0.3, -0.6), (0.999999, 0.0), (0.6, 0.9)):
        add(scatmech.single_scatter, expected.expected_lommel_seeliger, w=w, b=b)
    return cases


def directions(width: float, precision: DTypeLike) -> tuple[Array, Array]:
    """Pairs of unit vectors (light, viewer), rounded to a precision.

    Every other pair is uniform over both hemispheres; else the viewer mirrors the light at a normal
    with Beckmann slopes of the width, so that narrow lobes are met.
    """
    random = np.random.default_rng(7)
    light, viewer = hemisphere(random, 8 * PAIRS), hemisphere(random, 8 * PAIRS)
    slope = width * np.sqrt(random.exponential(size=len(light)))
    azimuth = random.uniform(-np.pi, np.pi, len(light))
    normal = np.stack([slope * np.cos(azimuth), slope * np.sin(azimuth), np.ones_like(slope)], 1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    mirrored = 2.0 * (light * normal).sum(axis=1, keepdims=True) * normal - light
    viewer[::2] = mirrored[::2]
    above = (light[:, 2] > LOWEST_COSINE) & (viewer[:, 2] > LOWEST_COSINE)
    light, viewer = (v[above][:PAIRS].astype(precision).astype(float) for v in (light, viewer))
    return light, viewer


def hemisphere(random: np.random.Generator, count: int) -> Array:
    cosine, azimuth = random.uniform(0.0, 1.0, count), random.uniform(-np.pi, np.pi, count)
    sine = np.sqrt(1.0 - cosine**2)
    return np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), cosine], axis=1)


def difference(case: Case, precision: DTypeLike) -> float:
    """The worst difference relative to the formula, where that is above the floor."""
    light, viewer = directions(case.width, precision)
    judged = case.judge(light, viewer, **case.parameters)
    value = case.formula(light, viewer, **case.parameters)
    compared = value > FLOOR
    assert compared.sum() > PAIRS // 3
    return float((np.abs(judged - value)[compared] / value[compared]).max())


@pytest.mark.parametrize("case", mitsuba_cases(), ids=str)
def test_formula_as_mitsuba_has_it(case: Case) -> None:
    pytest.importorskip("mitsuba", reason="Mitsuba is not installed: pip install brdfc[judges]")
    assert difference(case, np.float32) <= case.tolerance


@pytest.mark.parametrize("case", scatmech_cases(), ids=str)
def test_formula_as_scatmech_has_it(case: Case) -> None:
    pytest.importorskip("SCATPY", reason="SCATMECH is not installed: pip install brdfc[judges]")
    assert difference(case, np.float64) <= case.tolerance


@pytest.mark.parametrize("n", [1.2, 1.5, 1.9])
def test_the_judges_take_internal_reflectance_from_approximations(n: float) -> None:
    """Why bodies under an interface are compared with the judge's own constant."""
    exact = blocks.internal_reflectance(n)
    assert blocks.internal_reflectance_fit(n) == pytest.approx(exact, rel=1e-3)
    assert blocks.internal_reflectance_sum(n) == pytest.approx(exact, rel=1e-3)
