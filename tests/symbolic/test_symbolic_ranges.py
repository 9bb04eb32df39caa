"""Ranges hold what a float32 program computes; what conditions teach holds too."""

from __future__ import annotations

import math
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_expressions import (
    BINDINGS,
    A,
    B,
    naive_values,
    points,
    random_domain,
    random_expression,
    tree_size,
)

from brdfc.codegen.select import select
from brdfc.source.errors import BrdfcError
from brdfc.symbolic.bounds import RULES
from brdfc.symbolic.expression import ONE, ZERO, Expression, const, make, walk
from brdfc.symbolic.intervals import EVERYTHING, Interval, hull, meet, single
from brdfc.symbolic.ranges import Ranges
from brdfc.symbolic.trigonometry import widest_above

TRUTHS = ("lt", "le", "gt", "ge", "eq", "ne", "and", "or", "not")
HALF_PI = single(math.pi / 2)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.integers(0, 2**32))
def test_float32_values_lie_in_the_range(seed: int) -> None:
    random = Random(seed)
    domain = random_domain(random)
    expression = random_expression(random)
    ranges = Ranges(domain)
    pixels = points(random, domain, 60)
    for e in walk(expression):
        of = ranges.of(e)
        if of.undefined or e.operator in TRUTHS or tree_size(select(e, BINDINGS)) > 2000:
            continue
        values = naive_values(e, pixels)
        if any(ranges.of(part).undefined for part in walk(e)):
            continue  # an undefined part may have given NaN in a branch that was not to be taken
        assert (values >= of.low).all(), (e, of, values.min())
        assert (values <= of.high).all(), (e, of, values.max())
        if of.gap:
            assert (np.abs(values) >= of.gap).all(), (e, of)


def ranges(**domain: tuple[float, float]) -> Ranges:
    return Ranges({k: Interval(single(low), single(high)) for k, (low, high) in domain.items()})


def of(e: Expression, low: float, high: float) -> Interval:
    return ranges(a=(low, high)).of(e)


@pytest.mark.parametrize(
    ("operator", "low", "high", "wanted"),
    [
        ("sin", 0, 1e-20, (0, 1e-20)),
        ("sin", 0, math.pi, (-8.8e-8, 1)),
        ("sin", 3, 6, (-1, 0.1412)),
        ("cos", -1, 1, (0.5403, 1)),
        ("sqrt", 0, 4, (0, 2)),
        ("cbrt", -8, 27, (-2, 3)),
        ("exp", -200, 0, (0, 1)),
        ("abs", -2, 1, (0, 2)),
        ("sign", -2, 0, (-1, 0)),
        ("round", -2.5, 0.4, (-3, 0)),
        ("atan", 0, 1e30, (0, math.pi / 2)),
    ],
)
def test_bounds_are_near(
    operator: str, low: float, high: float, wanted: tuple[float, float]
) -> None:
    found = of(make(operator, A), low, high)
    assert not found.undefined
    assert (found.low, found.high) == pytest.approx(wanted, rel=1e-3, abs=1e-9)


def test_a_sine_from_zero_reaches_zero() -> None:
    assert of(make("sin", A), 0, 1).has_zero


def test_a_cosine_at_a_right_angle_is_never_zero() -> None:
    found = of(make("cos", A), -math.pi / 2, math.pi / 2)
    assert found.low < 0 < found.high
    assert not found.has_zero
    assert 4.3e-8 < found.gap < 4.38e-8


def test_a_cosine_never_exceeds_one() -> None:
    assert of(make("cos", A), -30, 30) == Interval(-1, 1, gap=of(make("cos", A), -30, 30).gap)


def test_a_square_is_not_negative_and_keeps_its_bound() -> None:
    assert of(make("sub", ONE, make("mul", A, A)), -1, 1) == Interval(0, 1)
    assert of(make("sub", ONE, make("pow", A, const(2))), -1, 1) == Interval(0, 1)


def test_odd_powers_of_what_is_unbounded_are_defined() -> None:
    huge = make("exp", make("mul", const(100), A))
    assert not of(make("pow", huge, const(3)), -10, 10).undefined


def test_zero_to_the_power_zero_is_one_on_every_engine() -> None:
    found = ranges(a=(0, 1), b=(0, 2)).of(make("pow", A, B))
    assert (found.low, found.undefined) == (0, False)
    assert found.high >= 1


@pytest.mark.parametrize("operator", ["sqrt", "ln", "log10"])
def test_negative_arguments_are_undefined(operator: str) -> None:
    assert of(make(operator, A), -1, 1).undefined
    assert not of(make(operator, A), 0.5, 1).undefined


