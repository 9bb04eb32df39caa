"""What is computed of a window: what is counted of its samples, and the values of every page."""

from __future__ import annotations

from dataclasses import dataclass, replace
from threading import Event
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.cmm.link import Link
from brdfc.cmm.rendering import Rendering, Target
from brdfc.images.counts import Counts, counted
from brdfc.images.memory import WINDOW_PIXELS
from brdfc.images.samples import Samples
from brdfc.images.window import Grid, Window


@dataclass(frozen=True)
class Computing:
    """renderings: one a page, of the same profiles. columns: the samples of a pixel that their link
    takes, of so many channels. total: the pixels of the image. It holds no file, so that another
    process can compute too."""

    renderings: tuple[Rendering, ...]
    samples: Samples
    columns: tuple[int, ...]
    channels: int
    total: int

    @property
    def link(self) -> Link:
        return self.renderings[0].link

    @property
    def working(self) -> int:
        """Bytes that a pixel takes while it is computed with, about."""
        floats = 4 * (3 * len(self.columns) + (1 + len(self.renderings)) * self.link.outputs)
        plain = self.renderings[0].to in (Target.XYZ, Target.SPECTRUM, Target.DEVICE)
        return floats + (8 * 3 * 2 if plain else 8 * 3 * 8)

    def page(self, page: int) -> Computing:
        """The same for one page."""
        return replace(self, renderings=(self.renderings[page],))

    def run(
        self, band: NDArray[np.float32], window: Window, spoiled: Event
    ) -> tuple[list[NDArray[Any]], Counts]:
        """The values of each page, (rows, columns, samples), for the samples (rows, columns,
        channels) of a window; and what was counted.

        spoiled is set where samples are no numbers. From then on, in any window, there are only
        counts: nothing will be written.
        """
        counts = counted(self.link, self.columns, band, window)
        if counts.faults:
            spoiled.set()
        if spoiled.is_set():
            return [], counts
        if self.columns != tuple(range(self.channels)):
            band = band[..., list(self.columns)]
        return self._rendered(band, counts), counts

    def _rendered(self, band: NDArray[np.float32], counts: Counts) -> list[NDArray[Any]]:
        """The values of each page, in pieces: what computing takes beside its result does not grow
        with the window."""
        rows, columns = band.shape[:2]
        first, *others = self.renderings
        pages = [np.empty((rows, columns, r.samples), self.samples.kind) for r in self.renderings]
        across = min(columns, WINDOW_PIXELS)
        for piece in Grid(rows, columns, max(1, WINDOW_PIXELS // across), across).windows():
            found = first.link.together([r.link for r in others], band[piece.part], self.total)
            for rendering, values, page in zip(self.renderings, found, pages, strict=True):
                finished, clipped = rendering.finished(values)
                page[piece.part], more = self.samples.counted(finished)
                counts.clipped += clipped + more
        return pages


def columns(link: Link, count: int) -> list[int] | None:
    """The samples of an image that a link takes: those of the image it was compiled for, by their
    names, where there are as many; else all. None where the image does not fit."""
    if count == len(link.samples) and set(link.channels) <= set(link.samples):
        return [link.samples.index(name) for name in link.channels]
    return list(range(count)) if count == len(link.channels) else None
