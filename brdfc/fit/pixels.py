"""A model fitted to every pixel of many, all seen in the same directions, all at once.

Differences are of f cos(incidence) on the cube-root scale (objectives.SCALES), as for one material.
From the best point of a grid each pixel goes by Levenberg and Marquardt's method, its coefficients
kept within their ranges by projection; those that have arrived are left alone, so that the hard
ones alone take long. The steps are matrix products of NumPy's over blocks of pixels.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.fit.checks import least_geometries
from brdfc.fit.fitting import AGREED, Scaling
from brdfc.fit.objectives import SCALES
from brdfc.fit.pixel_starts import Starts
from brdfc.fit.response import Response
from brdfc.lang.model import Model
from brdfc.source.errors import FitError
from brdfc.symbolic.formula import NO_WHITE

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Equations = tuple[Array, Array, Array]

BLOCK = 256
"""Pixels that are computed together; their slopes still fit a processor's cache."""
BATCH = 16 * BLOCK
"""Pixels that go on together, so that the few that take long fill blocks too."""
MOST_STEPS = 200
ARRIVED = 1e-6
"""A pixel has converged where a step along the gradient, in the metric of the normal equations,
would lower its sum of squares by this share at most: coefficients are then within a hundredth of
their standard error,"""
EXACT = 1e-6
"""or where the root mean square of its differences is below this, which 32-bit samples cannot be
closer than."""
_DAMPING = 1e-3, 1e-12, 1e12
"""At first, at least, at most: where that does not help either, a pixel is left."""


@dataclass(frozen=True, eq=False)
class Pixels:
    """coefficients: (pixels, p); loss: (pixels,), the root mean square on the cube-root scale;
    converged: (pixels,); geometries: (pixels,), how many were usable; enough: (pixels,), whether
    those are as many as the model needs."""

    coefficients: Array
    loss: Array
    converged: Mask
    geometries: NDArray[np.int64]
    enough: Mask


class PixelFit:
    """Fits of a model in the full geometry to pixels; see Response for fixed and white.

    directions: (n, 4). Raises FitError where they are fewer than the coefficients need. Another
    process is sent what it was made from.
    """

    def __init__(
        self,
        model: Model,
        directions: Array,
        fixed: Mapping[str, Sequence[float]] = {},
        white: Sequence[float] = NO_WHITE,
    ) -> None:
        self._made_from = model, directions, dict(fixed), tuple(white)
        self.response = Response(model, directions, fixed, white)
        self._least = least_geometries(self.response)
        if len(directions) < self._least:
            raise FitError(
                f"{len(directions)} geometries for {len(self.response.coefficients)} coefficients "
                f"of '{model.name}'; {self._least} are needed at least",
                hint="take a model with fewer, or fix some: --set NAME=VALUE",
            )
        self._cosine = np.cos(directions[:, :1])
        self._scale = SCALES["cube-root"]
        self._scaling = Scaling(self.response)
        self._starts = Starts(self.response, BLOCK)

    def __reduce__(self) -> tuple[type[PixelFit], tuple[object, ...]]:
        return PixelFit, self._made_from

    def __call__(self, values: NDArray[np.floating]) -> Pixels:
        """For BRDF values (pixels, n, width); those that are NaN or negative are left out."""
        parts = [self._batch(values[at : at + BATCH]) for at in range(0, len(values), BATCH)]
        return Pixels(
            *(
                np.concatenate([getattr(part, name) for part in parts])
                for name in ("coefficients", "loss", "converged", "geometries", "enough")
            )
        )

    def _batch(self, values: NDArray[np.floating]) -> Pixels:
        valid = values >= 0
        geometries = valid.sum(axis=1).min(axis=1)
        coefficients = np.full((len(values), len(self.response.coefficients)), np.nan)
        loss = np.full(len(values), np.nan)
        converged = np.zeros(len(values), bool)
        enough = (geometries >= self._least) & (
            valid.sum(axis=(1, 2)) >= len(self.response.coefficients)
        )
        if enough.any():
            usable = valid[enough]
            given = np.where(usable, values[enough], 0.0).astype(np.float64)
            coefficients[enough], loss[enough], converged[enough] = self._fitted(given, usable)
        return Pixels(coefficients, loss, converged, geometries, enough)

    def _fitted(self, given: Array, valid: Mask) -> tuple[Array, Array, Mask]:
        count, width = len(given), given[0].size
        seen = given * self._cosine
        weight = np.where(valid, self._scale.slope(seen) * self._cosine, 0.0)
        starts = np.concatenate(
            [
                self._starts(given[part].reshape(-1, width), weight[part].reshape(-1, width))
                for part in blocks(count)
            ],
            axis=1,
        )
        descent = _Descent(self, self._scale.seen(seen), valid)
        ends = [descent.run(places) for places in starts]
        squares, converged = (np.stack(found) for found in zip(*ends, strict=True))
        # Of ends that are as good, one that has converged.
        best = np.where(converged, squares, squares * (1 + AGREED)).argmin(axis=0), np.arange(count)
        loss = np.sqrt(squares[best] / valid.sum(axis=(1, 2)))
        return self._scaling.values(starts[best]), loss, converged[best]

    def equations(self, places: Array, target: Array, valid: Mask) -> Equations:
        """Sums of squares (pixels,) at places (pixels, p), their gradient over 2 (pixels, p), and
        the normal equations (pixels, p, p)."""
        coefficients = self._scaling.values(places)
        values, slopes = self.response.parts(coefficients)
        seen = np.broadcast_to(values, target.shape) * self._cosine
        apart = (self._scale.seen(seen) - target) * valid
        factor = self._scale.slope(seen) * self._cosine * valid
        rows = np.empty((len(places), len(slopes), *target.shape[1:]))
        for row, slope in enumerate(slopes):
            np.multiply(factor, slope, out=rows[:, row])
        flat = rows.reshape(*rows.shape[:2], -1)
        residuals = apart.reshape(len(places), -1, 1)
        by = self._scaling.slopes(coefficients)
        gradient = (flat @ residuals)[..., 0] * by
        normal = (flat @ flat.transpose(0, 2, 1)) * (by[:, :, None] * by[:, None, :])
        return (residuals.transpose(0, 2, 1) @ residuals)[:, 0, 0], gradient, normal


