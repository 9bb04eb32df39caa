"""A bound on a form's error is never below what is sampled, and is none where none can be had."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest
from random_expressions import naive_values, points, random_domain, random_expression
from random_expressions import values_at as quantities_at

from brdfc.codegen.select import select
from brdfc.judge.bound import error_bound
from brdfc.judge.measure import Judge
from brdfc.judge.problem import Problem
from brdfc.judge.strata import points as strata
from brdfc.lang.load import load, load_text
from brdfc.lang.model import Model
from brdfc.prepared import prepare, problem_of
from brdfc.symbolic.evaluate import evaluate_precisely
from brdfc.symbolic.expression import Expression, const, make, quantity
from brdfc.symbolic.guards import guarded
from brdfc.symbolic.intervals import Interval
from brdfc.symbolic.ranges import Ranges

A, B = quantity("a", 1), quantity("b", 1)


def sampled(e: Expression, domain: dict[str, Interval], random: Random) -> float:
    """Worst bits of the guarded expression at random points, 0 where all are undefined."""
    safe = guarded(e, Ranges(domain))[0]
    pixels = points(random, domain, 20)
    found = naive_values(safe, pixels).astype(np.float64)
    truth = np.array([evaluate_precisely(safe, quantities_at(p)) for p in pixels])
    good = np.isfinite(truth) & (np.abs(truth) < 3e38)
    with np.errstate(all="ignore"):
        unit = np.spacing(np.abs(truth).astype(np.float32)).astype(np.float64)
        units = np.where(good, np.abs(found - truth) / unit, 0.0)
    return float(np.log2(1 + units).max())


def test_no_sampled_error_is_above_the_bound() -> None:
    bounded = 0
    for seed in range(1500):
        random = Random(seed)
        e = random_expression(random, levels=3)
        domain = random_domain(random)
        bound = error_bound(e, Ranges(domain))
        if bound is not None:
            bounded += 1
            assert sampled(e, domain, random) <= bound + 1e-9, (seed, str(e), domain)
    assert bounded > 300


def bits(e: Expression, **domain: tuple[float, float]) -> float | None:
    return error_bound(e, Ranges({name: Interval(*ends) for name, ends in domain.items()}))


def test_a_sum_is_rounded_once() -> None:
    assert bits(make("add", A, B), a=(1, 2), b=(1, 2)) == pytest.approx(np.log2(2), abs=0.01)


def test_cancellation_amplifies() -> None:
    difference = make("sub", make("exp", A), const(1))
    far, near = (bits(difference, a=(low, 2.0)) for low in (1.0, 0.01))
    assert far is not None
    assert near is not None
    assert far < 5 < near
    assert bits(make("div", const(1), difference), a=(-1, 1)) is None


def test_a_condition_on_a_rounded_value_has_no_bound() -> None:
    jump = make("where", make("gt", make("exp", A), const(2)), const(1), const(5))
    assert bits(jump, a=(0, 1)) is None
    exact = make("where", make("gt", A, const(2)), const(1), const(5))
    assert bits(exact, a=(0, 4)) == 0


def problem(name: str, **fixed: str) -> Problem:
    return problem_of(*prepare(load(name), fixed, ()))


def worst(p: Problem, ranges: Ranges) -> float:
    at = strata(ranges.domain, p.quantities, 200)
    measured = Judge(p, at).measure(select(guarded(p.start, ranges)[0], p.bindings))
    assert measured is not None
    return measured.bits


def test_lambert_has_a_small_bound() -> None:
    p = problem("lambert")
    bound = error_bound(p.start, p.ranges)
    assert bound is not None
    assert worst(p, p.ranges) <= bound < 5


def test_ward_has_a_bound_where_angles_are_fixed_and_the_lobe_is_wide() -> None:
    p = problem("ward", incident="40deg", reflection="10deg")
    ranges = Ranges({**p.ranges.domain, "m": Interval(0.1, 1.0)})
    bound = error_bound(p.start, ranges)
    assert bound is not None
    assert worst(p, ranges) <= bound < 12


def test_ward_in_its_whole_domain_has_none() -> None:
    p = problem("ward")
    assert error_bound(p.start, p.ranges) is None


def test_a_constant_beyond_float32_has_none() -> None:
    assert bits(make("mul", A, const(10**60)), a=(0, 1)) is None


def test_nested_powers_end() -> None:
    model = load_text(
        'model t "T"\nchannel x : number in 0.5..1 = 1\n'
        "let y = x^4\nlet z = y^4\nlet w = z^4\nradiance = (w^64, w^-64, w)\n"
    )
    assert isinstance(model, Model)
    p = problem_of(*prepare(model, {}, ()))
    bound = error_bound(p.start, p.ranges)
    assert bound is None or bound > 10
