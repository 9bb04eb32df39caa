"""The samples of a TIFF page, read from where its strips or tiles lie in the file.

A file comes from outside: nothing is allocated for what a header claims before it is known to be in
the file, and whatever a segment holds that cannot be decoded is one clear error.
"""

from __future__ import annotations

import os
import sys
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from brdfc.images.window import Grain, Window
from brdfc.source.errors import ImageError

State = tuple[int, int]
SEGMENT_LIMIT = 1 << 30
"""Bytes that a strip or a tile may decode to."""
_LONGER = 1 << 16
"""Bytes that compression may add to what it cannot make smaller."""
_NATIVE = "<" if sys.byteorder == "little" else ">"
CODECS = "pip install 'brdfc[codecs]'"


class Segments:
    """A page of an open TIFF file: height, width, channels, and the kind of its samples.

    grain: what is read without a segment being decoded twice; state: of the file, what changes when
    it is written. Reading is by place, so that any
    number of threads can do it at once.
    """

    def __init__(self, stream: BinaryIO, page: Any, where: str) -> None:
        self._file = stream.fileno()
        self.state = _state(self._file)
        self._page, self._where = page, where
        self.planes, depth, self.height, self.width, together = map(int, page.shaped)
        self.channels: int = self.planes * together
        self._together: int = together
        self.kind: np.dtype[Any] = page.dtype.newbyteorder("=")
        if depth != 1 or not self.height or not self.width:
            raise ImageError("rows and columns of pixels are needed", where=where)
        self.tiled = tiled = bool(page.is_tiled)
        self._rows = page.tilelength if tiled else min(page.rowsperstrip, self.height)
        self._columns = page.tilewidth if tiled else self.width
        if self._rows < 1 or self._columns < 1:
            raise ImageError("a damaged TIFF image: its strips have no rows", where=where)
        self._across = -(-self.width // self._columns)
        self._down = -(-self.height // self._rows)
        self._name = "tile" if tiled else "strip"
        self._offsets = np.array(page.dataoffsets, dtype=np.int64)
        self._counts = np.array(page.databytecounts, dtype=np.int64)
        self._check_places()
        self._plain = not tiled and _plain(page) and bool(self._counts.all())
        if self._plain:
            self._check_plain()
        else:
            self._check_sizes()
            self._decode = page.decode
        self.grain = Grain() if self._plain else Grain(self._rows, self._columns)

    @property
    def decoded(self) -> int:
        """Bytes of a strip or tile while it is decoded; 0 where samples are read as they lie."""
        return 0 if self._plain else self._segment_bytes

    def read(self, window: Window) -> NDArray[Any]:
        """The samples of a window, (rows, columns, channels) of their kind in the file.

        The array of a planar image is a view of planes. Raises ImageError for what cannot be read,
        and where the file has changed since it was opened.
        """
        planes = np.empty((self.planes, window.rows, window.columns, self._together), self.kind)
        for plane, samples in enumerate(planes):
            if self._plain:
                self._read_plain(plane, samples, window)
            else:
                self._read_decoded(plane, samples, window)
        if self._plain and self._page.parent.byteorder != _NATIVE:
            planes.byteswap(inplace=True)
        if _state(self._file) != self.state:
            raise ImageError("the file changed while it was read", where=self._where)
        return planes[0] if self.planes == 1 else np.moveaxis(planes[..., 0], 0, -1)

    def _read_plain(self, plane: int, samples: NDArray[Any], window: Window) -> None:
        """Rows as they lie in the file; those that follow each other there, in one go."""
        width = self.width * self._together * self.kind.itemsize
        left = window.left * self._together * self.kind.itemsize
        rows = range(window.top, window.top + window.rows)
        first = plane * self._down
        places = [
            int(self._offsets[first + row // self._rows]) + row % self._rows * width + left
            for row in rows
        ]
        start = 0
        for end in range(1, len(places) + 1):
            joined = window.columns == self.width and end < len(places)
            if not joined or places[end] != places[end - 1] + width:
                self._fill(samples[start:end].data.cast("B"), places[start])
                start = end

    def _read_decoded(self, plane: int, samples: NDArray[Any], window: Window) -> None:
        """The strips or tiles that a window touches, decoded, and what of them lies in it."""
        bottom, right = window.top + window.rows, window.left + window.columns
        for down in range(window.top // self._rows, -(-bottom // self._rows)):
            for across in range(window.left // self._columns, -(-right // self._columns)):
                index = (plane * self._down + down) * self._across + across
                top, left = down * self._rows, across * self._columns
                y = slice(max(top, window.top), min(top + self._rows, bottom))
                x = slice(max(left, window.left), min(left + self._columns, right))
                here = samples[
                    y.start - window.top : y.stop - window.top,
                    x.start - window.left : x.stop - window.left,
                ]
                segment = self._segment(index)
                if segment is None:
                    here[...] = self._page.nodata
                    continue
                part = segment[0, y.start - top : y.stop - top, x.start - left : x.stop - left]
                if part.shape != here.shape:
                    raise self._damaged(index, f"it has {segment.shape[1]} rows")
                here[...] = part

    def _segment(self, index: int) -> NDArray[Any] | None:
        """A strip or tile, (1, rows, columns, samples); None for one that the file leaves out."""
        data = bytearray(int(self._counts[index]))
        self._fill(memoryview(data), int(self._offsets[index]))
        try:
            found: NDArray[Any] | None = self._decode(
                bytes(data) if data else None, index, jpegtables=self._page.jpegtables
            )[0]
        except Exception as error:  # whatever a codec says to what is none of its own
            if "imagecodecs" in str(error):
                raise ImageError(
                    f"its compression cannot be read: {error}", where=self._where, hint=CODECS
                ) from error
            raise self._damaged(index, str(error) or type(error).__name__) from error
        return found

    def _fill(self, buffer: memoryview, offset: int) -> None:
        done = 0
        while done < len(buffer):
            try:
                got = os.preadv(self._file, [buffer[done:]], offset + done)
            except OSError as error:
                raise ImageError(f"cannot be read: {error.strerror}", where=self._where) from error
            if got == 0:
                raise ImageError("the file changed while it was read", where=self._where)
            done += got

    def _damaged(self, index: int, reason: str) -> ImageError:
        place, across = divmod(index, self._across)
        row, column = place % self._down * self._rows, across * self._columns
        return ImageError(
            f"the {self._name} at row {row}, column {column} cannot be decoded: {reason}",
            where=self._where,
        )

    def _check_places(self) -> None:
        """Every segment is there, and within the file."""
        needed = self.planes * self._down * self._across
        if min(len(self._offsets), len(self._counts)) < needed:
            raise ImageError(
                f"a damaged TIFF image: {len(self._offsets):,} of {needed:,} {self._name}s",
                where=self._where,
            )
        offsets, counts = self._offsets[:needed], self._counts[:needed]
        size = self.state[0]
        # Compared without a sum, which could overflow.
        beyond = (offsets < 0) | (counts < 0) | (counts > size) | (offsets > size - counts)
        if beyond.any():
            raise ImageError(
                f"the file is cut short: it has {size:,} bytes, and {int(beyond.sum()):,} of its "
                f"{needed:,} {self._name}s lie beyond",
                where=self._where,
            )

    def _check_plain(self) -> None:
        """Segments that are read as they lie hold all their rows."""
        row = self.width * self._together * self.kind.itemsize
        rows = np.full(self._down, self._rows, dtype=np.int64)
        rows[-1] = self.height - (self._down - 1) * self._rows
        needed = np.tile(rows, self.planes)
        counts = self._counts[: len(needed)]
        # By division: what a header claims can overflow a product.
        if (counts // row < needed).any():
            raise ImageError(
                f"a damaged TIFF image: strips of {int(counts.min()):,} bytes, rows of {row:,}",
                where=self._where,
            )

    def _check_sizes(self) -> None:
        """Segments that are decoded have a size that can be, before and after."""
        self._segment_bytes = self._rows * self._columns * self._together * self.kind.itemsize
        if self._segment_bytes > SEGMENT_LIMIT:
            raise ImageError(
                f"a {self._name} of it decodes to {self._segment_bytes:,} bytes, and at most "
                f"{SEGMENT_LIMIT:,} are read",
                where=self._where,
                hint="write it in smaller strips or tiles",
            )
        longest = int(self._counts.max())
        if longest > self._segment_bytes + self._segment_bytes // 2 + _LONGER:
            raise ImageError(
                f"a damaged TIFF image: {longest:,} bytes in the file for a {self._name} of "
                f"{self._segment_bytes:,}",
                where=self._where,
            )


def _state(file: int) -> State:
    """What changes when a file is written: its size, and when it was."""
    found = os.fstat(file)
    return found.st_size, found.st_mtime_ns


def _plain(page: Any) -> bool:
    """Whether samples lie in the file as an array has them."""
    return bool(
        page.compression == 1
        and page.predictor == 1
        and page.fillorder == 1
        and page.bitspersample == 8 * page.dtype.itemsize
        and page.sampleformat != 5
        and not page.is_subsampled
    )
