"""Where the fit of each of many pixels starts: the best point of a grid over the coefficients that
are not linear, with the linear ones solved for.

All pixels were seen in the same directions, so that their normal equations at a point of the grid
are sums over directions of weights, which differ from pixel to pixel, times products of the model's
slopes, which do not: one matrix product for all pixels and points.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations_with_replacement, product

import numpy as np
from numpy.typing import NDArray

from brdfc.fit.fitting import Scaling, spread
from brdfc.fit.response import Response

Array = NDArray[np.float64]

_POINTS = {0: (1,), 1: (32,), 2: (12, 12)}
"""Of the grid, along each coefficient that is not linear."""
_SPREAD = 256
"""Points where those are three or more,"""
_STARTS = 4
"""which are too few to trust the best: so many starts, the best of every fourth point."""
_SAME = 1e-9
"""Points whose losses differ by this share of what is measured are as good: the first is taken."""
_STEPS = 10007
"""Places that a start can have along a coefficient. What rounding leaves of a matrix product
depends on where in it a pixel stands; a start does not."""
_RIDGE = 1e-12
_NOTHING = 1e-100
_ROWS = 128
_SINGLE = 1 << 18
"""Multiplications of a matrix product, below which the libraries that NumPy uses do not split it
among threads of their own: windows have theirs."""


class Starts:
    """Starts of fits of a response. block: pixels that are looked at together, at most."""

    def __init__(self, response: Response, block: int) -> None:
        self._scaling = scaling = Scaling(response)
        self._linear = linear = np.array([c.linear for c in response.coefficients])
        self._block = block
        self._points = places = _points(response, linear)
        values = np.where(linear, 0.0, scaling.values(places))
        offset, slopes = response.slopes(values)
        offset = offset.reshape(len(places), -1)
        basis = slopes[..., linear].reshape(len(places), offset.shape[1], -1)
        columns = basis.shape[-1]
        self._pairs = list(combinations_with_replacement(range(columns), 2))
        squares = [basis[..., a] * basis[..., b] for a, b in self._pairs]
        squares += [offset * basis[..., a] for a in range(columns)] + [offset**2]
        self._of_squares = _Products(squares)
        self._of_values = _Products([basis[..., a] for a in range(columns)] + [offset])
        self._low = [c.low for c in response.coefficients if c.linear]
        self._high = [c.high for c in response.coefficients if c.linear]

    def __call__(self, given: Array, weight: Array) -> Array:
        """Places (starts, pixels, p) in 0..1 for BRDF values (pixels, n k), and by how much a
        difference of each counts."""
        count = len(given)
        squares = np.zeros((self._block, weight.shape[1]))
        squares[:count] = weight**2
        weighted = np.zeros_like(squares)
        weighted[:count] = squares[:count] * given
        left = self._of_squares(squares)
        right = self._of_values(weighted)
        size = len(self._low)
        matrix = dict(zip(self._pairs, left, strict=False))
        target = [right[a] - left[len(self._pairs) + a] for a in range(size)]
        found = solved_within(matrix, target, self._low, self._high)
        # The loss but for the sum of the measured squares, which no point changes.
        loss = left[-1] - 2 * right[-1]
        for (a, b), square in matrix.items():
            loss += (1 if a == b else 2) * square * found[a] * found[b]
        for a in range(size):
            loss -= 2 * target[a] * found[a]
        scale = (weighted[:count] * given).sum(axis=1)
        several = _STARTS if len(loss) == _SPREAD else 1
        parts = loss[:, :count].reshape(-1, several, count)
        best = (parts <= parts.min(axis=0) + _SAME * scale).argmax(axis=0)
        best = best * several + np.arange(several)[:, None]
        places = self._points[best].copy()
        if size:
            values = self._scaling.values(places)
            values[..., self._linear] = np.stack(
                [f[best, np.arange(count)] for f in found], axis=-1
            )
            places = np.where(self._linear, self._scaling.places(values), places)
        return np.asarray(np.rint(places * _STEPS) / _STEPS)


class _Products:
    """Sums over directions of what pixels have times what points of a grid have; those that occur
    several times, or are 0, are computed once."""

    def __init__(self, columns: Sequence[Array]) -> None:
        """columns: (points, n k) each."""
        whole = np.concatenate(columns)
        # What is as good as nothing; the least of numbers are slow to multiply.
        whole = np.where(np.abs(whole) > _NOTHING, whole, 0.0)
        distinct, place = np.unique(whole, axis=0, return_inverse=True)
        self._place = place.reshape(len(columns), -1)
        self._rows = min(_ROWS, len(distinct))
        padded = np.zeros((-(-len(distinct) // self._rows) * self._rows, whole.shape[1]))
        padded[: len(distinct)] = distinct
        self._distinct = padded.reshape(-1, 1, self._rows, whole.shape[1])

    def __call__(self, pixels: Array) -> Array:
        """(columns, points, pixels) for (pixels, n k)."""
        count, samples = pixels.shape
        across = count
        while across % 2 == 0 and across * self._rows * samples > _SINGLE:
            across //= 2
        parts = pixels.reshape(-1, across, samples).transpose(0, 2, 1)
        found = (self._distinct @ parts).transpose(0, 2, 1, 3).reshape(-1, count)
        return np.asarray(found[self._place])


def _points(response: Response, linear: NDArray[np.bool_]) -> Array:
    """Places (points, p) of the grid, those near the model's defaults first."""
    scaling = Scaling(response)
    shaped = np.flatnonzero(~linear)
    default = scaling.places(np.array([c.default for c in response.coefficients]))
    if len(shaped) in _POINTS:
        axes = [(np.arange(n) + 0.5) / n for n in _POINTS[len(shaped)][: len(shaped)]]
        rows = list(product(*axes))
        places = np.tile(default, (len(rows), 1))
        places[:, shaped] = np.array(rows).reshape(len(rows), -1)
    else:
        places = spread(response, _SPREAD, 1)
    apart = np.abs(places - default)[:, shaped].sum(axis=1)
    return np.asarray(places[np.argsort(apart, kind="stable")])


