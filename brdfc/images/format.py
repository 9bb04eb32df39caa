"""How a TIFF of results is laid out: its samples, and the strips or tiles they lie in."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.images.segments import CODECS
from brdfc.images.window import Grain, Window
from brdfc.source.errors import ImageError, MissingExtraError

COMPRESSIONS = ("none", "deflate", "lzw", "zstd")
_STRIP_BYTES = 1 << 18
"""Bytes of a strip, about; what a reader takes at once."""
_LARGEST = 2**32 - 2**25
"""Bytes of samples that a TIFF holds with everything around them; a BigTIFF has no such limit."""
TILES = 16
"""What the sides of a tile are multiples of, by the specification."""


@dataclass(frozen=True)
class Format:
    """A TIFF of (height, width, samples) of a kind. tile: the side of its tiles, 0 for strips;
    compression: one of COMPRESSIONS; photometric: what TIFF calls the samples, and embedded: the
    profile that says what they are, if any."""

    height: int
    width: int
    samples: int
    kind: np.dtype[Any]
    tile: int = 0
    compression: str = "none"
    photometric: str = "minisblack"
    embedded: bytes | None = None

    def __post_init__(self) -> None:
        if self.compression not in COMPRESSIONS:
            raise ImageError(
                f"'{self.compression}' is no compression", hint=", ".join(COMPRESSIONS)
            )
        if self.tile < 0 or self.tile % TILES:
            raise ImageError(f"tiles of {self.tile} pixels", hint=f"multiples of {TILES} are TIFF")

    @property
    def compressed(self) -> bool:
        return self.compression != "none"

    @property
    def row_bytes(self) -> int:
        return self.width * self.samples * self.kind.itemsize

    @property
    def page_bytes(self) -> int:
        """Bytes of the samples of a page, those around the image in tiles too."""
        if not self.tile:
            return self.height * self.row_bytes
        tiles = -(-self.height // self.tile) * -(-self.width // self.tile)
        return tiles * self.tile_bytes

    @property
    def tile_bytes(self) -> int:
        return self.tile * self.tile * self.samples * self.kind.itemsize

    @property
    def rows_per_strip(self) -> int:
        return min(self.height, max(1, _STRIP_BYTES // self.row_bytes))

    @property
    def grain(self) -> Grain:
        """The least part that can be written on its own."""
        if self.tile:
            return Grain(self.tile, self.tile)
        return Grain(self.rows_per_strip, self.width) if self.compressed else Grain()

    def big(self, pages: int) -> bool:
        """Whether so many pages need a BigTIFF."""
        return pages * self.page_bytes > _LARGEST

    def options(self, description: str) -> dict[str, Any]:
        """What tifffile's writer is told of a page."""
        return {
            # With a third axis of 1 tifffile takes the rows for pages.
            "shape": (self.height, self.width, self.samples)[: 3 if self.samples > 1 else 2],
            "dtype": self.kind,
            "planarconfig": "contig" if self.samples > 1 else None,
            "contiguous": False,
            "description": description,
            "software": _software(),
            "metadata": None,
            **({"tile": (self.tile, self.tile)} if self.tile else {}),
            **({} if self.tile else {"rowsperstrip": self.rows_per_strip}),
            **({"compression": _TAGS[self.compression]} if self.compressed else {}),
            "photometric": self.photometric,
            "extrasamples": ("unspecified",) * (self.samples - _COLOURS[self.photometric]),
            "iccprofile": self.embedded,
        }

    def tiles(self, window: Window, values: NDArray[Any]) -> NDArray[Any]:
        """The values of a window as tiles, (rows of tiles, tiles, side, side, samples); zeros where
        the image ends before they do."""
        side = self.tile
        down, across = -(-window.rows // side), -(-window.columns // side)
        whole = np.zeros((down * side, across * side, self.samples), self.kind)
        whole[: window.rows, : window.columns] = values
        parts = whole.reshape(down, side, across, side, self.samples)
        return np.ascontiguousarray(parts.transpose(0, 2, 1, 3, 4))

    def encoded(self, window: Window, values: NDArray[Any]) -> list[bytes]:
        """The compressed strips or tiles of a window, in their order in the file."""
        return [encoder(self.compression)(part) for part in self._segments(window, values)]

    def _segments(self, window: Window, values: NDArray[Any]) -> Iterator[NDArray[Any]]:
        if self.tile:
            for row in self.tiles(window, values):
                yield from row
            return
        for top in range(0, window.rows, self.rows_per_strip):
            yield np.ascontiguousarray(values[top : top + self.rows_per_strip])


_TAGS = {"deflate": "adobe_deflate", "lzw": "lzw", "zstd": "zstd"}
"""Names that tifffile has for compressions."""


def encoder(compression: str) -> Callable[[NDArray[Any]], bytes]:
    """What compresses a strip or tile; MissingExtraError where that is not installed."""
    if compression == "deflate":
        return lambda data: zlib.compress(data.data)
    try:
        import imagecodecs
    except ImportError as error:
        raise MissingExtraError(
            f"{compression} needs the package imagecodecs", hint=f"{CODECS}, or take deflate"
        ) from error
    found: Callable[[NDArray[Any]], bytes] = getattr(imagecodecs, f"{compression}_encode")
    return found


def _software() -> str:
    from brdfc import __version__

    return f"brdfc {__version__}"


_COLOURS = {"minisblack": 1, "rgb": 3, "separated": 4}
"""Samples of a pixel that are no extra ones."""


@cache
def srgb_profile() -> bytes:
    """A profile of sRGB, to be embedded."""
    from PIL import ImageCms

    made = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    # Bytes 24 to 35 are the time of its creation: the same on any day.
    return made[:24] + _DATE + made[36:]


_DATE = b"".join(n.to_bytes(2, "big") for n in (2020, 1, 1, 0, 0, 0))
