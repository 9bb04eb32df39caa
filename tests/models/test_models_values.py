"""Every library model, in both geometries, against its textbook formula from unit vectors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from textbook import PRECISE, SIXTY_DIGITS, TEXTBOOK, directions, plane_directions

from brdfc.judge import strata
from brdfc.lang.load import library, load
from brdfc.lang.model import Model
from brdfc.prepared import prepare
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.formula import Formula
from brdfc.symbolic.precise import PreciseEvaluation

Array = NDArray[np.float64]
Values = dict[str, Array]

MODELS = [name for name, entry in library().items() if entry.kind == "model"]
GEOMETRIES = ["plane", "full"]
SHARE = 4
"""Points a share of the strata: some fifty for each model."""
VANISHING = 1e-100
"""Where a reflectance is 0, the textbook's (1 - l.h)^5 or (g - c)^2 leave powers of the last of its
60 digits."""


def drawn(model: Model, share: int, seed: int = 1) -> tuple[Formula, Values]:
    """A model's formula, and points of its domain where models live: lobe, grazing, tail, edges."""
    roles, ready = prepare(model, {}, (), cache=True)
    found = strata.points(ready.domain, roles.channels + roles.variables, share, seed)
    return ready, {name: v.astype(np.float64) for name, v in found.values.items()}


def textbook(name: str, geometry: str, point: Mapping[str, Any]) -> list[Any]:
    """The radiance that the textbook gives at a point, with 60 digits."""
    angles = ("incident", "reflection")
    turns = ("orientation",) if geometry == "plane" else ("incident_azimuth", "reflection_azimuth")
    at = [SIXTY_DIGITS.mpf(point.get(angle, 0)) for angle in (*angles, *turns)]
    where = (plane_directions if geometry == "plane" else directions)(PRECISE, *at)
    channels = {k: v for k, v in point.items() if k not in (*angles, *turns)}
    return list(TEXTBOOK[name](PRECISE, where, channels))


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("name", MODELS)
def test_a_model_is_its_textbook_formula(name: str, geometry: str) -> None:
    ready, values = drawn(load(name, geometry), SHARE)
    exact = PreciseEvaluation(ready.exact)
    compared = 0
    for i in range(len(next(iter(values.values())))):
        row = {n: v[i].tolist() for n, v in values.items()}
        point = {n: v[0] if len(v) == 1 else v for n, v in row.items()}
        try:
            expected = textbook(name, geometry, point)
        except ZeroDivisionError:
            continue  # where the textbook's form is 0/0 or x/0
        found = exact(row)
        for ours, theirs in zip(found, expected, strict=True):
            assert ours == pytest.approx(float(theirs), rel=1e-9, abs=VANISHING), point
        compared += 1
    assert compared > 20


@pytest.mark.parametrize("name", MODELS)
def test_the_plane_of_incidence_is_a_plane_of_the_full_geometry(name: str) -> None:
    plane, full = load(name), load(name, "full")
    ready, values = drawn(plane, 50)
    turn = values.pop("orientation", np.zeros_like(values["incident"]))
    beyond = np.pi * (values.get("reflection", turn) >= 0)
    around = {
        "incident_azimuth": turn + np.pi * (values["incident"] < 0),
        "reflection_azimuth": turn + beyond,
        **{n: np.abs(values[n]) for n in ("incident", "reflection") if n in values},
    }
    wanted = {q.name for q in full.quantities}
    flat = evaluate(ready.exact, {**values, "orientation": turn})
    deep = evaluate(
        prepare(full, {}, (), cache=True)[1].exact,
        {k: v for k, v in {**values, **around}.items() if k in wanted},
    )
    seen = flat > 1e-30
    np.testing.assert_allclose(deep[seen], flat[seen], rtol=1e-6)


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("name", MODELS)
def test_a_model_has_a_value_everywhere(name: str, geometry: str) -> None:
    """Finite in float64 at every point of the strata, and never below 0 but for rounding."""
    ready, points = drawn(load(name, geometry), 400, seed=3)
    values = evaluate(ready.prepared, points)
    assert np.isfinite(values).all()
    assert (values >= -1e-12).all()
