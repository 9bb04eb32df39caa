"""Whether a law that a model says it breaks is broken as far as it says."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from brdfc.laws.albedo import TOLERANCE, albedos
from brdfc.laws.claims import Claim, Point
from brdfc.laws.measures import measure
from brdfc.laws.reflectance import (
    INCIDENT,
    INCIDENT_AZIMUTH,
    REFLECTION,
    REFLECTION_AZIMUTH,
    Reflectance,
)

_ABSENT = {INCIDENT: 0.0, REFLECTION: 0.0, INCIDENT_AZIMUTH: 0.0, REFLECTION_AZIMUTH: math.pi}
"""Directions that a model has no quantity for, and that it does not depend on."""
_FINEST = 1e-7


@dataclass(frozen=True)
class Reproduced:
    """figure: what is there; agrees: whether that is the stated figure; breaks: whether it breaks
    the law at all."""

    figure: float
    agrees: bool
    breaks: bool


def reproduce(
    reflectance: Reflectance, claim: Claim, given: Point, stated: float, within: float
) -> Reproduced:
    """A law's figure at one point: the albedo (energy), f (bounded), the relative difference of
    both ways (reciprocal) or the least radiance (positive), each of the component it is worst in.

    given: the value of every quantity of the model. within: the relative difference allowed.
    Raises ValueError for a law that has no figure at a point.
    """
    point = {**{name: (value,) for name, value in _ABSENT.items()}, **given}
    if claim.name == "energy":
        assert claim.bound is not None
        values = {name: np.array([value]) for name, value in point.items()}
        tolerance = max(_FINEST, min(TOLERANCE, within / 4))
        figure = float(albedos(reflectance, values, tolerance).value[0])
        broken = not figure <= claim.bound + TOLERANCE
    else:
        seen = measure(reflectance, claim)
        figure = seen.figure(point)
        broken = seen.breaks(figure)
    return Reproduced(figure, math.isclose(figure, stated, rel_tol=within), broken)