def test_rounding_large_numbers_is_undefined() -> None:
    assert RULES["trunc"](Interval(0, 1e10)).undefined
    assert RULES["round"](Interval(-1e10, 0)).undefined
    assert not RULES["floor"](Interval(0, 1e10)).undefined


def test_division_by_a_range_with_a_gap() -> None:
    found = RULES["div"](Interval(-1, 2), Interval(-3, 3, gap=0.5))
    assert (found.low, found.high, found.undefined) == (
        pytest.approx(-4, rel=1e-6),
        pytest.approx(4, rel=1e-6),
        False,
    )
    assert RULES["div"](Interval(1, 2), Interval(-3, 3)) == EVERYTHING


def test_meet_and_hull() -> None:
    assert meet(Interval(-1, 3), Interval(0, 5)) == Interval(0, 3)
    assert meet(Interval(0, 1), Interval(2, 3)) == Interval(0, 1)
    assert meet(Interval(-1, 1, gap=0.5), Interval(0, 9)) == Interval(0.5, 1, gap=0.5)
    assert hull(Interval(0, 1), Interval(4, 5, undefined=True)) == Interval(0, 5, undefined=True)


# ------------------------------------------------------------ what conditions teach


def test_a_condition_narrows_its_branch() -> None:
    inside = ranges(a=(-1, 1)).assuming(make("gt", A, ZERO), True)
    assert inside.of(A).low > 0
    outside = ranges(a=(-1, 1)).assuming(make("gt", A, ZERO), False)
    assert outside.of(A) == Interval(-1, 0)


def test_both_parts_of_and_hold_and_neither_of_or() -> None:
    both = make("and", make("gt", A, ZERO), make("lt", B, ZERO))
    inside = ranges(a=(-1, 1), b=(-1, 1)).assuming(both, True)
    assert inside.of(A).low > 0
    assert inside.of(B).high < 0
    either = make("or", make("gt", A, ZERO), make("lt", B, ZERO))
    outside = ranges(a=(-1, 1), b=(-1, 1)).assuming(either, False)
    assert outside.of(A).high <= 0
    assert outside.of(B).low >= 0


def test_a_size_keeps_away_from_zero() -> None:
    inside = ranges(a=(-1, 1)).assuming(make("ge", make("abs", A), ONE), True)
    assert not inside.of(A).has_zero
    assert not inside.of(make("div", ONE, A)).undefined


def test_a_positive_cosine_keeps_its_angle_in_front() -> None:
    positive = make("gt", make("min", make("cos", A), make("cos", B)), ZERO)
    inside = ranges(a=(-HALF_PI, HALF_PI), b=(-1, 1)).assuming(positive, True)
    assert inside.of(A).high < math.pi / 2
    assert not inside.of(make("tan", A)).undefined


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.floats(0, 1, width=32))
def test_no_angle_beyond_the_widest_has_a_greater_cosine(cosine: float) -> None:
    widest = widest_above(cosine)
    beyond = np.float32(widest)
    for _ in range(3):
        beyond = np.nextafter(beyond, np.float32(4))
        assert np.float32(math.cos(float(beyond))) <= cosine


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.integers(0, 2**32))
def test_facts_hold_for_float32_values(seed: int) -> None:
    random = Random(seed)
    domain = random_domain(random)
    made = random_expression(random, levels=3)
    left = make("cos", A) if random.random() < 0.5 else random_expression(random, levels=2)
    if left.width > 1 or made.width > 1:
        return
    bound = const(random.choice([-1, 0, 1])) if random.random() < 0.5 else B
    condition = make(random.choice(("lt", "le", "gt", "ge", "eq", "ne")), left, bound)
    pixels = points(random, domain, 200)
    holds = naive_values(make("where", condition, ONE, ZERO), pixels)[:, 0] >= 0.5
    for truth in (True, False):
        inside = Ranges(domain).assuming(condition, truth)
        chosen = pixels[holds == truth]
        if not len(chosen) or any(Ranges(domain).of(e).undefined for e in walk(condition)):
            continue
        for e in (left, A, B, made):
            known = inside.of(e)
            if not any(inside.of(part).undefined for part in walk(e)):
                values = naive_values(e, chosen)
                assert (values >= known.low).all(), (condition, truth, e, known)
                assert (values <= known.high).all(), (condition, truth, e, known)


def test_ranges_of_huge_constants_do_not_fail() -> None:
    assert of(const(10**400), 0, 1) == Interval(math.inf, math.inf)
    with pytest.raises(BrdfcError, match="does not fit a 32-bit float"):
        select(const(10**400), {})
