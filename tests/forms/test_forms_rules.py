"""Every rule keeps the value wherever its conditions hold; matching finds what it should."""

from __future__ import annotations

import math
import random

import pytest

from brdfc.forms.neighbours import directions, places
from brdfc.forms.patterns import CONSTANT, instantiate, match, match_product
from brdfc.forms.products import factors, product
from brdfc.forms.rules import VALUE
from brdfc.forms.texts import pattern
from brdfc.symbolic.evaluate import evaluate_precisely
from brdfc.symbolic.expression import Expression, walk
from brdfc.symbolic.intervals import Interval
from brdfc.symbolic.ranges import Ranges


def variables(*expressions: Expression) -> list[str]:
    return sorted({e.name for x in expressions for e in walk(x) if e.operator == "quantity"})


@pytest.mark.parametrize("direction", directions(), ids=lambda d: d.name)
def test_a_rule_keeps_the_value(direction) -> None:
    source = random.Random(direction.name)
    names = variables(direction.left, direction.right)
    assert set(variables(direction.right)) <= set(variables(direction.left))
    compared = 0
    for _ in range(300):
        values = {n: (source.uniform(-3, 3),) for n in names}
        if CONSTANT in values:  # stands for a positive constant only
            values[CONSTANT] = (abs(values[CONSTANT][0]),)
        for name, relation in direction.rule.needs.items():
            if name == VALUE:
                continue
            values[name] = (abs(values[name][0]) + (0.01 if relation == "> 0" else 0.0),)
        left = evaluate_precisely(direction.left, values)[0]
        right = evaluate_precisely(direction.right, values)[0]
        if math.isnan(left) or (VALUE in direction.rule.needs and left < 0):
            continue  # where the formula itself says nothing, a form may say anything
        compared += 1
        assert right == pytest.approx(left, rel=1e-14, abs=1e-30), values
    assert compared > 50, "the rule was hardly tried"


def test_products_match_as_sets_of_factors() -> None:
    (found, rest), *_ = match_product(pattern("x^2/y^2"), pattern("3*a^2*c/b^2"), {}, whole=False)
    assert (str(found["x"]), str(found["y"])) == ("a", "b")
    assert str(product(rest, 1)) == "(c * 3)"


def test_a_sign_is_matched_by_a_sign() -> None:
    negative, positive = pattern("exp(-(a/b))"), pattern("exp(a/b)")
    (bound,) = match(pattern("exp(-x)"), negative, {})
    assert str(bound["x"]) == "(a / b)"
    assert not list(match(pattern("exp(-x)"), positive, {}))


def test_a_variable_stands_for_one_expression_throughout() -> None:
    assert list(match(pattern("sin(x) + cos(x)"), pattern("cos(a) + sin(a)"), {}))
    assert not list(match(pattern("sin(x) + cos(x)"), pattern("cos(a) + sin(b)"), {}))


def test_instances_are_what_was_matched() -> None:
    left, right = pattern("min(x*y, x*z)"), pattern("x*min(y, z)")
    e = pattern("min(p*q, r*p)")
    results = {str(instantiate(right, bound)) for bound in match(left, e, {})}
    assert "(p * min(q, r))" in results


@pytest.mark.parametrize("text", ["a*b/(c*d)", "-a", "(a*b)^3/c^2", "2*a/7", "1/a", "a"])
def test_products_survive_their_factors(text: str) -> None:
    e = pattern(text)
    again = product(factors(e), 1)
    values = {n: (1.0 + i,) for i, n in enumerate("abcd")}
    assert evaluate_precisely(again, values) == pytest.approx(evaluate_precisely(e, values))


def test_of_a_product_only_the_whole_is_a_place() -> None:
    e = pattern("a*b*sqrt(c*d)/m^2")
    found = [str(place) for place, _ in places(e, Ranges({n: Interval(0, 1) for n in "abcdm"}))]
    assert found[0] == str(e)
    assert "(c * d)" in found
    assert "(a * b)" not in found
