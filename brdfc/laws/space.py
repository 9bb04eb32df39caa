"""The domain of a model as a unit cube, stretched to where models misbehave.

Ranges over decades go by decades, and zeniths beyond the middle by decades of what is left to the
right angle. A law may be claimed under a condition on the quantities (Rd + ks <= 1): a point that
breaks it is drawn back onto the condition's border, where laws are broken first.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.laws.reflectance import INCIDENT, INCIDENT_AZIMUTH, Array, Reflectance, Values
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.expression import Expression, walk

_HALVINGS = 30
_DECADES = 30
"""A positive range whose ends are further apart than this factor is taken by decades."""


@dataclass(frozen=True)
class Coordinate:
    """One axis of the cube: a component of a quantity, or of none where name is "".

    grazing: how near to the right angle a zenith comes, in radians; 0 for what is no zenith.
    """

    name: str
    low: float
    high: float
    default: float = 0.5
    grazing: float = 0.0

    def value(self, x: Array) -> Array:
        """The quantity's value at 0..1."""
        low, high = self.low, self.high
        if self.grazing:
            high = min(high, math.pi / 2 - self.grazing)
            middle = (low + high) / 2
            end, start = math.pi / 2 - high, math.pi / 2 - middle
            near = math.pi / 2 - np.exp(
                math.log(start) + (math.log(end) - math.log(start)) * (2 * x - 1)
            )
            found = np.where(x < 0.5, low + 2 * x * (middle - low), near)
        elif low > 0 and high / low > _DECADES:
            found = np.exp(math.log(low) + x * (math.log(high) - math.log(low)))
        else:
            found = low + x * (high - low)
        return np.clip(found, low, high)

    def unit(self, value: float) -> float:
        """Where in 0..1 the quantity has a value; not for zeniths."""
        low, high = self.low, self.high
        if low == high:
            return 0.0
        if low > 0 and high / low > _DECADES:
            return math.log(value / low) / math.log(high / low)
        return (value - low) / (high - low)


class Space:
    """The cube of a model's parameters and its incident direction, and of further coordinates.

    grazing: how near the right angle an incidence comes, in radians. further: axes without a
    quantity, in 0..1, for whoever asks. condition: what has to be true of a point.
    """

    def __init__(
        self,
        reflectance: Reflectance,
        grazing: float,
        further: int = 0,
        condition: Expression | None = None,
    ) -> None:
        axes = [
            Coordinate(q.name, q.low, q.high, default)
            for q in reflectance.parameters
            for default in q.default
        ]
        self.parameters = len(axes)
        axes.append(Coordinate(INCIDENT, *reflectance.limits[INCIDENT], grazing=grazing))
        if INCIDENT_AZIMUTH in reflectance.directions:
            axes.append(Coordinate(INCIDENT_AZIMUTH, *reflectance.limits[INCIDENT_AZIMUTH]))
        self.named = len(axes)
        self.axes = (*axes, *(Coordinate("", 0.0, 1.0) for _ in range(further)))
        self.defaults = np.array([a.unit(a.default) for a in axes[: self.parameters]])
        self._condition = condition
        self._about = {e.name for e in walk(condition) if e.name} if condition else set()

    @property
    def dimensions(self) -> int:
        return len(self.axes)

    def columns(self, name: str) -> list[int]:
        """The axes of a quantity's components."""
        return [i for i, axis in enumerate(self.axes) if axis.name == name]

    def values(self, x: Array) -> dict[str, Array]:
        """The quantities (points, components) at points of the cube (points, dimensions)."""
        columns: dict[str, list[Array]] = {}
        for i, axis in enumerate(self.axes[: self.named]):
            columns.setdefault(axis.name, []).append(axis.value(x[:, i]))
        found = {name: np.stack(parts, axis=-1) for name, parts in columns.items()}
        found.setdefault(INCIDENT_AZIMUTH, np.zeros((len(x), 1)))
        return found

    def allows(self, values: Values) -> NDArray[np.bool_]:
        """Whether the condition holds (points,), in every component."""
        count = len(values[INCIDENT])
        if self._condition is None:
            return np.ones(count, dtype=bool)
        truth = evaluate(self._condition, {name: values[name] for name in self._about})
        return np.broadcast_to(truth.astype(bool).all(axis=-1), (count,))

    def drawn_back(self, x: Array) -> Array:
        """The points, those that the condition forbids moved straight towards the defaults of
        the parameters it is about, up to its border."""
        if self._condition is None:
            return x
        forbidden = np.nonzero(~self.allows(self.values(x)))[0]
        about = [i for i in range(self.parameters) if self.axes[i].name in self._about]
        good, bad = x[forbidden].copy(), x[forbidden]
        good[:, about] = self.defaults[about]
        for _ in range(_HALVINGS):
            middle = (good + bad) / 2
            allowed = self.allows(self.values(middle))[:, None]
            good, bad = np.where(allowed, middle, good), np.where(allowed, bad, middle)
        result = x.copy()
        result[forbidden] = good
        return result
