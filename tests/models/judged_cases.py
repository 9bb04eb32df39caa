"""What of the library coincides with a judge: pairs of functions, and the parameters of both."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mitsuba_bsdf as mitsuba
import scatmech_bsdf as scatmech
from library import Function, composed, reflectance

Parameters = dict[str, Any]


@dataclass(frozen=True)
class Case:
    judge: Function
    judged: Parameters
    ours: str
    """A library model by its name, or a formula in building blocks."""
    given: Parameters
    width: float
    """Slope around which half of the directions are drawn: that of the lobe."""
    tolerance: float
    """Relative, of every single value."""

    @property
    def formula(self) -> Function:
        return reflectance(self.ours) if self.ours.isidentifier() else composed(self.ours)

    def __str__(self) -> str:
        values = "-".join(f"{name}={value}" for name, value in self.judged.items())
        return f"{self.judge.__name__}-{values}"


class Cases(list[Case]):
    def __init__(self, tolerance: float) -> None:
        super().__init__()
        self._tolerance = tolerance

    def add(
        self,
        judge: Function,
        ours: str,
        both: Parameters,
        judged: Parameters | None = None,
        given: Parameters | None = None,
        *,
        width: float = 0.3,
        tolerance: float | None = None,
    ) -> None:
        """both: parameters that judge and library call the same; judged and given: those of one."""
        judged, given = both | (judged or {}), both | (given or {})
        self.append(Case(judge, judged, ours, given, width, tolerance or self._tolerance))


SLOPES = (0.001, 0.01, 0.1, 0.3, 1.0)
PAIRS_OF_SLOPES = ((0.001, 0.001), (0.1, 0.4), (0.5, 0.05), (1.0, 0.3))
INDICES = (1.05, 1.5, 2.5)
METALS = ((0.2, 3.9), (1.4, 1.6))
"""Complex indices; those of dielectrics have k = 0, and eta + ik = i reflects all."""

CONDUCTOR = "conductor(eta, k, difference_cosine)"
DIELECTRIC = "dielectric(n, difference_cosine)"
GRAZING = "(1 - difference_cosine)^5"
SMITH = {
    "beckmann": "beckmann(alpha)*smith_separable_beckmann(alpha)/(4*pi)",
    "ggx": "trowbridge_reitz(alpha)*smith_separable(alpha)/(4*pi)",
}
SMITH_ANISOTROPIC = {
    "beckmann": "beckmann_anisotropic(alphax, alphay)/(4*pi)"
    "*smith_separable_beckmann_anisotropic(alphax, alphay)",
    "ggx": "trowbridge_reitz_anisotropic(alphax, alphay)/(4*pi)"
    "*smith_separable_anisotropic(alphax, alphay)",
}
SHADOWS = {"": "1/(cos_incident*cos_reflection)", "V": "v_cavity"}
ENTERED = "(1 - dielectric(n, cos_incident))*(1 - dielectric(n, cos_reflection))/(pi*n^2)"
INKS = (
    (0.0001, 0.01, 0.8),
    (0.01, 1.4, 0.8),
    (0.01, 2.0, 0.8),
    (1.0, 0.5, 0.8),
    (10.0, 0.1, 0.3),
)
"""KS, SX and Rg: the first two take the series for thin layers, near one end and the other."""
SERIES = 1e-8
"""What the last term of that series leaves, 5e-9 where it ends."""
LAYER = "kubelka_munk_layer(KS, SX, Rg)"
REFLECTS_ALL: Parameters = {"eta": 0.0, "k": 1.0}
LOBE: Parameters = {"Rd": 0, "ks": 1}
WHITE_LOBE: Parameters = LOBE | {"F0": 1}


def mitsuba_cases() -> Cases:
    cases = Cases(5e-5)
    cases.add(mitsuba.diffuse, "lambert", {"Rd": 0.7})
    for a in SLOPES:
        axes: Parameters = {"alphax": a, "alphay": a}
        cases.add(mitsuba.ward_gmd, "ward_gmd", {}, axes, LOBE | {"m": a}, width=a)
        cases.add(mitsuba.height_correlated, "ggx", {}, axes, WHITE_LOBE | {"alpha": a}, width=a)
    for x, y in PAIRS_OF_SLOPES:
        axes, width = {"alphax": x, "alphay": y}, max(x, y)
        ward = LOBE | {"mx": x, "my": y}
        cases.add(mitsuba.ward_gmd, "ward_gmd_anisotropic", {}, axes, ward, width=width)
        cases.add(mitsuba.height_correlated, "ggx_anisotropic", axes, given=WHITE_LOBE, width=width)
    for name in SMITH:
        smith_cases(cases, name)
    for n in (1.2, 1.5, 1.9):
        body, inside = {"Rd": 0.8, "n": n}, {"k2": mitsuba.internal_reflectance(n)}
        cases.add(mitsuba.plastic, f"{ENTERED}*saunderson(Rd, k2)", body, given=inside)
    principled_cases(cases)
    return cases


def smith_cases(cases: Cases, name: str) -> None:
    distribution = {"distribution": name}
    for a in SLOPES:
        for n in INDICES:
            plastic, rough = f"{SMITH[name]}*{DIELECTRIC}", {"alpha": a, "n": n}
            cases.add(mitsuba.rough_plastic, plastic, rough, distribution, width=a)
    for x, y in PAIRS_OF_SLOPES:
        for eta, k in ((0.0, 1.0), *METALS):
            metal = f"{SMITH_ANISOTROPIC[name]}*{CONDUCTOR}"
            rough = {"alphax": x, "alphay": y, "eta": eta, "k": k}
            cases.add(mitsuba.rough_conductor, metal, rough, distribution, width=max(x, y))
    for n in INDICES:
        glass = f"{SMITH_ANISOTROPIC[name]}*{DIELECTRIC}"
        rough = {"alphax": 0.3, "alphay": 0.2, "n": n}
        cases.add(mitsuba.rough_dielectric, glass, rough, distribution)


def principled_cases(cases: Cases) -> None:
    """Mitsuba has Disney's model of 2015; this is what it shares with the one of 2012."""
    for r in (0.2, 0.5, 1.0):
        metal = f"{SMITH_ANISOTROPIC['ggx']}*schlick(F0, difference_cosine)"
        for anisotropic in (0.0, 0.7):
            aspect = (1.0 - 0.9 * anisotropic) ** 0.5
            paint = {"base": 0.6, "roughness": r, "anisotropic": anisotropic}
            alphas = {"F0": 0.6, "alphax": r**2 / aspect, "alphay": r**2 * aspect}
            cases.add(mitsuba.principled_metal, metal, {}, paint, alphas, width=r**2)
        body, paint = f"Rd*disney(r) + sheen*{GRAZING}", {"base": 0.4, "roughness": r}
        ours = {"Rd": 0.4, "r": r}
        cases.add(mitsuba.principled_diffuse, body, {"sheen": 0.6}, paint, ours)
    # only at roughness 1 do the lobes of 2012 and of 2015 have the same G
    rough = {"base": 0.4, "roughness": 1.0, "clearcoat": 0.8, "gloss": 0.2}
    for metallic, specular, sheen in ((0.0, 0.5, 0.0), (0.3, 0.8, 0.5), (1.0, 0.5, 0.0)):
        weights = {"metallic": metallic, "specular": specular, "sheen": sheen}
        cases.add(mitsuba.principled_tinted, "disney", rough | weights, width=1.0)
    # Mitsuba forms 1 + (b² - 1) c² in single precision, which cancels at the peak as b gets small
    for gloss, tolerance in ((0.0, 5e-5), (0.5, 2e-4), (0.9, 3e-3)):
        coat = (
            "0.25*0.8*schlick(0.04, difference_cosine)*smith_separable(0.25)/(4*pi)"
            f"*generalised_trowbridge_reitz_1({0.1 - 0.099 * gloss!r})"
        )
        varnish = {"clearcoat": 0.8, "gloss": gloss}
        cases.add(mitsuba.principled_clearcoat, coat, {}, varnish, width=0.1, tolerance=tolerance)


