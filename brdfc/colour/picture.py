"""XYZ to pictures a person can look at."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from brdfc.colour.difference import D50
from brdfc.colour.library import colour_science


def srgb(xyz: ArrayLike) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    """8-bit sRGB of XYZ (..., 3) under D50, Y = 1 for white, adapted to D65 by linear Bradford.

    Returns the picture, and which pixels (...) lay outside what sRGB can show; those are clipped,
    component by component.
    """
    colour = colour_science()
    encoded = colour.XYZ_to_sRGB(
        np.asarray(xyz, dtype=np.float64),
        illuminant=colour.XYZ_to_xy(np.array(D50)),
        chromatic_adaptation_transform="Bradford",
    )
    outside = ((encoded < -0.5 / 255) | (encoded > 255.5 / 255)).any(axis=-1)
    return np.round(np.clip(encoded, 0, 1) * 255).astype(np.uint8), outside
