"""From a formula to the program of its best form: search, measure, schedule, choose."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import count

from brdfc.calc.price import price
from brdfc.calc.program import Program
from brdfc.codegen.nodes import Node, postorder
from brdfc.codegen.schedule import schedule
from brdfc.codegen.select import Binding, select
from brdfc.forms.search import Form, Found, Score, search
from brdfc.judge.goals import Goal
from brdfc.judge.measure import Judge, Measured
from brdfc.judge.strata import FEW, MANY, Points, points
from brdfc.lang.model import Quantity
from brdfc.symbolic.expression import Expression, walk
from brdfc.symbolic.formula import Formula
from brdfc.symbolic.guards import guarded
from brdfc.symbolic.ranges import Ranges
from brdfc.symbolic.sympy_forms import proposals

EFFORT = 300
"""Forms measured by default, of a formula with so few parts that WORK is not exceeded."""
WORK = 10_000
"""Forms times parts of the formula, by default: about the same time for any formula."""
SYMPY_EFFORT = 500
"""From this effort on, what SymPy's simplify and fu make of the formula is measured too."""
PATIENCE = 60.0
"""Seconds after which a search stops with what it has; the result then depends on the machine."""

_FINALISTS = 8
SCHEDULED = 400
"""Operators of all finalists of a kind together: scheduling takes longer than measuring."""
_HOPELESS = 1.04
"""A form whose corrected estimate is beyond the best price by this factor is not scheduled."""
_SAME_BITS = 0.1
SAME_PRICE = 0.02
"""Prices so near each other are the same: the price table is not more exact than that."""


@dataclass(frozen=True)
class Problem:
    """What is to be compiled, and its surroundings."""

    formula: Formula
    quantities: tuple[Quantity, ...]
    bindings: Mapping[str, Binding]
    inputs: int

    @property
    def exact(self) -> Expression:
        """The formula as the model writes it."""
        return self.formula.exact

    @property
    def start(self) -> Expression:
        """The form a search starts from."""
        return self.formula.simple

    @cached_property
    def ranges(self) -> Ranges:
        return Ranges(self.formula.domain)


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


@dataclass(frozen=True)
class Explored:
    """All forms that did not fail in the search, those of the steps to the chosen one among them.

    finished: there were no more forms to measure. stopped: patience ran out before the effort was
    spent, so that the result may be another on a faster machine.
    """

    candidates: tuple[Candidate, ...]
    chosen: Candidate
    finished: bool
    stopped: bool
    points: int

    @property
    def written(self) -> Candidate:
        """The formula as the model writes it."""
        return self.candidates[0]

    def derivation(self) -> tuple[Candidate, ...]:
        """The forms from the formula as written to the chosen one."""
        by_form = {c.form.expression: c for c in self.candidates}
        return tuple(by_form[form.expression] for form in self.chosen.form.path)


