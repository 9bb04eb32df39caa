"""Where the names of points go, so that none covers another and few cover points."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

DISTANCES = (5.0, 9.0, 14.0, 20.0, 28.0, 38.0, 50.0, 65.0, 85.0, 110.0)
DIRECTIONS = 16
FAR = 12.0
"""From this distance on a line leads from the name to its point."""
COVERING = 12.0
"""A name that covers one mark is as bad as one so much farther away."""
CROSSING = 60.0
"""The same for a line to a name that crosses another name."""
AIR = 1.5


@dataclass(frozen=True)
class Box:
    """A rectangle, in any one unit of length."""

    left: float
    bottom: float
    right: float
    top: float

    def overlaps(self, other: Box) -> bool:
        return (
            self.left < other.right
            and other.left < self.right
            and self.bottom < other.top
            and other.bottom < self.top
        )

    def inside(self, frame: Box) -> bool:
        return (
            frame.left <= self.left
            and frame.bottom <= self.bottom
            and self.right <= frame.right
            and self.top <= frame.top
        )

    def holds(self, places: NDArray[np.float64]) -> int:
        """How many of the places (n, 2) lie in it."""
        x, y = places[:, 0], places[:, 1]
        within = (x > self.left) & (x < self.right) & (y > self.bottom) & (y < self.top)
        return int(np.count_nonzero(within))


@dataclass(frozen=True)
class Placed:
    """The middle of a name; far: a line should lead from it to its point."""

    x: float
    y: float
    far: bool


def place(
    anchors: Sequence[tuple[float, float]],
    sizes: Sequence[tuple[float, float]],
    marks: Sequence[tuple[float, float]],
    taken: Sequence[Box],
    frame: Box,
) -> list[Placed | None]:
    """A place for each name beside its anchor, the first first.

    sizes: width and height of each name. marks: what a name should not cover, if it can be helped;
    taken: what it must not. None where no place is left in the frame.
    """
    covered = np.array(marks, dtype=np.float64).reshape(-1, 2)
    full = list(taken)
    names: list[Box] = []
    found: list[Placed | None] = []
    for anchor, size in zip(anchors, sizes, strict=True):
        best, box, least = None, None, math.inf
        for distance in DISTANCES:
            if distance >= least:  # farther only gets worse
                break
            for placed, candidate in _around(anchor, size, distance):
                if not candidate.inside(frame) or any(candidate.overlaps(b) for b in full):
                    continue
                cost = distance + COVERING * candidate.holds(covered)
                if placed.far:
                    line = _line(anchor, placed)
                    cost += CROSSING * sum(name.holds(line) > 0 for name in names)
                if cost < least:
                    best, box, least = placed, candidate, cost
        found.append(best)
        if best is not None and box is not None:
            full.append(box)
            names.append(box)
            if best.far:
                covered = np.concatenate([covered, _line(anchor, best)])
    return found


def _line(anchor: tuple[float, float], to: Placed) -> NDArray[np.float64]:
    """Places along the line that leads from a point to its name."""
    return np.linspace(anchor, (to.x, to.y), 12)


def _around(
    anchor: tuple[float, float], size: tuple[float, float], distance: float
) -> list[tuple[Placed, Box]]:
    """The places at a distance, the upper right first."""
    candidates = []
    half_width, half_height = size[0] / 2 + AIR, size[1] / 2 + AIR
    for i in range(DIRECTIONS):
        angle = math.pi * (0.25 + 2 * i / DIRECTIONS)
        x = anchor[0] + math.cos(angle) * (distance + half_width)
        y = anchor[1] + math.sin(angle) * (distance + half_height)
        box = Box(x - half_width, y - half_height, x + half_width, y + half_height)
        candidates.append((Placed(x, y, distance >= FAR), box))
    return candidates
