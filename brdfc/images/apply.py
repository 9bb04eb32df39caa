"""A link of profiles on an image of coefficients, band by band."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from brdfc.cmm.link import Link
from brdfc.images.tiff import WRITING, Band, open_coefficients, write_xyz
from brdfc.source.errors import ImageError


@dataclass
class Applied:
    """What was done: pixels, and for each channel how many samples lay outside its range."""

    pixels: int = 0
    outside: dict[str, int] = field(default_factory=dict)


def apply_to_tiff(
    link: Link,
    source: str | Path,
    target: str | Path,
    description: str,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Applied:
    """Evaluate a float32 TIFF of coefficients to a float32 TIFF of XYZ.

    The target appears whole or not at all. Raises ImageError for an image that does not fit the
    link, or that holds NaN or infinity anywhere (with their count). progress gets rows done and
    rows in all.
    """
    source, target = Path(source), Path(target)
    if target.exists() and source.exists() and target.samefile(source):
        raise ImageError("the output would replace its own input", where=str(target))
    with open_coefficients(source) as image:
        names = link.channels
        if image.channels != len(names):
            raise ImageError(
                f"the image has {image.channels} samples a pixel, the profile takes {len(names)}: "
                f"{', '.join(names)}",
                where=str(source),
                hint=WRITING if image.channels == 1 else None,
            )
        applied = Applied(pixels=image.height * image.width)
        faults = _Faults()

        def bands() -> Iterator[Band]:
            top = 0
            for band in image.bands():
                faults.count(band, top)
                _count_outside(link, band, applied)
                # After the first fault the rest is only counted: nothing will be written.
                yield (
                    link.apply(band)
                    if not faults.total
                    else np.zeros((*band.shape[:2], 3), np.float32)
                )
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

        write_xyz(target, image.height, image.width, bands(), description)
    return applied


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
    """Samples outside what the model declares: it says nothing about them, so the user is told."""
    start = 0
    for described in link.described:
        width = described.type.value.width
        values = band[..., start : start + width]
        start += width
        low, high = np.float32(described.low), np.float32(described.high)
        outside = int(((values < low) | (values > high)).sum())
        if outside:
            applied.outside[described.name] = applied.outside.get(described.name, 0) + outside
