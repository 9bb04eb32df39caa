"""A model in the full geometry as a BRDF: radiance over irradiance, on arrays or precisely."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from brdfc.lang.model import Model, Quantity
from brdfc.symbolic.build import build
from brdfc.symbolic.constants import fold_constants
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.expression import walk
from brdfc.symbolic.precise import PreciseEvaluation

Array = NDArray[np.float64]
Values = Mapping[str, Array]
"""An array (..., components) for every quantity by its name, angles in radians."""

INCIDENT, REFLECTION = "incident", "reflection"
INCIDENT_AZIMUTH, REFLECTION_AZIMUTH = "incident_azimuth", "reflection_azimuth"
ANGLES = (INCIDENT, REFLECTION, INCIDENT_AZIMUTH, REFLECTION_AZIMUTH)
INTENSITY = "intensity"

RIGHT = math.pi / 2
_WHOLE = {
    INCIDENT: (0.0, RIGHT),
    REFLECTION: (0.0, RIGHT),
    INCIDENT_AZIMUTH: (-math.pi, math.pi),
    REFLECTION_AZIMUTH: (-math.pi, math.pi),
}
_MIRRORED = {
    INCIDENT: REFLECTION,
    REFLECTION: INCIDENT,
    INCIDENT_AZIMUTH: REFLECTION_AZIMUTH,
    REFLECTION_AZIMUTH: INCIDENT_AZIMUTH,
}


def in_full_geometry(model: Model) -> bool:
    """Whether a model's directions are zeniths, not signed angles in the plane of incidence."""
    zeniths = [q for q in model.quantities if q.name in (INCIDENT, REFLECTION)]
    return bool(zeniths) and all(q.type.is_angle and q.low >= 0 for q in zeniths)


class Reflectance:
    """The BRDF f of a model in the full geometry (see in_full_geometry).

    parameters: all quantities but the four angles and the intensity, constants too; limits: low
    and high of the four angles, those the model lacks over the whole hemisphere.
    """

    def __init__(self, model: Model) -> None:
        self._exact = build(model.radiance, {}, free=True)
        self._quick = fold_constants(self._exact)
        self._precise = PreciseEvaluation(self._exact)
        self._used = {e.name for e in walk(self._exact) if e.operator == "quantity"}
        known = {q.name: q for q in model.quantities}
        self.parameters: tuple[Quantity, ...] = tuple(
            q for q in model.quantities if q.name not in ANGLES and q.name != INTENSITY
        )
        self.directions = tuple(name for name in ANGLES if name in known)
        angular = (q.name for q in self.parameters if q.type.is_angle)
        self.angular = frozenset((*ANGLES, *angular))
        self.limits = {
            name: (known[name].low, known[name].high) if name in known else whole
            for name, whole in _WHOLE.items()
        }
        self._intensity = known[INTENSITY].default if INTENSITY in known else (1.0,)

    @cached_property
    def isotropic(self) -> bool:
        """Whether turning light and viewer together about the normal changes nothing."""
        random = np.random.Generator(np.random.PCG64(1))
        limits = {q.name: (q.low, q.high, q.type.value.width) for q in self.parameters}
        limits |= {name: (*self.limits[name], 1) for name in ANGLES}
        values = {n: random.uniform(lo, hi, (256, w)) for n, (lo, hi, w) in limits.items()}
        turned = {n: values[n] + 1.0 for n in (INCIDENT_AZIMUTH, REFLECTION_AZIMUTH)}
        before, after = self(values), self({**values, **turned})
        return bool(np.allclose(before, after, rtol=1e-6, atol=0, equal_nan=True))

    @property
    def width(self) -> int:
        """Components of the result: 3 for XYZ."""
        return self._exact.width

    def radiance(self, values: Values) -> Array:
        """The model's radiance (..., width). values: every quantity; an angle that the model
        lacks does not matter, an absent intensity has its default."""
        given = {INTENSITY: np.array(self._intensity), **values}
        return evaluate(self._quick, {name: given[name] for name in sorted(self._used)})

    def __call__(self, values: Values) -> Array:
        """f (..., width) in 1/sr: radiance over intensity times the cosine of incidence."""
        lit = values.get(INTENSITY, np.array(self._intensity)) * np.cos(values[INCIDENT])
        with np.errstate(all="ignore"):
            return np.asarray(self.radiance(values) / lit)

    def precise_radiance(self, point: Mapping[str, Sequence[float]]) -> tuple[float, ...]:
        """The radiance at one point in high precision; NaN where it is undefined."""
        return self._precise({INTENSITY: self._intensity, **point})

    def precise(self, point: Mapping[str, Sequence[float]]) -> tuple[float, ...]:
        """f at one point in high precision; NaN where it is undefined."""
        (intensity,) = point.get(INTENSITY, self._intensity)
        lit = intensity * math.cos(point[INCIDENT][0])
        return tuple(value / lit for value in self.precise_radiance(point))


def reversed_path(values: Mapping[str, Array]) -> dict[str, Array]:
    """The same with light and viewer exchanged."""
    return {**values, **{name: values[other] for name, other in _MIRRORED.items()}}


def reversed_point(point: Mapping[str, tuple[float, ...]]) -> dict[str, tuple[float, ...]]:
    """The same for one point."""
    return {**point, **{name: point[other] for name, other in _MIRRORED.items()}}
