"""Every model of the library as its textbook writes it, from unit vectors: a second, independent
implementation to check the library against.

The formulas keep the shapes of the books, arc cosines of n.h and all, and lose digits in floating
point where those do: judge with the 60 digits of PRECISE.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np
import textbook_diffuse as diffuse
import textbook_lobes as lobes
import textbook_microfacet as microfacet
from textbook_geometry import (
    NUMPY,
    PRECISE,
    SIXTY_DIGITS,
    Directions,
    Geometry,
    Namespace,
    Number,
    directions,
    plane_directions,
)

__all__ = [
    "NUMPY",
    "PRECISE",
    "SIXTY_DIGITS",
    "TEXTBOOK",
    "Directions",
    "Namespace",
    "directions",
    "plane_directions",
    "precise",
]

Brdf = Callable[[Namespace, Geometry, SimpleNamespace], Number]
Radiance = Callable[[Namespace, Directions, Mapping[str, Any]], Any]


def _radiance(brdf: Brdf) -> Radiance:
    """The radiance that a light of intensity 1 makes: the BRDF times the cosine of incidence.

    With NUMPY, channels have the shape (points, 1) or (points, 3), and so has the result,
    (points, 3). With PRECISE, channels are numbers or triples, and the result is a list of three.
    Beneath the horizon of light or viewer it is 0.
    """

    def radiance(ns: Namespace, where: Directions, values: Mapping[str, Any]) -> Any:
        geometry = Geometry(ns, where.light, where.viewer)
        if ns is PRECISE:
            if geometry.ci <= 0 or geometry.co <= 0:
                return [SIXTY_DIGITS.mpf(0)] * 3
            return [geometry.ci * brdf(ns, geometry, _component(values, i)) for i in range(3)]
        with np.errstate(all="ignore"):
            value = geometry.ci * brdf(ns, geometry, SimpleNamespace(**values))
        above = (geometry.ci > 0) & (geometry.co > 0)
        return np.where(above, value, 0) + np.zeros(3, value.dtype)

    return radiance


def _component(values: Mapping[str, Any], i: int) -> SimpleNamespace:
    chosen = {k: v[i] if isinstance(v, Sequence) else v for k, v in values.items()}
    return SimpleNamespace(**{k: SIXTY_DIGITS.mpf(v) for k, v in chosen.items()})


TEXTBOOK: dict[str, Radiance] = {
    name: _radiance(brdf)
    for name, brdf in {
        "lambert": diffuse.lambert,
        "ward": lobes.ward,
        "ward_anisotropic": lobes.ward_anisotropic,
        "ward_duer": lobes.ward_duer,
        "ward_gmd": lobes.ward_gmd,
        "ward_gmd_anisotropic": lobes.ward_gmd_anisotropic,
        "ward_printed": lobes.ward_printed,
        "phong": lobes.phong,
        "blinn_phong": lobes.blinn_phong,
        "blinn_phong_n8": lobes.blinn_phong_n8,
        "blinn_phong_n2": lobes.blinn_phong_n2,
        "cook_torrance": microfacet.cook_torrance(("",)),
        "cook_torrance_1982": microfacet.cook_torrance_1982,
        "cook_torrance_ngan": microfacet.cook_torrance_ngan,
        "cook_torrance_2": microfacet.cook_torrance(("1", "2")),
        "cook_torrance_3": microfacet.cook_torrance(("1", "2", "3")),
        "ggx": microfacet.ggx,
        "ggx_anisotropic": microfacet.ggx_anisotropic,
        "oren_nayar": diffuse.oren_nayar,
        "oren_nayar_qualitative": diffuse.oren_nayar_qualitative,
        "eon": diffuse.eon,
        "ashikhmin_shirley": lobes.ashikhmin_shirley,
        "ashikhmin_shirley_anisotropic": lobes.ashikhmin_shirley_anisotropic,
        "lafortune": lobes.lafortune(("",)),
        "lafortune_2": lobes.lafortune(("1", "2")),
        "lafortune_3": lobes.lafortune(("1", "2", "3")),
        "abc_microfacet": lobes.abc_microfacet,
        "abc_smooth": lobes.abc_smooth,
        "disney": microfacet.disney,
        "disney_anisotropic": microfacet.disney_anisotropic,
        "minnaert": diffuse.minnaert,
        "lommel_seeliger": diffuse.lommel_seeliger,
        "hapke": diffuse.hapke,
        "print_layer": microfacet.print_layer,
    }.items()
}


def precise(name: str, geometry: Mapping[str, Any], values: Mapping[str, Any]) -> list[Any]:
    """The radiance that a model's textbook gives, with 60 digits.

    `geometry` holds angles in degrees: incident, reflection and, of the full geometry, both
    azimuths, or of an anisotropic model in the plane, its orientation. Numbers may be int, str
    ("0.1", "1/3"), Fraction or float; a float counts as the decimal number that it prints as.
    ZeroDivisionError where the textbook's formula is 0/0 and only its limit has a value.
    """
    if any(abs(Fraction(str(geometry[k]))) >= 90 for k in ("incident", "reflection")):
        return [SIXTY_DIGITS.mpf(0)] * 3  # cos 90 deg is not quite 0, with 60 digits either
    radians = {k: _exact(v) * PRECISE.pi / 180 for k, v in geometry.items()}
    build = directions if "incident_azimuth" in geometry else plane_directions
    channels = {k: _exact(v) for k, v in values.items()}
    return list(TEXTBOOK[name](PRECISE, build(PRECISE, **radians), channels))


def _exact(value: Any) -> Any:
    if isinstance(value, list | tuple):
        return [_exact(component) for component in value]
    fraction = Fraction(str(value))
    return SIXTY_DIGITS.mpf(fraction.numerator) / fraction.denominator
