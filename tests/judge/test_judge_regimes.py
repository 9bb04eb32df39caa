"""Regime splits: found where the domain demands one, paid by what pixels do on average."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from brdfc.calc.price import nanoseconds, price
from brdfc.calc.program import If, Program
from brdfc.calc.text import assemble, disassemble
from brdfc.codegen.estimate import estimated_price
from brdfc.codegen.nodes import postorder
from brdfc.codegen.select import ChannelBinding, select
from brdfc.compiler import compile_model
from brdfc.forms.neighbours import Neighbours
from brdfc.forms.search import Form, Score
from brdfc.forms.texts import pattern
from brdfc.judge.explore import Explored, explore
from brdfc.judge.goals import goal
from brdfc.judge.graphs import Graphs
from brdfc.judge.regimes import Side, Splitter, between
from brdfc.lang.load import load, load_text
from brdfc.lang.model import Model
from brdfc.prepared import prepare, problem_of
from brdfc.symbolic.expression import walk
from brdfc.symbolic.intervals import Interval
from brdfc.symbolic.ranges import Ranges

ROOT = "sqrt(x^2 + y) - x"
BINDINGS = {"x": ChannelBinding(0, 1), "y": ChannelBinding(1, 1)}


def near(text: str, low: float, high: float, *, regimes: bool) -> set[str]:
    known = Ranges({"x": Interval(low, high), "y": Interval(0.01, 1)})
    return {str(form) for _, form in Neighbours(known, regimes).of(pattern(text))}


# ------------------------------------------------------------ rules on a part of the domain


def test_a_rule_that_holds_on_a_part_of_the_domain_is_used_there() -> None:
    quotient = "(y / (sqrt(((x ^ 2) + y)) + x))"
    assert quotient in near(ROOT, 0.5, 1, regimes=False)
    assert not any(quotient in form for form in near(ROOT, -1, 1, regimes=False))
    (split,) = near(ROOT, -1, 1, regimes=True)
    assert split == str(pattern(f"y/(sqrt(x^2 + y) + x) where x > 0 else {ROOT}"))
    assert not any(quotient in form for form in near(ROOT, -1, -0.5, regimes=True))


def test_a_split_is_not_made_again_inside_itself() -> None:
    split = f"y/(sqrt(x^2 + y) + x) where x > 0 else {ROOT}"
    assert not any(form.count("where") > 1 for form in near(split, -1, 1, regimes=True))


def model(formula: str, low: float, high: float) -> Model:
    text = f"""model t "T"
