"""A fit in the forms that other programs read: a table, an image of coefficients, a renderer's."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from brdfc.fit.result import Fit
from brdfc.source.errors import FitError

PATCH = 16
"""Pixels of a side of an image that is one material."""


def csv_text(fit: Fit) -> str:
    """A row a coefficient."""
    rows = [f"{e.name},{e.value:.9g},{e.low:.9g},{e.high:.9g}" for e in fit.estimates]
    return "\n".join(["coefficient,value,low,high", *rows]) + "\n"


def write_patch(fit: Fit, path: str | Path) -> None:
    """A small TIFF of the coefficients, as `brdfc apply` takes it, whole or not at all."""
    import tifffile

    from brdfc.files import whole_file

    if fit.fixed:
        raise FitError(
            f"{', '.join(fit.fixed)} are fixed, and an image has no samples of them",
            where=str(path),
            hint="compile the model with the same --set, and without --tiff",
        )
    pixel = np.array([e.value for e in fit.estimates], np.float32)
    with whole_file(path) as temporary:
        tifffile.imwrite(
            temporary,
            np.broadcast_to(pixel, (PATCH, PATCH, len(pixel))).copy(),
            photometric="minisblack",
            planarconfig="contig",
            description=f"{fit.model}: {', '.join(e.name for e in fit.estimates)}",
            metadata=None,
        )


def _diffuse(values: Mapping[str, float], white: tuple[float, ...]) -> dict[str, object]:
    return {"type": "diffuse", "reflectance": _rgb([values[f"Rd{c}"] for c in "xyz"], white)}


MITSUBA: dict[str, Callable[[Mapping[str, float], tuple[float, ...]], dict[str, object]]] = {
    "lambert": _diffuse,
}
"""Models that Mitsuba 3 has as they are, and its words for them. Its rough conductor and its
plastic have Fresnel terms and shadowing of their own: coefficients of ours mean something else
there."""


def require_mitsuba(model: str) -> None:
    """FitError where Mitsuba has no such model."""
    if model not in MITSUBA:
        raise FitError(f"Mitsuba has no '{model}' as it is", hint=f"it has {', '.join(MITSUBA)}")


def mitsuba_text(fit: Fit) -> str:
    """The material as a dictionary of Mitsuba 3, in JSON; FitError where it has no such model, and
    for coefficients that are no X, Y, Z."""
    require_mitsuba(fit.model)
    if fit.kind != "XYZ":
        raise FitError(f"coefficients of {fit.kind} values are no X, Y, Z")
    return json.dumps(MITSUBA[fit.model](fit.values, fit.white), indent=2) + "\n"


def _rgb(xyz: list[float], white: tuple[float, ...]) -> dict[str, object]:
    """Linear sRGB of a reflectance: its colour under the white as it is under D65."""
    from brdfc.colour.adaptation import adaptation_matrix
    from brdfc.colour.library import colour_science

    space = colour_science().RGB_COLOURSPACES["sRGB"]
    to_xyz = np.asarray(space.matrix_RGB_to_XYZ, dtype=np.float64)
    adapted = adaptation_matrix(list(white), to_xyz.sum(axis=1).tolist())
    rgb = np.linalg.solve(to_xyz, adapted @ np.array(xyz))
    return {"type": "rgb", "value": [float(f"{v:.7g}") for v in np.clip(rgb, 0, 1)]}
