"""Where a search for forms may fail: rules applied where they do not hold, and no end."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from brdfc.forms.neighbours import Neighbours, places
from brdfc.forms.products import factors, product
from brdfc.forms.search import Form, Found, Score, search
from brdfc.forms.texts import pattern
from brdfc.symbolic.expression import Expression, make, quantity
from brdfc.symbolic.intervals import Interval, single
from brdfc.symbolic.ranges import Ranges


def ranges(**domain: tuple[float, float]) -> Ranges:
    return Ranges({name: Interval(single(a), single(b)) for name, (a, b) in domain.items()})


def near(text: str, **domain: tuple[float, float]) -> set[str]:
    """The forms one step away."""
    return {str(form) for _, form in Neighbours(ranges(**domain)).of(pattern(text))}


@pytest.mark.parametrize(
    ("text", "form", "holds", "fails"),
    [
        ("sqrt(x^2)", "x", (0, 1), (-1, 1)),
        ("acos(cos(x))", "x", (0, 3.14), (0, 6.28)),
        ("x*y/x", "y", (0.5, 1), (0, 1)),
        ("exp(ln(x))", "x", (0.5, 1), (-1, 1)),
        ("sqrt(x)*sqrt(y)", "sqrt((x * y))", (0, 1), (-1, 1)),
        ("min(x*y, x*z)", "(x * min(y, z))", (0, 1), (-1, 1)),
    ],
)
def test_a_rule_is_applied_only_where_the_ranges_prove_it(
    text: str, form: str, holds: tuple[float, float], fails: tuple[float, float]
) -> None:
    others = {"y": (0.0, 1.0), "z": (0.0, 1.0)}
    assert form in near(text, x=holds, **others)
    assert form not in near(text, x=fails, **others)


def test_a_condition_proves_what_holds_in_its_branch_only() -> None:
    inside = pattern("sqrt(x^2) where x > 0 else 2")
    assert "(x where (x > 0) else 2)" in near("sqrt(x^2) where x > 0 else 2", x=(-1, 1))
    (root,) = [(e, at) for e, at in places(inside, ranges(x=(-1, 1))) if e.operator == "sqrt"]
    assert root[1].of(quantity("x", 1)).low >= 0


def test_a_part_in_two_branches_is_known_by_neither() -> None:
    both = "sqrt(x^2) where x > 0 else 1 + sqrt(x^2)"
    assert not any("(x where" in form or "+ x" in form for form in near(both, x=(-1, 1)))


def test_a_part_of_a_product_elsewhere_counts_as_a_place_of_the_part() -> None:
    # x*y stands alone where x > 0, and inside a product where it is not known.
    whole = pattern("(x*y where x > 0 else 1) + (x*y)*z")
    known = dict(places(whole, ranges(x=(-1, 1), y=(0, 1), z=(0, 1))))
    assert known[pattern("x*y")].of(quantity("x", 1)).low == -1


def test_a_form_brings_in_no_pole() -> None:
    tangent = "tan((x - y)/2)"
    forms = near(tangent, x=(0, 1.5), y=(0, 1.5))
    assert any("(sin(x) - sin(y))" in form for form in forms)
    # Where x + y may be pi, that quotient is 0/0 and the tangent is not.
    assert not any("(sin(x) - sin(y))" in f for f in near(tangent, x=(0, 2), y=(0, 2)))


def test_products_of_products_take_no_exponential_time(
    function_calls: Callable[[Callable[[], object]], int],
) -> None:
    e = quantity("x", 1)
    for _ in range(200):
        e = make("div", make("mul", e, quantity("y", 1)), make("mul", e, quantity("z", 1)))

    def take_apart() -> None:
        assert product(factors(e), 1).width == 1
        assert places(e, ranges(x=(0.5, 1), y=(0.5, 1), z=(0.5, 1)))

    assert function_calls(take_apart) < 100_000


# ------------------------------------------------------------ the search


def length(e: Expression) -> Score:
    return Score(float(len(str(e))), 1.0)


ANY = {"a": (0.5, 1.0), "b": (0.5, 1.0), "c": (0.5, 1.0)}


def found(effort: int, text: str = "sqrt(a^2)*sqrt(b)*exp(-c)") -> Found:
    return search(pattern(text), ranges(**ANY), length, effort)


def test_every_form_keeps_the_steps_that_led_to_it() -> None:
    for form in found(40).forms:
        assert len(form.steps) == len(form.path) - 1
        assert form.path[0].step is None
    assert any(len(form.steps) >= 2 for form in found(40).forms)


def test_effort_is_the_number_of_forms_measured() -> None:
    assert len(found(10).forms) == 10
    assert not found(10).finished
    assert not found(10).stopped
    assert [f.expression for f in found(40).forms[:10]] == [f.expression for f in found(10).forms]


def test_a_formula_without_other_forms_is_finished() -> None:
    alone = found(10, "a + b")
    assert [form.steps for form in alone.forms] == [()]
    assert alone.finished


def test_a_form_that_fails_is_left_out_but_the_formula_as_written_stays() -> None:
    start = pattern("sqrt(a^2)*exp(-c)")
    none = search(start, ranges(**ANY), lambda _e: None, 20)
    assert none.forms == (Form(start, Score(float("inf"), float("inf"))),)
    others = search(start, ranges(**ANY), lambda e: length(e) if e is start else None, 20)
    assert [form.expression for form in others.forms] == [start]


def test_a_search_that_is_stopped_says_so() -> None:
    asked = iter([False, False, True])
    stopped = search(pattern("sqrt(a^2)*exp(-c)"), ranges(**ANY), length, 50, lambda: next(asked))
    assert stopped.stopped
    assert not stopped.finished
    assert len(stopped.forms) == 3
