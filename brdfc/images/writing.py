"""TIFF files of results: laid out first and then filled at any place, or compressed in order."""

from __future__ import annotations

import os
from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from io import FileIO
from itertools import repeat
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.files import whole_file
from brdfc.images.format import Format
from brdfc.images.window import Window


@dataclass(frozen=True)
class Places:
    """Where the samples of a laid out file lie: the first byte of each page. It holds no file, so
    that another process can fill in parts too."""

    path: Path
    format: Format
    starts: tuple[int, ...]

    def put(self, file: int, page: int, window: Window, values: NDArray[Any]) -> None:
        """Write the values of a window, (rows, columns, samples), to an open file; again is the
        same. In a file of tiles a window begins at one, and ends at one or with the image."""
        form, start = self.format, self.starts[page]
        if form.tile:
            across = -(-form.width // form.tile)
            for down, row in enumerate(form.tiles(window, values), window.top // form.tile):
                tile = down * across + window.left // form.tile
                _write_at(file, row, start + tile * form.tile_bytes)
        elif window.columns == form.width:
            _write_at(file, values, start + window.top * form.row_bytes)
        else:
            left = window.left * form.samples * form.kind.itemsize
            for row, samples in enumerate(values, window.top):
                _write_at(file, samples, start + row * form.row_bytes + left)


def lay_out(path: Path, form: Format, descriptions: Sequence[str]) -> Places:
    """Write a TIFF of pages with these descriptions whose samples are holes yet."""
    import tifffile

    hole = bytes(form.tile_bytes)
    with _Holes(path, hole) as stream:
        with tifffile.TiffWriter(stream, bigtiff=form.big(len(descriptions))) as tiff:
            for description in descriptions:
                data = repeat(hole) if form.tile else None
                tiff.write(data, **form.options(description))
        stream.truncate(max(stream.end, stream.seek(0, os.SEEK_END)))
    return laid_out(path, form)


def laid_out(path: Path, form: Format) -> Places:
    """Where the samples of a file lie that lay_out wrote."""
    import tifffile

    with tifffile.TiffFile(path) as laid:
        return Places(path, form, tuple(int(page.dataoffsets[0]) for page in laid.pages))


class _Holes(FileIO):
    """A file in which a certain object is not written but left out: a hole, of zeros."""

    def __init__(self, path: Path, hole: bytes) -> None:
        super().__init__(path, "w+")
        self._hole = hole
        self.end = 0

    def write(self, data: Any) -> int:
        if data is not self._hole:
            written: int = super().write(data)
            return written
        self.end = max(self.end, self.seek(len(data), os.SEEK_CUR))
        return len(data)


def write_compressed(
    path: Path, form: Format, count: int, pages: Iterable[tuple[str, Generator[bytes]]]
) -> None:
    """Write so many pages, of a description and its compressed strips or tiles each, in their
    order; all are taken to their ends."""
    import tifffile

    with tifffile.TiffWriter(path, bigtiff=form.big(count)) as tiff:
        for description, segments in pages:
            with closing(segments):
                tiff.write(segments, **form.options(description))
                for _ in segments:  # what comes after the last one, such as an error
                    raise AssertionError("more segments than the page has")


def write_colours(
    path: str | Path,
    shape: tuple[int, int, int],
    bands: Iterable[NDArray[np.float32]],
    description: str,
) -> None:
    """Write (height, width, samples) of float32 as a TIFF, whole or not at all; bands from top to
    bottom."""
    height, width, samples = shape
    form = Format(height, width, samples, np.dtype(np.float32))
    top = 0
    with whole_file(path) as temporary:
        places = lay_out(temporary, form, [description])
        with opened_to_fill(temporary) as file:
            for band in bands:
                places.put(file, 0, Window(top, 0, len(band), width), band)
                top += len(band)


@contextmanager
def opened_to_fill(path: Path) -> Iterator[int]:
    """A file that exists, open for parts of it to be written; its number."""
    file = os.open(path, os.O_WRONLY)
    try:
        yield file
    finally:
        os.close(file)


def _write_at(file: int, values: NDArray[Any], offset: int) -> None:
    data = np.ascontiguousarray(values).data.cast("B")
    done = 0
    while done < len(data):
        done += os.pwrite(file, data[done:], offset + done)
