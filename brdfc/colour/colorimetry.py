"""What the values of a profile connection space look like: their XYZ, and colour differences."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from brdfc.colour.difference import D50, ciede2000

XYZ = tuple[float, float, float]

BRIGHTEST = 100.0
"""Times white: the brightest that colours are compared at."""


Rows = tuple[tuple[float, ...], ...]


@dataclass(frozen=True)
class Display:
    """A display that shows each primary from 0 to 1, and clips the rest. to_primaries: three rows
    that make its primaries of X, Y, Z under the colorimetry's white; to_xyz: three that make X, Y,
    Z under its own white of the primaries."""

    to_primaries: Rows
    to_xyz: Rows
    white: XYZ

    def shown(self, xyz: NDArray[np.float64]) -> NDArray[np.float64]:
        """X, Y, Z (..., 3) of what it shows."""
        primaries = np.clip(xyz @ np.array(self.to_primaries).T, 0.0, 1.0)
        return np.asarray(primaries @ np.array(self.to_xyz).T)


@dataclass(frozen=True)
class Colorimetry:
    """white: X, Y, Z of a perfect diffuser. rows: three rows that make X, Y, Z of the values; none
    where the values are XYZ already. display: where colours are compared as a display shows them.
    """

    white: XYZ = D50
    rows: Rows = ()
    display: Display | None = None

    @property
    def width(self) -> int:
        """Values that a colour has: 3, or one a wavelength."""
        return len(self.rows[0]) if self.rows else 3

    def xyz(self, values: ArrayLike) -> NDArray[np.float64]:
        """(..., width) to (..., 3)."""
        wide = np.asarray(values, dtype=np.float64)
        return wide @ np.array(self.rows).T if self.rows else wide

    def difference(self, first: ArrayLike, second: ArrayLike) -> NDArray[np.float64]:
        """CIEDE2000 of (..., width) and (..., width), the truth, under this white.

        Where the truth is more than BRIGHTEST times white, both are dimmed to that first: CIELAB
        makes no sense of a highlight of a million times white, where the rounding of a neutral
        float32 would be a visible hue.
        """
        colours, truth = self.xyz(first), self.xyz(second)
        if self.display is not None:
            shown = self.display.shown
            return ciede2000(shown(colours), shown(truth), self.display.white)
        brightness = np.max(np.abs(truth) / self.white, axis=-1, keepdims=True, initial=BRIGHTEST)
        dimmed = BRIGHTEST / brightness
        return ciede2000(colours * dimmed, truth * dimmed, self.white)


XYZ_UNDER_D50 = Colorimetry()
"""What profiles connect through, and what a formula gives where nobody says anything else."""
