"""The most that two formulas differ by over a whole domain: proved, and nearly attained.

Branch and bound: the domain is a box; the boxes whose proved difference is largest are halved,
again and again, until none exceeds what is looked for, or the budget of boxes is spent. A box is
halved along the axis that moves its colours most. The difference at the middle of every box, and at
points beforehand, is what was seen (A. Neumaier, Complete search
in continuous global optimization and constraint satisfaction, Acta Numerica 13, 2004).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from brdfc.proof.intervals import Array, Enclosure
from brdfc.proof.pair import Pair

Point = Mapping[str, tuple[float, ...]]

BATCH = 1024
"""Boxes halved at a time, at most."""
FIRST = 192
"""Boxes looked at at a time, at least."""
SPREAD = 256
"""Points looked at before any box."""
STEPS = 12
NEAR = (-0.2, -0.05, -0.01, 0.01, 0.05, 0.2)
"""Steps from the worst point seen, at most, and how far each goes, in parts of a range."""
SOME = 150
"""Boxes from which on a proof is given up that would not end: the bound falls at best with the
power 4/5 of the boxes."""
_AGREE = 1e-6
"""What float64 may add to a difference that was seen."""
TIGHT = 1.3
"""A bound so many times what was seen is not worth more work."""


@dataclass(frozen=True)
class Bound:
    """most: proved, CIEDE2000. seen: the largest difference at any point that was looked at, and
    at which. boxes: that the proof took."""

    most: float
    seen: float
    at: Point
    boxes: int


@dataclass
class _Search:
    """The boxes in work. seen, at: as in Bound; done: boxes bounded so far."""

    pair: Pair
    boxes: Enclosure
    upper: Array
    smear: Array
    seen: float = 0.0
    at: Array = field(default_factory=lambda: np.zeros(0))
    done: int = 1

    @property
    def most(self) -> float:
        return float(self.upper.max(initial=0.0))

    def look(self, points: Array) -> None:
        differences = self.pair.differences(points)
        worst = int(differences.argmax())
        if differences[worst] > self.seen or not self.at.size:
            self.seen, self.at = float(differences[worst]), points[worst]

    def climb(self) -> None:
        """Look further from the worst point, a quantity at a time, while that finds more."""
        whole = self.pair.whole()
        for _ in range(STEPS):
            before = self.seen
            tries = [self.at]
            for axis in range(len(self.at)):
                low, high = whole.low[0, axis], whole.high[0, axis]
                steps = (self.at[axis] + step * (high - low) for step in NEAR)
                for value in (low, high, *steps):
                    moved = self.at.copy()
                    moved[axis] = min(max(value, low), high)
                    tries.append(moved)
            self.look(np.array(tries))
            if self.seen <= before:
                break

    def halve(self, count: int) -> None:
        """Halve the boxes of the largest bounds, each along the axis that matters most there; a few
        boxes several times, as many cost little more than one."""
        order = np.argsort(-self.upper, kind="stable")
        chosen, rest = order[:count], order[count:]
        parts = Enclosure(self.boxes.low[chosen], self.boxes.high[chosen])
        smear, known = self.smear[chosen], self.upper[chosen]
        while True:
            axes = smear.argmax(axis=1)
            parts = _halves(parts, axes)
            smear[np.arange(len(axes)), axes] /= 2
            smear, known = np.tile(smear, (2, 1)), np.tile(known, 2)
            if len(known) >= FIRST:
                break
        upper, smear = self.pair.bounds(parts)
        self.done += len(upper)
        self.look(parts.middle)
        self.boxes = Enclosure(
            np.concatenate([self.boxes.low[rest], parts.low]),
            np.concatenate([self.boxes.high[rest], parts.high]),
        )
        self.upper = np.concatenate([self.upper[rest], np.minimum(upper, known)])
        self.smear = np.concatenate([self.smear[rest], smear])


def _halves(boxes: Enclosure, axes: NDArray[np.intp]) -> Enclosure:
    """Both halves of each box along an axis of its own: all lower ones, then all upper ones."""
    count = np.arange(len(axes))
    middle = boxes.middle[count, axes]
    low, high = np.tile(boxes.low, (2, 1)), np.tile(boxes.high, (2, 1))
    high[count, axes] = middle
    low[len(axes) + count, axes] = middle
    return Enclosure(low, high)


def spread(pair: Pair, count: int = SPREAD) -> Array:
    """Points of the domain, (points, axes): anywhere, and with each quantity at an end."""
    random = np.random.Generator(np.random.PCG64(7))
    whole = pair.whole()
    unit = random.random((count, whole.low.shape[1]))
    ends = random.random(unit.shape)
    cornered = np.arange(count)[:, None] % 2 == 0
    unit = np.where(cornered & (ends < 0.8), np.round(unit), unit)
    return np.asarray(whole.low + unit * (whole.high - whole.low))


def bound(pair: Pair, enough: float, budget: int, polish: int = 0, slack: float = 0.0) -> Bound:
    """The most that two formulas of a pair differ by.

    Stops where that is proved to be at most `enough`, where more was seen, or where the budget of
    boxes is spent. polish: boxes that may follow a proof, until the bound is near to what was seen:
    TIGHT times that, or no more than slack beyond it.
    """
    whole = pair.whole()
    search = _Search(pair, whole, *pair.bounds(whole))
    for some in (spread(pair), whole.middle):
        search.look(some)
    search.climb()

    def pursue(goal: Callable[[], float], boxes: int) -> None:
        while search.seen <= enough and search.done < boxes:
            most = search.most
            above = int((search.upper > goal()).sum())
            hopeless = search.done > SOME and search.done * (most / enough) ** 1.25 > 2 * boxes
            if not above or (most > enough and hopeless):
                break
            search.halve(min(BATCH, above))

    pursue(lambda: enough, budget)
    if search.most <= enough:
        pursue(lambda: max(TIGHT * search.seen + 1e-9, search.seen + slack), search.done + polish)
    search.climb()
    most = search.most
    if search.seen > most * (1 + _AGREE) + _AGREE:  # a proof that is refuted proves nothing
        most = np.inf
    return Bound(max(most, search.seen), search.seen, pair.named(search.at), search.done)
