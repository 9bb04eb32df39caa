"""Two formulas, and the most that their colours differ by in each of many boxes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from brdfc.colour.colorimetry import Colorimetry
from brdfc.proof.appearance import Seen, seen
from brdfc.proof.changes import Changes
from brdfc.proof.difference import most_difference
from brdfc.proof.intervals import Array, Enclosure
from brdfc.proof.opponent import opponent
from brdfc.proof.values import Values
from brdfc.proof.varying import Varying
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.expression import Expression, walk
from brdfc.symbolic.intervals import Interval


@dataclass(frozen=True)
class Pair:
    """Two formulas of the same quantities, and how their values are seen.

    domain: a range for every component of every quantity. The axes of boxes are the components
    that the formulas read.
    """

    first: Expression
    second: Expression
    colorimetry: Colorimetry
    domain: Mapping[str, Sequence[Interval]]

    @cached_property
    def axes(self) -> tuple[tuple[str, int], ...]:
        read = {
            e.name: e.width
            for formula in (self.first, self.second)
            for e in walk(formula)
            if e.operator == "quantity"
        }
        return tuple((name, i) for name in sorted(read) for i in range(read[name]))

    @cached_property
    def signals(self) -> tuple[tuple[Expression, ...], tuple[Expression, ...]]:
        """Luminance and opponent signals of both."""
        return opponent(self.first, self.colorimetry), opponent(self.second, self.colorimetry)

    def whole(self) -> Enclosure:
        """The domain as one box: (1, axes)."""
        ends = [self.domain[name][component] for name, component in self.axes]
        return Enclosure(np.array([[i.low for i in ends]]), np.array([[i.high for i in ends]]))

    def bounds(self, boxes: Enclosure) -> tuple[Array, Array]:
        """The most that the formulas differ by in each box, (boxes,), and how much of it each axis
        may be the cause of, (boxes, axes)."""
        half = ((boxes.high - boxes.low) / 2).T[:, :, None]
        middle = boxes.middle
        thin = self._changes(Enclosure(middle, middle))
        wide = self._changes(boxes, thin, half)
        there, around = self._seen(thin), self._seen(wide)
        with np.errstate(all="ignore"):
            narrow = [a.centred(t, half) for a, t in zip(around, there, strict=True)]
        found = most_difference(Seen(*narrow))
        return np.broadcast_to(found, (len(boxes.low),)), _smear(around, half, found)

    def _changes(
        self, boxes: Enclosure, middle: Changes | None = None, half: Array | None = None
    ) -> Changes:
        """Values and changes over boxes, and with their middles also slopes along the axes."""
        directions = np.eye(len(self.axes))
        quantities = {}
        for name in dict(self.axes):
            places = [i for i, (n, _) in enumerate(self.axes) if n == name]
            low = boxes.low[:, places]
            # One and the same array says that a box is a point.
            high = low if boxes.high is boxes.low else boxes.high[:, places]
            part = directions[:, None, places]
            slopes = Enclosure(part, part) if middle else None
            quantities[name] = Varying(Enclosure(low, high), slopes)
        return Changes(Values(quantities, middle.values if middle else None, half), middle, half)

    def _seen(self, changes: Changes) -> Seen:
        before, after = self.signals
        moved = [changes.of(a, b) for a, b in zip(before, after, strict=True)]
        return seen([changes.values.of(a) for a in before], moved)

    def differences(self, points: Array) -> Array:
        """At points (points, axes), (points,); 0 where the first is undefined, infinite where only
        the second is."""
        named = self.by_name(points)
        one, other = (evaluate(e, named) for e in (self.second, self.first))
        with np.errstate(all="ignore"):
            found = self.colorimetry.difference(one, other)
        found = np.broadcast_to(found, (len(points),))
        known = np.broadcast_to(np.isfinite(other).all(axis=-1), found.shape)
        return np.where(known, np.nan_to_num(found, nan=np.inf, posinf=np.inf), 0.0)

    def by_name(self, points: Array) -> dict[str, Array]:
        """Points (points, axes) by quantity, (points, components)."""
        axes = [name for name, _ in self.axes]
        return {n: points[:, [i for i, a in enumerate(axes) if a == n]] for n in dict(self.axes)}

    def named(self, point: Array) -> dict[str, tuple[float, ...]]:
        """A point (axes,) by quantity."""
        found: dict[str, tuple[float, ...]] = {}
        for (name, _), value in zip(self.axes, point.tolist(), strict=True):
            found[name] = (*found.get(name, ()), value)
        return found


def _smear(wide: Seen, half: Array, found: Array) -> Array:
    """How far each axis moves the change, in parts of it, and the colour, which decides what the
    change is worth: (boxes, axes). R. B. Kearfott, Rigorous Global Search, 1996, 4.3.2."""
    count = (len(half), half.shape[1])
    total = np.zeros(count)
    change = 1 / np.maximum(found, 1e-6)
    weights = [np.full(count[1], weight) for weight in (1 / 50, 1 / 25, 1 / 25)] + [change] * 3
    for part, weight in zip(wide, weights, strict=True):
        if part.slopes is not None:
            size = np.fmin(part.slopes.size[..., 0], 1e9)
            total = total + np.broadcast_to(size, count) * half[..., 0] * weight
    return total.T
