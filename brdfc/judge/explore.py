"""From a formula to the program of its best form: search, split, measure, schedule, choose."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import count

from brdfc.codegen.nodes import postorder
from brdfc.forms.search import Form, Found, Score, search
from brdfc.judge.candidates import Candidate, choose, failed, judged
from brdfc.judge.goals import Goal
from brdfc.judge.measure import Judge, Measured
from brdfc.judge.problem import Problem
from brdfc.judge.regimes import splits
from brdfc.judge.strata import FEW, MANY
from brdfc.symbolic.expression import Expression
from brdfc.symbolic.ranges import Ranges
from brdfc.symbolic.sympy_forms import proposals

SYMPY_EFFORT = 500
"""From this effort on, what SymPy's simplify and fu make of the formula is measured too."""
PATIENCE = 60.0
"""Seconds after which a search stops with what it has; the result then depends on the machine."""

_FINALISTS = 8
SCHEDULED = 400
"""Operators of all finalists of a kind together: scheduling takes longer than measuring."""
_HOPELESS = 1.04
"""A form whose corrected estimate is beyond the best price by this factor is not scheduled."""


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


Candidates = dict[Expression, Candidate]


def explore(
    problem: Problem,
    goal: Goal,
    effort: int,
    progress: Callable[[int, int], None] = lambda done, total: None,
    *,
    thorough: bool = False,
) -> Explored | None:
    """The best form of a formula for a goal; None where every form fails.

    effort: forms measured at most; as many again, with rules used on a part of the domain, where
    none of those reaches the goal. A few hundred points guide the search; the forms worth
    choosing are measured again at thousands, and scheduled; with thorough all of them are, so that
    they can be compared. progress gets forms measured and the effort.
    """
    judge = Judge(problem, problem.points(FEW))
    found, candidates = _searched(problem, judge, effort, progress, regimes=goal.kind == "best")
    if not any(goal.accepts(c.measured) for c in candidates.values()) and not found.stopped:
        found, more = _searched(problem, judge, effort, progress, regimes=True)
        candidates |= {e: c for e, c in more.items() if e not in candidates}
    # Where float64 is not good enough for the truth, its price limits how many points there are.
    many = problem.final_points(MANY if judge.quick else 2 * FEW)
    strict = Judge(problem, many)
    few = max(2, min(_FINALISTS, SCHEDULED // len(postorder(problem.graph(problem.start)))))
    finals = _finals(problem, strict, candidates, goal, few)
    if not finals:
        return None
    if effort > 1:
        for form in splits(problem, strict, tuple(candidates.values()), finals, goal):
            split = judged(problem, strict, form, scheduled=True)
            candidates.setdefault(form.expression, split)
            finals += [split] if split.works else []
    chosen = choose(finals, goal)
    # The steps to it get figures that compare with its own.
    for form in chosen.form.path:
        if candidates[form.expression].program is None:
            candidates[form.expression] = judged(problem, strict, form, scheduled=True)
    if thorough:
        scale = chosen.price / chosen.measured.price
        for expression, c in candidates.items():
            if c.works and c.program is None:
                c = judged(problem, strict, c.form, scheduled=False)
                # An estimate, corrected by how far it was off where it counts.
                candidates[expression] = replace(c, price=scale * c.price)
        _schedule_fronts(problem, strict, candidates)
    return Explored(tuple(candidates.values()), chosen, found.finished, found.stopped, many.count)


def _schedule_fronts(problem: Problem, strict: Judge, candidates: Candidates) -> None:
    """Schedule what the fronts of price and error consist of, twice: the second time what came to
    the front because another form proved dearer than its estimate."""
    for _ in range(2):
        working = sorted((c for c in candidates.values() if c.works), key=lambda c: c.merit)
        estimates: list[Candidate] = []
        for error in ("bits", "de"):
            best = float("inf")
            for c in working:
                if getattr(c.measured, error) < best:
                    best = getattr(c.measured, error)
                    estimates += [c] if c.program is None else []
        for c in estimates:
            candidates[c.form.expression] = judged(problem, strict, c.form, scheduled=True)


def _searched(
    problem: Problem,
    judge: Judge,
    effort: int,
    progress: Callable[[int, int], None],
    regimes: bool,
) -> tuple[Found, Candidates]:
    """The forms a search finds, with figures for those that do not fail."""
    figures: dict[Expression, Measured] = {}
    measured_so_far = count()

    def score(e: Expression) -> Score | None:
        progress(next(measured_so_far), effort)
        measured = judge.measure(judge.shared_out(problem.graph(e)))
        if measured is None:
            return None
        figures[e] = measured
        return Score(measured.price, measured.bits)

    def candidate(form: Form) -> Candidate:
        measured = figures.get(form.expression)
        return Candidate(form, measured, measured.price) if measured else failed(form)

    deadline = time.monotonic() + PATIENCE

    def stop() -> bool:
        return time.monotonic() > deadline

    # SymPy takes seconds over a formula, so it is asked only where time is not short.
    proposed = proposals if effort >= SYMPY_EFFORT else (lambda _e: ())
    ranges = Ranges(problem.ranges.domain)
    found = search(problem.start, ranges, score, effort, stop, proposed, regimes)
    return found, {form.expression: candidate(form) for form in found.forms}


def _finals(
    problem: Problem, strict: Judge, candidates: Candidates, goal: Goal, few: int
) -> list[Candidate]:
    """The forms to choose from, measured strictly and scheduled: as written, so many of the
    cheapest that seem good enough, and where accuracy is asked for or none of those holds, of the
    most accurate."""

    def strictly(chosen: list[Candidate]) -> list[Candidate]:
        for expression in (c.form.expression for c in chosen):
            known = candidates[expression]
            if known.program is None and known.works:
                candidates[expression] = judged(problem, strict, known.form, scheduled=True)
        finals = (candidates[c.form.expression] for c in chosen)
        return [c for c in finals if c.works]

    every = list(candidates.values())
    working = [c for c in every if c.works]
    good = [c for c in working if goal.accepts(c.measured)]
    finals = strictly([every[0]])
    best, off = math.inf, 1.0  # the cheapest so far, and how far its estimate was off
    for c in sorted(good, key=lambda c: c.merit)[:few]:
        if c.price * off > best * _HOPELESS:
            break
        for final in strictly([c]):
            finals.append(final)
            if goal.accepts(final.measured) and final.price < best:
                best, off = final.price, final.price / c.price
    if goal.kind == "best" or not any(goal.accepts(c.measured) for c in finals):
        working.sort(key=lambda c: (round(c.measured.mean_bits, 2), *c.merit))
        finals += strictly([candidates[c.form.expression] for c in working[:few]])
    return finals
