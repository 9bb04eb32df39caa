"""TIFF files of coefficients, opened and read in windows or in bands of rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from brdfc.images.scaling import Scaling
from brdfc.images.segments import SEGMENT_LIMIT, Segments
from brdfc.images.window import Window
from brdfc.source.errors import ImageError

WRITING = (
    "an array (rows, columns, samples) is written as one image with "
    'tifffile.imwrite(path, array, photometric="minisblack", planarconfig="contig")'
)

Band = NDArray[np.float32]
KINDS = (np.float32, np.float16, np.uint16, np.uint8)
"""The kinds of samples that coefficients can have; integers with a scaling."""
_KIND_NAMES: dict[type, str] = {
    np.float32: "32-bit floats",
    np.float16: "16-bit floats",
    np.uint8: "8-bit",
    np.uint16: "16-bit integers",
}
BAND_PIXELS = 1 << 18
"""Pixels a band holds: a few megabytes, whatever the size of the image."""


@dataclass(frozen=True)
class CoefficientImage:
    """An open image, (height, width, channels), read from the file as it is used.

    scaling: what integers mean; without one they are given as they are.
    """

    segments: Segments
    where: str
    scaling: Scaling | None = None

    def scaled(self, scaling: Scaling | None) -> CoefficientImage:
        """The same, with a scaling of its integers."""
        return replace(self, scaling=scaling)

    @property
    def height(self) -> int:
        return self.segments.height

    @property
    def width(self) -> int:
        return self.segments.width

    @property
    def channels(self) -> int:
        return self.segments.channels

    @property
    def kind(self) -> np.dtype[Any]:
        return self.segments.kind

    @property
    def greatest(self) -> int:
        """Of integer samples, the greatest they can be; 0 for floats."""
        return 0 if self.kind.kind == "f" else int(np.iinfo(self.kind).max)

    @property
    def rows_per_band(self) -> int:
        whole = self.segments.grain.rows
        return max(1, BAND_PIXELS // self.width // whole) * whole

    def bands(self) -> Iterator[Band]:
        """The image from top to bottom, (rows, width, channels) float32 each."""
        for top in range(0, self.height, self.rows_per_band):
            yield self.rows(slice(top, top + self.rows_per_band))

    def rows(self, part: slice) -> Band:
        """Some rows, (rows, width, channels) float32."""
        top, bottom, _ = part.indices(self.height)
        size = (bottom - top) * self.width * self.channels * 4
        if size > SEGMENT_LIMIT:
            raise ImageError(
                f"{bottom - top} rows of it take {size:,} bytes, and at most {SEGMENT_LIMIT:,} are "
                "read at once",
                where=self.where,
                hint="write it in strips or tiles of fewer rows",
            )
        return self.window(Window(top, 0, bottom - top, self.width))

    def window(self, window: Window) -> Band:
        """A part, (rows, columns, channels) float32; of a planar image a view of planes.

        Raises ImageError for what cannot be read, and where the file has changed since it was
        opened.
        """
        samples = self.segments.read(window)
        if self.scaling is not None:
            return self.scaling.apply(samples)
        return samples.astype(np.float32, copy=False)


@contextmanager
def open_coefficients(path: str | Path) -> Iterator[CoefficientImage]:
    """Open a float32 TIFF, chunky or planar; ImageError for anything else."""
    with open_samples(path, (np.float32,)) as image:
        yield image


@contextmanager
def open_samples(path: str | Path, kinds: Sequence[type]) -> Iterator[CoefficientImage]:
    """Open a TIFF, chunky or planar, whose samples are of one of these kinds; ImageError for
    anything else."""
    import tifffile

    with ExitStack() as stack:
        try:
            stream = stack.enter_context(Path(path).open("rb"))
        except OSError as error:
            raise ImageError(f"cannot be read: {error.strerror}", where=str(path)) from error
        try:
            tiff = stack.enter_context(tifffile.TiffFile(stream))
        except Exception as error:  # a hostile file can make the library raise anything
            raise ImageError(f"not a TIFF image: {error}", where=str(path)) from error
        yield CoefficientImage(_segments(stream, tiff, str(path), kinds), str(path))


def _segments(stream: BinaryIO, tiff: Any, where: str, kinds: Sequence[type]) -> Segments:
    try:
        pages = len(tiff.pages)
        page = tiff.pages[0]
        axes, kind = page.axes, page.dtype
    except Exception as error:  # as above
        raise ImageError(f"a damaged TIFF image: {error}", where=where) from error
    if pages != 1:
        raise ImageError(
            f"the file holds {pages} images; one with all coefficients as samples is needed",
            where=where,
            hint=WRITING,
        )
    if kind not in kinds:
        wanted = " or ".join(_KIND_NAMES[k] for k in kinds)
        raise ImageError(
            f"its samples are {kind}; {wanted} are needed",
            where=where,
            hint="convert it with the scaling that its samples have: brdfc does not guess one",
        )
    if axes not in ("YXS", "SYX", "YX"):
        raise ImageError(f"rows, columns and samples are needed, not axes {axes}", where=where)
    try:
        return Segments(stream, page, where)
    except ImageError:
        raise
    except Exception as error:  # as above
        raise ImageError(f"a damaged TIFF image: {error}", where=where) from error
