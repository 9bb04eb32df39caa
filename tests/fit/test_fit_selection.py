"""Which of several fitted models is chosen."""

from __future__ import annotations

from dataclasses import replace

from fitted_cases import TRUTH, directions, made

from brdfc.fit.fit import fit
from brdfc.fit.selection import Candidate, chosen
from brdfc.lang.load import load


def candidates() -> list[Candidate]:
    """Three, the largest with the least left; seen and outside are made up."""
    found = []
    for name, seen in (("lambert", 0.2), ("ward", 0.011), ("ggx", 0.010)):
        one = fit(load(name, "full"), made("ward", TRUTH["ward"], directions(60), 0.01), starts=3)
        found.append(Candidate(one, 100.0, 10 * seen, 10 * seen, seen, 0.002, 0.0))
    return found


def name_of(found: Candidate | None) -> str:
    return found.name if found else ""


def test_the_smallest_within_one_standard_error() -> None:
    lambert, ward, ggx = candidates()
    assert name_of(chosen([lambert, ward, ggx], None)) == "ward"
    assert name_of(chosen([lambert, replace(ward, seen=0.013), ggx], None)) == "ggx"


def test_the_smallest_that_keeps_to_a_tolerance() -> None:
    three = candidates()
    assert name_of(chosen(three, 3.0)) == "lambert"
    assert name_of(chosen(three, 1.0)) == "ward"
    assert chosen(three, 0.05) is None


def test_the_cheaper_of_two_alike() -> None:
    _, ward, _ = candidates()
    assert chosen([ward, replace(ward, cost=50.0)], None) == replace(ward, cost=50.0)


def test_a_search_that_did_not_converge_is_not_chosen() -> None:
    lambert, ward, ggx = candidates()
    lost = replace(ward, fit=replace(ward.fit, converged=False))
    assert name_of(chosen([lambert, lost, ggx], None)) == "ggx"
    assert chosen([lost], None) is None
