"""A window's way from the source to its place in the result, here or on another machine."""

from __future__ import annotations

from threading import Event

from brdfc.images.computing import Computing
from brdfc.images.counts import Counts
from brdfc.images.tiff import CoefficientImage
from brdfc.images.window import Window
from brdfc.images.writing import Places


def fill(
    image: CoefficientImage,
    computing: Computing,
    places: Places,
    file: int,
    window: Window,
    spoiled: Event,
) -> Counts:
    """Read a window, compute it, and write every page of it to an open file; what was counted. Done
    again it is the same. spoiled: see Computing.run."""
    pages, counts = computing.run(image.window(window), window, spoiled)
    for page, values in enumerate(pages):
        places.put(file, page, window, values)
    return counts
