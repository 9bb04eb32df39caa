"""Points of a model's domain at which a program is judged, its edges and its peak included.

A uniform sample misses what matters: the edges where guards act, and the highlight, which at a
roughness of 0.001 is a tenth of a degree wide. So the points come in strata, one a run:

    corners   each quantity at an end of its range, in a pattern that reaches every pair of ends
    edges     most quantities at an end, or one float inside it (2^-24 of the range beside 0)
    mirror    angles nearly equal, or nearly opposite: the peak; every fourth pixel at its narrowest
              (out of plane zeniths nearly equal, azimuths nearly opposite, or nearly equal)
    rim       angles near an end of their range: grazing
    uniform   anywhere; ranges over decades by decades
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import cycle, islice

import numpy as np
from numpy.typing import NDArray

from brdfc.judge.directions import is_azimuth, wrapped
from brdfc.lang.model import Quantity
from brdfc.symbolic.intervals import Interval

Values = NDArray[np.float32]

_STRATA = ("corners", "mirror", "edges", "mirror", "rim", "uniform")
_DECADES = 30
"""A range whose ends differ by more than this factor is sampled by decades."""


@dataclass(frozen=True)
class Samples:
    """runs: environment variables by name, for each run; pixels: by channel quantity, for each
    run, an array (pixels, components)."""

    runs: tuple[Mapping[str, float], ...]
    pixels: tuple[Mapping[str, Values], ...]

    def points(self) -> dict[str, Values]:
        """The values of every quantity at every pixel of every run, (points, components)."""
        columns: dict[str, list[Values]] = {}
        for run, pixels in zip(self.runs, self.pixels, strict=True):
            count = len(next(iter(pixels.values())))
            fixed = {n: np.full((count, 1), v, dtype=np.float32) for n, v in run.items()}
            for name, values in {**pixels, **fixed}.items():
                columns.setdefault(name, []).append(values)
        return {name: np.concatenate(parts) for name, parts in columns.items()}


def sample(
    domain: Mapping[str, Interval],
    channels: tuple[Quantity, ...],
    variables: tuple[Quantity, ...],
    *,
    runs: int = 48,
    pixels: int = 8,
    seed: int = 1,
) -> Samples:
    """runs sets of variables, each with so many pixels; the same seed gives the same points."""
    random = np.random.Generator(np.random.PCG64(seed))
    all_runs, all_pixels = [], []
    for run, stratum in enumerate(islice(cycle(_STRATA), runs)):
        source = _Source(random, domain, stratum, run // len(_STRATA))
        all_runs.append({q.name: float(source.values(q, i)[0]) for i, q in enumerate(variables)})
        rows = []
        for pixel in range(pixels):
            inside = source.pixel(pixel)
            rows.append([inside.values(q, i) for i, q in enumerate(channels)])
        columns = [np.array(column, dtype=np.float32) for column in zip(*rows, strict=True)]
        all_pixels.append({q.name: c for q, c in zip(channels, columns, strict=True)})
    return Samples(tuple(all_runs), tuple(all_pixels))


@dataclass
class _Source:
    """Where the values of one run come from. number: of the run in its stratum, or of the pixel;
    centre: the first angle, which the others of the stratum mirror stay near; turn: the first
    azimuth, which the others stay opposite to."""

    random: np.random.Generator
    domain: Mapping[str, Interval]
    stratum: str
    number: int
    centre: float | None = None
    turn: float | None = None

    def pixel(self, number: int) -> _Source:
        """The same for one pixel of the run: its angles stay near the run's."""
        return _Source(self.random, self.domain, self.stratum, number, self.centre, self.turn)

    def values(self, quantity: Quantity, index: int) -> Values:
        """A value for each component of a quantity, the index-th of its kind."""
        interval = self.domain[quantity.name]
        ends = np.array([interval.low, interval.high], dtype=np.float32)
        width = quantity.type.value.width
        drawn = self.drawn(quantity, ends, width, index)
        return np.clip(drawn, ends[0], ends[1]).astype(np.float32)

    def drawn(self, quantity: Quantity, ends: Values, width: int, index: int) -> Values:
        random, angle = self.random, quantity.type.is_angle
        match self.stratum:
            case "corners":
                return np.array([ends[self.end(index + i)] for i in range(width)], np.float32)
            case "edges" if random.random() < 0.7:
                # No float just above 0: what is nearer to 0 than this is no measured value.
                step = ends[::-1] * np.float32(2**-24)
                inside = np.where(ends == 0, step, np.nextafter(ends, ends[::-1]))
                either: Values = random.choice(np.concatenate([ends, inside]), size=width)
                return either
            case "mirror" if is_azimuth(quantity):
                return self.turned(ends)
            case "mirror" if angle:
                return self.mirrored(ends)
            case "mirror" if self.number % 4 == 0 and _over_decades(ends):
                return np.full(width, ends[0])
            case "rim" if angle and not is_azimuth(quantity):
                away = (ends[1] - ends[0]) * 10 ** random.uniform(-7, -1)
                return random.choice([ends[0] + away, ends[1] - away], size=1)
        return _spread(random, ends, width)

    def end(self, place: int) -> int:
        """Which end: binary digits of the number, so that eight numbers reach all the corners of
        three quantities, and every pair of ends of those that follow."""
        digit = (self.number >> (place % 3)) & 1
        return digit ^ ((self.number >> (place // 3 % 3)) & 1 if place >= 3 else 0)

    def mirrored(self, ends: Values) -> Values:
        random = self.random
        if self.centre is None:
            self.centre = float(random.uniform(ends[0], ends[1]))
            return np.array([self.centre], dtype=np.float32)
        # Models differ in the sign of the mirror direction; a zenith out of plane has none.
        same = random.random() < 0.7 or -self.centre < ends[0]
        centre = self.centre if same else -self.centre
        away = 10 ** random.uniform(-5, 0) * random.choice([-1.0, 1.0])
        return np.array([centre + (away if random.random() < 0.9 else 0.0)], dtype=np.float32)

    def turned(self, ends: Values) -> Values:
        random = self.random
        if self.turn is None:
            self.turn = float(random.uniform(ends[0], ends[1]))
            return np.array([self.turn], dtype=np.float32)
        centre = self.turn + (np.pi if random.random() < 0.7 else 0.0)
        away = 10 ** random.uniform(-5, 0) * random.choice([-1.0, 1.0])
        whole = np.array([centre + (away if random.random() < 0.9 else 0.0)])
        return wrapped(whole).astype(np.float32)


def _over_decades(ends: Values) -> bool:
    return bool(ends[0] > 0 and ends[1] / ends[0] > _DECADES)


def _spread(random: np.random.Generator, ends: Values, width: int) -> Values:
    if _over_decades(ends):
        low, high = np.log(ends.astype(np.float64))
        return np.exp(random.uniform(low, high, width)).astype(np.float32)
    low, high = (float(end) for end in ends)
    return random.uniform(low, high, width).astype(np.float32)
