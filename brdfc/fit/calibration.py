"""From a camera's values to BRDFs and colours: what a white is, and the matrix to XYZ."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.fit.exposures import Region
from brdfc.fit.measurements import Kind
from brdfc.source.errors import MeasurementError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class White:
    """Either values of the camera, one a channel or one for all, of a perfect diffuser that faces
    the light at the axis (of an exposure of 1, less dark), or a region of the images whose surface
    is a diffuser of a reflectance."""

    values: tuple[float, ...] = ()
    region: Region | None = None
    reflectance: float = 1.0


def white_values(white: White, measured: Sequence[Array], channels: int) -> Array:
    """The values (channels,) of a perfect diffuser. measured: those of the region, where it is lit.

    Raises MeasurementError where there are none, or they are not above 0.
    """
    if white.region is None:
        found = np.array(white.values, dtype=np.float64)
        found = np.repeat(found, channels) if found.size == 1 else found
    elif measured:
        found = np.mean(measured, axis=0) / white.reflectance
    else:
        raise MeasurementError(
            "the white region is lit in no photograph, or clipped in all",
            hint="check the region, the cylinder's edges, the light's angle and the exposure",
        )
    if found.shape != (channels,) or not (np.isfinite(found) & (found > 0)).all():
        listed = ", ".join(f"{v:g}" for v in found)
        message = f"the white is {listed}; {channels} values above 0 are needed, one a channel"
        raise MeasurementError(message)
    return found


def coloured(
    values: Array, white: Array, matrix: Array | None
) -> tuple[Kind, Array, list[float] | None]:
    """What values (n, channels) are, relative to those of the white, and its X, Y, Z.

    matrix: (3, 3) from the camera's RGB to XYZ of any scale; None: RGB is left. With it, the white
    is what the matrix makes of it, Y = 1, so that a perfect diffuser keeps the light's colour.
    """
    if values.shape[1] == 1:
        return Kind.SPECTRAL, values / white, None
    if matrix is None:
        return Kind.RGB, values / white, None
    white_xyz = matrix @ white
    if not white_xyz.min() > 0:
        raise MeasurementError(
            f"the matrix makes X, Y, Z {', '.join(f'{v:g}' for v in white_xyz)} of the white",
            hint="it maps the camera's linear R, G, B to X, Y, Z; check its rows and columns",
        )
    return Kind.XYZ, values @ matrix.T / white_xyz[1], (white_xyz / white_xyz[1]).tolist()
