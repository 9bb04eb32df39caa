"""Which angles of a model make up a direction, and where a direction's mirror is.

In the plane of incidence a direction is one signed angle, and the mirror of an incidence is the
equal reflection. Out of plane it is a zenith and an azimuth, and the mirror has the same zenith and
the opposite azimuth. An angle whose range spans a whole turn is an azimuth. Of the other angles the
first two are the directions'; a third one turns the surface.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.lang.model import Quantity

TURN = 2 * math.pi
_NEAR = 1e-6
"""A range that short of a whole turn still is one: its ends may be rounded."""


@dataclass(frozen=True)
class Directions:
    """zeniths: the names of the directions' angles from the normal, two at most; azimuths: theirs,
    two or none. Both in the order of the quantities."""

    zeniths: tuple[str, ...]
    azimuths: tuple[str, ...]

    @property
    def pair(self) -> bool:
        """Whether there are two directions, so that one can be the other's mirror."""
        return len(self.zeniths) == 2

    @property
    def full(self) -> bool:
        """Whether directions leave the plane of incidence."""
        return self.pair and len(self.azimuths) == 2


def is_azimuth(quantity: Quantity) -> bool:
    """Whether an angle goes all the way round."""
    return quantity.type.is_angle and quantity.high - quantity.low >= TURN * (1 - _NEAR)


def directions(quantities: Iterable[Quantity]) -> Directions:
    """The directions that a model's quantities describe."""
    angles = [q for q in quantities if q.type.is_angle]
    zeniths = tuple(q.name for q in angles if not is_azimuth(q))[:2]
    azimuths = tuple(q.name for q in angles if is_azimuth(q))
    return Directions(zeniths, azimuths if len(azimuths) == 2 and len(zeniths) == 2 else ())


def wrapped(angle: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same azimuth within half a turn of 0."""
    return np.asarray(angle - TURN * np.round(angle / TURN))


def sideways(tilt: NDArray[np.float64], zenith: NDArray[np.float64]) -> NDArray[np.float64]:
    """How far an azimuth is from the mirror's where the half vector is tilted out of the plane of
    incidence: twice the tilt over tan(zenith), as directions of equal zenith t whose azimuths are
    2 e from opposite have tan(theta_h) = tan(t) sin(e)."""
    return np.asarray(2 * tilt * np.abs(np.cos(zenith)) / np.maximum(np.sin(zenith), 1e-3))


def opposite(
    random: np.random.Generator, azimuth: NDArray[np.float32], away: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Azimuths (count, 1) that lie opposite others, but for what they are away; every eighth is on
    the same side: retro-reflection. In radians, within half a turn of 0."""
    turned = np.where(random.random(azimuth.shape) < 0.125, 0.0, math.pi)
    return wrapped(azimuth.astype(np.float64) + turned + away)
