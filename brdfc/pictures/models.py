"""A model as the subject of a picture: its formula in float64."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from brdfc.cmm.rendering import adapted_xyz
from brdfc.colour.conditions import ViewingConditions
from brdfc.colours import bands, colours_of
from brdfc.lang.load import load
from brdfc.laws.reflectance import in_full_geometry
from brdfc.pictures.sources import DIRECTIONS, XYZ, Array, Source
from brdfc.roles import assign_roles
from brdfc.source.errors import ValueGivenError
from brdfc.symbolic.constants import fold_constants
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.expression import Expression
from brdfc.symbolic.formula import formula


@dataclass(frozen=True)
class ModelSubject:
    """exact: the radiance; angles: the names of its angles that are left open."""

    label: str
    white: XYZ
    full: bool
    exact: Expression
    angles: tuple[str, ...]
    ranges: Mapping[str, tuple[float, float]]

    def colours(self, angles: Mapping[str, Array]) -> Array:
        given = {name: angles[name][:, None] for name in self.angles if name in angles}
        missing = [name for name in self.angles if name not in given]
        if missing:
            raise ValueGivenError(
                f"'{self.label}' has the angle '{missing[0]}', which this picture does not give",
                hint=f"fix it: with {missing[0]}=0deg",
            )
        count = len(next(iter(angles.values())))
        return np.broadcast_to(evaluate(self.exact, given), (count, 3))

    def adapted(self, xyz: Array, adapt: str | None, transform: str) -> tuple[Array, XYZ]:
        return adapted_xyz(xyz, self.white, adapt, transform)


def model_subject(
    source: Source,
    geometry: str | None,
    conditions: ViewingConditions | None,
    highlight: str | None,
    usual: str | None = None,
) -> ModelSubject:
    """The subject of a model: what a source gives no value for has its default, but directions.
    usual: the geometry of models that leave it open, where none is given."""
    model = load(source.reference, geometry)
    if geometry is None and usual is not None and model.geometry:
        model = load(source.reference, usual)
    if bands(model) != 3:
        raise ValueGivenError(
            f"'{model.name}' is a model of spectra",
            hint="compile it, and give the profile: its colours are under the profile's light",
        )
    colours = colours_of(model, conditions, highlight)
    known = {q.name for q in model.quantities}
    values = {name: text for name, text in source.values.items() if name in known}
    if set(values) != set(source.values):
        assign_roles(model, source.values, ())  # says which one, and what is near
    roles = assign_roles(model, values, (), colours.formula_white)
    quantities = (*roles.channels, *roles.variables)
    defaults = {q.name: q.default for q in quantities if q.name not in DIRECTIONS}
    ready = formula(model, {**roles.constants, **defaults}, colours.formula_white)
    if ready.width != 3:
        raise ValueGivenError(f"the radiance of '{model.name}' is no colour")
    left = [q for q in quantities if q.name in DIRECTIONS]
    return ModelSubject(
        source.label,
        colours.colorimetry.white,
        in_full_geometry(model),
        fold_constants(ready.exact),
        tuple(q.name for q in left),
        {q.name: (q.low, q.high) for q in left},
    )
