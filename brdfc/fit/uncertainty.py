"""How sure coefficients are: the spread of an estimate that makes a sum of losses small.

The covariance is the sandwich A^-1 B A^-1, with A the curvature of the loss and B the spread of its
slopes over measurements (P. J. Huber, Proc. Fifth Berkeley Symposium, 1967): it holds for a mean of
colour differences as for least squares, and where the noise grows with the signal. All bands of a
geometry count as one measurement. The bootstrap fits anew to measurements drawn with replacement
(B. Efron, Annals of Statistics 7(1), 1979).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Losses = Callable[[Array], Array]
"""The loss of every measurement (n,) at a place (p,)."""

NORMAL = 1.959963985
"""Standard deviations to either side that 95 % lie within."""
FLAT = 1e-7
"""Share of the largest singular value that counts as nothing."""
AT_END = 1e-3
"""Share of its range within which a coefficient is at an end of it."""
WIDE = 0.5
"""A coefficient is undetermined where its interval takes up so much of its range to either side."""
TIED = 0.95
"""Two coefficients of at least this correlation cannot be told apart."""
STEP = 1e-3
MOST_LEVERAGE = 0.7


@dataclass(frozen=True)
class Spread:
    """Of places (p,): low and high of the interval of 95 %; the correlation (p, p), 0 for what was
    held; at_end: held at the low (-1) or high (1) end of its range, or 0; undetermined: what the
    measurements say nothing of."""

    low: Array
    high: Array
    correlation: Array
    at_end: NDArray[np.int_]
    undetermined: NDArray[np.bool_]


def spread_of(losses: Losses, x: Array, rounded: Losses, slopes: Array) -> Spread:
    """The spread of an estimate x in 0..1 that makes the sum of losses small.

    rounded: the same losses without a kink at 0, which their curvature is taken of: a colour
    difference is like an absolute value. slopes: (m, p), how what is seen changes with x, exactly;
    directions in which it does not are found by them.
    """
    estimate = x
    at_end = _ends(losses, x)
    x = np.where(at_end < 0, 0.0, np.where(at_end > 0, 1.0, x))
    silent = _silent(losses, x)
    at_end[silent] = 0
    free = np.flatnonzero((at_end == 0) & ~silent)
    flat_by_slopes = _flat(slopes[:, free])
    scores, curvatures = _slopes(losses, x, free), _curvatures(rounded, x, free)
    curvature = curvatures.sum(axis=0)
    # Directions that the loss does not change in have no finite spread.
    values, vectors = np.linalg.eigh(curvature)
    largest = max(float(values.max(initial=0.0)), 1e-300)
    flat = values < 1e-9 * largest
    inverse = vectors * np.where(flat, 0.0, 1 / np.where(flat, 1.0, values)) @ vectors.T
    scores = _without_itself(scores, curvatures, inverse)
    covariance = inverse @ (scores.T @ scores) @ inverse
    deviation = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    blind = (np.abs(vectors[:, flat]) > 0.1).any(axis=1) | flat_by_slopes
    low, high = np.minimum(x, estimate), np.maximum(x, estimate)
    low[free] -= np.where(blind, 1.0, NORMAL * deviation)
    high[free] += np.where(blind, 1.0, NORMAL * deviation)
    correlation = np.zeros((len(x), len(x)))
    scale = np.where(deviation > 0, deviation, 1.0)
    correlation[np.ix_(free, free)] = covariance / np.outer(scale, scale)
    undetermined = silent.copy()
    undetermined[free] |= blind | (NORMAL * deviation > WIDE)
    low[silent], high[silent] = 0.0, 1.0
    return Spread(np.clip(low, 0, 1), np.clip(high, 0, 1), correlation, at_end, undetermined)


def _ends(losses: Losses, x: Array) -> NDArray[np.int_]:
    """(p,): -1 or 1 where x is within AT_END of an end of the range that is as good: the loss is
    larger there by no more than chance makes it."""
    each = losses(x)
    here, chance = float(each.sum()), 2 * float(each.mean())
    found = np.zeros(len(x), int)
    for place in range(len(x)):
        side = -1 if x[place] < 0.5 else 1
        end = 0.0 if side < 0 else 1.0
        if abs(x[place] - end) < AT_END:
            there = float(losses(_moved(x, place, end - x[place])).sum())
            if there <= here + chance:
                found[place] = side
    return found


def _flat(slopes: Array) -> NDArray[np.bool_]:
    """(p,): which take part in a direction that changes nothing."""
    if not slopes.shape[1]:
        return np.zeros(0, bool)
    size = np.linalg.norm(slopes, axis=0)
    _, values, vectors = np.linalg.svd(slopes / np.where(size > 0, size, 1.0), full_matrices=False)
    nothing = vectors[values < FLAT * values[0]]
    return np.asarray((np.abs(nothing) > 0.1).any(axis=0) | (size == 0))


def _silent(losses: Losses, x: Array) -> NDArray[np.bool_]:
    """(p,): which could have any value: the width of a highlight that is not there."""
    here = losses(x)
    return np.array(
        [
            all(np.array_equal(losses(_moved(x, k, to - x[k])), here) for to in (0.1, 0.5, 0.9))
            for k in range(len(x))
        ]
    )


def _moved(x: Array, place: int, by: float) -> Array:
    found = x.copy()
    found[place] += by
    return found


def _slopes(losses: Losses, x: Array, free: NDArray[np.intp]) -> Array:
    """(n, free): central differences, within the ranges."""
    columns = []
    for place in free:
        step = _step(x[place])
        ends = (losses(_moved(x, place, side * step)) for side in (1, -1))
        columns.append(np.subtract(*ends) / (2 * step))
    return np.stack(columns, axis=1) if columns else np.zeros((len(losses(x)), 0))


def _curvatures(losses: Losses, x: Array, free: NDArray[np.intp]) -> Array:
    """(n, free, free), of every measurement."""
    rows = []
    for place in free:
        step = _step(x[place])
        ends = (_slopes(losses, _moved(x, place, side * step), free) for side in (1, -1))
        rows.append(np.subtract(*ends) / (2 * step))
    count = len(losses(x))
    matrix = np.stack(rows, axis=1) if rows else np.zeros((count, 0, 0))
    return (matrix + matrix.swapaxes(1, 2)) / 2


def _without_itself(slopes: Array, curvatures: Array, inverse: Array) -> Array:
    """The slope that each measurement has where the estimate is made without it.

    A measurement draws the estimate towards itself, so that its own slope looks too small (J. G.
    MacKinnon, H. White, Journal of Econometrics 29(3), 1985: HC3). One that decides alone is held
    to MOST_LEVERAGE.
    """
    leverage = curvatures @ inverse
    size = np.trace(leverage, axis1=1, axis2=2)
    leverage *= np.minimum(1.0, MOST_LEVERAGE / np.maximum(np.abs(size), 1e-300))[:, None, None]
    found = np.linalg.solve(np.eye(slopes.shape[1]) - leverage, slopes[..., None])
    return np.asarray(found[..., 0], np.float64)


def _step(x: float) -> float:
    """Small, and no larger than what is left to the ends, twice."""
    return float(min(STEP, x / 2.01, (1 - x) / 2.01))
