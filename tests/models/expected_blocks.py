"""What the expected formulas are built of: distributions of normals, shadowing, Fresnel, layers.

Directions are unit vectors (n, 3), the normal along z, the tangent along x; results are (n,).
Notation: ci, co cosines of light and viewer, h the half vector, c = h.z, d = l.h.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def half(light: Array, viewer: Array) -> tuple[Array, Array]:
    """h, and d = |l + v|/2."""
    total = light + viewer
    length = np.linalg.norm(total, axis=1)
    return total / length[:, None], length / 2.0


# Distributions of normals (P. Beckmann, A. Spizzichino 1963; T. Trowbridge, K. Reitz, JOSA 1975;
# B. Walter et al., EGSR 2007).


def slopes2(h: Array, alphax: float, alphay: float) -> Array:
    return ((h[:, 0] / alphax) ** 2 + (h[:, 1] / alphay) ** 2) / h[:, 2] ** 2


def beckmann(h: Array, alphax: float, alphay: float) -> Array:
    return np.exp(-slopes2(h, alphax, alphay)) / (math.pi * alphax * alphay * h[:, 2] ** 4)


def ggx(h: Array, alphax: float, alphay: float) -> Array:
    return 1.0 / (
        math.pi * alphax * alphay * (1.0 + slopes2(h, alphax, alphay)) ** 2 * h[:, 2] ** 4
    )


DISTRIBUTIONS = {"beckmann": beckmann, "ggx": ggx}


# Shadowing and masking.


def smith_ggx(v: Array, alphax: float, alphay: float) -> Array:
    """G1 = 1/(1 + Lambda) (Walter 2007, equation 34)."""
    return 2.0 / (1.0 + np.sqrt(1.0 + squared_stretch(v, alphax, alphay)))


def smith_beckmann(v: Array, alphax: float, alphay: float) -> Array:
    """G1 by Walter's rational fit (2007, equation 27), as in Mitsuba; within 0.35 % of exact."""
    with np.errstate(divide="ignore"):
        a = 1.0 / np.sqrt(squared_stretch(v, alphax, alphay))
    near = np.minimum(a, 1.6)
    fit = (3.535 * near + 2.181 * near**2) / (1.0 + 2.276 * near + 2.577 * near**2)
    return np.where(a < 1.6, fit, 1.0)


SMITH = {"beckmann": smith_beckmann, "ggx": smith_ggx}


def squared_stretch(v: Array, alphax: float, alphay: float) -> Array:
    return ((alphax * v[:, 0]) ** 2 + (alphay * v[:, 1]) ** 2) / v[:, 2] ** 2


def smith_1967(v: Array, m: float) -> Array:
    """Smith's own function for Gaussian slopes (IEEE Trans. AP 15(5), 1967).

    The numerator, absent from Walter's exact G1, also hides the facets that face away.
    """
    a = v[:, 2] / (m * np.hypot(v[:, 0], v[:, 1]))
    away = np.array([math.erfc(x) for x in a.tolist()])
    hidden = (np.exp(-(a**2)) / (a * math.sqrt(math.pi)) - away) / 2.0
    return (1.0 - away / 2.0) / (1.0 + hidden)


def v_cavity(light: Array, viewer: Array) -> Array:
    """G of R. L. Cook, K. E. Torrance (ACM TOG 1(1) 1982)."""
    h, d = half(light, viewer)
    return np.minimum(1.0, 2.0 * h[:, 2] * np.minimum(light[:, 2], viewer[:, 2]) / d)


# Fresnel reflectances of unpolarised light.


def fresnel(d: Array, eta: float, k: float = 0.0) -> Array:
    """From the complex amplitudes (M. Born, E. Wolf, Principles of Optics, 1999, 1.5 and 14.2)."""
    refracted = np.sqrt((eta + 1j * k) ** 2 - (1.0 - d**2))  # index times cosine inside
    s = (d - refracted) / (d + refracted)
    p = ((eta + 1j * k) ** 2 * d - refracted) / ((eta + 1j * k) ** 2 * d + refracted)
    return (np.abs(s) ** 2 + np.abs(p) ** 2) / 2.0


def schlick(d: Array, F0: float) -> Array:
    """C. Schlick, CGF 13(3) 1994."""
    return F0 + (1.0 - F0) * (1.0 - d) ** 5


def internal_reflectance(n: float) -> float:
    """Of diffuse light within index n: 1 - (1 - k1)/n², k1 the same from outside.

    k1 by the midpoint rule in the squared cosine, the measure of diffuse light.
    """
    cosine = np.sqrt((np.arange(200_000) + 0.5) / 200_000)
    return 1.0 - (1.0 - float(fresnel(cosine, n).mean())) / n**2


def internal_reflectance_sum(n: float) -> float:
    """The same as SCATMECH sums it: angles inside in steps of 0.2°, weighted by sin(2 theta)."""
    theta = np.radians(np.arange(451) * 0.2)
    weight = np.sin(2.0 * theta)
    return float((weight * fresnel(np.cos(theta), 1.0 / n)).sum() / weight.sum())


def internal_reflectance_fit(n: float) -> float:
    """The same by the fit of W. Egan, T. Hilgeman (1973) that Mitsuba evaluates."""
    return 0.0636 * n + 0.6681 + 0.7099 / n - 1.4399 / n**2


def kubelka_munk_layer(KS: float, SX: float, Rg: float) -> float:
    """P. Kubelka, F. Munk 1931, in the hyperbolic form of Kubelka (JOSA 38, 1948)."""
    a = 1.0 + KS
    b = math.sqrt(a**2 - 1.0)
    coth = 1.0 / math.tanh(b * SX)
    return (1.0 - Rg * (a - b * coth)) / (a - Rg + b * coth)
