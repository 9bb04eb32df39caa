"""Points where methods of reflectance fail, by stratum: what users report, and what is near it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.judge.directions import Directions, directions, sideways, wrapped
from brdfc.judge.strata import Points, Values, edges, inside
from brdfc.lang.model import Quantity
from brdfc.symbolic.intervals import Interval, single

STRATA: Mapping[str, str] = {
    "mirror": "reflection near the mirror direction, at distances from none to some lobe widths",
    "grazing mirror": "the same, both directions within 5 degrees of the same end",
    "grazing": "one direction or both within 5 degrees of an end, 0.00001 degrees among them",
    "normal": "one direction or both within 5 degrees of the normal, or on it",
    "retro": "the viewer near the light",
    "horizon": "directions at 90 degrees, a few floats to either side, and beyond where allowed",
    "shape low": "roughnesses and exponents at the low end of their range, half near the mirror",
    "shape high": "roughnesses and exponents at the high end, half near the mirror",
    "coefficients low": "about half of the coefficients at the low end of their range",
    "coefficients high": "about half of the coefficients at the high end",
    "corners": "most quantities at an end, one float inside, or 0",
    "uniform": "anywhere; ranges over decades by decades",
}
_RIGHT = math.pi / 2
_GRAZING = 0.09
_DECADES = 30


def failure_points(
    domain: Mapping[str, Interval],
    quantities: tuple[Quantity, ...],
    shares: Mapping[str, int],
    seed: int = 1,
) -> Points:
    """So many points of each stratum, in turn; the same seed gives the same points. Strata that say
    nothing of these quantities are left out."""
    random = np.random.Generator(np.random.PCG64(seed))
    names: list[str] = []
    parts: list[dict[str, Values]] = []
    for stratum in applicable(quantities):
        count = shares[stratum]
        source = _Source(random, domain, quantities, directions(quantities), count)
        parts.append(source.drawn(stratum))
        names += [stratum] * count
    whole = {q.name: np.concatenate([part[q.name] for part in parts]) for q in quantities}
    return Points(whole, tuple(names))


def applicable(quantities: tuple[Quantity, ...]) -> list[str]:
    """The strata that make sense for these quantities."""
    of = directions(quantities)
    shapes = any(is_shape(q) for q in quantities)
    coefficients = any(not is_shape(q) and not q.type.is_angle for q in quantities)
    absent: set[str] = set()
    absent |= set() if of.pair else {"mirror", "grazing mirror", "retro"}
    absent |= set() if of.zeniths else {"grazing", "normal", "horizon"}
    absent |= set() if shapes else {"shape low", "shape high"}
    absent |= set() if coefficients else {"coefficients low", "coefficients high"}
    return [name for name in STRATA if name not in absent]


def is_shape(q: Quantity) -> bool:
    """Whether a quantity is a roughness, or an exponent: a number over decades."""
    if q.type.name == "roughness":
        return True
    return q.type.name == "number" and q.low > 0 and q.high / q.low > _DECADES


@dataclass
class _Source:
    """Where the count points of one stratum come from."""

    random: np.random.Generator
    domain: Mapping[str, Interval]
    quantities: tuple[Quantity, ...]
    of: Directions
    count: int

    def drawn(self, stratum: str) -> dict[str, Values]:
        draw = edges if stratum == "corners" else inside
        at = {
            q.name: draw(self.random, self.domain[q.name], (self.count, q.type.value.width))
            for q in self.quantities
        }
        if stratum.startswith(("shape", "coefficients")):
            self.to_ends(at, stratum)
        if stratum in ("grazing", "grazing mirror"):
            self.near_ends(at)
        if stratum in ("mirror", "grazing mirror"):
            self.mirrored(at, slice(None))
            self.without_diffuse(at)
        elif stratum.startswith(("shape", "coefficients")) and self.of.pair:
            self.mirrored(at, slice(None, None, 2))
        elif stratum == "normal":
            self.near_normal(at)
        elif stratum == "retro":
            self.retro(at)
        elif stratum == "horizon":
            self.at_horizon(at)
        return at

    def put(self, at: dict[str, Values], name: str, values: NDArray[np.float64]) -> None:
        ends = self.domain[name]
        at[name] = np.clip(values, ends.low, ends.high).astype(np.float32)

    def away(self, least: float, most: float) -> NDArray[np.float64]:
        """Distances over decades, (count, 1)."""
        logarithm = self.random.uniform(math.log(least), math.log(most), (self.count, 1))
        return np.exp(logarithm)

    def signs(self) -> NDArray[np.float64]:
        return self.random.choice([-1.0, 1.0], (self.count, 1))

    def some(self, share: float) -> NDArray[np.bool_]:
        return np.asarray(self.random.random((self.count, 1)) < share)

    def tilts(self, at: Mapping[str, Values]) -> NDArray[np.float64]:
        """How far half vectors lie from the normal: half of them within three roughnesses (of
        models without one: 0.1), half anything from the last digit on, some not at all."""
        rough = [q.name for q in self.quantities if q.type.name == "roughness"]
        width = at[rough[0]].astype(np.float64) if rough else np.full((self.count, 1), 0.1)
        lobe = np.arctan(width * self.random.uniform(-3, 3, (self.count, 1)))
        tilt = np.where(self.some(0.5), lobe, self.signs() * self.away(1e-8, 0.5))
        return np.where(self.some(1 / 16), 0.0, tilt)

    def mirrored(self, at: dict[str, Values], which: slice) -> None:
        """Put the second direction near the first one's mirror, at some of the points."""
        near, across = self.tilts(at), self.tilts(at)
        zeniths, azimuths = self.of.zeniths, self.of.azimuths
        new = dict(at)
        self.put(new, zeniths[1], at[zeniths[0]] + 2 * near)
        if self.of.full:
            away = sideways(across, new[zeniths[1]].astype(np.float64))
            self.put(new, azimuths[1], wrapped(at[azimuths[0]] + math.pi + away))
        for name in (*zeniths, *azimuths):
            at[name][which] = new[name][which]

    def retro(self, at: dict[str, Values]) -> None:
        zeniths, azimuths = self.of.zeniths, self.of.azimuths
        near, across = self.tilts(at), self.tilts(at)
        if self.of.full:
            self.put(at, zeniths[1], at[zeniths[0]] + near)
            sine = np.maximum(np.sin(at[zeniths[1]].astype(np.float64)), 1e-3)
            self.put(at, azimuths[1], wrapped(at[azimuths[0]] + across / sine))
        else:
            self.put(at, zeniths[1], -at[zeniths[0]] + near)

    def near_ends(self, at: dict[str, Values]) -> None:
        """All directions near the same end of their range (out of plane: the horizon), or, every
        other time, only one of them."""
        high = np.ones((self.count, 1), dtype=np.bool_) if self.of.full else self.some(0.5)
        both, first = self.some(0.5), self.some(0.5)
        for index, name in enumerate(self.of.zeniths):
            ends, away = self.domain[name], self.away(1e-7, _GRAZING)
            near = np.where(high, ends.high - away, ends.low + away)
            moved = both | (first == (index == 0)) | (not self.of.pair)
            self.put(at, name, np.where(moved, near, at[name]))

    def near_normal(self, at: dict[str, Values]) -> None:
        both, first = self.some(0.5), self.some(0.5)
        for index, name in enumerate(self.of.zeniths):
            near = np.where(self.some(1 / 8), 0.0, self.signs() * self.away(1e-8, _GRAZING))
            near = np.abs(near) if self.domain[name].low >= 0 else near
            moved = both | (first == (index == 0)) | (not self.of.pair)
            self.put(at, name, np.where(moved, near, at[name]))

    def at_horizon(self, at: dict[str, Values]) -> None:
        """A right angle as float32 has it, which lies 4e-8 beyond one, floats beside it, and every
        fourth time what the range has beyond."""
        both, first = self.some(0.5), self.some(0.5)
        for index, name in enumerate(self.of.zeniths):
            ends = self.domain[name]
            steps = self.random.integers(-4, 5, (self.count, 1)) * np.spacing(np.float32(_RIGHT))
            beyond = self.random.uniform(_RIGHT, max(_RIGHT, ends.high), (self.count, 1))
            angle = np.where(self.some(0.25), beyond, single(_RIGHT) + steps)
            angle = angle if ends.low >= 0 else self.signs() * angle
            moved = both | (first == (index == 0)) | (not self.of.pair)
            self.put(at, name, np.where(moved, angle, at[name]))

    def to_ends(self, at: dict[str, Values], stratum: str) -> None:
        """Shapes all at an end, or coefficients each at it with an even chance."""
        shape = stratum.startswith("shape")
        for q in self.quantities:
            if q.type.is_angle or is_shape(q) != shape:
                continue
            ends = self.domain[q.name]
            end = np.float32(ends.low if stratum.endswith("low") else ends.high)
            there = shape | (self.random.random(at[q.name].shape) < 0.5)
            at[q.name] = np.where(there, end, at[q.name])

    def without_diffuse(self, at: dict[str, Values]) -> None:
        """Without its diffuse part a model shows the error of its lobe: every other time."""
        for q in self.quantities:
            if q.type.value.width > 1 and self.domain[q.name].low <= 0 <= self.domain[q.name].high:
                at[q.name][::2] = 0
