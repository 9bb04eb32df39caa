"""What is counted of an image on its way: samples that are no numbers, that lie outside the ranges
that a profile states, and pixels that were clipped."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.cmm.link import Link
from brdfc.images.window import Window

Place = tuple[int, int, int]
_FOLDED = 1024
"""Numbers that extremes are found of side by side, so that a processor takes many at once."""


@dataclass
class Counts:
    """Of some windows. faults: samples that are NaN or infinite; first: row, column and channel of
    the first of them. outside: by quantity. clipped: pixels. pixels: by what
    else is said of them."""

    faults: int = 0
    first: Place | None = None
    outside: dict[str, int] = field(default_factory=dict)
    clipped: int = 0
    pixels: dict[str, int] = field(default_factory=dict)

    def add(self, other: Counts) -> None:
        self.faults += other.faults
        self.clipped += other.clipped
        places = [place for place in (self.first, other.first) if place is not None]
        self.first = min(places, default=None)
        for name, count in other.outside.items():
            self.outside[name] = self.outside.get(name, 0) + count
        for name, count in other.pixels.items():
            self.pixels[name] = self.pixels.get(name, 0) + count


def counted(link: Link, columns: Sequence[int], band: NDArray[Any], window: Window) -> Counts:
    """What there is to count of the samples (rows, columns, channels) of a window.

    columns: the samples that the link takes. Those that it does not take count too where they are
    outside their range: the profile says nothing about them, so the user is told.
    """
    counts = Counts()
    least, greatest = extremes(band)
    sound = np.isfinite(least) & np.isfinite(greatest)
    for index, column in enumerate(columns):
        if not sound[column]:
            _count_faults(counts, band[..., column], window, index)
    given = link.samples if band.shape[-1] == len(link.samples) else link.channels
    for described in link.described:
        low, high = described.reach
        for place in (given.index(n) for n in described.component_names if n in given):
            # Nothing is outside where the extremes are not; NaN is on neither side.
            if sound[place] and not ((least[place] < low) | (greatest[place] > high)):
                continue
            values = band[..., place]
            outside = int(((values < low) | (values > high)).sum())
            if outside:
                counts.outside[described.name] = counts.outside.get(described.name, 0) + outside
    return counts


def _count_faults(counts: Counts, values: NDArray[Any], window: Window, channel: int) -> None:
    bad = ~np.isfinite(values)
    row, column = (int(i) for i in np.argwhere(bad)[0])
    first = (window.top + row, window.left + column, channel)
    counts.add(Counts(faults=int(bad.sum()), first=first))


def extremes(band: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """The least and the greatest of each channel of (rows, columns, channels); NaN where there is
    one."""
    channels = band.shape[-1]
    if not band.flags.c_contiguous or channels == 1:
        # Planes, each of them one after the other in memory.
        planes = [band[..., channel] for channel in range(channels)]
        return np.array([p.min() for p in planes]), np.array([p.max() for p in planes])
    # Many pixels side by side, so that numpy runs over long rows and not over a few channels.
    flat = band.reshape(-1)
    row = channels * max(1, _FOLDED // channels)
    whole = len(flat) // row * row
    least, greatest = [], []
    for part in (flat[:whole].reshape(-1, row), flat[whole:].reshape(-1, channels)):
        if len(part):
            least.append(np.minimum.reduce(part, axis=0).reshape(-1, channels))
            greatest.append(np.maximum.reduce(part, axis=0).reshape(-1, channels))
    low, high = np.concatenate(least), np.concatenate(greatest)
    return np.minimum.reduce(low, axis=0), np.maximum.reduce(high, axis=0)
