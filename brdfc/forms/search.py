"""The search: from a formula to equivalent forms, one rule at one place at a time.

Every form keeps the steps that led to it. What is worth following is not known here: the caller
measures each form (cost and error), and the search goes on from the forms on the front of the two.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import chain

from brdfc.forms.neighbours import Neighbours, Proposal, Step
from brdfc.symbolic.expression import Expression
from brdfc.symbolic.ranges import Ranges


@dataclass(frozen=True)
class Score:
    """What a form is worth: price (ns a pixel) and error (whatever the caller minimises)."""

    price: float
    error: float


@dataclass(frozen=True)
class Form:
    """A form with its score, the form it came from (None: as written), and the step between."""

    expression: Expression
    score: Score
    previous: Form | None = None
    step: Step | None = None

    @property
    def path(self) -> tuple[Form, ...]:
        """The forms from the formula as written to this one."""
        return (*self.previous.path, self) if self.previous else (self,)

    @property
    def steps(self) -> tuple[Step, ...]:
        """Every step from the formula as written."""
        return tuple(form.step for form in self.path if form.step)


@dataclass(frozen=True)
class Found:
    """The forms that do not fail, in the order found. finished: there were no more; stopped:
    `stop` said so; neither: the effort was spent."""

    forms: tuple[Form, ...]
    finished: bool
    stopped: bool


def search(
    expression: Expression,
    ranges: Ranges,
    score: Callable[[Expression], Score | None],
    effort: int,
    stop: Callable[[], bool] = lambda: False,
    proposals: Callable[[Expression], Iterable[Proposal]] = lambda _e: (),
    regimes: bool = False,
) -> Found:
    """Forms of an expression, at most `effort` of them measured.

    score: gives a form's worth, None for one that fails (NaN, infinity, a false zero). stop: asked
    before each; True ends the search with what there is. proposals: other forms of parts of the
    formula as written, measured first. regimes: use rules on a part of the domain, too (see
    Neighbours). Deterministic unless stopped.
    """
    # A formula that fails as it is written may have forms that do not.
    first = score(expression) or Score(float("inf"), float("inf"))
    neighbours = Neighbours(ranges, regimes)
    forms = [Form(expression, first)]
    seen = {expression}
    opened: set[Expression] = set()
    measured = 1
    while True:
        form = _next(forms, opened)
        if form is None:
            return Found(tuple(forms), True, False)
        opened.add(form.expression)
        others = () if form.previous else proposals(expression)
        near = chain(neighbours.proposed(expression, others), neighbours.of(form.expression))
        for step, new in near:
            if new in seen:
                continue
            if measured >= effort or stop():
                return Found(tuple(forms), False, measured < effort)
            seen.add(new)
            measured += 1
            worth = score(new)
            if worth is not None:
                forms.append(Form(new, worth, form, step))


def _next(forms: list[Form], opened: set[Expression]) -> Form | None:
    """The form to go on from: the cheapest not yet opened on the front of price and error, then
    the cheapest near it."""
    best = float("inf")
    candidates = sorted(forms, key=lambda f: (f.score.price, f.score.error, len(f.steps)))
    for form in candidates:
        if form.score.error < best:
            best = form.score.error
            if form.expression not in opened:
                return form
    for form in candidates:
        if form.expression not in opened:
            return form
    return None
