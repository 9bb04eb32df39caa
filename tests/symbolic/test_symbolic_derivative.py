"""Derivatives against differences, for every coefficient of every model of the library."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from brdfc.lang.load import load
from brdfc.laws.reflectance import Reflectance
from brdfc.source.errors import BrdfcError
from brdfc.symbolic.derivative import derivative
from brdfc.symbolic.evaluate import Evaluation, evaluate
from brdfc.symbolic.expression import ONE, ZERO, const, make, quantity, vector

MODELS = sorted(p.stem for p in (Path(__file__).parents[2] / "models").glob("*.brdf"))
X = quantity("x", 1)


def reflectance(name: str) -> Reflectance:
    try:
        return Reflectance(load(name, "full"))
    except BrdfcError:
        pytest.skip("a library of functions, no model")


@pytest.mark.parametrize("name", MODELS)
def test_every_coefficient_of_every_model(name: str) -> None:
    model = reflectance(name)
    random = np.random.default_rng(1)
    points = {
        "incident": random.uniform(0, 1.4, (200, 1)),
        "reflection": random.uniform(0, 1.4, (200, 1)),
        "incident_azimuth": np.zeros((200, 1)),
        "reflection_azimuth": random.uniform(-3, 3, (200, 1)),
        "intensity": np.ones((1, 1)),
    }
    inside = 0.37  # of the ranges, away from their ends and from kinks
    for q in model.parameters:
        points[q.name] = np.full((1, q.type.value.width), q.low + inside * (q.high - q.low))
    for q in model.parameters:
        for index in range(q.type.value.width):
            found = evaluate(derivative(model._quick, q.name, index), points)
            step = 1e-6 * (q.high - q.low)
            ends = []
            for side in (1, -1):
                moved = points[q.name].copy()
                moved[0, index] += side * step
                ends.append(model.radiance({**points, q.name: moved}))
            expected = (ends[0] - ends[1]) / (2 * step)
            size = np.abs(expected).max() + 1e-9
            assert found.shape[1] in (1, expected.shape[1])
            assert np.abs(found - expected).max() < 2e-5 * size


def test_what_does_not_change_is_zero() -> None:
    assert derivative(make("add", const(3), quantity("y", 1)), "x") is ZERO
    assert derivative(make("floor", X), "x") is ZERO
    assert derivative(X, "x") is ONE


def test_kinks_and_components() -> None:
    at = {"x": np.array([[-2.0], [0.5]]), "v": np.array([[1.0, 2.0, 3.0]])}
    size = derivative(make("abs", X), "x")
    assert evaluate(size, at).ravel().tolist() == [-1, 1]
    least = derivative(make("min", X, const(0)), "x")
    assert evaluate(least, at).ravel().tolist() == [1, 0]
    chosen = make("where", make("lt", X, const(0)), make("mul", X, X), X)
    assert evaluate(derivative(chosen, "x"), at).ravel().tolist() == [-4, 1]
    both = vector([make("mul", X, X), X])
    assert evaluate(derivative(both, "x"), at).tolist() == [[-4, 1], [1, 1]]
    colour = make("mul", quantity("v", 3), X)
    assert evaluate(derivative(colour, "v", 1), at).tolist() == [[0, -2, 0], [0, 0.5, 0]]


def test_powers_at_zero() -> None:
    """The derivative of x^2 at 0 is 0, not 0/0."""
    square = derivative(make("pow", X, const(2)), "x")
    assert evaluate(square, {"x": np.array([[0.0]])}).tolist() == [[0.0]]


def test_the_same_points_again_and_again() -> None:
    model = reflectance("ward")
    random = np.random.default_rng(2)
    points = {
        "incident": random.uniform(0, 1.4, (50, 1)),
        "reflection": random.uniform(0, 1.4, (50, 1)),
        "incident_azimuth": np.zeros((50, 1)),
        "reflection_azimuth": random.uniform(-3, 3, (50, 1)),
        "intensity": np.ones((1, 1)),
    }
    again = Evaluation([model._quick, derivative(model._quick, "m")], points)
    for m in (0.1, 0.3):
        values = {"m": np.array([[m]]), "ks": np.array([[0.2]]), "Rd": np.full((1, 3), 0.5)}
        found, slope = again(values)
        np.testing.assert_array_equal(found, model.radiance({**points, **values}))
        assert slope.shape == (50, 1)
    several = again(
        {"m": np.full((4, 1, 1), 0.2), "ks": np.full((4, 1, 1), 0.1), "Rd": np.ones((4, 1, 3))}
    )
    assert several[0].shape == (4, 50, 3)
