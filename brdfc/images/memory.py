"""How much of an image is held at once: limits in bytes, and windows that keep to them."""

from __future__ import annotations

import re
from dataclasses import dataclass

from brdfc.engine.choice import threads_at_hand
from brdfc.images.window import Grain, Grid
from brdfc.source.errors import ImageError, ValueGivenError

USUAL = 192 * 10**6
"""Bytes that buffers may take, unless another limit is given."""
WINDOW_PIXELS = 1 << 16
"""Pixels of a window, at most, where strips or tiles do not force more; what is read is then still
in the processor's cache when it is computed with."""
_FEWEST = 1 << 12
"""Pixels of a window, at least: below it numpy is busy with itself."""
_UNITS = {"": 1, "K": 10**3, "M": 10**6, "G": 10**9, "KI": 2**10, "MI": 2**20, "GI": 2**30}
_SIZE = re.compile(r"(\d{1,9}(?:\.\d{1,9})?)\s*([KMG]I?)?B?", re.IGNORECASE)


def parse_size(text: str) -> int:
    """Bytes of a text like 256MB or 1.5GiB; ValueGivenError for any other."""
    found = _SIZE.fullmatch(text.strip())
    if found is None or not float(found[1]):
        raise ValueGivenError(f"'{text}' is no size", hint="write, say, 256MB or 1GiB")
    return int(float(found[1]) * _UNITS[(found[2] or "").upper()])


@dataclass(frozen=True)
class Cost:
    """Bytes that a window takes. held: for each pixel while it is read, computed and written;
    working: for each pixel of a piece that is computed with; segment: of a strip or tile while it
    is decoded; piece: pixels that are computed with at once, at most."""

    held: int
    working: int
    segment: int = 0
    piece: int = WINDOW_PIXELS

    def window(self, pixels: int) -> int:
        return pixels * self.held + min(pixels, self.piece) * self.working + 2 * self.segment


@dataclass(frozen=True)
class Plan:
    """The windows of an image, and how many are under way at once."""

    grid: Grid
    workers: int


def planned(
    height: int,
    width: int,
    grain: Grain,
    cost: Cost,
    memory: int,
    threads: int | None,
    where: str,
) -> Plan:
    """Windows of whole grains, as large as the limit and the cache allow; ImageError where not even
    one grain keeps to the limit."""
    rows, columns = min(height, grain.rows), min(width, grain.columns)
    fewest = max(rows * columns, min(_FEWEST, height * width))
    least = cost.window(fewest)
    if least > memory:
        raise ImageError(
            f"its least part, {fewest:,} pixels in {rows:,} or more rows, takes {_shown(least)}, "
            f"and {_shown(memory)} are allowed",
            where=where,
            hint=f"--memory {_shown(least)}",
        )
    # One more than there are processors: while one waits for a file, the others compute.
    workers = min((threads or threads_at_hand()) + 1, memory // least)
    pixels = WINDOW_PIXELS
    while pixels > fewest and cost.window(pixels) * workers > memory:
        pixels //= 2
    across = min(width, max(1, pixels // rows // columns) * columns)
    down = max(1, pixels // across // rows) * rows if across == width else rows
    return Plan(Grid(height, width, down, across), workers)


def _shown(size: int) -> str:
    return f"{-(-size // 10**6)}MB"