def default_effort(problem: Problem) -> int:
    """How many forms are measured unless someone says otherwise."""
    parts = sum(1 for _ in walk(problem.start))
    return max(10, min(EFFORT, WORK // parts))


def explore(
    problem: Problem,
    goal: Goal,
    effort: int,
    progress: Callable[[int, int], None] = lambda done, total: None,
    *,
    thorough: bool = False,
) -> Explored | None:
    """The best form of a formula for a goal; None where every form fails.

    effort: forms measured at most. A few hundred points guide the search; the forms worth
    choosing are measured again at thousands, and scheduled; with thorough all of them are, so that
    they can be compared. progress gets forms measured and the effort.
    """
    judge = Judge(problem.exact, _points(problem, FEW), problem.quantities, problem.bindings)
    found, figures = _searched(problem, judge, effort, progress)
    candidates = {
        form.expression: Candidate(form, figures[form.expression], figures[form.expression].price)
        if form.expression in figures
        else _failed(form)
        for form in found.forms
    }
    # Where float64 is not good enough for the truth, its price limits how many points there are.
    many = _points(problem, MANY if judge.quick else 2 * FEW)
    strict = Judge(problem.exact, many, problem.quantities, problem.bindings)
    few = max(2, min(_FINALISTS, SCHEDULED // len(postorder(_graph(problem, problem.start)))))
    finals = _finals(problem, strict, candidates, goal, few)
    if not finals:
        return None
    chosen = _choose(finals, goal)
    # The steps to it get figures that compare with its own.
    for form in chosen.form.path:
        if candidates[form.expression].program is None:
            candidates[form.expression] = _judged(problem, strict, form, scheduled=True)
    if thorough:
        scale = chosen.price / chosen.measured.price
        for expression, c in candidates.items():
            if c.works and c.program is None:
                c = _judged(problem, strict, c.form, scheduled=False)
                # An estimate, corrected by how far it was off where it counts.
                candidates[expression] = replace(c, price=scale * c.price)
        _schedule_fronts(problem, strict, candidates)
    return Explored(tuple(candidates.values()), chosen, found.finished, found.stopped, many.count)


def _schedule_fronts(
    problem: Problem, strict: Judge, candidates: dict[Expression, Candidate]
) -> None:
    """Schedule what the fronts of price and error consist of, twice: the second time what came to
    the front because another form proved dearer than its estimate."""
    for _ in range(2):
        working = sorted((c for c in candidates.values() if c.works), key=_merit)
        estimates: list[Candidate] = []
        for error in ("bits", "de"):
            best = float("inf")
            for c in working:
                if getattr(c.measured, error) < best:
                    best = getattr(c.measured, error)
                    estimates += [c] if c.program is None else []
        for c in estimates:
            candidates[c.form.expression] = _judged(problem, strict, c.form, scheduled=True)


def _searched(
    problem: Problem, judge: Judge, effort: int, progress: Callable[[int, int], None]
) -> tuple[Found, dict[Expression, Measured]]:
    """The forms a search finds, and the figures of those that do not fail."""
    figures: dict[Expression, Measured] = {}
    measured_so_far = count()

    def score(e: Expression) -> Score | None:
        progress(next(measured_so_far), effort)
        measured = judge.measure(_graph(problem, e))
        if measured is None:
            return None
        figures[e] = measured
        return Score(measured.price, measured.bits)

    deadline = time.monotonic() + PATIENCE

    def stop() -> bool:
        return time.monotonic() > deadline

    # SymPy takes seconds over a formula, so it is asked only where time is not short.
    proposed = proposals if effort >= SYMPY_EFFORT else (lambda _e: ())
    ranges = Ranges(problem.ranges.domain)
    return search(problem.start, ranges, score, effort, stop, proposed), figures


def _judged(problem: Problem, strict: Judge, form: Form, scheduled: bool) -> Candidate:
    """A form measured at many points, and scheduled if it may be chosen."""
    graph = _graph(problem, form.expression)
    measured = strict.measure(graph)
    if measured is None:
        return _failed(form)
    if not scheduled:
        return Candidate(form, measured, measured.price)
    program = schedule(graph, problem.inputs)
    return Candidate(form, measured, price(program), program)


def _failed(form: Form) -> Candidate:
    """A form that gives NaN, infinity or a false zero."""
    worst = Measured(float("inf"), float("inf"), float("inf"), float("inf"), 0)
    return Candidate(form, worst, float("inf"))


def _points(problem: Problem, scale: int) -> Points:
    return points(problem.ranges.domain, problem.quantities, scale)


def _graph(problem: Problem, e: Expression) -> Node:
    # Ranges of its own: what those of a whole search still learn depends on the forms before.
    return select(guarded(e, Ranges(problem.ranges.domain))[0], problem.bindings)


def _finals(
    problem: Problem,
    strict: Judge,
    candidates: dict[Expression, Candidate],
    goal: Goal,
    few: int,
) -> list[Candidate]:
    """The forms to choose from, measured strictly and scheduled: as written, so many of the
    cheapest that seem good enough, and where accuracy is asked for or none of those holds, of the
    most accurate."""

    def judged(chosen: list[Candidate]) -> list[Candidate]:
        for expression in (c.form.expression for c in chosen):
            known = candidates[expression]
            if known.program is None and known.works:
                candidates[expression] = _judged(problem, strict, known.form, scheduled=True)
        finals = (candidates[c.form.expression] for c in chosen)
        return [c for c in finals if c.works]

    every = list(candidates.values())
    working = [c for c in every if c.works]
    good = [c for c in working if goal.accepts(c.measured)]
    finals = judged([every[0]])
    best, off = math.inf, 1.0  # the cheapest so far, and how far its estimate was off
    for c in sorted(good, key=_merit)[:few]:
        if c.price * off > best * _HOPELESS:
            break
        for final in judged([c]):
            finals.append(final)
            if goal.accepts(final.measured) and final.price < best:
                best, off = final.price, final.price / c.price
    if goal.kind == "best" or not any(goal.accepts(c.measured) for c in finals):
        working.sort(key=lambda c: (round(c.measured.mean_bits, 2), *_merit(c)))
        finals += judged([candidates[c.form.expression] for c in working[:few]])
    return finals


def _merit(c: Candidate) -> tuple[float, float, int, str]:
    """Cheapest first, then most accurate, then nearest to the formula as written."""
    return c.price, c.measured.bits, len(c.form.steps), str(c.form.expression)


def _choose(finals: list[Candidate], goal: Goal) -> Candidate:
    """The cheapest that is good enough; where none is, the most accurate, which the self-check
    then judges. Of forms that cost the same the most accurate is taken."""
    good = [c for c in finals if goal.accepts(c.measured)]
    if goal.kind == "best" or not good:
        least = min(c.measured.bits for c in finals)
        good = [c for c in finals if c.measured.bits <= least + _SAME_BITS]
    least_price = min(c.price for c in good)
    near = [c for c in good if c.price <= least_price * (1 + SAME_PRICE)]
    return min(near, key=lambda c: (c.measured.bits, *_merit(c)))
