"""Expressions spelled out whole, and SymPy's proposals."""

from __future__ import annotations

import pytest

import brdfc
from brdfc.forms.texts import pattern
from brdfc.prepared import prepare
from brdfc.symbolic.evaluate import evaluate_precisely
from brdfc.symbolic.expression import make, quantity
from brdfc.symbolic.spelling import spelled
from brdfc.symbolic.sympy_forms import proposals


def test_shared_parts_are_named_once() -> None:
    a = quantity("a", 1)
    cosine = make("cos", a)
    assert spelled(make("add", cosine, make("mul", cosine, a))) == "t1 = cos(a); t1 + (t1 * a)"


def test_the_text_grows_with_the_graph() -> None:
    e = quantity("a", 1)
    for _ in range(40):
        e = make("mul", e, make("sin", e))
    assert len(spelled(e)) < 2000


@pytest.mark.parametrize("name", ["ward", "cook_torrance"])
def test_nothing_is_left_out(name: str) -> None:
    _, formula = prepare(brdfc.load(name), {}, ())
    assert "..." not in spelled(formula.simple)


@pytest.mark.parametrize(
    "text",
    [
        "1/cos(x)^2 - 1",
        "sin(x)^2 + cos(x)^2 + a",
        "tan(x)^2*a",
        "exp(a)*exp(x)/b",
        "ln(exp(a)) + b/3",
    ],
)
def test_sympys_proposals_keep_the_value(text: str) -> None:
    e = pattern(text)
    values = {"x": (0.7,), "a": (0.3,), "b": (1.9,)}
    found = list(proposals(e))
    assert found
    for _, part, replacement in found:
        before = evaluate_precisely(part, values)[0]
        assert evaluate_precisely(replacement, values)[0] == pytest.approx(before, rel=1e-13)
