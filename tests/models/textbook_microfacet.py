"""BRDFs of microfacets, as their textbooks write them: Cook-Torrance, GGX, Disney's and a print's.

p holds a model's channels.
"""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace

from textbook_geometry import Geometry, Namespace, Number, Vector


def schlick(f0: Number, cosine: Number) -> Number:
    """C. Schlick, CGF 13(3), 1994: Fresnel's reflectance, roughly."""
    return f0 + (1 - f0) * (1 - cosine) ** 5


def dielectric(ns: Namespace, n: Number, cosine: Number) -> Number:
    """Fresnel's reflectance of unpolarised light, as Cook and Torrance write it."""
    g = ns.sqrt(n**2 + cosine**2 - 1)
    parallel = (cosine * (g + cosine) - 1) / (cosine * (g - cosine) + 1)
    return ((g - cosine) / (g + cosine)) ** 2 * (1 + parallel**2) / 2


def refractive_index(ns: Namespace, f0: Number) -> Number:
    """The index whose reflectance along the normal is f0."""
    return (1 + ns.sqrt(f0)) / (1 - ns.sqrt(f0))


def v_cavity(ns: Namespace, g: Geometry) -> Number:
    """Shadowing and masking in V-shaped cavities (Torrance, Sparrow 1967)."""
    masked, shadowed = 2 * g.c * g.co / g.d, 2 * g.c * g.ci / g.d
    return ns.minimum(1, ns.minimum(masked, shadowed))


def _beckmann_1982(ns: Namespace, g: Geometry, m: Number) -> Number:
    """Without 1/pi, as Cook and Torrance print it: its projected integral is pi."""
    return ns.exp(-((ns.tan(g.delta) / m) ** 2)) / (m**2 * ns.cos(g.delta) ** 4)


