"""The front of price and error, and figures that cannot be charted."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from brdfc.charts.points import Point, front
from brdfc.source.errors import BrdfcError

A_POINT = Point("forms", "a", 100.0, 6.0, 1.4, 4e-5, 24, "x", (), None, False)


def a_point(name: str, price: float, bits: float, **more: object) -> Point:
    return replace(A_POINT, name=name, price=price, bits=bits, **more)  # type: ignore[arg-type]


def names(points: tuple[Point, ...]) -> list[str]:
    return [p.name for p in points]


def test_the_front_is_what_nothing_beats_in_both() -> None:
    points = [
        a_point("dear", 300, 4),
        a_point("beaten", 200, 7),
        a_point("cheap", 100, 8),
        a_point("between", 150, 6),
    ]
    assert names(front(points, "bits")) == ["cheap", "between", "dear"]


def test_each_error_has_a_front_of_its_own() -> None:
    points = [a_point("cheap", 100, 8, de=1e-5), a_point("dear", 200, 4, de=1e-4)]
    assert names(front(points, "bits")) == ["cheap", "dear"]
    assert names(front(points, "de")) == ["cheap"]


def test_the_same_price_with_more_error_is_not_on_the_front() -> None:
    assert names(front([a_point("worse", 1, 9), a_point("better", 1, 8)], "bits")) == ["better"]


def test_the_same_error_for_more_is_not_on_the_front() -> None:
    assert names(front([a_point("dear", 2, 8), a_point("cheap", 1, 8)], "bits")) == ["cheap"]


def test_of_equals_the_chosen_then_the_simplest_then_the_first_stands() -> None:
    far = a_point("far", 1, 8, steps=("one", "two"))
    near = a_point("near", 1, 8, steps=("one",))
    late = a_point("late", 1, 8, steps=("two",))
    chosen = a_point("chosen", 1, 8, steps=("one", "two", "three"), chosen=True)
    assert names(front([far, near, late], "bits")) == ["near"]
    assert names(front([far, near, chosen], "bits")) == ["chosen"]


def test_one_point_is_its_own_front() -> None:
    assert front([A_POINT], "de") == (A_POINT,)
    assert front([], "de") == ()


@pytest.mark.parametrize("figure", ["price", "bits", "mean_bits", "de", "bound_bits"])
@pytest.mark.parametrize("value", [math.inf, -math.inf, math.nan, -1.0])
def test_figures_that_no_chart_can_show_are_refused(figure: str, value: float) -> None:
    with pytest.raises(BrdfcError, match=f"forms, a: {figure} = "):
        replace(A_POINT, **{figure: value})  # type: ignore[arg-type]


def test_a_price_of_nothing_is_refused() -> None:
    with pytest.raises(BrdfcError, match="takes time"):
        replace(A_POINT, price=0.0)
