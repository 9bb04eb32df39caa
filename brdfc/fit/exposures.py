"""Photographs of one scene merged into one, and the columns of it averaged."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.images.tiff import CoefficientImage
from brdfc.images.window import Window

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_FAR = 4.0
"""Standard deviations from a column's median, from which on a pixel is dust."""
_NORMAL = 1.4826
"""Standard deviations in a median absolute deviation, for normal noise."""


@dataclass(frozen=True)
class Region:
    """Columns left..right and rows top..bottom of an image, the last not included."""

    left: int
    top: int
    right: int
    bottom: int

    @property
    def window(self) -> Window:
        """The same, as images are read."""
        return Window(self.top, self.left, self.bottom - self.top, self.right - self.left)

    @property
    def places(self) -> tuple[Array, Array]:
        """The middles of its pixels: columns (1, n) and rows (m, 1)."""
        columns = np.arange(self.left, self.right, dtype=np.float64)[None, :] + 0.5
        rows = np.arange(self.top, self.bottom, dtype=np.float64)[:, None] + 0.5
        return columns, rows


@dataclass(frozen=True, eq=False)
class Exposed:
    """Images of one scene and their exposures. dark: the value of no light; clip: the value, as a
    share of the greatest, that is too bright; of floats, the value."""

    images: Sequence[CoefficientImage]
    exposures: Sequence[float]
    dark: float
    clip: float

    def values(self, region: Region) -> tuple[Array, Mask]:
        """Values (rows, columns, channels) of an exposure of 1, NaN where all images are clipped,
        and where that is (rows, columns).

        The sum of what is not clipped over the sum of its exposures: with the noise of photons,
        whose variance is the signal, no other weights do better.
        """
        total: Array | float = 0.0
        time: Array | float = 0.0
        for image, exposure in zip(self.images, self.exposures, strict=True):
            values = image.window(region.window).astype(np.float64)
            # One clipped channel makes the colour wrong: the pixel is clipped. NaN is, too.
            below = (values < self.clip * (image.greatest or 1.0)).all(axis=-1, keepdims=True)
            total = total + np.where(below, values - self.dark, 0.0)
            time = time + np.where(below, exposure, 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            merged: Array = np.asarray(total / time)
        return merged, np.asarray(np.isnan(merged).all(axis=-1))


def averaged(values: Array) -> tuple[Array, int]:
    """(columns, channels): means over the rows of values (rows, columns, channels), and how many
    pixels were left out for being far from their column's median. NaN is left out too; a column of
    nothing else is NaN."""
    clear = np.asarray(np.isfinite(values).all(axis=-1))
    mean = np.full(values.shape[1:], np.nan)
    some = clear.any(axis=0)
    good = np.where(clear[:, some, None], values[:, some], np.nan)
    away = np.abs(good - np.nanmedian(good, axis=0))
    spread = np.nanmedian(away, axis=0)
    # Where most pixels are equal, as without noise, nothing tells dust from the surface.
    dust = ((away > _FAR * _NORMAL * spread) & (spread > 0)).any(axis=-1)
    good[dust] = np.nan
    mean[some] = np.nanmean(good, axis=0)
    return mean, int(dust.sum())
