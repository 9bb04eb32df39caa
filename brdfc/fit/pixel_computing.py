"""What is computed of a window of a stack: coefficients of its pixels, and how good they are."""

from __future__ import annotations

from dataclasses import dataclass
from threading import Event
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.fit.pixels import PixelFit
from brdfc.images.counts import Counts
from brdfc.images.window import Window

Array = NDArray[np.float64]

QUALITY = ("rms", "converged", "geometries")
"""The samples that say how good a pixel's coefficients are."""
DONE, FAILED, FEW, LEFT_OUT = "fitted", "did not converge", "too few geometries", "samples left out"
"""What is counted."""
_GREATEST = 1e12
"""1/sr; what is above is no reflectance."""
WORKING = 80
"""Bytes that a sample takes while it is computed with, about."""


@dataclass(frozen=True, eq=False)
class PixelComputing:
    """fit: of the model. factors: (n,), from an image's values to BRDF; neutral: what a pixel's one
    sample becomes, where it has one. clip: values from here on are saturated. keep: coefficients of
    pixels whose fit failed are written too. quality: whether QUALITY is wanted beside them."""

    fit: PixelFit
    factors: Array
    neutral: Array | None
    clip: float | None
    keep: bool
    quality: bool

    def run(
        self, band: NDArray[np.float32], window: Window, spoiled: Event
    ) -> tuple[list[NDArray[Any]], Counts]:
        """Coefficients (rows, columns, p) float32, NaN where there are none, and QUALITY; for the
        samples (rows, columns, n channels) of a window, one image after the other."""
        shape = band.shape[:2]
        values = band.reshape(window.pixels, len(self.factors), -1)
        usable = np.isfinite(values) & (values >= 0)
        if self.clip is not None:
            usable &= values < self.clip
        brdf = np.where(usable, values, np.nan) * self.factors[:, None]
        usable &= brdf <= _GREATEST
        brdf[~usable] = np.nan
        found = self.fit(brdf if self.neutral is None else brdf * self.neutral)
        failed = found.enough & ~found.converged
        counts = {
            DONE: int(found.converged.sum()),
            FAILED: int(failed.sum()),
            FEW: int((~found.enough).sum()),
            LEFT_OUT: int((~usable).sum()),
        }
        coefficients = found.coefficients.astype(np.float32)
        if not self.keep:
            coefficients[~found.converged] = np.nan
        results = [coefficients]
        if self.quality:
            columns = [found.loss, found.converged, found.geometries]
            results.append(np.stack(columns, axis=1).astype(np.float32))
        return [r.reshape(*shape, -1) for r in results], Counts(pixels=counts)
