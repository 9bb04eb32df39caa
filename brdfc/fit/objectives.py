"""How far a model is from measurements: differences that a least squares method makes small.

All are of f cos(incidence), what is seen of a surface, not of the BRDF alone; each with the weight
its author gives it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.colour.difference import ciede2000_of_lab, lab
from brdfc.fit.measurements import Measurements
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import ValueGivenError

Array = NDArray[np.float64]

LEAST = 1e-6
"""Of f cos, in 1/sr: what a cube root is taken of at least, so that it has a slope."""


@dataclass(frozen=True)
class Scale:
    """seen: what a difference is taken of, a function of f cos; slope: its derivative. weight: of a
    measurement, by its directions (n, 4)."""

    seen: Callable[[Array], Array]
    slope: Callable[[Array], Array]
    weight: Callable[[Array], Array]


def _cube_root(x: Array) -> Array:
    """The cube root; below LEAST its tangent there."""
    return np.where(x > LEAST, np.cbrt(x), np.cbrt(LEAST) + (x - LEAST) * LEAST ** (-2 / 3) / 3)


def _even(directions: Array) -> Array:
    return np.ones(len(directions))


def _solid(directions: Array) -> Array:
    return np.sqrt(np.abs(np.sin(directions[:, 0])))


SCALES: dict[str, Scale] = {
    # A. Fores, J. Ferwerda, J. Gu, Color and Imaging Conference 20, 2012
    "cube-root": Scale(
        _cube_root,
        lambda x: np.maximum(x, LEAST) ** (-2 / 3) / 3,
        _even,
    ),
    # This and the next: J. Low, J. Kronander, A. Ynnerman, J. Unger, ACM TOG 31(1), 2012
    "log": Scale(
        lambda x: np.log1p(np.maximum(x, 0)),
        lambda x: 1 / (1 + np.maximum(x, 0)),
        _solid,
    ),
    "l2": Scale(
        lambda x: x,
        np.ones_like,
        _solid,
    ),
}
"""Scales of differences, by the names that --objective takes."""
COLOUR = "de2000"
"""The objective that is a mean CIEDE2000; a fit starts on the cube root."""


def scale_named(objective: str) -> Scale:
    """The scale that least squares works on; ValueGivenError for another name."""
    known = [COLOUR, *SCALES]
    if objective not in known:
        raise ValueGivenError(
            f"there is no objective '{objective}'",
            hint=did_you_mean(objective, known) or ", ".join(known),
        )
    return SCALES["cube-root" if objective == COLOUR else objective]


class Differences:
    """Residuals of measurements on a scale, (n k,), and their slopes."""

    def __init__(self, measured: Measurements, scale: Scale) -> None:
        self.scale = scale
        self.cosine = np.cos(measured.directions[:, 0])[:, None]
        weight = scale.weight(measured.directions) * np.sqrt(measured.weights)
        self.valid = measured.values >= 0  # and not missing
        self.weight = np.where(self.valid, weight[:, None], 0.0)
        given = np.where(self.valid, measured.values, 0.0)
        self.target = scale.seen(given * self.cosine)
        self.given = given

    def residuals(self, values: Array) -> Array:
        """Of BRDF values (n, k)."""
        return (self.weight * (self.scale.seen(values * self.cosine) - self.target)).ravel()

    def by_slopes(self, values: Array, slopes: Array) -> Array:
        """(n k, p), of slopes (n, k, p) of the BRDF."""
        factor = self.weight * self.scale.slope(values * self.cosine) * self.cosine
        return (factor[..., None] * slopes).reshape(-1, slopes.shape[-1])

    def linear_weight(self) -> Array:
        """(n, k): by how much a difference of the BRDF counts near what was measured."""
        return self.weight * self.scale.slope(self.given * self.cosine) * self.cosine


class ColourDifferences:
    """CIEDE2000 of measurements of X, Y, Z to a model, as seen: of pi f cos(incidence).

    factors: what the differences of lightness, chroma and hue are divided by (kL, kC, kH).
    """

    def __init__(
        self, measured: Measurements, factors: tuple[float, float, float] = (1.0, 1.0, 1.0)
    ) -> None:
        assert measured.white is not None
        self.factors, self.white = factors, measured.white
        self.seen = np.pi * np.cos(measured.directions[:, 0])[:, None]
        self.valid = (measured.values >= 0).all(axis=1)
        self.weights = measured.weights[self.valid] / measured.weights[self.valid].sum()
        self.target = self.lab(measured.values)

    def lab(self, values: Array) -> Array:
        """CIELAB of BRDF values (..., n, 3)."""
        return lab((values * self.seen)[..., self.valid, :], self.white)

    def each(self, values: Array) -> Array:
        """The difference of every valid measurement, (..., n)."""
        return ciede2000_of_lab(self.lab(values), self.target, self.factors)

    def mean(self, values: Array) -> float:
        return float(self.each(values) @ self.weights)
