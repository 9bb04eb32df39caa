"""Forms with their figures, and which of them a goal takes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from brdfc.calc.price import price
from brdfc.calc.program import Program
from brdfc.codegen.schedule import schedule
from brdfc.forms.search import Form
from brdfc.judge.goals import Goal
from brdfc.judge.measure import Judge, Measured
from brdfc.judge.problem import Problem

SAME_BITS = 0.1
"""Errors so near each other are the same: another sample may turn them round."""
SAME_PRICE = 0.02
"""Prices so near each other are the same: the price table is not more exact than that."""


@dataclass(frozen=True)
class Candidate:
    """A form with its figures. program is None where the form was not scheduled; then the price is
    an estimate."""

    form: Form
    measured: Measured
    price: float
    program: Program | None = None

    @property
    def works(self) -> bool:
        """Whether it gives no NaN, infinity or false zero at any point."""
        return math.isfinite(self.price)

    @property
    def merit(self) -> tuple[float, float, int, str]:
        """Cheapest first, then most accurate, then nearest to the formula as written."""
        form = self.form
        return self.price, self.measured.bits, len(form.steps), str(form.expression)


def judged(problem: Problem, judge: Judge, form: Form, scheduled: bool) -> Candidate:
    """A form measured at a judge's points, and scheduled if it may be chosen."""
    graph = judge.shared_out(problem.graph(form.expression))
    measured = judge.measure(graph)
    if measured is None:
        return failed(form)
    if not scheduled:
        return Candidate(form, measured, measured.price)
    program = schedule(graph, problem.inputs)
    return Candidate(form, measured, price(program), program)


def failed(form: Form) -> Candidate:
    """A form that gives NaN, infinity or a false zero."""
    worst = Measured(math.inf, math.inf, math.inf, math.inf, 0)
    return Candidate(form, worst, math.inf)


def choose(finals: Sequence[Candidate], goal: Goal) -> Candidate:
    """The cheapest that is good enough; where none is, the most accurate, which the self-check
    then judges. Of forms that cost the same the most accurate is taken."""
    good = [c for c in finals if goal.accepts(c.measured)]
    if goal.kind == "best" or not good:
        least = min(c.measured.bits for c in finals)
        good = [c for c in finals if c.measured.bits <= least + SAME_BITS]
    least_price = min(c.price for c in good)
    near = [c for c in good if c.price <= least_price * (1 + SAME_PRICE)]
    return min(near, key=lambda c: (c.measured.bits, *c.merit))
