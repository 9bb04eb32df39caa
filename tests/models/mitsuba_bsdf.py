"""Values of Mitsuba 3's BSDFs, as a judge that nobody here wrote.

Mitsuba (https://mitsuba-renderer.org, W. Jakob and others) returns f times the cosine of the
direction it calls wo; here the light is wo, the viewer is wi, and that cosine is divided out. The
wheel has no double-precision variant; `scalar_rgb` needs no library beside it. Every spectrum is
grey and one channel is returned.

Every public function takes light and viewer, unit vectors (n, 3) with the normal along z and the
tangent along x, both above the surface, and returns n values. Directions should be
exact in float32, else their rounding counts as Mitsuba's error. Raises ImportError without Mitsuba.
"""

from __future__ import annotations

import importlib
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@cache
def mitsuba() -> ModuleType:
    """Imported on first use, so that tests can be collected without it."""
    module = importlib.import_module("mitsuba")
    module.set_variant("scalar_rgb")
    return module


def evaluated(description: dict[str, Any], light: Array, viewer: Array) -> Array:
    """f of the BSDF that a scene description stands for."""
    mi = mitsuba()
    bsdf, context = mi.load_dict(description), mi.BSDFContext()
    interaction = mi.SurfaceInteraction3f()
    values = np.empty(len(light))
    for k, (wo, wi) in enumerate(zip(light.tolist(), viewer.tolist(), strict=True)):
        interaction.wi = wi
        values[k] = bsdf.eval(context, interaction, mi.Vector3f(wo))[0]
    return values / light[:, 2]


def diffuse(light: Array, viewer: Array, Rd: float) -> Array:
    return evaluated({"type": "diffuse", "reflectance": grey(Rd)}, light, viewer)


def rough_conductor(
    light: Array,
    viewer: Array,
    distribution: str,
    alphax: float,
    alphay: float,
    eta: float = 0.0,
    k: float = 1.0,
) -> Array:
    """distribution: "beckmann" or "ggx"; eta + ik = i, Mitsuba's material "none", reflects all."""
    return evaluated(
        {
            "type": "roughconductor",
            "distribution": distribution,
            "alpha_u": alphax,
            "alpha_v": alphay,
            "eta": eta,
            "k": k,
        },
        light,
        viewer,
    )


def rough_dielectric(
    light: Array, viewer: Array, distribution: str, alphax: float, alphay: float, n: float
) -> Array:
    """The side of the light only: reflection from an interface of index n."""
    return evaluated(
        {
            "type": "roughdielectric",
            "distribution": distribution,
            "alpha_u": alphax,
            "alpha_v": alphay,
            "int_ior": n,
            "ext_ior": 1.0,
        },
        light,
        viewer,
    )


def rough_plastic(light: Array, viewer: Array, distribution: str, alpha: float, n: float) -> Array:
    """Its lobe; its body is black here, being an interpolated table rather than a formula."""
    return evaluated(
        {
            "type": "roughplastic",
            "distribution": distribution,
            "alpha": alpha,
            "int_ior": n,
            "ext_ior": 1.0,
            "diffuse_reflectance": grey(0.0),
        },
        light,
        viewer,
    )


def plastic(light: Array, viewer: Array, Rd: float, n: float) -> Array:
    """The body of reflectance Rd under a smooth interface of index n, without the mirror image."""
    return evaluated(
        {
            "type": "plastic",
            "diffuse_reflectance": grey(Rd),
            "int_ior": n,
            "ext_ior": 1.0,
            "nonlinear": True,  # what comes back from the interface meets Rd again
        },
        light,
        viewer,
    )


def internal_reflectance(n: float) -> float:
    """What `plastic` takes for diffuse light in index n: the fit of W. Egan, T. Hilgeman (1973)."""
    return 0.0636 * n + 0.6681 + 0.7099 / n - 1.4399 / n**2


def principled(light: Array, viewer: Array, base: float, **weights: float) -> Array:
    """weights: Mitsuba's own names (roughness, metallic, specular, spec_tint, sheen, ...)."""
    return evaluated({"type": "principled", "base_color": grey(base), **weights}, light, viewer)


def principled_metal(
    light: Array, viewer: Array, base: float, roughness: float, anisotropic: float
) -> Array:
    return principled(
        light, viewer, base, metallic=1.0, roughness=roughness, anisotropic=anisotropic
    )


def principled_diffuse(
    light: Array, viewer: Array, base: float, roughness: float, sheen: float
) -> Array:
    """Without a lobe: specular = 0 makes the index 1."""
    return principled(light, viewer, base, specular=0.0, roughness=roughness, sheen=sheen)


def principled_clearcoat(light: Array, viewer: Array, clearcoat: float, gloss: float) -> Array:
    """The clearcoat over 4 ci co, a factor that Mitsuba leaves out of this lobe alone."""
    coat = principled(light, viewer, 0.0, specular=0.0, clearcoat=clearcoat, clearcoat_gloss=gloss)
    return coat / (4.0 * light[:, 2] * viewer[:, 2])


def principled_tinted(
    light: Array,
    viewer: Array,
    base: float,
    metallic: float,
    specular: float,
    roughness: float,
    sheen: float,
    clearcoat: float,
    gloss: float,
) -> Array:
    """Fully tinted by a grey base, the lobe has Schlick's Fresnel term; untinted, the exact one."""
    rest = principled(
        light,
        viewer,
        base,
        metallic=metallic,
        specular=specular,
        roughness=roughness,
        sheen=sheen,
        spec_tint=1.0,
    )
    return rest + principled_clearcoat(light, viewer, clearcoat, gloss)


def ward_gmd(light: Array, viewer: Array, alphax: float, alphay: float) -> Array:
    """D/(4 d²) from Mitsuba's Beckmann distribution."""
    d2 = ((light + viewer) ** 2).sum(axis=1) / 4.0
    return normals(light, viewer, "beckmann", alphax, alphay) / (4.0 * d2)


def height_correlated(light: Array, viewer: Array, alphax: float, alphay: float) -> Array:
    """D G/(4 ci co) from Mitsuba's GGX and its G1 = 1/(1 + Lambda), with G = 1/(1 + Li + Lo)."""
    inverse = sum(1.0 / masking(v, "ggx", alphax, alphay) for v in (light, viewer)) - 1.0
    return normals(light, viewer, "ggx", alphax, alphay) / (
        4.0 * light[:, 2] * viewer[:, 2] * inverse
    )


def normals(light: Array, viewer: Array, distribution: str, alphax: float, alphay: float) -> Array:
    """D at the half vector, which Mitsuba exposes by itself."""
    microfacets = microfacet_distribution(distribution, alphax, alphay)
    half = light + viewer
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    return np.array([microfacets.eval(mitsuba().Vector3f(h)) for h in half.tolist()])


def masking(direction: Array, distribution: str, alphax: float, alphay: float) -> Array:
    """Smith's G1, which Mitsuba exposes too."""
    microfacets = microfacet_distribution(distribution, alphax, alphay)
    vector = mitsuba().Vector3f
    return np.array([microfacets.smith_g1(vector(v), vector(0, 0, 1)) for v in direction.tolist()])


def microfacet_distribution(distribution: str, alphax: float, alphay: float) -> Any:
    mi = mitsuba()
    kind = {"beckmann": mi.MicrofacetType.Beckmann, "ggx": mi.MicrofacetType.GGX}[distribution]
    return mi.MicrofacetDistribution(kind, alphax, alphay)


def grey(value: float) -> dict[str, Any]:
    return {"type": "rgb", "value": [value, value, value]}
