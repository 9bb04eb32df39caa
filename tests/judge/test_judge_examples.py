"""Examples in a model file are checked; those that do not hold are shown in place."""

from __future__ import annotations

import pytest

from brdfc import load
from brdfc.judge.examples import check_examples
from brdfc.lang.load import library, load_text
from brdfc.lang.model import Model
from brdfc.source.errors import ModelError

TEXT = """model t "T"
channel x : number in 0..100 = 1
env p : angle in -90deg..90deg = 0deg as angp
constant k : number in 0..10 = 2
radiance = (k*x, cos(p), 1/x)
"""


def examples(lines: str) -> Model:
    model = load_text(TEXT + lines, "t.brdf")
    assert isinstance(model, Model)
    return model


def test_examples_that_hold_are_counted() -> None:
    model = examples("example x=4 p=60deg k=3 -> (12, 0.5, 0.25)\nexample -> (2, 1, 1)\n")
    assert check_examples(model) == 2


def test_a_right_angle_is_exact() -> None:
    assert check_examples(examples("example p=90deg -> (2, 0, 1)\n")) == 1


def test_every_example_that_does_not_hold_is_shown_with_a_caret() -> None:
    model = examples(
        "example x=4 -> (8, 1, 0.25)\n"
        "example x=4 -> (9, 1, 0.25)\n"
        "example -> (2, 1, 1.1) within 1e-3\n"
    )
    with pytest.raises(ModelError) as caught:
        check_examples(model)
    assert len(caught.value.diagnostics) == 2
    shown = str(caught.value)
    assert "t.brdf:7:" in shown
    assert "t.brdf:8:" in shown
    assert "^^^" in shown
    assert "(8, 1, 0.25)" in shown


def test_within_says_how_near() -> None:
    assert check_examples(examples("example x=3 -> (6, 1, 0.3333) within 1e-3\n")) == 1
    with pytest.raises(ModelError):
        check_examples(examples("example x=3 -> (6, 1, 0.3333) within 1e-5\n"))


def test_an_example_without_a_value_does_not_hold() -> None:
    with pytest.raises(ModelError, match="no value"):
        check_examples(examples("example x=0 -> (0, 1, 0)\n"))


@pytest.mark.parametrize("name", [n for n, entry in library().items() if entry.kind == "model"])
def test_the_library_holds(name: str) -> None:
    assert check_examples(load(name)) >= 3
    assert check_examples(load(name, "full")) >= 1
