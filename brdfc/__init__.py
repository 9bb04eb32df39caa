"""brdfc: reflectance models, written as formulas, compiled to ICC.2 (iccMAX) profiles.

    import brdfc

    model = brdfc.load("ward")
    pair = brdfc.compile(model, set={"m": 0.2})
    pair.save("ward_mvis.icc")
    link = brdfc.connect(pair.mid, pair.mvis, env={"incident": 0.7, "reflection": -0.2})
    xyz = link.apply(pixels)          # (..., channels) float32 in, (..., 3) float32 out

Angles are in radians here; on the command line they carry their unit.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from brdfc.cmm.connect import connect as connect
    from brdfc.cmm.link import Link as Link
    from brdfc.cmm.rendering import Rendering as Rendering
    from brdfc.cmm.rendering import rendering as rendering
    from brdfc.colour.conditions import ViewingConditions as ViewingConditions
    from brdfc.colour.conditions import viewing_conditions as viewing_conditions
    from brdfc.compiled import Compiled as Compiled
    from brdfc.compiler import compile_model as compile  # noqa: F401
    from brdfc.icc.profile import Profile as Profile
    from brdfc.lang.load import load as load
    from brdfc.source.errors import BrdfcError as BrdfcError

__version__ = "0.1.0"

# Imported when first used: `brdfc --help` must not wait for NumPy and SymPy.
_PLACES = {
    "BrdfcError": ("brdfc.source.errors", "BrdfcError"),
    "Compiled": ("brdfc.compiled", "Compiled"),
    "Link": ("brdfc.cmm.link", "Link"),
    "Rendering": ("brdfc.cmm.rendering", "Rendering"),
    "ViewingConditions": ("brdfc.colour.conditions", "ViewingConditions"),
    "Profile": ("brdfc.icc.profile", "Profile"),
    "compile": ("brdfc.compiler", "compile_model"),
    "connect": ("brdfc.cmm.connect", "connect"),
    "load": ("brdfc.lang.load", "load"),
    "rendering": ("brdfc.cmm.rendering", "rendering"),
    "viewing_conditions": ("brdfc.colour.conditions", "viewing_conditions"),
}

__all__ = [*_PLACES, "__version__"]


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module 'brdfc' has no attribute '{name}'")
    module, attribute = _PLACES[name]
    return getattr(import_module(module), attribute)
