"""Rewriting keeps the exact value; guards act only where a formula breaks."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_expressions import (
    BINDINGS,
    SCALARS,
    A,
    B,
    V,
    naive_values,
    points,
    random_domain,
    random_expression,
    tree_size,
    values_at,
)

from brdfc.codegen.select import select
from brdfc.lang.load import load_text
from brdfc.lang.model import Model
from brdfc.symbolic.build import build
from brdfc.symbolic.constants import fold_constants
from brdfc.symbolic.evaluate import evaluate, evaluate_precisely
from brdfc.symbolic.expression import ONE, PI, ZERO, Expression, component, const, make, vector
from brdfc.symbolic.formula import prepared
from brdfc.symbolic.guards import guarded
from brdfc.symbolic.intervals import Interval, single
from brdfc.symbolic.products import tidy_products
from brdfc.symbolic.ranges import Ranges
from brdfc.symbolic.rewrite import rewrite
from brdfc.symbolic.simplify import simplified

HALF = const(Fraction(1, 2))
PASSES = {
    "constants": lambda e, domain: fold_constants(e),
    "simplify": lambda e, domain: rewrite(e, Ranges(domain), simplified),
    "products": lambda e, domain: tidy_products(e, Ranges(domain)),
    "guards": lambda e, domain: guarded(e, Ranges(domain))[0],
    "all": lambda e, domain: prepared(e, domain)[0],
}


def boxes(**domain: tuple[float, float]) -> Mapping[str, Interval]:
    return {k: Interval(single(low), single(high)) for k, (low, high) in domain.items()}


def ready(e: Expression, **domain: tuple[float, float]) -> Expression:
    return prepared(e, boxes(**domain))[0]


def guards(e: Expression, **domain: tuple[float, float]) -> list[str]:
    return [g.reason for g in prepared(e, boxes(**domain))[1]]


def close(first: Sequence[float], second: Sequence[float]) -> bool:
    pairs = zip(first, second, strict=True)
    return all(math.isclose(x, y, rel_tol=1e-13, abs_tol=1e-25) for x, y in pairs)


@pytest.mark.parametrize("name", PASSES)
@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.integers(0, 2**32))
def test_the_exact_value_stays(name: str, seed: int) -> None:
    random = Random(seed)
    domain = random_domain(random)
    e = random_expression(random)
    new = PASSES[name](e, domain)
    if any(g.reason.startswith("the argument is") for g in guarded(e, Ranges(domain))[1]):
        return  # large numbers stay as they are, as float32 has no fractions there
    # Inside the box, not at its float32 ends, which rounding may put beyond an exact bound.
    for _ in range(8):
        inside = [random.uniform(domain[n].low, domain[n].high) for n in (*SCALARS, *"vvv")]
        values = values_at(np.array(inside))
        before = evaluate_precisely(e, values)
        if all(abs(x) < 1e25 for x in before):
            assert close(before, evaluate_precisely(new, values)), (str(e), str(new), values)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.integers(0, 2**32))
def test_a_guarded_program_never_gives_nan(seed: int) -> None:
    random = Random(seed)
    domain = random_domain(random)
    e = random_expression(random)
    safe, found = prepared(e, domain)
    if tree_size(select(safe, BINDINGS)) > 3000:
        return
    pixels = points(random, domain, 60)
    values = naive_values(safe, pixels)
    assert not np.isnan(values).any(), (str(e), str(safe))
    if found:
        assert np.isfinite(values).all(), (str(e), str(safe))


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.integers(0, 2**32))
def test_guards_are_put_in_once(seed: int) -> None:
    random = Random(seed)
    domain = random_domain(random)
    safe, _ = prepared(random_expression(random), domain)
    again, more = prepared(safe, domain)
    assert len(more) <= len(prepared(again, domain)[1]) + 1


# ------------------------------------------------------------ guards, one by one

BREAKS = {
    "reciprocal": (make("div", ONE, A), (-1, 1)),
    "reciprocal from 0": (make("div", ONE, A), (0, 1)),
    "reciprocal to 0": (make("div", ONE, A), (-1, 0)),
    "vector": (make("div", ONE, V), (-1, 1)),
    "root": (make("sqrt", A), (-1, 1)),
    "reciprocal root": (make("div", ONE, make("sqrt", A)), (-1, 1)),
    "logarithm": (make("ln", A), (0, 1)),
    "decimal logarithm": (make("log10", A), (-1, 1)),
    "arc": (make("asin", A), (-2, 2)),
    "power": (make("pow", A, const(-2)), (-1, 1)),
    "broken power": (make("pow", A, const(Fraction(-5, 2))), (-1, 1)),
    "broken power above": (make("pow", A, const(Fraction(5, 2))), (-1, 1)),
    "rounding": (make("round", make("mul", const(10**10), A)), (-1, 1)),
}


@pytest.mark.parametrize("name", BREAKS)
def test_one_guard_for_one_break(name: str) -> None:
    e, (low, high) = BREAKS[name]
    domain = boxes(a=(low, high), b=(0, 0), c=(0, 0), v=(low, high))
    safe, found = prepared(e, domain)
    # A root has two breaks, cured by one max; a power may overflow beside its pole.
    assert len(found) == (2 if name in ("reciprocal root", "broken power") else 1)
    for x in (low, -1e-30, -1e-45, 0.0, 1e-45, 1e-30, high):
        if low <= x <= high:
            pixel = np.full((1, 6), x, dtype=np.float32)
            assert np.isfinite(naive_values(safe, pixel)).all(), x
    for x in (low, high, (2 * low + high) / 3):
        values = values_at(np.full(6, x, dtype=np.float32))
        exact = evaluate_precisely(e, values)
        if all(map(math.isfinite, exact)):
            assert evaluate_precisely(safe, values) == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize(
    ("e", "low", "high"),
    [
        (make("div", ONE, A), 0.001, 1),
        (make("sqrt", A), 0, 1),
        (make("sqrt", make("sub", ONE, make("pow", A, const(2)))), -1, 1),
        (make("ln", A), 0.001, 1),
        (make("asin", A), -1, 1),
        (make("acos", make("cos", A)), -3, 3),
        (make("tan", A), -math.pi / 2, math.pi / 2),
        (make("div", ONE, make("cos", A)), -math.pi / 2, math.pi / 2),
        (make("pow", A, const(-2)), 0.001, 1),
        (make("pow", A, const(3)), -1, 1),
        (make("exp", make("neg", make("div", ONE, A))), 1e-3, 1),
    ],
)
def test_no_guard_where_the_range_excludes_the_break(
    e: Expression, low: float, high: float
) -> None:
    assert guards(e, a=(low, high)) == []


def test_a_power_whose_base_underflows_is_guarded() -> None:
    assert guards(make("pow", A, const(-3)), a=(1e-20, 1))


def test_zero_to_a_variable_power_stays_zero() -> None:
    """0^y is 0 for every y > 0 and 1 for y = 0; a guard must not change that."""
    e = make("pow", A, B)
    assert guards(e, a=(0, 1), b=(0, 5)) == []
    safe = ready(e, a=(0, 1), b=(-1, 5))
    for exponent, wanted in ((0.05, 0.0), (2.0, 0.0)):
        assert evaluate_precisely(safe, {"a": (0.0,), "b": (exponent,)}) == (wanted,)


def test_guards_do_not_cascade() -> None:
    quotient = make("div", ONE, A)
    e = make("add", make("mul", make("add", quotient, ONE), B), ONE)
    assert guards(e, a=(-1, 1), b=(0, 1)) == ["the denominator is -1..1"]


def test_a_condition_makes_a_guard_needless() -> None:
    e = make("where", make("gt", A, ZERO), make("ln", A), ZERO)
    assert guards(e, a=(-1, 1)) == []
    e = make("where", make("gt", make("abs", A), const(Fraction(1, 8))), make("div", ONE, A), ZERO)
    assert guards(e, a=(-1, 1)) == []


# ------------------------------------------------------------ what the ranges make needless


def test_a_dead_branch_goes() -> None:
    e = make("where", make("gt", A, ZERO), B, make("sqrt", B))
    assert ready(e, a=(0.001, 1), b=(-1, 1)) is B
    assert ready(e, a=(-1, 0), b=(0, 1)) is make("sqrt", B)
    assert ready(e, a=(0, 1), b=(0, 1)) is e


def test_a_needless_maximum_goes() -> None:
    e = make("max", A, const(Fraction(1, 10000)))
    assert ready(e, a=(0.001, 1)) is A
    assert ready(e, a=(0, 1)) is e


def test_zeros_and_ones_go() -> None:
    e = make("add", make("mul", A, ONE), make("mul", ZERO, B))
    assert ready(e, a=(0, 1), b=(0, 1)) is A


def test_two_bounds_become_one() -> None:
    both = make("and", make("gt", A, ZERO), make("gt", B, ZERO))
    e = make("where", both, A, B)
    one = make("gt", make("min", A, B), ZERO)
    assert ready(e, a=(-1, 1), b=(-1, 1)) is make("where", one, A, B)


# ------------------------------------------------------------ products


def test_constants_meet_and_divisions_are_joined() -> None:
    e = make("mul", make("div", A, const(4)), make("div", const(2), B))
    tidy = tidy_products(e, Ranges(boxes(a=(0, 1), b=(0.5, 1))))
    assert tidy is make("div", make("mul", A, HALF), B)


def test_scalars_go_before_vectors() -> None:
    e = make("mul", make("mul", V, A), B)
    tidy = tidy_products(e, Ranges(boxes(a=(0, 1), b=(0, 1), v=(0, 1))))
    assert tidy is make("mul", V, make("mul", A, B))


def test_a_product_stays_as_written_where_its_factors_underflow() -> None:
    e = make("pow", make("div", A, const(1000)), const(20))
    safe = ready(e, a=(0, 1000))
    assert naive_values(safe, np.full((1, 6), 1000, np.float32))[0, 0] == pytest.approx(1, rel=1e-4)


def test_a_joint_denominator_that_underflows_is_not_joined() -> None:
    e = make("div", make("div", A, B), B)
    for _ in range(2):
        e = make("div", make("div", e, B), B)
    e = make("mul", e, make("pow", B, const(5)))
    assert guards(e, a=(0, 1e-30), b=(1e-7, 1)) == []


# ------------------------------------------------------------ constants


def degrees(angle: int) -> Expression:
    return make("mul", const(Fraction(angle, 180)), PI)


@pytest.mark.parametrize(
    ("e", "value"),
    [
        (make("cos", degrees(60)), Fraction(1, 2)),
        (make("cos", degrees(90)), Fraction(0)),
        (make("tan", degrees(45)), Fraction(1)),
        (make("pow", make("sqrt", const(2)), const(2)), Fraction(2)),
        (make("exp", make("ln", const(3))), Fraction(3)),
        (make("max", const(1), const(2)), Fraction(2)),
        (make("round", const(Fraction(-5, 2))), Fraction(-3)),
        (make("trunc", const(Fraction(-5, 2))), Fraction(-2)),
        (make("cbrt", const(-8)), Fraction(-2)),
        (make("where", make("gt", PI, const(3)), ONE, make("div", ONE, ZERO)), Fraction(1)),
        (make("eq", make("mul", make("sqrt", const(2)), make("sqrt", const(3))),
              make("sqrt", const(6))), Fraction(1)),
    ],
)  # fmt: skip
def test_constants_are_exact(e: Expression, value: Fraction) -> None:
    assert fold_constants(e) is const(value)


def test_irrational_constants_have_fifty_digits() -> None:
    folded = fold_constants(make("sqrt", const(2)))
    assert abs(folded.value**2 - 2) < Fraction(1, 10**48)


@pytest.mark.parametrize(
    "e",
    [
        make("div", ONE, ZERO),
        make("sqrt", const(-1)),
        make("ln", ZERO),
        make("asin", const(2)),
        make("lt", make("sqrt", const(-1)), ONE),
        make("pow", const(2), const(10**9)),
        make("exp", make("exp", make("exp", const(100)))),
    ],
)
def test_what_has_no_finite_value_is_left_alone(e: Expression) -> None:
    folded = fold_constants(e)
    assert folded.operator == e.operator
    assert not math.isfinite(evaluate_precisely(e, {})[0])


def test_constant_vectors_are_folded() -> None:
    e = make("mul", vector([ONE, const(2), const(3)]), const(2))
    assert fold_constants(e) is vector([const(2), const(4), const(6)])
    assert fold_constants(component(e, 1)) is const(4)


def test_a_chain_of_doublings_is_folded_quickly() -> None:
    e = const(Fraction(1, 3))
    for _ in range(40):
        e = make("sub", e, make("mul", e, e))
    assert 0 < fold_constants(e).value < Fraction(1, 3)


def test_what_cancels_to_nothing_takes_no_digits_from_the_rest() -> None:
    """Of an identity, (1 - cos^2) - sin^2 say, SymPy gives what is left of its working precision,
    a number without digits, and takes its precision for that of all that is made of it."""
    model = load_text(
        'model t "T"\nchannel n : number in 1..100\n'
        "let t2 = (tan(5deg)*sin(-87.5deg))^2 + (tan(35deg)*cos(-87.5deg))^2\n"
        "let c2 = 1/(1 + t2)\n"
        "let log = ln(c2) + ((1 - c2) - t2*c2)\n"
        "let normal = (n + 2)*(n + 4)/(8*pi*(exp(-n/2*ln(2)) + n))\n"
        "radiance = 0.2*normal*exp(n/2*min(log, 0))\n"
    )
    assert isinstance(model, Model)
    whole = build(model.radiance, {"n": (60.0,)})
    folded = evaluate_precisely(fold_constants(whole), {})
    assert folded == pytest.approx(evaluate_precisely(whole, {}), rel=1e-13)


# ------------------------------------------------------------ evaluation


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.integers(0, 2**32))
def test_float64_agrees_with_high_precision(seed: int) -> None:
    random = Random(seed)
    domain = random_domain(random)
    e = random_expression(random, levels=3)
    pixels = points(random, domain, 10)
    fast = evaluate(e, {n: pixels[:, [i]] for i, n in enumerate(SCALARS)} | {"v": pixels[:, 3:]})
    agreed = known = 0
    for pixel, row in zip(pixels, fast, strict=True):
        exact = evaluate_precisely(e, values_at(pixel))
        if all(abs(x) < 1e100 for x in exact):
            known += 1
            agreed += np.allclose(row, exact, rtol=1e-6, atol=1e-9)
    assert agreed >= known * 0.8  # at jumps, and beside cancellation, float64 may differ


def test_what_rests_on_the_undefined_is_undefined() -> None:
    broken = make("div", ONE, A)
    at_zero = {"a": (0.0,)}
    for e in (
        make("add", broken, ONE),
        make("min", broken, ONE),
        make("pow", broken, ZERO),
        make("where", make("gt", broken, ZERO), ONE, ZERO),
        make("pow", ONE, broken),
    ):
        assert math.isnan(evaluate_precisely(e, at_zero)[0]), e


def test_a_condition_that_is_settled_does_not_look_further() -> None:
    condition = make("and", make("gt", A, ZERO), make("gt", make("ln", A), ZERO))
    e = make("where", condition, ONE, ZERO)
    assert evaluate_precisely(e, {"a": (-1.0,)}) == (0.0,)
    other = make("or", make("lt", A, ZERO), make("gt", make("ln", A), ZERO))
    assert evaluate_precisely(make("where", other, ONE, ZERO), {"a": (-1.0,)}) == (1.0,)


def test_only_the_branch_that_counts_matters() -> None:
    e = make("where", make("gt", A, ZERO), make("ln", A), ZERO)
    assert evaluate_precisely(e, {"a": (-1.0,)}) == (0.0,)


def test_towers_of_powers_end() -> None:
    e = A
    for _ in range(6):
        e = make("exp", e)
    assert evaluate_precisely(e, {"a": (3.0,)}) == (math.inf,)
    assert evaluate_precisely(make("div", ONE, e), {"a": (3.0,)}) == (0.0,)