def scatmech_cases() -> Cases:
    cases = Cases(1e-9)
    cases.add(scatmech.lambertian, "lambert", {"Rd": 0.7})
    for w, b in ((0.9, 0.5), (0.3, -0.6), (0.999999, 0.0), (0.6, 0.9)):
        cases.add(scatmech.single_scatter, "lommel_seeliger", {"w": w, "b": b})
    for KS, SX, Rg in INKS:
        ink = {"KS": KS, "SX": SX, "Rg": Rg}
        cases.add(scatmech.kubelka_munk, f"{LAYER}/pi", ink, tolerance=SERIES)
        for n in (1.2, 1.5, 2.5):
            body, inside = f"{ENTERED}*saunderson({LAYER}, k2)", scatmech.internal_reflectance(n)
            interface = ink | {"n": n}
            cases.add(
                scatmech.under_interface, body, interface, given={"k2": inside}, tolerance=SERIES
            )
    for B, C in ((100.0, 2.0), (1e4, 0.3), (1e6, 0.8)):
        lobe = "abc_smooth_lobe/dielectric(eta, sqrt(tangential_cosine2))"
        cases.add(scatmech.abc_lobe, lobe, {"B": B, "C": C}, width=0.1)
    for m in (0.003, 0.03, 0.1, 0.3, 0.8):
        slope = {"m": m}
        cases.add(scatmech.slopes, "beckmann_exponential(m)/(pi*m^2)", slope, width=m)
        cases.add(scatmech.ward, "ward", slope, given=LOBE, width=m)
        cases.add(scatmech.ward_duer, "ward_duer", slope, given=LOBE, width=m)
    cook_torrance_cases(cases)
    facet_cases(cases)
    return cases


