"""Values and directions to look at the textbook formulas with."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

RD = (0.1, 0.2, 0.6)
PAPER = {"KS": (0.1, 2.0, 30.0), "SX": 0.7, "Rg": (0.8, 0.85, 0.9), "tone": 0.6}
PAINT = {"base": RD, "metallic": 0.3, "specular": 0.5, "roughness": 0.4, "sheen": 0.2}
COAT = {"clearcoat": 0.5, "gloss": 0.3}
ABC = {"Rd": RD, "A": 50.0, "B": 2000.0, "C": 1.1, "eta": 1.5}
DUST = {"w": (0.2, 0.5, 0.9), "b": 0.3}


def lobe(end: str, **values: float) -> dict[str, float]:
    return {name + end: value for name, value in values.items()}


PEAK = lobe("1", ks=0.3, m=0.1, F0=0.04)
PEAK_2 = PEAK | lobe("2", ks=0.2, m=0.3, F0=0.5)
COSINE = lobe("1", ks=0.3, Cxy=-0.9, Cz=0.8, n=40)
COSINE_2 = COSINE | lobe("2", ks=0.2, Cxy=0.6, Cz=0.7, n=3)

# Every model, with values to look at it with.
SAMPLES: dict[str, dict[str, Any]] = {
    "lambert": {"Rd": RD},
    "ward": {"Rd": RD, "ks": 0.2, "m": 0.15},
    "ward_anisotropic": {"Rd": RD, "ks": 0.2, "mx": 0.3, "my": 0.1},
    "ward_duer": {"Rd": RD, "ks": 0.2, "m": 0.15},
    "ward_gmd": {"Rd": RD, "ks": 0.2, "m": 0.15},
    "ward_gmd_anisotropic": {"Rd": RD, "ks": 0.2, "mx": 0.3, "my": 0.1},
    "ward_printed": {"Rd": RD, "ks": 0.2, "m": 0.15},
    "phong": {"Rd": RD, "ks": 0.2, "n": 60},
    "blinn_phong": {"Rd": RD, "ks": 0.2, "n": 60},
    "blinn_phong_n8": {"Rd": RD, "ks": 0.2, "n": 60},
    "blinn_phong_n2": {"Rd": RD, "ks": 0.2, "n": 60},
    "cook_torrance": {"Rd": RD, "ks": 0.2, "m": 0.15, "F0": 0.04},
    "cook_torrance_1982": {"Rd": RD, "ks": 0.2, "m": 0.15, "F0": 0.04},
    "cook_torrance_ngan": {"Rd": RD, "ks": 0.2, "m": 0.15, "F0": 0.04},
    "cook_torrance_2": {"Rd": RD} | PEAK_2,
    "cook_torrance_3": {"Rd": RD} | PEAK_2 | lobe("3", ks=0.1, m=0.2, F0=1),
    "ggx": {"Rd": RD, "ks": 0.2, "alpha": 0.15, "F0": 0.04},
    "ggx_anisotropic": {"Rd": RD, "ks": 0.2, "alphax": 0.3, "alphay": 0.1, "F0": 0.04},
    "oren_nayar": {"Rd": RD, "sigma": 0.4},
    "oren_nayar_qualitative": {"Rd": RD, "sigma": 0.4},
    "eon": {"Rd": RD, "r": 0.7},
    "ashikhmin_shirley": {"Rd": RD, "Rs": 0.2, "n": 60},
    "ashikhmin_shirley_anisotropic": {"Rd": RD, "Rs": 0.2, "nu": 20, "nv": 200},
    "lafortune": {"Rd": RD, "ks": 0.3, "Cxy": -0.9, "Cz": 0.8, "n": 40},
    "lafortune_2": {"Rd": RD} | COSINE_2,
    "lafortune_3": {"Rd": RD} | COSINE_2 | lobe("3", ks=0.1, Cxy=0, Cz=1, n=2),
    "abc_microfacet": ABC,
    "abc_smooth": ABC,
    "disney": PAINT | COAT,
    "disney_anisotropic": PAINT | COAT | {"anisotropic": 0.7},
    "minnaert": {"Rd": RD, "k": 0.7},
    "lommel_seeliger": DUST,
    "hapke": DUST | {"B0": 0.8, "h": 0.1},
    "print_layer": PAPER | {"ks": 1, "alpha": 0.15, "F0": 0.04},
}


def arrays(values: Mapping[str, Any], dtype: Any = np.float64) -> dict[str, Array]:
    """Channels of the shape (1, 1) or (1, 3)."""
    return {k: np.atleast_2d(np.asarray(v, dtype)) for k, v in values.items()}


def columns(angles: Array, dtype: Any = np.float64) -> tuple[Array, ...]:
    """Each column of the angles as an argument of a geometry, of shape (points, 1)."""
    return tuple(column[:, None].astype(dtype) for column in angles.T)


def somewhere(count: int, seed: int) -> Array:
    """Zeniths up to 89 deg and azimuths, in radians, (count, 4)."""
    u = np.random.default_rng(seed).uniform(0, 1, (count, 4))
    return np.radians(u * [89, 89, 360, 360])
