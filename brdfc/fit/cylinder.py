"""The geometry of a sample round a cylinder, a camera far in front, a small light beside it.

    A. Sole, I. Farup, P. Nussbaum, S. Tominaga, "Bidirectional reflectance measurement and
    reflection model fitting of complex materials using an image-based measurement setup", Journal
    of Imaging 4(11):136, 2018; T. Habib, P. Green, A. Sole, 2020, figure 1.

The axis is y, upwards; the camera is on z, at camera_distance from the axis, and looks at it; x is
to the right of its image. The light is in the plane y = 0, at light_distance from the axis and
light_angle from z, positive to the right. A pixel u right of the axis and v above the camera's
level looks along (u, v, -f), f the focal length in pixels.

Seen from above, the axis O, the camera C and the point P that a pixel sees make a triangle with
R = OP, dC = OC and the angle a = atan(u/f) at C. The law of sines gives the angle r between the
normal OP and the direction PC, and the sum of angles the place of P round the axis, b:

    sin r = dC sin(a)/R        b = r - a        P = (R sin b, y, R cos b)

and P's height is y = v (dC - R cos b)/f. Vectors from P to camera and light give all angles, in or
out of the plane y = 0. A small light of intensity I gives P the irradiance I cos(incidence)/d^2, d
its distance from P: inverse square and cosine are two factors.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.source.errors import MeasurementError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Setup:
    """radius of the cylinder, camera_distance and light_distance from its axis, in one unit;
    light_angle in radians, within -pi..pi. Raises MeasurementError for what cannot be."""

    radius: float
    camera_distance: float
    light_distance: float
    light_angle: float

    def __post_init__(self) -> None:
        lengths = (self.radius, self.camera_distance, self.light_distance, self.light_angle)
        if not all(map(math.isfinite, lengths)) or self.radius <= 0:
            raise MeasurementError("radius, distances and the light's angle are finite numbers")
        for what in ("camera", "light"):
            distance = getattr(self, f"{what}_distance")
            if distance <= self.radius:
                raise MeasurementError(
                    f"the {what} at {distance:g} from the axis is within the cylinder, whose "
                    f"radius is {self.radius:g}"
                )
        if abs(self.light_angle) > math.pi:
            raise MeasurementError(
                f"a light angle of {math.degrees(self.light_angle):g} degrees is beyond 180"
            )


@dataclass(frozen=True)
class Pixels:
    """Where the camera has the cylinder: the column of its axis, the row at the camera's height,
    and the focal length, all in pixels from the image's upper left corner."""

    axis: float
    level: float
    focal: float


def pixels_from_edges(setup: Setup, left: float, right: float, level: float) -> Pixels:
    """From the columns of the cylinder's outline, where its surface is last seen: there the ray
    touches it, and sin a = R/dC."""
    if not (math.isfinite(left) and math.isfinite(right) and left < right):
        raise MeasurementError(f"the cylinder's edges are LEFT,RIGHT, not {left:g},{right:g}")
    tangent = setup.radius / math.sqrt(setup.camera_distance**2 - setup.radius**2)
    return Pixels((left + right) / 2, level, (right - left) / 2 / tangent)


@dataclass(frozen=True, eq=False)
class Seen:
    """Of every pixel: directions (..., 4) in radians, as in Measurements, azimuths from the tangent
    to the right, zeniths up to pi; light_distance (...): from the light to the point. NaN beside
    the cylinder."""

    directions: Array
    light_distance: Array

    @property
    def irradiance(self) -> Array:
        """(...): of a light of unit intensity; 0 in its shadow."""
        lit = np.maximum(np.cos(self.directions[..., 0]), 0.0)
        return np.asarray(lit / self.light_distance**2)


def seen(setup: Setup, pixels: Pixels, columns: Array, rows: Array) -> Seen:
    """What pixels at columns and rows see; arrays that broadcast, from the upper left corner, so
    that the middle of the first pixel is at 0.5, 0.5."""
    across, up = np.broadcast_arrays(columns - pixels.axis, pixels.level - rows)
    at_camera = np.arctan2(across, pixels.focal)
    with np.errstate(invalid="ignore"):
        in_plane = np.arcsin(setup.camera_distance * np.sin(at_camera) / setup.radius)
    round_axis = in_plane - at_camera
    sine, cosine = np.sin(round_axis), np.cos(round_axis)
    height = up * (setup.camera_distance - setup.radius * cosine) / pixels.focal
    point = np.stack([setup.radius * sine, height, setup.radius * cosine], axis=-1)
    zero = np.zeros_like(sine)
    normal = np.stack([sine, zero, cosine], axis=-1)
    tangent = np.stack([cosine, zero, -sine], axis=-1)

    def towards(x: float, z: float) -> tuple[Array, Array, Array]:
        to = np.array([x, 0.0, z]) - point
        along, away = (to * tangent).sum(axis=-1), (to * normal).sum(axis=-1)
        zenith = np.arctan2(np.hypot(along, to[..., 1]), away)
        return zenith, np.arctan2(to[..., 1], along), np.linalg.norm(to, axis=-1)

    light_x = setup.light_distance * math.sin(setup.light_angle)
    light_z = setup.light_distance * math.cos(setup.light_angle)
    incident, light_azimuth, distance = towards(light_x, light_z)
    reflection, camera_azimuth, _ = towards(0.0, setup.camera_distance)
    directions = np.stack([incident, reflection, light_azimuth, camera_azimuth], axis=-1)
    return Seen(directions, distance)