def cook_torrance_cases(cases: Cases) -> None:
    for m in (0.003, 0.03, 0.1, 0.3, 0.8):
        slope = {"m": m}
        cases.add(
            scatmech.gaussian_facets, "cook_torrance", slope, REFLECTS_ALL, WHITE_LOBE, width=m
        )
        ngan = "cook_torrance_ngan"
        cases.add(scatmech.cook_torrance_ngan, ngan, slope, given=WHITE_LOBE, width=m)
    for F0 in (0.0006, 0.04, 0.5, 0.9):
        printed = {"m": 0.3, "F0": F0}
        cases.add(scatmech.cook_torrance_1982, "cook_torrance_1982", printed, given=LOBE)
    two = {"m1": 0.1, "m2": 0.4}
    halves = {"Rd": 0, "ks1": 0.7, "ks2": 0.3, "F01": 1, "F02": 1}
    share = REFLECTS_ALL | {"fraction": 0.3}
    cases.add(scatmech.two_gaussian_facets, "cook_torrance_2", two, share, halves)
    matt = {"Rd": 0.5, "ks": 0.3, "m": 0.3}
    cases.add(scatmech.diffuse_and_facets, "cook_torrance", matt, REFLECTS_ALL, {"F0": 1})


def facet_cases(cases: Cases) -> None:
    for shadow, ours in SHADOWS.items():
        for eta, k in ((1.5, 0.0), *METALS):
            facets, metal = f"beckmann(m)*{CONDUCTOR}*{ours}/(4*pi)", {"eta": eta, "k": k}
            cases.add(scatmech.gaussian_facets, facets, {"m": 0.3} | metal, {"shadow": shadow})
        glass = {"eta": 1.5, "k": 0.0}
        for a in SLOPES:
            axes: Parameters = {"alphax": a, "alphay": a, "shadow": shadow}
            facets = f"trowbridge_reitz(alpha)*{CONDUCTOR}*{ours}/(4*pi)"
            cases.add(scatmech.ellipsoid_facets, facets, glass, axes, {"alpha": a}, width=a)
        for x, y in PAIRS_OF_SLOPES:
            facets = f"trowbridge_reitz_anisotropic(alphax, alphay)*{CONDUCTOR}*{ours}/(4*pi)"
            both = {"alphax": x, "alphay": y} | glass
            cases.add(scatmech.ellipsoid_facets, facets, both, {"shadow": shadow}, width=max(x, y))
    for eta, k in ((1.5, 0.0), (4.05, 0.0), *METALS):
        shared = f"v_cavity*{CONDUCTOR}*(1 + half_tangent2)^2/4"
        cases.add(scatmech.even_facets, shared, {"eta": eta, "k": k})
