"""What the textbook formulas are written in: functions of two arithmetics, and unit vectors.

The surface's normal is z, its tangent x; both directions point away from the surface. Everything
works on arrays (float32 or float64; one point a row, shape (points, 1)) with NUMPY, and on single
numbers of 60 digits with PRECISE.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import mpmath
import numpy as np

Number = Any  # an array, or an mpf of PRECISE
Vector = tuple[Number, Number, Number]

SIXTY_DIGITS = mpmath.mp.clone()  # a context of its own: nobody else's precision is touched
SIXTY_DIGITS.dps = 60


@dataclass(frozen=True)
class Namespace:
    """The functions of one arithmetic, under numpy's names."""

    pi: Number
    number: Callable[[str], Number]  # a decimal constant that binary cannot hold, such as 0.33
    sin: Callable[[Number], Number]
    cos: Callable[[Number], Number]
    tan: Callable[[Number], Number]
    tanh: Callable[[Number], Number]
    exp: Callable[[Number], Number]
    log: Callable[[Number], Number]
    sqrt: Callable[[Number], Number]
    arccos: Callable[[Number], Number]
    arctan2: Callable[[Number, Number], Number]
    minimum: Callable[[Number, Number], Number]
    maximum: Callable[[Number, Number], Number]
    where: Callable[[Any, Number, Number], Number]


NUMPY = Namespace(
    math.pi,  # and number gives a Python float, too: neither widens a float32 array
    float,
    np.sin,
    np.cos,
    np.tan,
    np.tanh,
    np.exp,
    np.log,
    np.sqrt,
    np.arccos,
    np.arctan2,
    np.minimum,
    np.maximum,
    np.where,
)

PRECISE = Namespace(
    SIXTY_DIGITS.mpf(SIXTY_DIGITS.pi),
    SIXTY_DIGITS.mpf,
    SIXTY_DIGITS.sin,
    SIXTY_DIGITS.cos,
    SIXTY_DIGITS.tan,
    SIXTY_DIGITS.tanh,
    SIXTY_DIGITS.exp,
    SIXTY_DIGITS.log,
    SIXTY_DIGITS.sqrt,
    lambda x: SIXTY_DIGITS.acos(max(-1, min(1, x))),  # a cosine is 1 + 1e-60 at times
    SIXTY_DIGITS.atan2,
    min,
    max,
    lambda condition, yes, no: yes if condition else no,
)


@dataclass(frozen=True)
class Directions:
    """Unit vectors to the light and to the viewer."""

    light: Vector
    viewer: Vector


def directions(
    ns: Namespace,
    incident: Number,
    reflection: Number,
    incident_azimuth: Number,
    reflection_azimuth: Number,
) -> Directions:
    """The directions with these zenith angles and azimuths, in radians; mirror 180 deg apart."""
    return Directions(
        _unit(ns, incident, incident_azimuth), _unit(ns, reflection, reflection_azimuth)
    )


def plane_directions(
    ns: Namespace, incident: Number, reflection: Number, orientation: Number = 0
) -> Directions:
    """The directions with these signed angles, in radians, in one plane; mirror at equal angles.

    `orientation` is the angle between the tangent and the plane.
    """
    x, y, z = _unit(ns, reflection, orientation)
    return Directions(_unit(ns, incident, orientation), (-x, -y, z))


def _unit(ns: Namespace, zenith: Number, azimuth: Number) -> Vector:
    sine = ns.sin(zenith)
    return sine * ns.cos(azimuth), sine * ns.sin(azimuth), ns.cos(zenith)


@dataclass(frozen=True)
class Geometry:
    """What the books derive from the two directions, the half vector h first of all."""

    ns: Namespace
    light: Vector
    viewer: Vector

    @property
    def ci(self) -> Number:
        """n.l, the cosine of incidence."""
        return self.light[2]

    @property
    def co(self) -> Number:
        """n.v, the cosine of reflection."""
        return self.viewer[2]

    @cached_property
    def phase_cosine(self) -> Number:
        """l.v"""
        return _dot(self.light, self.viewer)

    @cached_property
    def sum(self) -> Vector:
        """l + v, the half vector before it is normalised."""
        (lx, ly, lz), (vx, vy, vz) = self.light, self.viewer
        return lx + vx, ly + vy, lz + vz

    @cached_property
    def sum2(self) -> Number:
        """|l + v|^2"""
        return _dot(self.sum, self.sum)

    @cached_property
    def half(self) -> Vector:
        """h"""
        length = self.ns.sqrt(self.sum2)
        x, y, z = self.sum
        return x / length, y / length, z / length

    @property
    def c(self) -> Number:
        """n.h"""
        return self.half[2]

    @cached_property
    def delta(self) -> Number:
        """The angle between the normal and h."""
        return self.ns.arccos(self.c)

    @cached_property
    def half_azimuth(self) -> Number:
        """The angle of h about the normal, from the tangent."""
        return self.ns.arctan2(self.half[1], self.half[0])

    @cached_property
    def d(self) -> Number:
        """l.h = v.h"""
        return _dot(self.light, self.half)

    @cached_property
    def azimuth_difference_cosine(self) -> Number:
        """1 where light and viewer are on the same side, -1 towards the mirror direction."""
        azimuths = [self.ns.arctan2(y, x) for x, y, _ in (self.light, self.viewer)]
        return self.ns.cos(azimuths[1] - azimuths[0])


def _dot(a: Vector, b: Vector) -> Number:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
