"""Values of SCATMECH's BRDFs in double precision, as a judge that nobody here wrote.

SCATMECH (T. A. Germer, NIST; https://pages.nist.gov/pySCATMECH) models polarised scatter: a BRDF is
a Mueller matrix, whose first element is the BRDF of unpolarised light seen without a polariser. It
does not include the cosine. In its frame the light arrives from azimuth 180°, so azimuth `phis` is
0 for the mirror direction; `rotation` turns the sample. Numbers go to it as text: a complex number
handed over as such would be cut to six digits.

Every public function takes light and viewer, unit vectors (n, 3) with the normal along z and the
tangent along x, both above the surface, and returns n values. Raises ImportError without it.
"""

from __future__ import annotations

import importlib
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Parameters = dict[str | None, Any]


def evaluated(model: str, parameters: Parameters, light: Array, viewer: Array) -> Array:
    """f of a SCATMECH BRDF model, at wavelength 1; the key None holds a nested model's name."""
    brdf = importlib.import_module("pySCATMECH.brdf").BRDF_Model(model, {"lambda": 1, **parameters})
    incident, scattered = (np.arctan2(np.hypot(v[:, 0], v[:, 1]), v[:, 2]) for v in (light, viewer))
    forward = np.arctan2(light[:, 1], light[:, 0]) + np.pi  # azimuth in which the light travels
    azimuth = np.arctan2(viewer[:, 1], viewer[:, 0]) - forward
    geometries = np.stack([incident, scattered, azimuth, -forward], axis=1).tolist()
    return np.array([brdf.MuellerBRDF(*geometry)[0, 0] for geometry in geometries])


def index(eta: float, k: float) -> str:
    return f"({eta!r},{k!r})"


def lambertian(light: Array, viewer: Array, Rd: float) -> Array:
    return evaluated("Lambertian_BRDF_Model", {"reflectance": table(Rd)}, light, viewer)


def kubelka_munk(light: Array, viewer: Array, KS: float, SX: float, Rg: float) -> Array:
    """A layer of absorption KS, scattering 1 and thickness SX on a ground of reflectance Rg."""
    parameters: Parameters = {"reflectance": layer(KS, SX, Rg)}
    return evaluated("Lambertian_BRDF_Model", parameters, light, viewer)


def under_interface(
    light: Array, viewer: Array, KS: float, SX: float, Rg: float, n: float
) -> Array:
    """The same layer under a smooth interface of index n, without the interface's own mirror."""
    parameters: Parameters = {"reflectance": layer(KS, SX, Rg), "substrate": index(n, 0.0)}
    return evaluated("Diffuse_Subsurface_BRDF_Model", parameters, light, viewer)


def internal_reflectance(n: float) -> float:
    """What `under_interface` takes for diffuse light in index n: a sum over angles inside, in
    steps of 0.2°, weighted by sin(2 theta)."""
    theta = np.radians(np.arange(451) * 0.2)
    cosine, refracted = np.cos(theta), np.emath.sqrt(1.0 / n**2 - np.sin(theta) ** 2)
    s = (cosine - refracted) / (cosine + refracted)
    p = (cosine - n**2 * refracted) / (cosine + n**2 * refracted)
    weight = np.sin(2.0 * theta)
    return float((weight * (np.abs(s) ** 2 + np.abs(p) ** 2) / 2.0).sum() / weight.sum())


def gaussian_facets(
    light: Array, viewer: Array, m: float, eta: float = 0.0, k: float = 1.0, shadow: str = "V"
) -> Array:
    """Facets with Gaussian slopes. shadow: "" none, "V" cavities, "Smith" his function of 1967.

    Smith's RMS slope is that of one axis, m/sqrt(2); eta + ik = i reflects all.
    """
    slopes = {None: "Gaussian_Slope_Distribution_Function", "s": m}
    return facets(light, viewer, slopes, eta, k, shadow, m / math.sqrt(2.0))


def cook_torrance_1982(light: Array, viewer: Array, m: float, F0: float) -> Array:
    """As printed, pi ci co under a D without its 1/pi: four times what energy balance wants."""
    n = (1.0 + math.sqrt(F0)) / (1.0 - math.sqrt(F0))
    return 4.0 * gaussian_facets(light, viewer, m, n, 0.0)


def cook_torrance_ngan(light: Array, viewer: Array, m: float) -> Array:
    """Of mirrors, with Ngan's pi² ci co in the same place."""
    return 4.0 / math.pi * gaussian_facets(light, viewer, m)


def two_gaussian_facets(
    light: Array, viewer: Array, m1: float, m2: float, fraction: float, eta: float, k: float
) -> Array:
    """Two kinds of facets, a fraction of them with slope m2, in V cavities."""
    slopes = {
        None: "Two_Slope_Distribution_Function",
        "s1": {None: "Gaussian_Slope_Distribution_Function", "s": m1},
        "s2": {None: "Gaussian_Slope_Distribution_Function", "s": m2},
        "fract": fraction,
    }
    return facets(light, viewer, slopes, eta, k, "V")


