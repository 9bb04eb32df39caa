"""XYZ to pictures a person can look at."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from brdfc.colour.colorimetry import XYZ, Display
from brdfc.colour.difference import D50
from brdfc.colour.library import colour_science


def srgb_display(white: XYZ) -> Display:
    """What srgb shows of XYZ under a white, before it is rounded to 8 bits."""
    from brdfc.colour.adaptation import adaptation_matrix

    space = colour_science().RGB_COLOURSPACES["sRGB"]
    own = np.asarray(space.matrix_RGB_to_XYZ, dtype=np.float64)
    x, y, z = own.sum(axis=1).tolist()
    to_primaries = np.linalg.inv(own) @ adaptation_matrix(white, (x, y, z))
    return Display(
        tuple(map(tuple, to_primaries.tolist())), tuple(map(tuple, own.tolist())), (x, y, z)
    )


def srgb(xyz: ArrayLike, bits: int = 8) -> tuple[NDArray[Any], NDArray[np.bool_]]:
    """sRGB in 8 or 16 bits of XYZ (..., 3) under D50, Y = 1 for white, adapted to D65 by linear
    Bradford.

    Returns the picture, and which pixels (...) lay outside what sRGB can show; those are clipped,
    component by component.
    """
    colour = colour_science()
    encoded = colour.XYZ_to_sRGB(
        np.asarray(xyz, dtype=np.float64),
        illuminant=colour.XYZ_to_xy(np.array(D50)),
        chromatic_adaptation_transform="Bradford",
    )
    most = 2**bits - 1
    outside = ((encoded < -0.5 / most) | (encoded > (most + 0.5) / most)).any(axis=-1)
    kind = np.uint8 if bits == 8 else np.uint16
    return np.round(np.clip(encoded, 0, 1) * most).astype(kind), outside
