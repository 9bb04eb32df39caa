"""Parts of an image: rectangles of pixels that are read, computed and written one at a time."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True)
class Window:
    """A rectangle of pixels: its first row and column, and how many of both."""

    top: int
    left: int
    rows: int
    columns: int

    @property
    def pixels(self) -> int:
        return self.rows * self.columns

    @property
    def part(self) -> tuple[slice, slice]:
        """What it is of an array (rows, columns, ...)."""
        rows = slice(self.top, self.top + self.rows)
        return rows, slice(self.left, self.left + self.columns)


@dataclass(frozen=True)
class Grain:
    """The least part that can be read, or written, without touching a segment twice."""

    rows: int = 1
    columns: int = 1

    def joined(self, other: Grain, width: int) -> Grain:
        """The least part that both can take, no wider than the image.

        Where that would be many times either, whole grains of the first: some segments of the other
        are then touched twice.
        """
        rows = math.lcm(self.rows, other.rows)
        if rows > 4 * max(self.rows, other.rows):
            rows = -(-other.rows // self.rows) * self.rows
        return Grain(rows, min(width, math.lcm(self.columns, other.columns)))


@dataclass(frozen=True)
class Grid:
    """An image of height by width pixels in windows of so many rows and columns, from the left to
    the right and from the top down; the last of each may be smaller."""

    height: int
    width: int
    rows: int
    columns: int

    @property
    def pixels(self) -> int:
        return self.height * self.width

    def windows(self, start: int = 0) -> Iterator[Window]:
        """The windows from a row on."""
        for top in range(start, self.height, self.rows):
            rows = min(self.rows, self.height - top)
            for left in range(0, self.width, self.columns):
                yield Window(top, left, rows, min(self.columns, self.width - left))
