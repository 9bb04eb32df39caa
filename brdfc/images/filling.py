"""A window's way from the source to its place in the results, here or on another machine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass
from threading import Event
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from brdfc.images.counts import Counts
from brdfc.images.memory import Plan
from brdfc.images.source import Samples
from brdfc.images.stream import in_order
from brdfc.images.unfinished import Unfinished, least_done
from brdfc.images.window import Window
from brdfc.images.writing import Places, opened_to_fill


class Computes(Protocol):
    """What is computed of a window. It holds no file, so that another process can compute too."""

    def run(
        self, band: NDArray[np.float32], window: Window, spoiled: Event
    ) -> tuple[list[NDArray[Any]], Counts]:
        """The values of each page of each result, (rows, columns, samples); none where nothing is
        to be written. See Computing.run."""
        ...


@dataclass(frozen=True)
class Filling:
    """computing: what is computed; results: where its pages belong, those of the first file
    first."""

    computing: Computes
    results: tuple[Places, ...]

    def fill(self, image: Samples, files: Sequence[int], window: Window, spoiled: Event) -> Counts:
        """Read a window, compute it, and write every page of it to open files; what was counted.
        Done again it is the same. spoiled: see Computing.run."""
        pages, counts = self.computing.run(image.window(window), window, spoiled)
        slots = (
            (places, file, page)
            for places, file in zip(self.results, files, strict=True)
            for page in range(len(places.starts))
        )
        for (places, file, page), values in zip(slots, pages, strict=bool(pages)):
            places.put(file, page, window, values)
        return counts


def fill_here(
    filling: Filling,
    image: Samples,
    plan: Plan,
    unfinished: Sequence[Unfinished],
    progress: Callable[[int, int], None],
) -> Counts:
    """Fill the results in one pass over an image, several windows at a time, from the top down or
    from where an earlier run had come to; what was counted. unfinished: one a result."""
    spoiled, grid = Event(), plan.grid
    start, _ = least_done(unfinished)
    with ExitStack() as stack:
        files = [stack.enter_context(opened_to_fill(p.path)) for p in filling.results]

        def work(window: Window) -> tuple[Window, Counts]:
            return window, filling.fill(image, files, window, spoiled)

        done, row = start * grid.width, Counts()
        results = stack.enter_context(closing(in_order(work, grid.windows(start), plan.workers)))
        for window, counts in results:
            row.add(counts)
            if window.left + window.columns == grid.width:
                for each, file in zip(unfinished, files, strict=True):
                    each.reached(window.top + window.rows, row, file)
                row = Counts()
            done += window.pixels
            progress(done, grid.pixels)
    return unfinished[0].counts
