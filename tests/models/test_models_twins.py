"""The library's models as textbooks write them: other forms of the same formulas.

In high precision they have the library's values; `brdfc stability` shows what they lose in float32.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from brdfc.judge import strata
from brdfc.judge.rival import as_written
from brdfc.lang.load import library, load, textbook_form
from brdfc.lang.model import Model
from brdfc.prepared import prepare, problem_of
from brdfc.symbolic.formula import formula
from brdfc.symbolic.precise import PreciseEvaluation

MODELS = [name for name, entry in library().items() if entry.kind == "model"]
GEOMETRIES = ["plane", "full"]
SHARE = 3
"""Points a share of the strata: some forty for each model."""
VANISHING = 1e-30
"""Beneath it a factor like (1 - l.h)^5 or (g - c)^2 has none of its 40 digits in such forms."""


def twins(name: str, geometry: str) -> tuple[Model, Model]:
    """A library model, and its textbook form."""
    written = textbook_form(name, geometry)
    assert written is not None, f"models/textbook has no {name}"
    return load(name, geometry), written


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("name", MODELS)
def test_a_textbook_form_has_the_quantities_of_its_model(name: str, geometry: str) -> None:
    ours, theirs = (
        {(q.name, q.role, q.type.name, q.low, q.high, q.default) for q in model.quantities}
        for model in twins(name, geometry)
    )
    assert ours == theirs


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("name", MODELS)
def test_a_textbook_form_has_the_values_of_its_model(name: str, geometry: str) -> None:
    """To 9 digits, wherever it has one: at the normal, say, some divide 0 by 0."""
    model, twin = twins(name, geometry)
    roles, ready = prepare(model, {}, (), cache=True)
    precise = PreciseEvaluation(ready.exact)
    written = PreciseEvaluation(formula(twin, roles.constants).exact)
    drawn = strata.points(ready.domain, roles.channels + roles.variables, SHARE)
    undefined = 0
    for i in range(drawn.count):
        point = {n: v[i].astype(np.float64).tolist() for n, v in drawn.values.items()}
        theirs = written(point)
        if any(math.isnan(value) for value in theirs):
            undefined += 1
            continue
        ours = precise(point)
        assert theirs == pytest.approx(ours, rel=1e-9, abs=VANISHING), point
    assert undefined <= drawn.count / 3


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_a_textbook_form_can_stand_beside_its_model(geometry: str) -> None:
    """As a program, operator by operator, for a report."""
    model, twin = twins("ggx", geometry)
    roles, ready = prepare(model, {}, (), cache=True)
    program = as_written(twin, problem_of(roles, ready), roles.constants)
    assert program.outputs == 3


def test_textbook_forms_are_of_library_models() -> None:
    """Nothing there that no report would show."""
    folder = library()["ward"].path.parent / "textbook"
    shared = {"facets", "vectors", "vectors_anisotropic"}
    assert {path.stem for path in folder.glob("*.brdf")} == shared | set(MODELS)
