"""What is measured of a form: bits where values count, failures, and values as a program has."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from brdfc.calc.program import Program
from brdfc.codegen.schedule import schedule
from brdfc.codegen.select import VariableBinding, select
from brdfc.engine.interpreter import run
from brdfc.forms.texts import pattern
from brdfc.judge.explore import explore
from brdfc.judge.goals import GOALS
from brdfc.judge.measure import Judge, Measured
from brdfc.judge.problem import Problem
from brdfc.judge.strata import FEW, STRATA, Points, points
from brdfc.lang.load import load
from brdfc.prepared import prepare, problem_of
from brdfc.symbolic.expression import Expression, const, make, quantity, rebuild, walk
from brdfc.symbolic.guards import guarded
from brdfc.symbolic.intervals import Interval, single
from brdfc.symbolic.ranges import Ranges

LIBRARY = ["lambert", "ward", "ward_printed", "cook_torrance", "ggx", "oren_nayar"]
LIBRARY += ["ashikhmin_shirley"]


@cache
def problem(name: str) -> Problem:
    return problem_of(*prepare(load(name), {}, ()))


@cache
def ward_judge() -> Judge:
    p = problem("ward")
    # In lobes within 89.9 degrees, as the figures these are compared with.
    steep = Interval(single(-math.radians(89.9)), single(math.radians(89.9)))
    domain = {**p.ranges.domain, "incident": steep, "reflection": steep}
    every = points(domain, p.quantities, 20_000)
    lobe = np.isin(every.strata, ("lobe", "grazing lobe"))
    at = Points({n: v[lobe] for n, v in every.values.items()}, ("lobe",) * int(lobe.sum()))
    return Judge(p, at)


def ward_with(form: str | None) -> Measured:
    """Ward with tan(delta)^2 written another way; i, r: the two angles."""
    p = problem("ward")
    ready: Expression = p.start
    if form is not None:
        (square,) = [
            e for e in walk(p.start) if e.operator == "pow" and e.arguments[0].operator == "tan"
        ]
        new = renamed(pattern(form))
        ready = replaced(p.start, square, new)
    node = select(guarded(ready, Ranges(p.ranges.domain))[0], p.bindings)
    found = ward_judge().measure(node)
    assert found is not None
    return found


def renamed(e: Expression) -> Expression:
    names = {"i": "incident", "r": "reflection"}
    if e.operator == "quantity":
        return quantity(names[e.name], 1)
    return rebuild(e, [renamed(a) for a in e.arguments])


def replaced(e: Expression, old: Expression, new: Expression) -> Expression:
    return new if e is old else rebuild(e, [replaced(a, old, new) for a in e.arguments])


def test_the_chosen_form_of_ward_keeps_its_digits() -> None:
    p = problem("ward")
    found = explore(p, GOALS["balanced"], 120)
    assert found is not None
    safe = guarded(found.chosen.form.expression, Ranges(p.ranges.domain))[0]
    measured = ward_judge().measure(select(safe, p.bindings))
    assert measured is not None
    assert measured.bits <= 6.1


@pytest.mark.parametrize(
    ("form", "least", "most"),
    [
        ("1/cos((i - r)/2)^2 - 1", 19.4, 20.4),
        ("(1 - cos(i - r))/(1 + cos(i - r))", 17.3, 18.3),
        ("((sin(i) - sin(r))/(cos(i) + cos(r)))^2", 16.1, 18.8),
    ],
    ids=["secant", "tangent of half", "sines"],
)
def test_known_bad_forms_of_ward_are_as_bad_as_known(form: str, least: float, most: float) -> None:
    assert least <= ward_with(form).bits <= most


def test_a_wrong_constant_is_no_failure_but_a_colour_difference() -> None:
    p = problem("lambert")
    judge = Judge(p, points(p.ranges.domain, p.quantities, FEW))
    node = select(guarded(make("mul", p.start, const(2)), p.ranges)[0], p.bindings)
    found = judge.measure(node)
    assert found is not None
    assert found.de > 10
    assert found.bits > 20


@pytest.mark.parametrize("broken", [np.nan, np.inf, 0.0])
def test_nan_infinity_and_false_zeros_fail(broken: float) -> None:
    p = problem("lambert")
    judge = Judge(p, points(p.ranges.domain, p.quantities, FEW))
    values = judge.graphs.values(select(guarded(p.start, p.ranges)[0], p.bindings)).copy()
    assert judge.figures(values, 1.0) is not None
    values[np.argmax(judge.truth[:, 0]), 0] = broken
    assert judge.figures(values, 1.0) is None


@pytest.mark.parametrize("name", LIBRARY)
def test_values_of_a_graph_are_those_of_its_program(name: str) -> None:
    p = problem(name)
    at = points(p.ranges.domain, p.quantities, 8)
    graphs = Judge(p, at).graphs
    node = select(guarded(p.start, p.ranges)[0], p.bindings)
    expected = graphs.values(node)
    program: Program = schedule(node, p.inputs)
    names = [b.signature for b in p.bindings.values() if isinstance(b, VariableBinding)]
    for i, pixel in enumerate(graphs.channels):
        environment = {n: float(graphs.variables[n][i]) for n in names}
        found = run(program, pixel[None], environment)[0]
        assert (found.view(np.uint32) == expected[i].view(np.uint32)).all()


# ------------------------------------------------------------ points


@pytest.mark.parametrize("name", LIBRARY)
def test_points_lie_in_the_domain(name: str) -> None:
    p = problem(name)
    whole = p.ranges.domain
    narrow = {n: Interval(i.low, single(i.low + (i.high - i.low) / 1e3)) for n, i in whole.items()}
    for domain in (whole, narrow):
        at = points(domain, p.quantities, 30)
        assert set(at.strata) == set(STRATA)
        for name, values in at.values.items():
            assert (values >= np.float32(domain[name].low)).all()
            assert (values <= np.float32(domain[name].high)).all()


def test_the_same_points_every_time() -> None:
    p = problem("ward")
    first, again = (points(p.ranges.domain, p.quantities, 10) for _ in range(2))
    assert all((first.values[n] == again.values[n]).all() for n in first.values)