def solved_within(
    matrix: dict[tuple[int, int], Array],
    target: Sequence[Array],
    low: Sequence[float],
    high: Sequence[float],
) -> list[Array]:
    """Normal equations solved for many at once, and what is outside its range put on its end, with
    the others solved for again. matrix: by row and column, row <= column."""
    free = _solved(matrix, target)
    size = len(target)
    outside = [(x < a) | (x > b) for x, a, b in zip(free, low, high, strict=True)]
    ends = [np.clip(x, a, b) for x, a, b in zip(free, low, high, strict=True)]
    if not any(o.any() for o in outside):
        return free
    held = {
        (a, b): np.where(outside[a] | outside[b], float(a == b), value)
        for (a, b), value in matrix.items()
    }
    moved = []
    for a in range(size):
        rest = target[a].copy()
        for b in range(size):
            if b != a:
                rest -= np.where(outside[b], matrix[min(a, b), max(a, b)] * ends[b], 0.0)
        moved.append(np.where(outside[a], ends[a], rest))
    again = _solved(held, moved)
    return [np.clip(x, a, b) for x, a, b in zip(again, low, high, strict=True)]


def _solved(matrix: dict[tuple[int, int], Array], target: Sequence[Array]) -> list[Array]:
    """By L D L', number by number, each an array over all systems."""
    size = len(target)
    upper: dict[tuple[int, int], Array] = {}
    pivots: list[Array] = []
    found = list(target)
    for a in range(size):
        pivot = matrix[a, a] * (1 + _RIDGE) + 1e-300
        least = _RIDGE * pivot
        for c in range(a):
            pivot = pivot - upper[c, a] ** 2 * pivots[c]
        pivots.append(np.maximum(pivot, least))
        for b in range(a + 1, size):
            value = matrix[a, b]
            for c in range(a):
                value = value - upper[c, a] * upper[c, b] * pivots[c]
            upper[a, b] = value / pivots[a]
        for c in range(a):
            found[a] = found[a] - upper[c, a] * found[c]
    found = [x / pivot for x, pivot in zip(found, pivots, strict=True)]
    for a in reversed(range(size)):
        for b in range(a + 1, size):
            found[a] = found[a] - upper[a, b] * found[b]
    return found