def cook_torrance(
    lobes: tuple[str, ...],
) -> Callable[[Namespace, Geometry, SimpleNamespace], Number]:
    """R. L. Cook, K. E. Torrance, SIGGRAPH 1981, with Schlick's Fresnel term and the 1/4 that
    keeps energy; `lobes` are the ends of the lobes' channel names."""

    def brdf(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
        value = p.Rd / ns.pi
        for lobe in lobes:
            ks, m, f0 = (getattr(p, name + lobe) for name in ("ks", "m", "F0"))
            distribution = _beckmann_1982(ns, g, m) / ns.pi
            reflected = schlick(f0, g.d) * distribution * v_cavity(ns, g)
            value = value + ks * reflected / (4 * g.ci * g.co)
        return value

    return brdf


def cook_torrance_1982(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """As printed in ACM TOG 1(1), 1982: 1/pi, and Fresnel's formula for the index that F0 means."""
    fresnel = dielectric(ns, refractive_index(ns, p.F0), g.d)
    reflected = fresnel * _beckmann_1982(ns, g, p.m) * v_cavity(ns, g)
    return p.Rd / ns.pi + p.ks * reflected / (ns.pi * g.ci * g.co)


def cook_torrance_ngan(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """As the parameters of A. Ngan, F. Durand, W. Matusik, EGSR 2005, assume it: 1/pi^2."""
    reflected = schlick(p.F0, g.d) * _beckmann_1982(ns, g, p.m) * v_cavity(ns, g)
    return p.Rd / ns.pi + p.ks * reflected / (ns.pi**2 * g.ci * g.co)


def _ggx_lobe(ns: Namespace, g: Geometry, ax: Number, ay: Number, f0: Number) -> Number:
    """T. Trowbridge, K. Reitz 1975; B. Walter et al., EGSR 2007; height-correlated Smith masking
    (E. Heitz, JCGT 3(2), 2014)."""

    def slope(direction: Vector) -> Number:
        x, y, z = direction
        phi, tangent = ns.arctan2(y, x), ns.tan(ns.arccos(z))
        a2 = (ax * ns.cos(phi)) ** 2 + (ay * ns.sin(phi)) ** 2
        return (ns.sqrt(1 + a2 * tangent**2) - 1) / 2

    masking = 1 / (1 + slope(g.light) + slope(g.viewer))
    reflected = schlick(f0, g.d) * _gtr2(ns, g, ax, ay) * masking
    return reflected / (4 * g.ci * g.co)


def _gtr2(ns: Namespace, g: Geometry, ax: Number, ay: Number) -> Number:
    phi, tan2 = g.half_azimuth, ns.tan(g.delta) ** 2
    ellipse = ns.cos(phi) ** 2 / ax**2 + ns.sin(phi) ** 2 / ay**2
    return 1 / (ns.pi * ax * ay * ns.cos(g.delta) ** 4 * (1 + tan2 * ellipse) ** 2)


def ggx(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """alpha is the width itself, not a perceptual roughness whose square is the width."""
    return p.Rd / ns.pi + p.ks * _ggx_lobe(ns, g, p.alpha, p.alpha, p.F0)


def ggx_anisotropic(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """alphax is the width along the tangent."""
    return p.Rd / ns.pi + p.ks * _ggx_lobe(ns, g, p.alphax, p.alphay, p.F0)


def disney(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """B. Burley, Physically-based shading at Disney, SIGGRAPH course, 2012; without tints."""
    return _disney(ns, g, p, p.roughness**2, p.roughness**2)


def disney_anisotropic(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """The same with the course's anisotropic distribution; its masking stays isotropic."""
    aspect = ns.sqrt(1 - ns.number("0.9") * p.anisotropic)
    return _disney(ns, g, p, p.roughness**2 / aspect, p.roughness**2 * aspect)


def _disney(ns: Namespace, g: Geometry, p: SimpleNamespace, ax: Number, ay: Number) -> Number:
    weight = schlick(0, g.d)
    grazing = 2 * p.roughness * g.d**2 + 0.5

    def fade(cosine: Number) -> Number:
        return 1 + (grazing - 1) * (1 - cosine) ** 5

    def masking(width: Number) -> Number:
        def one(cosine: Number) -> Number:
            return 1 / (cosine + ns.sqrt(width**2 + cosine**2 - width**2 * cosine**2))

        return one(g.ci) * one(g.co)

    diffuse = p.base / ns.pi * fade(g.ci) * fade(g.co)
    f0 = ns.number("0.08") * p.specular * (1 - p.metallic) + p.base * p.metallic
    specular = _gtr2(ns, g, ax, ay) * schlick(f0, g.d) * masking((0.5 + p.roughness / 2) ** 2)
    width = ns.number("0.1") * (1 - p.gloss) + ns.number("0.001") * p.gloss
    gtr1 = (width**2 - 1) / (ns.pi * ns.log(width**2) * (1 + (width**2 - 1) * g.c**2))
    coat = p.clearcoat / 4 * gtr1 * schlick(ns.number("0.04"), g.d) * masking(0.25)
    return (1 - p.metallic) * (diffuse + p.sheen * weight) + specular + coat


def print_layer(ns: Namespace, g: Geometry, p: SimpleNamespace) -> Number:
    """A halftone of an ink on paper, beneath a glossy surface: Murray-Davies, Kubelka-Munk for the
    ink, Saunderson's k1 and k2, and a GGX lobe. 0/0 for an ink without absorption (KS = 0)."""
    a = 1 + p.KS
    b = ns.sqrt(a**2 - 1)
    coth = 1 / ns.tanh(b * p.SX)
    ink = (1 - p.Rg * (a - b * coth)) / (a - p.Rg + b * coth)
    body = (1 - p.tone) * p.Rg + p.tone * ink
    n = refractive_index(ns, p.F0)
    k1 = p.F0 + (1 - p.F0) / 21  # the mean of Schlick's reflectance over the hemisphere
    k2 = 1 - (1 - k1) / n**2
    through = (1 - schlick(p.F0, g.ci)) * (1 - schlick(p.F0, g.co))
    diffuse = through / (ns.pi * n**2) * body / (1 - k2 * body)
    return diffuse + p.ks * _ggx_lobe(ns, g, p.alpha, p.alpha, p.F0)
