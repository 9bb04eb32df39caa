"""Linked profiles on an image of coefficients, band by band."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.cmm.link import Link
from brdfc.cmm.rendering import Rendering, Target
from brdfc.files import refuse_same
from brdfc.images.tiff import WRITING, Band, open_coefficients, write_colours
from brdfc.source.errors import ImageError


@dataclass
class Applied:
    """What was done: pixels, for each channel how many samples lay outside its range, and how many
    pixels were clipped to what sRGB can show."""

    pixels: int = 0
    clipped: int = 0
    outside: dict[str, int] = field(default_factory=dict)


def apply_to_tiff(
    rendering: Rendering,
    source: str | Path,
    target: str | Path,
    run: str,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Applied:
    """Evaluate a float32 TIFF of coefficients to a TIFF of what the rendering gives; run: the
    variables, for the description in it.

    The target appears whole or not at all. Raises ImageError for an image that does not fit the
    link, or that holds NaN or infinity anywhere (with their count). progress gets rows done and
    rows in all.
    """
    link = rendering.link
    refuse_same([target], [source])
    with open_coefficients(source) as image:
        names = link.channels
        columns = _columns(link, image.channels)
        if columns is None:
            raise ImageError(
                f"the image has {image.channels} samples a pixel, the profile takes {len(names)}: "
                f"{', '.join(names)}",
                where=str(source),
                hint=WRITING if image.channels == 1 else None,
            )
        applied = Applied(pixels=image.height * image.width)
        faults = _Faults()

        def bands() -> Iterator[NDArray[Any]]:
            top = 0
            for whole in image.bands():
                band = whole[..., columns]
                faults.count(band, top)
                _count_outside(link, whole, applied)
                if faults.total:  # the rest is only counted: nothing will be written
                    yield np.zeros((*band.shape[:2], rendering.samples), rendering.dtype)
                else:
                    colours, clipped = rendering.counted(band)
                    applied.clipped += clipped
                    yield colours
                top += len(band)
                progress(top, image.height)
            if faults.total:
                row, column, channel = faults.first
                raise ImageError(
                    f"{faults.total} of {applied.pixels * len(names):,} samples are NaN or "
                    f"infinite, the first at row {row}, column {column}, '{names[channel]}'",
                    where=str(source),
                    hint="mask or fill them first; nothing was written",
                )

        shape = (image.height, image.width, rendering.samples)
        write_colours(target, shape, bands(), f"{_NAMES[rendering.to]}; {_said(rendering, run)}")
    return applied


_ALL = slice(None)


def _columns(link: Link, count: int) -> slice | list[int] | None:
    """The samples of an image that a link takes: those of the image it was compiled for, by their
    names, where there are as many; else all."""
    if count == len(link.samples) and set(link.channels) <= set(link.samples):
        return [link.samples.index(name) for name in link.channels]
    return _ALL if count == len(link.channels) else None


_NAMES = {
    Target.XYZ: "XYZ, Y = 1 for white",
    Target.LAB: "CIELAB",
    Target.SRGB: "sRGB",
    Target.SPECTRUM: "reflectances",
}


def _said(rendering: Rendering, run: str) -> str:
    return "; ".join(part for part in (rendering.note, run) if part)


@dataclass
class _Faults:
    """Samples that are no numbers: how many, and where the first is (row, column, channel)."""

    total: int = 0
    first: tuple[int, int, int] = (0, 0, 0)

    def count(self, band: Band, top: int) -> None:
        bad = ~np.isfinite(band)
        found = int(bad.sum())
        if found and not self.total:
            row, column, channel = (int(i) for i in np.argwhere(bad)[0])
            self.first = (top + row, column, channel)
        self.total += found


def _count_outside(link: Link, band: Band, applied: Applied) -> None:
    """Samples outside what the profile states, also of those it does not read: it says nothing
    about them, so the user is told."""
    given = link.samples if band.shape[-1] == len(link.samples) else link.channels
    for described in link.described:
        places = [given.index(n) for n in described.component_names if n in given]
        values = band[..., places]
        low, high = described.reach
        outside = int(((values < low) | (values > high)).sum())
        if outside:
            applied.outside[described.name] = applied.outside.get(described.name, 0) + outside