channel Rd : XYZ in 0..1 = 0.5
channel x : number in {low}..{high} = {high}
channel y : number in 0.01..1 = 0.5
radiance = {formula}
"""
    made = load_text(text, "t.brdf")
    assert isinstance(made, Model)
    return made


def explored(of: Model, aim: str = "balanced", error: str | None = None) -> Explored:
    found = explore(problem_of(*prepare(of, {}, ())), goal(aim, error), 60)
    assert found is not None
    return found


def has_choice(found: Explored) -> bool:
    return any(e.operator == "where" for e in walk(found.chosen.form.expression))


def test_a_formula_good_on_one_half_each_way_is_split() -> None:
    found = explored(model(f"Rd*({ROOT})", -100, 100), error="16ulp")
    assert found.written.measured.bits > 15
    assert found.chosen.measured.bits < 4
    assert has_choice(found)


@pytest.mark.parametrize(("low", "high"), [(1, 100), (-100, -1)])
def test_a_domain_on_one_side_needs_no_split(low: float, high: float) -> None:
    found = explored(model(f"Rd*({ROOT})", low, high), error="16ulp")
    assert found.chosen.measured.bits < 4.1
    assert not has_choice(found)


def test_a_split_formula_compiles_and_agrees_with_the_model() -> None:
    compiled = compile_model(model(f"Rd*({ROOT})", -100, 100), max_error="16ulp", cache=False)
    assert compiled.form is not None
    assert "where (x > 0)" in compiled.form.derivation[-1].after
    assert compiled.verdict.points > 100


# ------------------------------------------------------------ cheap beside careful


@pytest.fixture(scope="module")
def ward() -> Explored:
    found = explore(problem_of(*prepare(load("ward"), {}, ())), goal("accuracy"), 60)
    assert found is not None
    return found


def test_the_careful_form_runs_only_where_it_is_needed(ward: Explored) -> None:
    *_, careful, split = ward.derivation()
    assert split.form.step is not None
    assert split.form.step.rule == "split"
    assert split.measured.bits <= careful.measured.bits + 0.1
    assert split.price < 0.9 * careful.price
    assert ward.written.measured.bits > split.measured.bits + 2


def test_a_split_costs_what_pixels_need_on_average(ward: Explored) -> None:
    program = ward.chosen.program
    assert program is not None
    read_back = Program(program.inputs, program.outputs, assemble(disassemble(program.body)))
    assert read_back == program  # shares are no part of a program
    assert price(program) < price(read_back)  # of which only the dearest path is known
    everything = ward.derivation()[-2].program
    assert everything is not None
    assert price(read_back) > price(everything)


# ------------------------------------------------------------ thresholds


def split_values(count: int = 1000) -> dict[str, np.ndarray]:
    random = np.random.default_rng(1)
    return {"x": random.uniform(-1, 1, (count, 1)), "y": random.uniform(0, 1, (count, 1))}


def side(text: str, errors: np.ndarray) -> Side:
    return Side(Form(pattern(text), Score(1.0, 1.0)), errors)


def test_the_cheap_side_takes_as_much_as_it_can() -> None:
    values = split_values()
    x = values["x"][:, 0]
    cheap = side("x*y", np.where(x > 0.3, 5.0, 0.5))
    careful = side("y*x", np.full(len(x), 0.9))
    split = Splitter(values).most_used(cheap, careful, 1.0)
    assert split is not None
    assert str(split.of) == "x"
    assert 0.25 < split.threshold <= 0.31
    assert split.low is cheap
    assert split.share == np.mean(x <= 0.3)
    assert str(split.expression).startswith("((x * y) where (x < ")


def test_the_cheap_side_may_be_the_upper_one_or_between() -> None:
    values = split_values()
    x = values["x"][:, 0]
    careful = side("y*x", np.full(len(x), 0.9))
    upper = Splitter(values).most_used(side("x*y", np.where(x < 0.3, 5.0, 0.5)), careful, 1.0)
    assert upper is not None
    assert upper.high.form.expression is pattern("x*y")
    middle = side("x*y", np.where(np.abs(x) < 0.3, 5.0, 0.5))
    between_ends = Splitter(values).most_used(middle, careful, 1.0)
    assert between_ends is not None
    assert str(between_ends.of) == "abs(x)"


def test_two_that_fail_on_different_sides_are_good_together() -> None:
    values = split_values()
    x = values["x"][:, 0]
    low, high = side("x*y", 2 + 3 * (x > 0.1)), side("y*x", 2 + 3 * (x < -0.1))
    split = Splitter(values).most_accurate(low, high)
    assert split is not None
    assert split.worst == 2
    assert -0.1 <= split.threshold <= 0.11
    assert split.form.steps[-1].rule == "split"


def test_a_careful_side_that_fails_too_makes_no_split() -> None:
    values = split_values()
    bad = side("x*y", np.full(1000, 5.0))
    assert Splitter(values).most_used(bad, bad, 1.0) is None


def test_what_differs_deep_inside_is_chosen_there() -> None:
    values = split_values()
    errors = np.where(values["x"][:, 0] > 0, 5.0, 0.5)
    cheap, careful = side("sqrt(y)*exp(x*y)", errors), side("sqrt(y)*exp(y*x)", 0 * errors)
    split = Splitter(values).most_used(cheap, careful, 1.0)
    assert split is not None
    assert str(split.expression).startswith("(sqrt(y) * exp(((x * y) where (x < ")


@pytest.mark.parametrize(
    ("low", "high", "short"),
    [(0.29, 0.34, "0.3"), (-0.2, 0.1, "-0.05"), (1.0, 1.5, "1.2"), (1e-8, 9e-8, "5e-8")],
)
def test_thresholds_are_short(low: float, high: float, short: str) -> None:
    assert between(low, high) == Fraction(short)


def test_a_threshold_lies_above_the_lower_value_and_not_above_the_other() -> None:
    low = 0.1
    high = float(np.nextafter(low, 1))
    assert low < between(low, high) <= high


# ------------------------------------------------------------ shares


def shares(text: str, x: list[float], y: list[float]) -> list[float | None]:
    node = select(pattern(text), BINDINGS)
    points = np.array([x, y], dtype=np.float32).T
    shared = Graphs(points, {}).shared_out(node)
    return [n.share for n in postorder(shared) if n.operator == "where"]


def test_shares_count_those_that_come_to_a_branch() -> None:
    nested = "(1 where y > 0 else 2) where x > 0 else 3"
    x = [1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0]
    y = [1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0]
    assert shares(nested, x, y) == [0.25, 0.5]


def test_an_estimate_counts_operators_by_their_share() -> None:
    text = "exp(sin(x)) where x > 0 else 3"
    node = select(pattern(text), BINDINGS)

    def estimated(x: list[float]) -> float:
        points = np.array([x, x], dtype=np.float32).T
        return estimated_price(Graphs(points, {}).shared_out(node))

    never, half, always = estimated([-1, -1]), estimated([-1, 1]), estimated([1, 1])
    assert never < half < always
    assert half == pytest.approx((never + always) / 2)
    assert estimated_price(node) >= always


def test_a_branch_of_known_share_costs_that_share() -> None:
    then, otherwise = assemble("{ in tan exp out }"), assemble("{ in out }")
    times = [nanoseconds((If(then, otherwise, share),)) for share in (0.0, 0.25, 1.0, None)]
    assert times[1] == pytest.approx(0.75 * times[0] + 0.25 * times[2])
    assert times[3] == times[2]
