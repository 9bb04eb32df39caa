"""A formula under a white: the same reflectances, seen as colours."""

from __future__ import annotations

import numpy as np
import pytest

from brdfc.lang.load import library, load, load_text
from brdfc.lang.model import Model
from brdfc.symbolic.build import build
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.expression import describe, walk
from brdfc.symbolic.formula import NO_WHITE, formula

MODELS = [name for name, entry in library().items() if entry.kind == "model"]
WHITE = (0.97, 1.0, 0.484)


def points(model: Model, count: int = 200) -> dict[str, np.ndarray]:
    random = np.random.default_rng(5)
    return {
        q.name: random.uniform(q.low, q.high, (count, q.type.value.width))
        for q in model.quantities
        if q.role.value != "constant"
    }


@pytest.mark.parametrize("name", MODELS)
def test_colours_are_reflectances_times_the_white(name: str) -> None:
    model = load(name)
    at = points(model)
    plain = formula(model, {}).exact
    colours = {q.name for q in model.quantities if q.type.is_colour}
    seen = {n: v * WHITE if n in colours else v for n, v in at.items()}
    expected = evaluate(plain, at) * WHITE
    found = evaluate(formula(model, {}, WHITE).exact, seen)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-300)


@pytest.mark.parametrize("name", MODELS)
def test_a_fixed_colour_is_under_the_white_too(name: str) -> None:
    model = load(name)
    colours = [q for q in model.quantities if q.type.is_colour]
    fixed = {q.name: (0.1, 0.2, 0.05) for q in colours}
    at = points(model, 20)
    left = {n: v for n, v in at.items() if n not in fixed}
    whole = {**at, **{n: np.array([v]) for n, v in fixed.items()}}
    expected = evaluate(formula(model, {}, WHITE).exact, whole)
    found = evaluate(formula(model, fixed, WHITE).exact, left)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-300)


def test_no_white_changes_nothing() -> None:
    model = load("ward")
    assert formula(model, {}, NO_WHITE).exact is build(model.radiance, {})


def test_where_a_colour_is_only_scaled_and_added_it_stays_as_it_is() -> None:
    """No division by the white, and no multiplication: `Rd/pi + s W` is what a hand would write."""
    exact = formula(load("ward"), {}, WHITE).exact
    divisors = [e.arguments[1] for e in walk(exact) if e.operator == "div"]
    assert not any(e.operator == "vector" for e in divisors)
    assert "min(" not in describe(exact, 50).replace("min(cos", "")


def test_bands_are_no_colours() -> None:
    model = load_text(
        'model m "K/S of three bands"\nchannel KS : bands in 0..10 = 1\nradiance = 1/(1 + KS)\n'
    )
    assert isinstance(model, Model)
    at = {"KS": np.array([[1.0, 2.0, 4.0]])}
    found = evaluate(formula(model, {}, WHITE).exact, at)
    np.testing.assert_allclose(found[0], np.array([1 / 2, 1 / 3, 1 / 5]) * WHITE)


def test_more_than_the_white_is_taken_as_the_most_a_model_is_declared_for() -> None:
    """1 - sqrt(1 - Rd) has no value beyond a reflectance of 1."""
    model = load_text(
        'model m "not linear"\nchannel Rd : XYZ in 0..1 = 0.5\nradiance = 1 - sqrt(1 - Rd)\n'
    )
    assert isinstance(model, Model)
    found = evaluate(formula(model, {}, WHITE).exact, {"Rd": np.array([[0.97, 1.0, 1.0]])})
    np.testing.assert_allclose(found[0], WHITE)


def test_ranges_and_defaults_are_shares_of_the_white() -> None:
    quantity = load("ward").quantity("Rd")
    assert quantity is not None
    under = quantity.under((1.1, 1.0, 0.35))
    assert (under.low, under.high) == (0.0, 1.1)
    assert under.default == pytest.approx((0.55, 0.5, 0.175))
    other = load("ward").quantity("ks")
    assert other is not None
    assert other.under((1.1, 1.0, 0.35)) is other
