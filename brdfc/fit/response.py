"""A model's reflectance at measured directions, as a function of its coefficients.

The formula is the compiler's own, in the full geometry and in float64. What depends on directions
alone is computed once; derivatives come with the values. Coefficients that the reflectance is
linear in, such as Rd and ks, are found by looking at the derivatives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.lang.model import Model, Role
from brdfc.laws.reflectance import ANGLES, INCIDENT, in_full_geometry
from brdfc.source.errors import FitError
from brdfc.symbolic.constants import fold_constants
from brdfc.symbolic.derivative import derivative
from brdfc.symbolic.evaluate import Evaluation
from brdfc.symbolic.expression import Expression, make, quantity, walk
from brdfc.symbolic.formula import NO_WHITE, formula

Array = NDArray[np.float64]

DECADES = 50.0
"""A positive coefficient whose greatest value is so many times its least is searched by its
logarithm."""


@dataclass(frozen=True)
class Coefficient:
    """One number to be found: a component of a channel of the model, within its declared range.
    linear: the reflectance is linear in it and all others that are; logarithmic: it is searched by
    its logarithm."""

    name: str
    quantity: str
    index: int
    low: float
    high: float
    default: float
    linear: bool
    logarithmic: bool


class Response:
    """The BRDF [1/sr] of a model in the full geometry at directions.

    directions: (n, 4), radians, in the order of laws.reflectance.ANGLES. fixed: quantities that are
    not fitted, a number a component. white: that colours are relative to. Raises FitError for a
    model that has no full geometry, or nothing to fit.
    """

    def __init__(
        self,
        model: Model,
        directions: Array,
        fixed: Mapping[str, Sequence[float]] = {},
        white: Sequence[float] = NO_WHITE,
    ) -> None:
        if not in_full_geometry(model):
            raise FitError(
                f"'{model.name}' has no zeniths and azimuths",
                hint="load it in the full geometry",
            )
        given = {name: tuple(map(float, values)) for name, values in fixed.items()}
        exact = fold_constants(formula(model, given, white).exact)
        reflectance = make("div", exact, make("cos", quantity(INCIDENT, 1)))
        read = {e.name for e in walk(reflectance) if e.operator == "quantity"}
        wanted = [
            (q, index)
            for q in model.quantities
            if q.role is Role.CHANNEL and q.name in read
            for index in range(q.type.value.width)
        ]
        if not wanted:
            raise FitError(f"'{model.name}' has no coefficient left to fit")
        slopes = [derivative(reflectance, q.name, index) for q, index in wanted]
        linear = _linear([q.name for q, _ in wanted], slopes)
        self.model, self.white, self.reflectance = model, tuple(white), reflectance
        # A colour's component is that share of the white's, which the model declares the range of.
        share = [white[index] if q.type.is_colour else 1.0 for q, index in wanted]
        self.coefficients = tuple(
            Coefficient(
                q.component_names[index],
                q.name,
                index,
                q.low * part,
                q.high * part,
                q.default[index] * part,
                q.name in linear,
                q.name not in linear and q.low > 0 and q.high / q.low >= DECADES,
            )
            for (q, index), part in zip(wanted, share, strict=True)
        )
        self.width = reflectance.width
        points = {name: directions[:, k : k + 1] for k, name in enumerate(ANGLES)}
        self.count = len(directions)
        self._values = Evaluation([reflectance], points)
        self._slopes = Evaluation([reflectance, *slopes], points)

    def values(self, found: Array) -> Array:
        """(..., n, width) for coefficients (..., p)."""
        (values,) = self._values(self._named(found))
        return self._whole(values, found)

    def slopes(self, found: Array) -> tuple[Array, Array]:
        """The same, and (..., n, width, p): by each coefficient."""
        values, *parts = self._slopes(self._named(found))
        return (
            self._whole(values, found),
            np.stack([self._whole(part, found) for part in parts], axis=-1),
        )

    def parts(self, found: Array) -> tuple[Array, list[Array]]:
        """The same, each slope an array of its own that broadcasts to (..., n, width): what does
        not depend on the coefficients, or on the component, is there once."""
        values, *slopes = self._slopes(self._named(found))
        return _defined(values), [_defined(slope) for slope in slopes]

    def _named(self, found: Array) -> dict[str, Array]:
        """Arrays (..., 1, components) by the names of quantities."""
        columns: dict[str, list[int]] = {}
        for place, coefficient in enumerate(self.coefficients):
            columns.setdefault(coefficient.quantity, []).append(place)
        return {name: found[..., None, places] for name, places in columns.items()}

    def _whole(self, values: Array, found: Array) -> Array:
        """Broadcast, and defined."""
        shape = (*found.shape[:-1], self.count, self.width)
        return _defined(np.array(np.broadcast_to(values, shape)))


def _defined(values: Array) -> Array:
    """What the formula leaves undefined is 0."""
    if np.isfinite(values).all():
        return values
    return np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)


def _linear(names: Sequence[str], slopes: Sequence[Expression]) -> set[str]:
    """Quantities that the reflectance is linear in together: whose derivatives depend on none of
    them."""
    read = {name: set[str]() for name in names}
    for name, slope in zip(names, slopes, strict=True):
        read[name] |= {e.name for e in walk(slope) if e.operator == "quantity"}
    found: set[str] = set()
    for name in read:
        if (
            name not in read[name]
            and not read[name] & found
            and not any(name in read[other] for other in found)
        ):
            found.add(name)
    return found
