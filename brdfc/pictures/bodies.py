"""A lit sphere and a lit cylinder: the data of their pictures."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.images.directions import NAMES, Arrangement, Faced, angles, positions
from brdfc.pictures.sources import Array, Subject
from brdfc.source.errors import ValueGivenError

BODIES = ("sphere", "cylinder")
_ROOM = 2.3
"""Width of the picture, for a body of radius 1."""


@dataclass(frozen=True)
class Lit:
    """inside: the pixels that show the body; places: their x and y, where the body's radius is 1,
    (pixels, 2); xyz: their colours (pixels, 3)."""

    inside: NDArray[np.bool_]
    places: Array
    xyz: Array


def light_direction(incident: float, azimuth: float) -> tuple[float, float, float]:
    """Towards a light at an angle from the line of sight; azimuth: 0 from the right, 90 degrees
    from above. Radians."""
    across = math.sin(incident)
    return across * math.cos(azimuth), across * math.sin(azimuth), math.cos(incident)


def lit(
    subject: Subject, body: str, size: int, light: tuple[float, float, float], exposure: float
) -> Lit:
    """A body seen from far away along -z, under a distant light.

    body: of BODIES; the cylinder stands upright. A subject in the plane geometry can be a cylinder
    with a light beside it, where all directions are in one plane. Raises ValueGivenError.
    """
    if body not in BODIES:
        raise ValueGivenError(f"there is no body '{body}'", hint=" or ".join(BODIES))
    flat = abs(light[1]) < 1e-9 and body == "cylinder"
    if not (subject.full or flat):
        raise ValueGivenError(
            f"'{subject.label}' has its angles in one plane; a {body} has directions in space",
            hint="use --geometry full, of a model that imports geometry, or a cylinder with the "
            "light beside it (--azimuth 0deg)",
        )
    place = positions(0, size, size, size, _ROOM)
    x, y = place[..., 0], place[..., 1]
    if body == "sphere":
        inside = x * x + y * y < 1
        normal = np.dstack([x, y, np.sqrt(np.clip(1 - x * x - y * y, 0, None))])
    else:
        inside = (np.abs(x) < 1) & (np.abs(y) < 1)
        normal = np.dstack([x, np.zeros_like(x), np.sqrt(np.clip(1 - x * x, 0, None))])
    geometry = "full" if subject.full else "plane"
    scene = Arrangement(light, (0.0, 0.0, 1.0), geometry, distant=True)
    found = angles(normal[inside], place[inside], scene, Faced()).astype(np.float64)
    by_name = {name: found[:, i] for i, name in enumerate(NAMES[geometry])}
    return Lit(inside, place[inside][:, :2], exposure * subject.colours(by_name))
