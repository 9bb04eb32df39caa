"""Points at which forms of a formula are compared, by stratum.

Drawn uniformly over floats, points call a form best that is 16.7 bits wrong at the peak: almost
none of them lies in a narrow highlight. So they are drawn where reflectance models live: in the
lobe (angles whose half difference is a few roughnesses), in the lobe at grazing incidence, in its
tail, around retro-reflection, uniformly, and at the edges of the domain. Out of plane the lobe is
where zeniths are as near and azimuths nearly opposite; some of its points are where they are equal,
at retro-reflection.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.judge.directions import Directions, directions, opposite, sideways
from brdfc.lang.model import Quantity
from brdfc.symbolic.intervals import Interval

Values = NDArray[np.float32]

# Stratum: share of the points, and how many roughnesses from the peak; None where angles are
# independent.
STRATA: Mapping[str, tuple[int, float | None]] = {
    "lobe": (4, 3.0),
    "grazing lobe": (2, 3.0),
    "rim": (1, None),
    "tail": (1, 9.0),
    "uniform": (2, None),
    "edges": (2, None),
    "retro": (1, 3.0),
}
FEW, MANY = 80, 800
"""Points a share: for guiding a search, and for judging what it found."""


@dataclass(frozen=True)
class Points:
    """values: (points, components) for each quantity; strata: the stratum of each point."""

    values: Mapping[str, Values]
    strata: tuple[str, ...]

    @property
    def count(self) -> int:
        return len(self.strata)

    def joined(self, more: Mapping[str, Values], stratum: str) -> Points:
        """These points and more of them, which are a stratum of their own."""
        values = {name: np.concatenate([v, more[name]]) for name, v in self.values.items()}
        added = len(next(iter(values.values()))) - self.count
        return Points(values, self.strata + (stratum,) * added)


def points(
    domain: Mapping[str, Interval], quantities: tuple[Quantity, ...], scale: int, seed: int = 1
) -> Points:
    """Points of a domain, each stratum in turn, scale for each of its shares; the same seed gives
    the same points."""
    random = np.random.Generator(np.random.PCG64(seed))
    columns: dict[str, list[Values]] = {q.name: [] for q in quantities}
    names: list[str] = []
    for stratum, (share, reach) in STRATA.items():
        count = share * scale
        drawn = _stratum(random, domain, quantities, stratum, count, reach)
        for name, values in drawn.items():
            columns[name].append(values)
        names += [stratum] * count
    whole = {name: np.concatenate(parts) for name, parts in columns.items()}
    return Points(whole, tuple(names))


def _stratum(
    random: np.random.Generator,
    domain: Mapping[str, Interval],
    quantities: tuple[Quantity, ...],
    stratum: str,
    count: int,
    reach: float | None,
) -> dict[str, Values]:
    drawn: dict[str, Values] = {}
    for q in quantities:
        interval, shape = domain[q.name], (count, q.type.value.width)
        if stratum == "edges":
            drawn[q.name] = edges(random, interval, shape)
        else:
            drawn[q.name] = inside(random, interval, shape)
    of = directions(quantities)
    angles = of.zeniths
    rough = [q.name for q in quantities if q.type.name == "roughness"]
    if reach is not None and of.pair:
        first = domain[angles[0]]
        if stratum == "grazing lobe":
            away = np.exp(random.uniform(math.log(2e-3), math.log(9e-2), (count, 1)))
            end = np.where(random.random((count, 1)) < 0.5, first.low + away, first.high - away)
            drawn[angles[0]] = np.clip(end, first.low, first.high).astype(np.float32)
        width = drawn[rough[0]].astype(np.float64) if rough else np.full((count, 1), 0.1)
        tilt = np.arctan(width * random.uniform(-reach, reach, (count, 1)))
        near = drawn[angles[0]] + 2 * tilt
        if stratum == "retro" and not of.full:
            near = -near
        other = domain[angles[1]]
        drawn[angles[1]] = np.clip(near, other.low, other.high).astype(np.float32)
        if of.full:
            across = np.arctan(width * random.uniform(-reach, reach, (count, 1)))
            _turn_opposite(random, domain, of, drawn, across)
    if stratum == "rim":
        # All angles within a thousandth of a degree to a tenth of the same end: what a sum of two
        # angles rounds away is then a large part of the distance to it.
        first_end = random.random((count, 1)) < 0.5
        for name in angles:
            away = np.exp(random.uniform(math.log(2e-7), math.log(2e-3), (count, 1)))
            low, high = domain[name].low, domain[name].high
            drawn[name] = np.clip(np.where(first_end, low + away, high - away), low, high).astype(
                np.float32
            )
    if stratum == "lobe":
        # Without its diffuse part a model shows the error of its lobe.
        for q in quantities:
            if q.type.value.width > 1 and domain[q.name].low <= 0 <= domain[q.name].high:
                drawn[q.name][::2] = 0
    return drawn


def _turn_opposite(
    random: np.random.Generator,
    domain: Mapping[str, Interval],
    of: Directions,
    drawn: dict[str, Values],
    tilt: NDArray[np.float64],
) -> None:
    """Put the second azimuth opposite the first, but for a tilt of the half vector sideways."""
    first, second = of.azimuths
    zenith = drawn[of.zeniths[1]].astype(np.float64)
    turned = opposite(random, drawn[first], sideways(tilt, zenith))
    ends = domain[second]
    drawn[second] = np.clip(turned, ends.low, ends.high).astype(np.float32)


def inside(random: np.random.Generator, of: Interval, shape: tuple[int, int]) -> Values:
    """Anywhere in a range, uniformly."""
    if of.low > 0 and of.high / of.low > 30:  # a range over decades is drawn by decades
        drawn = np.exp(random.uniform(math.log(of.low), math.log(of.high), shape))
    else:
        drawn = random.uniform(of.low, of.high, shape)
    return np.clip(drawn, of.low, of.high).astype(np.float32)


def edges(random: np.random.Generator, of: Interval, shape: tuple[int, int]) -> Values:
    """Both ends, the floats beside them, zero, and the inside, mixed."""
    ends = np.array([of.low, of.high], dtype=np.float32)
    choices = [*ends, *np.nextafter(ends, ends[::-1])]
    if of.low <= 0 <= of.high:
        choices.append(np.float32(0))
    picked = random.choice(np.array(choices, dtype=np.float32), size=shape)
    return np.where(random.random(shape) < 0.75, picked, inside(random, of, shape))
