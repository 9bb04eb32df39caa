"""The library's models, and texts that import its building blocks, as functions of unit vectors."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from brdfc.lang.load import load, load_text
from brdfc.lang.model import Model
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.expression import Expression
from brdfc.symbolic.formula import formula

Array = NDArray[np.float64]
Function = Callable[..., Array]

GEOMETRY = "full"


def reflectance(name_or_text: str) -> Function:
    """The reflectance f(light, viewer, **parameters) of a library model, or of a model's text.

    light and viewer are vectors (n, 3) above the surface, the normal along z and the tangent along
    x; their lengths do not count. Every channel of the model is a parameter: a number, or an array
    that goes with (n, components); what is not given has its default. Returns f [1/sr], (n, 3),
    in float64 by the formula that a program is made from. TypeError for a parameter that the model
    does not have.
    """

    def f(light: Array, viewer: Array, **parameters: ArrayLike) -> Array:
        model, prepared = _ready(name_or_text)
        values = {q.name: np.array([q.default]) for q in model.quantities}
        for name, value in parameters.items():
            if name not in values:
                raise TypeError(f"'{model.name}' has no parameter '{name}'")
            values[name] = np.atleast_2d(np.asarray(value, np.float64)) + 0 * values[name]
        values |= _angles("incident", light) | _angles("reflection", viewer)
        return evaluate(prepared, values) / np.cos(values["incident"])

    return f


@cache
def _ready(name_or_text: str) -> tuple[Model, Expression]:
    """The model and its formula, guarded as programs need it."""
    is_text = "\n" in name_or_text
    model = (load_text if is_text else load)(name_or_text, geometry=GEOMETRY)
    assert isinstance(model, Model)
    return model, formula(model, {"intensity": (1.0,)}).prepared


def _angles(name: str, direction: Array) -> dict[str, Array]:
    """Zenith and azimuth, (n, 1), under the names that the geometry gives them."""
    x, y, z = direction[:, :1], direction[:, 1:2], direction[:, 2:]
    return {name: np.arctan2(np.hypot(x, y), z), f"{name}_azimuth": np.arctan2(y, x)}


_BLOCKS = """model composed "One formula in the library's building blocks, the same in X, Y and Z"

channel alpha   : roughness   in 0.001..1 = 0.3 "width of the distribution of slopes"
channel m       : roughness   in 0.001..1 = 0.3 "RMS slope"
channel alphax  : roughness   in 0.001..1 = 0.3 "its width along the tangent"
channel alphay  : roughness   in 0.001..1 = 0.3 "its width across it"
channel n       : number      in 1..10    = 1.5 "index of a dielectric"
channel eta     : number      in 0..10    = 1.5 "complex index of a conductor, eta + ik"
channel k       : number      in 0..10    = 0   "its imaginary part"
channel F0      : reflectance in 0..1     = 1   "Fresnel reflectance at normal incidence"
channel B       : number      in 1..1e7   = 1e3 "how narrow an ABC lobe is"
channel C       : number      in 0.3..3   = 1   "how fast its tail falls"
channel Rd      : reflectance in 0..1     = 0   "reflectance of a body"
channel k2      : number      in 0..1     = 0   "reflectance of an interface from inside"
channel KS      : number      in 0..1000  = 0   "absorption over scattering of a layer"
channel SX      : number      in 0..20    = 0   "its scattering times thickness"
channel Rg      : reflectance in 0..1     = 0   "reflectance of the ground"
channel r       : reflectance in 0..1     = 0.5 "perceptual roughness"
channel sheen   : number      in 0..1     = 0   "grazing light of cloth"

import geometry (visible, irradiance, cos_incident, cos_reflection, half_tangent2, half_sine2,
  half_cosine2, difference_cosine, tangential_cosine2)
import fresnel (schlick, schlick_average, dielectric, index, conductor)
import distributions (beckmann, beckmann_anisotropic, beckmann_exponential,
  beckmann_exponential_anisotropic, trowbridge_reitz, trowbridge_reitz_anisotropic,
  generalised_trowbridge_reitz_1, gaussian, abc, log_cosine, blinn_phong,
  blinn_phong_anisotropic)
import shadowing (v_cavity, neumann, kelemen, smith_separable, smith_separable_anisotropic,
  smith_correlated, smith_correlated_anisotropic, smith_separable_beckmann,
  smith_separable_beckmann_anisotropic, smith_correlated_beckmann)
import diffuse (lambertian, oren_nayar_qualitative, disney, coupled, transmitted, kubelka_munk,
  kubelka_munk_layer, saunderson)
import abc_smooth (lobe as abc_smooth_lobe)

let f = FORMULA
radiance = irradiance*(f, f, f) where visible else 0
"""


def composed(text: str) -> Function:
    """The same of a formula for f in the building blocks; see _BLOCKS for its parameters."""
    return reflectance(_BLOCKS.replace("FORMULA", text))
