"""Pairs of directions above a surface, as unit vectors: the normal along z, the tangent along x."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import DTypeLike, NDArray

Array = NDArray[np.float64]

PAIRS = 4000
LOWEST_COSINE = 0.001


def pairs(width: float, precision: DTypeLike = np.float64) -> tuple[Array, Array]:
    """PAIRS pairs of unit vectors (light, viewer), (n, 3), rounded to a precision.

    Every other pair is uniform over both hemispheres; else the viewer mirrors the light at a normal
    with Beckmann slopes of the width, so that narrow lobes are met.
    """
    random = np.random.default_rng(7)
    light, viewer = hemisphere(random, 8 * PAIRS), hemisphere(random, 8 * PAIRS)
    slope = width * np.sqrt(random.exponential(size=len(light)))
    azimuth = random.uniform(-np.pi, np.pi, len(light))
    normal = np.stack([slope * np.cos(azimuth), slope * np.sin(azimuth), np.ones_like(slope)], 1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    mirrored = 2.0 * (light * normal).sum(axis=1, keepdims=True) * normal - light
    viewer[::2] = mirrored[::2]
    above = (light[:, 2] > LOWEST_COSINE) & (viewer[:, 2] > LOWEST_COSINE)
    return rounded(light[above][:PAIRS], precision), rounded(viewer[above][:PAIRS], precision)


def rounded(direction: Array, precision: DTypeLike) -> Array:
    """Directions in a precision, those nearby whose length is nearest to 1.

    The library works with angles and does not see lengths; the judge's half vector turns with them,
    and at grazing angles the 3e-8 of single precision would be felt by slopes of 0.001.
    """
    nearest = direction[:, :2].astype(precision)
    steps = np.array(list(itertools.product(range(-2, 3), repeat=2)), precision)
    xy = (nearest[:, None] + steps * np.spacing(nearest)[:, None]).astype(np.float64)
    height = np.sqrt(1.0 - (xy**2).sum(axis=2, keepdims=True)).astype(precision)
    near = np.concatenate([xy, height], axis=2)
    best = np.abs((near**2).sum(axis=2) - 1.0).argmin(axis=1)
    return np.asarray(near[np.arange(len(near)), best])


def hemisphere(random: np.random.Generator, count: int) -> Array:
    cosine, azimuth = random.uniform(0.0, 1.0, count), random.uniform(-np.pi, np.pi, count)
    sine = np.sqrt(1.0 - cosine**2)
    return np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), cosine], axis=1)


def diffuse_light(count: int) -> Array:
    """Directions (count, 3) whose mean is the hemisphere's, weighted by the cosine: the midpoint
    rule in the squared cosine. For what does not depend on the azimuth."""
    cosine = np.sqrt((np.arange(count) + 0.5) / count)
    return np.stack([np.sqrt(1.0 - cosine**2), 0.0 * cosine, cosine], axis=1)