def ellipsoid_facets(
    light: Array,
    viewer: Array,
    alphax: float,
    alphay: float,
    eta: float = 0.0,
    k: float = 1.0,
    shadow: str = "V",
) -> Array:
    """Ellipsoidal bumps of height 1 that cover the plane: the slopes of Trowbridge and Reitz."""
    slopes = {
        None: "Ellipsoid_Slope_Distribution_Function",
        "rx": 1.0 / alphax,
        "ry": 1.0 / alphay,
        "rz": 1.0,
        "density": alphax * alphay / math.pi,
    }
    return facets(light, viewer, slopes, eta, k, shadow)


def even_facets(light: Array, viewer: Array, eta: float, k: float) -> Array:
    """All slopes equally frequent (density 1), in V cavities: what is left is F G/(4 ci co c^4)."""
    return facets(light, viewer, {None: "Unit_Slope_Distribution_Function"}, eta, k, "V")


def slopes(light: Array, viewer: Array, m: float) -> Array:
    """The density of Gaussian slopes alone, as the quotient of such facets and even ones."""
    return gaussian_facets(light, viewer, m, shadow="V") / even_facets(light, viewer, 0.0, 1.0)


def ward(light: Array, viewer: Array, m: float) -> Array:
    """Ward's normalisation, 1/(4 sqrt(ci co)), of the density of slopes."""
    return slopes(light, viewer, m) / (4.0 * np.sqrt(light[:, 2] * viewer[:, 2]))


def ward_duer(light: Array, viewer: Array, m: float) -> Array:
    """The one of Dür, 1/(4 ci co)."""
    return slopes(light, viewer, m) / (4.0 * light[:, 2] * viewer[:, 2])


def facets(
    light: Array,
    viewer: Array,
    slopes: Parameters,
    eta: float,
    k: float,
    shadow: str,
    slope: float = 0.0,
) -> Array:
    shadows: dict[str, Parameters] = {
        "": {None: "Unit_Shadow_Function"},
        "V": {None: "Torrance_Sparrow_Shadow_Function"},
        "Smith": {None: "Smith_Shadow_Function", "w": slope},
    }
    parameters = {"sdf": slopes, "shadow": shadows[shadow], "substrate": index(eta, k)}
    return evaluated("Shadowed_Facet_BRDF_Model", parameters, light, viewer)


def abc_lobe(light: Array, viewer: Array, B: float, C: float) -> Array:
    """(1 + B q)^-C: a surface with an ABC power spectrum against one with a white spectrum.

    Rayleigh-Rice scatter is proportional to the spectrum at frequency sqrt(q)/wavelength; all
    else cancels in the quotient. SCATMECH's spectrum is A/(1 + (B f)^2)^(C/2).
    """
    spectrum: Parameters = {None: "ABC_PSD_Function", "A": 1, "B": math.sqrt(B), "C": 2 * C}
    rough, white = (
        evaluated("Microroughness_BRDF_Model", {"psd": psd, "substrate": "1.5"}, light, viewer)
        for psd in (spectrum, spectrum | {"C": 0})
    )
    return rough / white


def single_scatter(light: Array, viewer: Array, w: float, b: float) -> Array:
    """Light scattered once in a deep medium of albedo w (< 1), asymmetry b, without interface."""
    parameters: Parameters = {
        "phase_function": {
            None: "Unpolarized_Phase_Function",
            "phase_function": {None: "Henyey_Greenstein_Phase_Function", "g": b},
            "log_scattering": math.log(w),
            "log_absorption": math.log1p(-w),
        },
        "substrate": index(1.0, 0.0),
    }
    return evaluated("First_Diffuse_BRDF_Model", parameters, light, viewer)


def diffuse_and_facets(
    light: Array, viewer: Array, Rd: float, ks: float, m: float, eta: float, k: float
) -> Array:
    """A Lambertian and Gaussian facets in V cavities, summed by SCATMECH."""
    substrate = index(eta, k)
    parameters: Parameters = {
        "substrate": substrate,
        "factor1": 1.0,
        "source1": {
            None: "Lambertian_BRDF_Model",
            "lambda": 1,
            "substrate": substrate,
            "reflectance": table(Rd),
        },
        "factor2": ks,
        "source2": {
            None: "Shadowed_Facet_BRDF_Model",
            "lambda": 1,
            "substrate": substrate,
            "sdf": {None: "Gaussian_Slope_Distribution_Function", "s": m},
            "shadow": {None: "Torrance_Sparrow_Shadow_Function"},
        },
    }
    return evaluated("Two_Source_BRDF_Model", parameters, light, viewer)


def layer(KS: float, SX: float, Rg: float) -> Parameters:
    return {
        None: "Kubelka_Munk_Reflectance",
        "thickness": SX,
        "absorption": KS,
        "scattering": 1.0,
        "substrate": table(Rg),
    }


def table(value: float) -> Parameters:
    return {None: "Table_Reflectance", "table": value}
