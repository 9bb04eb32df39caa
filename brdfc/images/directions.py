"""From normals, a light and a camera to the angles of every pixel.

The surface is looked at along -z: x to the right, y up, the first row of an image at the top. A
pixel lies where the image puts it, at height 0 unless a height is given. Angles are those of the
models: from the normal, azimuths from the tangent that x has on the surface. What is at the light
itself, or at the camera, gets 90 degrees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Vector = tuple[float, float, float]

NAMES = {
    "plane": ("incident", "reflection"),
    "full": ("incident", "reflection", "incident_azimuth", "reflection_azimuth"),
}
"""The quantities of each geometry, in the order that profiles have them in."""
RIGHT = float(np.float32(math.pi / 2))
"""90 degrees as a float32, a little beyond a right angle: where a model sees nothing."""


@dataclass(frozen=True)
class Arrangement:
    """light and camera: positions, or where distant is set directions; width: of the image, in the
    same unit; geometry: of NAMES."""

    light: Vector
    camera: Vector
    geometry: str = "full"
    distant: bool = False
    width: float = 2.0


@dataclass
class Faced:
    """What was met: pixels that face away from the light or from the camera, and those that one of
    them is at; the largest angle between a direction and the plane of incidence (plane geometry;
    radians)."""

    from_light: int = 0
    from_camera: int = 0
    touched: int = 0
    leaves_plane: float = 0.0


def positions(top: int, rows: int, height: int, width: int, scene_width: float) -> Array:
    """Where the pixels of some rows lie, (rows, width, 3), at height 0; the image's middle is the
    origin."""
    size = scene_width / width
    x = (np.arange(width) + 0.5) * size - scene_width / 2
    y = (height / 2 - (np.arange(top, top + rows) + 0.5)) * size
    place = np.zeros((rows, width, 3))
    place[..., 0], place[..., 1] = x, y[:, None]
    return place


def angles(normals: Array, places: Array, scene: Arrangement, faced: Faced) -> NDArray[np.float32]:
    """The angles of pixels, (..., 2) or (..., 4) float32 in radians, in the order of NAMES.

    normals: (..., 3), of any length but 0; places: (..., 3). What faces away from the light or the
    camera gets 90 degrees, where models give nothing, and is counted in faced.
    """
    normal = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    tangent = _tangent(normal)
    across = np.cross(normal, tangent)
    towards = [_towards(point, places, scene.distant) for point in (scene.light, scene.camera)]
    faced.touched += sum(int((to == 0).all(axis=-1).sum()) for to in towards)
    found = [_polar(normal, tangent, across, to) for to in towards]
    (incident, light_azimuth), (reflection, camera_azimuth) = found
    faced.from_light += int((incident > math.pi / 2).sum())
    faced.from_camera += int((reflection > math.pi / 2).sum())
    incident, reflection = np.minimum(incident, RIGHT), np.minimum(reflection, RIGHT)
    if scene.geometry == "full":
        columns = (incident, reflection, light_azimuth, camera_azimuth)
        return np.stack(columns, axis=-1).astype(np.float32)
    # In the plane light and viewer have the same sign on opposite sides of the normal.
    lit = np.where(np.cos(light_azimuth) < 0, -incident, incident)
    seen = np.where(np.cos(camera_azimuth) > 0, -reflection, reflection)
    for zenith, azimuth in ((incident, light_azimuth), (reflection, camera_azimuth)):
        away = np.arcsin(np.abs(np.sin(zenith) * np.sin(azimuth)))
        faced.leaves_plane = max(faced.leaves_plane, float(away.max(initial=0.0)))
    return np.stack((lit, seen), axis=-1).astype(np.float32)


def _tangent(normal: Array) -> Array:
    """The direction of x on the surface; of y where the normal is x."""
    along_x = np.zeros_like(normal)
    along_x[..., 0] = 1.0
    steep = np.abs(normal[..., 0]) > 1 - 1e-12
    along_x[steep] = (0.0, 1.0, 0.0)
    on_surface = along_x - normal * (along_x * normal).sum(axis=-1, keepdims=True)
    tangent: Array = on_surface / np.linalg.norm(on_surface, axis=-1, keepdims=True)
    return tangent


def _towards(point: Vector, places: Array, distant: bool) -> Array:
    return np.broadcast_to(np.array(point), places.shape) - (0 if distant else places)


def _polar(normal: Array, tangent: Array, across: Array, to: Array) -> tuple[Array, Array]:
    """Zenith and azimuth of a direction; of both, arcs of tangents lose no digits anywhere."""
    x, y, z = ((to * axis).sum(axis=-1) for axis in (tangent, across, normal))
    zenith = np.where((to == 0).all(axis=-1), RIGHT, np.arctan2(np.hypot(x, y), z))
    return zenith, np.arctan2(y, x)
