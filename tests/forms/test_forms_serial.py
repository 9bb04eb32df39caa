"""Expressions to data and back."""

from __future__ import annotations

import json

import pytest

import brdfc
from brdfc.symbolic.build import build
from brdfc.symbolic.serial import from_data, to_data


@pytest.mark.parametrize("name", ["lambert", "ward", "cook_torrance"])
def test_an_expression_comes_back_as_the_same_object(name: str) -> None:
    e = build(brdfc.load(name).radiance, {})
    assert from_data(json.loads(json.dumps(to_data(e)))) is e


@pytest.mark.parametrize("rows", [[], [["add", [0, 1], None]], [["const", [], None]], [[]], [1]])
def test_data_that_is_no_expression_is_refused(rows: list[object]) -> None:
    with pytest.raises((KeyError, IndexError, TypeError, ValueError)):
        from_data(rows)  # type: ignore[arg-type]
