"""Two charts of the hemisphere of viewing directions, graded to where reflectance changes fast.

Both are polar, by a radius u and a turn w in 0..1 each. `mirror` is polar in the half vector
around the normal: the lobes of microfacet models are round there, even towards grazing, where they
are long and thin in the viewing direction. `retro` is polar in the viewing direction around the
light. The radius is graded by decades to the centre, where a lobe may be as narrow as 1e-3, and
to the horizon; the turn towards where the horizon comes near at grazing incidence, and where a
model is anisotropic, towards the axes of its tangent frame: a lobe that is a thousand times longer
than wide is a needle along one of them. The horizon is always u = 1, in closed form.

Directions are relative to an incident direction of azimuth 0, l = (sin ti, 0, cos ti).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from brdfc.laws.reflectance import Array

DECADES = math.log(1e4)
"""The radius is linear below this part of its range, then grows by decades."""
NEARER = 4
"""How many times nearer to the light than to the mirror direction the retro chart takes over."""
_NEEDLE = 1e-3
"""How near to an axis, in radians, a needle is resolved."""
PARTS, PARTS_TO_AXES = 4, 12
"""Parts of the turn, in each of which a chart is smooth."""


@dataclass(frozen=True)
class Directions:
    """Viewing directions, as unit vectors x, y, z; solid_angle: d omega/(du dw)."""

    x: Array
    y: Array
    z: Array
    solid_angle: Array

    @property
    def zenith(self) -> Array:
        """In radians."""
        return np.asarray(np.arctan2(np.hypot(self.x, self.y), self.z))

    @property
    def azimuth(self) -> Array:
        """In radians from the incident one, pi at the mirror direction."""
        return np.asarray(np.arctan2(self.y, self.x))


def mirror(incident: Array, u: Array, w: Array, tangent: Array | None = None) -> Directions:
    """Directions by half vector, u = 0 the mirror direction; the arrays broadcast.

    v = 2(l.h)h - l, so that d omega_v = 4(l.h) d omega_h. tangent: where the tangent is, as an
    azimuth from the incident one (its last axis, and that of incident, is 1).
    """
    sine, cosine = np.sin(incident), np.cos(incident)
    turn = _turn(cosine, w) if tangent is None else _turn_to_axes(cosine, w, tangent)
    cos_turn, sin_turn, turning = turn
    reach, height = _horizon(sine, cosine, cos_turn)
    part, to_horizon, growing = _radius(u)
    half = reach / 2 * part
    sin_half = np.sin(half)
    along = sine * sin_half * cos_turn + cosine * np.cos(half)  # l.h
    vx = 2 * along * sin_half * cos_turn - sine
    vy = 2 * along * sin_half * sin_turn
    vz = height * np.sin(reach * to_horizon)
    density = 4 * along * sin_half * (reach / 2) * growing * turning
    return Directions(vx, vy, vz, density)


def retro(incident: Array, u: Array, w: Array) -> Directions:
    """Directions by their angle to the light, u = 0 the light's own; the three arrays broadcast."""
    sine, cosine = np.sin(incident), np.cos(incident)
    cos_turn, sin_turn, turning = _turn(cosine, w)
    reach, height = _horizon(sine, cosine, cos_turn)
    part, to_horizon, growing = _radius(u)
    angle = reach * part
    sin_angle = np.sin(angle)
    vx = sine * np.cos(angle) - cosine * sin_angle * cos_turn
    vy = sin_angle * sin_turn
    vz = height * np.sin(reach * to_horizon)
    return Directions(vx, vy, vz, sin_angle * reach * growing * turning)


def share_of_mirror(incident: Array, at: Directions) -> Array:
    """A partition of the hemisphere: 1 at the mirror direction, 0 at the light's, smooth between.

    What the `mirror` chart is to count of a direction; the rest is for the `retro` chart, which
    gets what is several times nearer to the light. It depends on the ratio of the two distances
    alone, so that it takes lobes of any width apart.
    """
    sine, cosine = np.sin(incident), np.cos(incident)
    rest = at.y**2 + (at.z - cosine) ** 2
    to_mirror, to_light = (at.x + sine) ** 2 + rest, (at.x - sine) ** 2 + rest
    with np.errstate(all="ignore"):
        share = to_light**4 / (to_light**4 + (to_mirror / NEARER**2) ** 4)
    return np.where(np.isnan(share), 1.0, share)


