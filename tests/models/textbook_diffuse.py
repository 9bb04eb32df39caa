"""BRDFs without a mirror-like lobe, as their textbooks write them. p holds a model's channels."""

from __future__ import annotations

from types import SimpleNamespace

from textbook_geometry import Geometry, Namespace, Number


def lambert(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """J. H. Lambert, Photometria, 1760."""
    return p.Rd / ns.pi


def oren_nayar(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """M. Oren, S. Nayar, SIGGRAPH 1994: the full model, direct light and interreflection."""
    s2 = p.sigma**2
    a, b = _larger_and_smaller_angle(ns, g)
    cosine = g.azimuth_difference_cosine
    less = ns.where(cosine >= 0, 0, (2 * b / ns.pi) ** 3)
    c1 = 1 - s2 / (s2 + ns.number("0.33")) / 2
    c2 = ns.number("0.45") * s2 / (s2 + ns.number("0.09")) * (ns.sin(a) - less)
    c3 = s2 / (s2 + ns.number("0.09")) * (4 * a * b / ns.pi**2) ** 2 / 8
    direct = c1 + cosine * c2 * ns.tan(b) + (1 - abs(cosine)) * c3 * ns.tan((a + b) / 2)
    twice = ns.number("0.17") * s2 / (s2 + ns.number("0.13")) * (1 - cosine * (2 * b / ns.pi) ** 2)
    return p.Rd / ns.pi * direct + p.Rd**2 / ns.pi * twice


def oren_nayar_qualitative(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """The same paper's simplified model, which leaves interreflection and C3 away."""
    s2 = p.sigma**2
    a, b = _larger_and_smaller_angle(ns, g)
    constant = 1 - s2 / (s2 + ns.number("0.33")) / 2
    factor = ns.number("0.45") * s2 / (s2 + ns.number("0.09"))
    same_side = ns.maximum(0, g.azimuth_difference_cosine)
    return p.Rd / ns.pi * (constant + factor * same_side * ns.sin(a) * ns.tan(b))


def _larger_and_smaller_angle(ns: Namespace, g: Geometry) -> tuple[Number, Number]:
    of_light, of_viewer = ns.arccos(g.ci), ns.arccos(g.co)
    return ns.maximum(of_light, of_viewer), ns.minimum(of_light, of_viewer)


def eon(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """J. Portsmouth, P. Kutz, S. Hill, EON: a practical energy-preserving rough diffuse BRDF,
    JCGT 14(1), 2025, with the exact directional albedo E of its Fujii Oren-Nayar part.

    At r = 0 the multiple-scattering part is 0/0.
    """
    r, rho = p.r, p.Rd
    scale = 1 / (1 + (ns.number("0.5") - 2 / (3 * ns.pi)) * r)
    s = g.phase_cosine - g.ci * g.co
    t = ns.where(s > 0, ns.maximum(g.ci, g.co), 1)
    single = rho / ns.pi * scale * (1 + r * s / t)

    def directional(cosine: Number) -> Number:
        angle = ns.arccos(cosine)
        sine = ns.sin(angle)
        shape = sine * (angle - sine * cosine)
        shape = shape + 2 * (sine / cosine * (1 - sine**3) - sine) / 3
        return scale * (1 + r * shape / ns.pi)

    mean = scale * (1 + (2 - 28 / (5 * ns.pi)) / 3 * r)
    rho_multiple = rho**2 * mean / (1 - rho * (1 - mean))
    lost = (1 - directional(g.ci)) * (1 - directional(g.co)) / (1 - mean)
    return single + rho_multiple / ns.pi * lost


def minnaert(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """M. Minnaert, Astrophysical Journal 93, 1941; (k+1)/2 makes Rd the albedo along the normal."""
    return p.Rd * (p.k + 1) / (2 * ns.pi) * (g.ci * g.co) ** (p.k - 1)


def lommel_seeliger(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """H. Seeliger 1887, with the phase function of L. Henyey, J. Greenstein 1941."""
    return p.w * _henyey_greenstein(g, p.b) / (4 * ns.pi * (g.ci + g.co))


def hapke(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """B. Hapke, Journal of Geophysical Research 86, 1981, with the opposition surge B."""

    def multiple(x: Number) -> Number:
        return (1 + 2 * x) / (1 + 2 * x * ns.sqrt(1 - p.w))

    phase = ns.arccos(g.phase_cosine)
    surge = p.B0 / (1 + ns.tan(phase / 2) / p.h)
    scattered = (1 + surge) * _henyey_greenstein(g, p.b) + multiple(g.ci) * multiple(g.co) - 1
    return p.w / (4 * ns.pi * (g.ci + g.co)) * scattered


def _henyey_greenstein(g: Geometry, b: Number) -> Number:
    """In the phase angle, whose cosine is l.v: with b > 0 most light goes forward, on."""
    return (1 - b**2) / (1 + 2 * b * g.phase_cosine + b**2) ** 1.5
