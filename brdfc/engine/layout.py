"""How the samples of pixels lie in memory, and parts of them where code can read and write them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from brdfc.engine.kernels import Values


@dataclass(frozen=True)
class Samples:
    """Samples (pixels, samples) of an image, of any strides. interleaved: those of a pixel are next
    to each other. direct: they lie so, or each in a plane of its own, and not otherwise."""

    values: Values
    interleaved: bool
    direct: bool

    @property
    def step(self) -> int:
        """Samples from one pixel to the next: all of a pixel, or 1 in planes."""
        return self.values.shape[1] if self.interleaved else 1

    def addresses(self) -> list[int]:
        """Of the first sample of all, or of each plane."""
        base = self.values.ctypes.data
        if self.interleaved:
            return [base]
        return [base + k * self.values.strides[1] for k in range(self.values.shape[1])]

    def part(self, start: int, stop: int) -> Samples:
        return Samples(self.values[start:stop], self.interleaved, self.direct)

    def room(self, pixels: int) -> Samples:
        """As much memory of the same layout, all 0."""
        count = self.values.shape[1]
        if self.interleaved:
            return Samples(np.zeros((pixels, count), np.float32), True, True)
        return Samples(np.zeros((count, pixels), np.float32).T, False, True)


def samples(values: Values, widest: int) -> Samples:
    """Values (pixels, samples) as they lie; pixels of more samples than `widest` count as neither
    interleaved nor in planes."""
    count = values.shape[1]
    across, along = values.strides if values.flags.aligned else (0, 0)
    if across == 4 or count <= 1:
        return Samples(values, False, across == 4)
    together = along == 4 and across == 4 * count and count <= widest
    return Samples(values, together, together)


def flat(values: Values) -> Values:
    """(..., samples) as (pixels, samples): the same memory wherever that can be."""
    return values.reshape(math.prod(values.shape[:-1]), values.shape[-1])


def shares(count: int, parts: int, least: int, multiple: int) -> Iterator[tuple[int, int]]:
    """Ranges of pixels, as many as parts but of no less than `least`, for threads."""
    parts = max(1, min(parts, count // least))
    size = -(-count // parts)
    size += -size % multiple
    for start in range(0, count, size):
        yield start, min(start + size, count)
