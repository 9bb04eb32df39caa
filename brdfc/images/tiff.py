"""TIFF files of coefficients and of colours, read and written in bands of rows."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.files import whole_file
from brdfc.source.errors import ImageError

WRITING = (
    "an array (rows, columns, samples) is written as one image with "
    'tifffile.imwrite(path, array, photometric="minisblack", planarconfig="contig")'
)

Band = NDArray[np.float32]
_KIND_NAMES: dict[type, str] = {
    np.float32: "32-bit floats",
    np.uint8: "8-bit",
    np.uint16: "16-bit integers",
}
_LARGEST = 2**32 - 2**25
"""Bytes of samples that a TIFF holds with everything around them."""
BAND_PIXELS = 1 << 18
"""Pixels a band holds: a few megabytes, whatever the size of the image."""


@dataclass(frozen=True)
class CoefficientImage:
    """An open image: samples are (height, width, channels), read from the file as they are used.
    greatest: of integer samples, the greatest they can be; 0 for floats."""

    height: int
    width: int
    channels: int
    samples: Any
    greatest: int = 0

    @property
    def rows_per_band(self) -> int:
        return max(1, BAND_PIXELS // max(1, self.width))

    def bands(self) -> Iterator[Band]:
        """The image from top to bottom, (rows, width, channels) float32 each."""
        for top in range(0, self.height, self.rows_per_band):
            yield self.rows(slice(top, top + self.rows_per_band))

    def rows(self, part: slice) -> Band:
        """Some rows, (rows, width, channels) float32."""
        return np.ascontiguousarray(self.samples[part], dtype=np.float32)


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

    try:
        tiff = tifffile.TiffFile(path)
    except OSError as error:
        raise ImageError(f"cannot be read: {error.strerror or error}", where=str(path)) from error
    except Exception as error:  # a hostile file can make the library raise anything
        raise ImageError(f"not a TIFF image: {error}", where=str(path)) from error
    with tiff:
        yield _image(tiff, str(path), kinds)


def _image(tiff: Any, where: str, kinds: Sequence[type]) -> CoefficientImage:
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
        samples = _mapped(tiff, page) if page.is_memmappable else page.asarray()
    except Exception as error:  # truncated data, unknown compression
        raise ImageError(f"its samples cannot be read: {error}", where=where) from error
    if axes == "SYX":
        samples = np.moveaxis(samples, 0, -1)
    elif axes == "YX":
        samples = samples[..., None]
    height, width, channels = samples.shape
    greatest = 0 if kind.kind == "f" else int(np.iinfo(kind).max)
    return CoefficientImage(height, width, channels, samples, greatest)


def _mapped(tiff: Any, page: Any) -> Any:
    """The samples of an uncompressed image where they lie in the file."""
    return np.memmap(
        tiff.filehandle.path,
        dtype=page.dtype.newbyteorder(tiff.byteorder),
        mode="r",
        offset=page.dataoffsets[0],
        shape=page.shape,
    )


def write_colours(
    path: str | Path,
    shape: tuple[int, int, int],
    bands: Iterable[NDArray[Any]],
    description: str,
) -> None:
    """Write (height, width, samples) as a TIFF, whole or not at all; bands from top to bottom.

    Bytes are a picture, three samples of red, green and blue; numbers of another kind are numbers.
    """
    import tifffile

    from brdfc import __version__

    iterator = iter(bands)
    first = next(iterator)
    picture = first.dtype == np.uint8
    kind: dict[str, Any] = {"photometric": "rgb"}
    if not picture:
        more = ("unspecified",) * (shape[-1] - 1)
        kind = {"photometric": "minisblack", "extrasamples": more}

    def strips() -> Iterator[NDArray[Any]]:
        yield first
        yield from iterator

    # The size of a TIFF is limited to 4 GiB, and that of a BigTIFF is not.
    big = math.prod(shape) * first.dtype.itemsize > _LARGEST
    with whole_file(path) as temporary, tifffile.TiffWriter(temporary, bigtiff=big) as tiff:
        tiff.write(
            strips(),
            shape=shape,
            dtype=first.dtype,
            rowsperstrip=len(first),
            planarconfig="contig",
            description=description,
            software=f"brdfc {__version__}",
            metadata=None,
            **kind,
        )