def within_turn(azimuth: Array) -> Array:
    """The same azimuth in -180..180 degrees."""
    return np.asarray(azimuth - 2 * math.pi * np.round(azimuth / (2 * math.pi)))


def _horizon(sine: Array, cosine: Array, cos_turn: Array) -> tuple[Array, Array]:
    """How far the horizon is from the chart's centre, and the height of v above it: v.n is height
    times the sine of the angle left to the horizon. Both charts share it."""
    return np.arctan2(sine * cos_turn, cosine) + math.pi / 2, np.hypot(sine * cos_turn, cosine)


def _radius(u: Array) -> tuple[Array, Array, Array]:
    """The part of the way to the horizon, what is left of it, and the derivative by u."""
    rest = 1 - u
    whole = math.expm1(DECADES)
    exponent = DECADES * (1 - rest * rest)
    left = -np.expm1(-DECADES * rest * rest) * (whole + 1) / whole
    return np.expm1(exponent) / whole, left, 2 * DECADES * rest * np.exp(exponent) / whole


def _turn(cosine: Array, w: Array) -> tuple[Array, Array, Array]:
    """Cosine and sine of the turn, and its derivative by w: four quarters, each graded to the
    plane across the plane of incidence, where at grazing all changes within cos(incident)."""
    quarter = np.minimum(np.floor(4 * w), 3)
    within = 4 * w - quarter
    odd = quarter % 2 == 1
    scale = np.maximum(cosine, 1e-9)
    stretch = np.arcsinh(math.pi / 2 / scale)
    part = np.where(odd, within, 1 - within) * stretch
    away = scale * np.sinh(part)
    front = (quarter == 0) | (quarter == 3)
    cos_turn = np.where(front, np.sin(away), -np.sin(away))
    sin_turn = np.where(quarter < 2, np.cos(away), -np.cos(away))
    return cos_turn, sin_turn, 4 * scale * stretch * np.cosh(part)


def _turn_to_axes(cosine: Array, w: Array, tangent: Array) -> tuple[Array, Array, Array]:
    """The same in twelve parts, between six places and the middles of the ways between them: the
    plane across the plane of incidence, and the axes of the tangent frame.

    cosine, tangent: (..., 1); w: (..., nodes).
    """
    quarters = np.arange(4) * math.pi / 2
    axes = np.mod(tangent + quarters, 2 * math.pi)
    sides = np.broadcast_to((math.pi / 2, 3 * math.pi / 2), (*axes.shape[:-1], 2))
    # A needle beside a side is to be seen from the side, too.
    beside = np.abs(np.sin(2 * (tangent - math.pi / 2))) / 2
    near = np.minimum(np.maximum(cosine, 1e-9), np.maximum(beside, _NEEDLE))
    near = np.broadcast_to(near, sides.shape)
    places = np.concatenate([sides, axes], axis=-1)
    scales = np.concatenate([near, np.full(axes.shape, _NEEDLE)], axis=-1)
    # The cosine of a side is 0, not the float next to it: at grazing that decides.
    cosines = np.concatenate([np.zeros(sides.shape), np.cos(axes)], axis=-1)
    order = np.argsort(places, axis=-1, kind="stable")
    sorted_places = np.take_along_axis(places, order, axis=-1)
    following = np.concatenate(
        [sorted_places[..., 1:], sorted_places[..., :1] + 2 * math.pi], axis=-1
    )
    ways = (following - sorted_places) / 2

    part = np.minimum(np.floor(PARTS_TO_AXES * w), PARTS_TO_AXES - 1)
    within = PARTS_TO_AXES * w - part
    index = part.astype(np.int64)
    back = index % 2 == 1
    end = np.take_along_axis(order, (index + 1) // 2 % 6, axis=-1)
    way = np.take_along_axis(ways, index // 2, axis=-1)
    scale = np.take_along_axis(scales, end, axis=-1)
    stretch = np.arcsinh(way / scale)
    share = np.where(back, 1 - within, within) * stretch
    away = np.where(back, -1, 1) * scale * np.sinh(share)
    at_cosine = np.take_along_axis(cosines, end, axis=-1)
    at_sine = np.sin(np.take_along_axis(places, end, axis=-1))
    cos_turn = at_cosine * np.cos(away) - at_sine * np.sin(away)
    sin_turn = at_sine * np.cos(away) + at_cosine * np.sin(away)
    return cos_turn, sin_turn, PARTS_TO_AXES * scale * stretch * np.cosh(share)