class _Descent:
    """Levenberg and Marquardt's method on many pixels."""

    def __init__(self, fit: PixelFit, target: Array, valid: Mask) -> None:
        self._fit, self._target, self._valid = fit, target, valid
        self._exact = EXACT**2 * valid.sum(axis=(1, 2))

    def run(self, places: Array) -> tuple[Array, Mask]:
        """Move places (pixels, p); the sums of squares there, and which have converged."""
        count = len(places)
        first, least, most = _DAMPING
        damping = np.full(count, first)
        squares, gradient, normal = self._equations(places, np.arange(count))
        converged = np.zeros(count, bool)
        going = np.arange(count)
        for _ in range(MOST_STEPS):
            at, slope, matrix = places[going], gradient[going], normal[going]
            held = ((at <= 0) & (slope > 0)) | ((at >= 1) & (slope < 0))
            enough = np.maximum(ARRIVED * squares[going], self._exact[going])
            step = _step(matrix, slope, held, damping[going])
            arrived = -(step * slope).sum(axis=1) <= enough
            # A damped step gains less: it shows who may have arrived, one without, who has.
            near = np.flatnonzero(arrived)
            whole = _step(matrix[near], slope[near], held[near], np.full(len(near), least))
            arrived[near] = -(whole * slope[near]).sum(axis=1) <= enough[near]
            converged[going] = arrived
            stay = ~arrived & (damping[going] < most)
            going, at, step = going[stay], at[stay], step[stay]
            if not len(going):
                break
            moved = np.clip(at + step, 0.0, 1.0)
            there = self._equations(moved, going)
            better = there[0] < squares[going]
            to = going[better]
            places[to] = moved[better]
            squares[to], gradient[to], normal[to] = (found[better] for found in there)
            damping[going] = np.where(
                better, np.maximum(damping[going] / 10, least), damping[going] * 10
            )
        return squares, converged

    def _equations(self, places: Array, which: NDArray[np.int64]) -> Equations:
        """Of some of the pixels, block by block."""
        parts = []
        for part in blocks(len(which)):
            rows = which[part]
            parts.append(self._fit.equations(places[part], self._target[rows], self._valid[rows]))
        squares, gradient, normal = (np.concatenate(found) for found in zip(*parts, strict=True))
        return squares, gradient, normal


def blocks(count: int) -> Iterator[slice]:
    """So many pixels, BLOCK of them at a time."""
    return (slice(at, at + BLOCK) for at in range(0, count, BLOCK))


def _step(matrix: Array, gradient: Array, held: Mask, damping: Array) -> Array:
    """(pixels, p): the step that damped normal equations ask for, of what is not held."""
    size = matrix.shape[-1]
    apart = held[:, :, None] | held[:, None, :]
    system = np.where(apart, 0.0, matrix)
    diagonal = np.einsum("...ii->...i", system)
    largest = diagonal.max(axis=1, keepdims=True)
    # What changes nothing at all is held by the smallest of weights.
    diagonal += damping[:, None] * diagonal + 1e-14 * largest + 1e-300
    diagonal[held] = 1.0
    step = np.linalg.solve(system, np.where(held, 0.0, -gradient)[..., None])
    return np.asarray(step[..., 0]).reshape(-1, size)
