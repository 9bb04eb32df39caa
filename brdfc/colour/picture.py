"""XYZ to pictures a person can look at."""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import ArrayLike, NDArray

from brdfc.colour.difference import D50


def srgb(xyz: ArrayLike) -> tuple[NDArray[np.uint8], int]:
    """8-bit sRGB of XYZ (..., 3) under D50, Y = 1 for white, adapted to D65 by linear Bradford.

    Returns the picture and how many pixels lay outside what sRGB can show; those are clipped,
    channel by channel.
    """
    with warnings.catch_warnings():
        # It warns of optional packages that this needs none of.
        warnings.simplefilter("ignore")
        import colour

    values = np.asarray(xyz, dtype=np.float64)
    encoded = colour.XYZ_to_sRGB(
        values,
        illuminant=colour.XYZ_to_xy(np.array(D50)),
        chromatic_adaptation_transform="Bradford",
    )
    outside = int(((encoded < -0.5 / 255) | (encoded > 255.5 / 255)).any(axis=-1).sum())
    return np.round(np.clip(encoded, 0, 1) * 255).astype(np.uint8), outside
