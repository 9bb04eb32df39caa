"""The ranges that the samples of an image of coefficients lie in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from brdfc.images.tiff import CoefficientImage, open_coefficients
from brdfc.source.errors import ImageError, SceneError

Ends = tuple[float, float]

PERCENTILES = (1.0, 99.0)
"""Said of each sample, beside its ends."""
_SAMPLED = 1 << 20
"""Pixels that percentiles are found from, at most, evenly spread."""
_STRETCHED = 4.0
"""A range so many times that between the percentiles is stretched by few pixels."""


@dataclass(frozen=True)
class Measured:
    """pixels: of the image. names: of its samples. ends: the least and the greatest of each;
    percentiles: of each; ranges: what is kept of each, so that at most a share of the pixels lies
    outside, outside: how many do."""

    pixels: int
    names: tuple[str, ...]
    ends: tuple[Ends, ...]
    percentiles: tuple[Ends, ...]
    ranges: tuple[Ends, ...]
    outside: int = 0

    @property
    def stretched(self) -> tuple[str, ...]:
        """The names of samples whose range is far wider than what nearly all pixels need."""
        return tuple(
            name
            for name, (low, high), (first, last) in zip(
                self.names, self.ends, self.percentiles, strict=True
            )
            if high - low > _STRETCHED * (last - first) and high > low
        )


def measure(path: str | Path, names: Sequence[str], share: float, where: str) -> Measured:
    """Measure a float32 TIFF whose samples have these names.

    share: of the pixels that the ranges may leave out, at both ends of every sample. Raises
    ImageError for NaN or infinity, with its place; SceneError for another number of samples.
    """
    with open_coefficients(path) as image:
        if image.channels != len(names):
            raise SceneError(
                f"the image has {image.channels} samples a pixel; {len(names)} are needed: "
                f"{', '.join(names)}",
                where=where,
                hint="a scene says which quantities they are: samples = [...] under [channels]",
            )
        low, high = _extremes(image, str(path))
        some = _spread(image)
        first, last = np.percentile(some, PERCENTILES, axis=0)
        ranges, outside = (low, high), 0
        if share > 0:
            ranges, outside = _trimmed(image, some, low, high, share)
    return Measured(
        image.height * image.width,
        tuple(names),
        _pairs(low, high),
        _pairs(first, last),
        _pairs(*ranges),
        outside,
    )


def _pairs(low: NDArray[np.floating], high: NDArray[np.floating]) -> tuple[Ends, ...]:
    return tuple(zip(map(float, low), map(float, high), strict=True))


def _extremes(
    image: CoefficientImage, where: str
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    low = np.full(image.channels, np.inf, np.float32)
    high = -low
    top = 0
    for band in image.bands():
        flat = band.reshape(-1, image.channels)
        bad = ~np.isfinite(flat)
        if bad.any():
            place, channel = (int(i) for i in np.argwhere(bad)[0])
            row, column = divmod(place, image.width)
            raise ImageError(
                f"a sample is NaN or infinite at row {top + row}, column {column}, channel "
                f"{channel + 1}: no range holds it",
                where=where,
                hint="mask or fill it first",
            )
        low, high = np.minimum(low, flat.min(axis=0)), np.maximum(high, flat.max(axis=0))
        top += len(band)
    return low, high


def _spread(image: CoefficientImage) -> NDArray[np.float32]:
    """Some of the pixels, evenly spread, (pixels, channels)."""
    step = -(-image.height * image.width // _SAMPLED)
    parts, offset = [], 0
    for band in image.bands():
        flat = band.reshape(-1, image.channels)
        parts.append(flat[(-offset) % step :: step])
        offset += len(flat)
    return np.concatenate(parts)


def _trimmed(
    image: CoefficientImage,
    some: NDArray[np.float32],
    low: NDArray[np.float32],
    high: NDArray[np.float32],
    share: float,
) -> tuple[tuple[NDArray[np.floating], NDArray[np.floating]], int]:
    """Ranges that at most a share of the pixels leaves, counted; as much at both ends of each."""
    allowed = int(share * image.height * image.width)
    each = share / (2 * image.channels)
    while each > 1e-9:
        ends = np.quantile(some, [each, 1 - each], axis=0, method="nearest")
        outside = sum(
            int(((band < ends[0]) | (band > ends[1])).any(axis=-1).sum()) for band in image.bands()
        )
        if outside <= allowed:
            return (ends[0], ends[1]), outside
        each /= 2
    return (low, high), 0
