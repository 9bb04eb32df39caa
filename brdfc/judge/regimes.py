"""Regime splits: one form where it is good, another where that is not.

Of two forms measured at the same points, one may be cheap and fail somewhere, the other careful
everywhere; or each may be good where the other is not. Where the points at which one is good lie on
one side of some value, `one where value < threshold else other` is a form of its own. (Herbie finds
regimes in the same way: P. Panchekha, A. Sanchez-Stern, J. Wilcox, Z. Tatlock, Automatically
improving accuracy for floating point expressions, PLDI 2015.)
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import permutations

import numpy as np
from numpy.typing import NDArray

from brdfc.codegen.estimate import estimated_price
from brdfc.forms.neighbours import Step
from brdfc.forms.search import Form
from brdfc.judge.candidates import SAME_BITS, Candidate, choose
from brdfc.judge.goals import Goal
from brdfc.judge.measure import Judge
from brdfc.judge.problem import Problem
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.expression import Expression, const, describe, make, quantity, rebuild, walk

Values = NDArray[np.float64]

_TRIED = 4
"""Forms tried as sides of a split."""
_WORTH_BITS, _WORTH_PRICE = 0.5, 0.1
"""What a split must gain: a program with one is longer, and a processor may guess its branch wrong.
"""
_MARGIN = 4
"""How far below the limit the cheap side's error must stay at a judge's points: between them it may
be larger."""
_MOST_BRANCHES = 60
_CONDITIONS = ("lt", "le", "gt", "ge", "eq", "ne", "and", "or", "not")


@dataclass(frozen=True, eq=False)
class Side:
    """A form, and its error at every point, in whatever unit the goal counts."""

    form: Form
    errors: Values


@dataclass(frozen=True, eq=False)
class Split:
    """low where of < threshold, else high. worst: the error at the worst point; share: the part of
    the points that takes low."""

    low: Side
    high: Side
    of: Expression
    threshold: Fraction
    worst: float
    share: float

    @property
    def expression(self) -> Expression:
        """The form: a choice between the two, where they differ."""
        below = make("lt", self.of, const(self.threshold))
        return _chosen(below, self.low.form.expression, self.high.form.expression)

    @property
    def form(self) -> Form:
        """The same with the step that leads to it, from the more accurate of the two."""
        before = min(self.low, self.high, key=lambda side: float(side.errors.max())).form
        step = Step("split", describe(before.expression), describe(self.expression))
        return Form(self.expression, before.score, before, step)

    def share_of(self, side: Side) -> float:
        """The part of the points that takes one of the two."""
        return self.share if side is self.low else 1 - self.share


def splits(
    problem: Problem,
    judge: Judge,
    candidates: Sequence[Candidate],
    finals: Sequence[Candidate],
    goal: Goal,
) -> list[Form]:
    """Splits that may serve a goal better than the best of the final forms, which a judge has
    measured at its points.

    Where that reaches the goal: a cheaper form, which fails somewhere, beside it, if that costs
    less. Otherwise, or where accuracy is asked for: two finals more accurate together than alone.
    """
    splitter = Splitter({n: v.astype(np.float64) for n, v in judge.points.values.items()})

    def side(c: Candidate, margin: int = 1) -> Side:
        bits, de = judge.errors(problem.graph(c.form.expression))
        return Side(c.form, bits + math.log2(margin) if goal.counts_bits else de * margin)

    def estimate(form: Form) -> float:
        return estimated_price(judge.shared_out(problem.graph(form.expression)))

    best = choose(finals, goal)
    reached = goal.kind == "best" or goal.accepts(best.measured)
    found = []
    if reached:
        most = best.measured.bits + SAME_BITS if goal.kind == "best" else goal.most
        limit = best.measured.price * (1 - _WORTH_PRICE)
        cheap = sorted((c for c in candidates if c.measured.price < limit), key=lambda c: c.merit)
        careful = side(best)
        tried = [splitter.most_used(side(c, _MARGIN), careful, most) for c in cheap[:_TRIED]]
        forms = [split.form for split in tried if split]
        found += sorted((f for f in forms if estimate(f) < limit), key=estimate)[:1]
    if goal.kind == "best" or not reached:
        sides = [side(c) for c in sorted(finals, key=lambda c: c.measured.bits)[:_TRIED]]
        pairs = [splitter.most_accurate(a, b) for a, b in permutations(sides, 2)]
        least = min(float(s.errors.max()) for s in sides)
        worth = least - _WORTH_BITS if goal.counts_bits else least / 2**_WORTH_BITS
        better = sorted((s for s in pairs if s and s.worst < worth), key=lambda s: s.worst)
        found += [split.form for split in better[:1]]
    return found


class Splitter:
    """Finds splits between forms at fixed points. values: (points, components) by quantity."""

    def __init__(self, values: Mapping[str, Values]) -> None:
        self.values = values
        self._sorted: dict[Expression, tuple[NDArray[np.intp], Values] | None] = {}

    def most_used(self, cheap: Side, careful: Side, limit: float) -> Split | None:
        """The split within an error limit whose cheap side takes the most points, or None."""
        best: Split | None = None
        for low, high in ((cheap, careful), (careful, cheap)):
            for of, values, worst in self._worst(low, high):
                good = np.flatnonzero(worst <= limit)
                if len(good):
                    at = int(good[-1 if low is cheap else 0])
                    split = _split(low, high, of, values, worst, at)
                    if best is None or split.share_of(cheap) > best.share_of(cheap):
                        best = split
        return best

    def most_accurate(self, low: Side, high: Side) -> Split | None:
        """The split whose worst error is least, or None where there is nothing to split at."""
        best: Split | None = None
        for of, values, worst in self._worst(low, high):
            at = int(np.argmin(worst))
            if np.isfinite(worst[at]) and (best is None or worst[at] < best.worst):
                best = _split(low, high, of, values, worst, at)
        return best

    def _worst(self, low: Side, high: Side) -> Iterator[tuple[Expression, Values, Values]]:
        """For every value to split at: its values in order, and the worst error of a split after
        each but the last (infinite between equal values)."""
        for of in self._branches(low.form.expression, high.form.expression):
            known = self._ordered(of)
            if known is not None:
                order, values = known
                below = np.maximum.accumulate(low.errors[order])[:-1]
                above = np.maximum.accumulate(high.errors[order][::-1])[::-1][1:]
                apart = values[1:] > values[:-1]
                yield of, values, np.where(apart, np.maximum(below, above), np.inf)

    def _branches(self, a: Expression, b: Expression) -> list[Expression]:
        """Values to split at: scalars, without their sign too, and what the forms compute."""
        scalars = [quantity(name, 1) for name, v in self.values.items() if v.shape[1] == 1]
        signed = [s for s in scalars if (self.values[s.name] < 0).any()]
        found = dict.fromkeys([*scalars, *(make("abs", s) for s in signed)])
        for e in (*walk(a), *walk(b)):
            if e.width == 1 and e.arguments and e.operator not in _CONDITIONS:
                found[e] = None
        return list(found)[:_MOST_BRANCHES]

    def _ordered(self, of: Expression) -> tuple[NDArray[np.intp], Values] | None:
        """The points in the order of a value, and its values; None where it has none somewhere."""
        if of not in self._sorted:
            values = np.broadcast_to(evaluate(of, self.values)[..., 0], self._count)
            order = np.argsort(values, kind="stable")
            self._sorted[of] = (order, values[order]) if np.isfinite(values).all() else None
        return self._sorted[of]

    @property
    def _count(self) -> int:
        return len(next(iter(self.values.values())))


def _split(low: Side, high: Side, of: Expression, values: Values, worst: Values, at: int) -> Split:
    threshold = between(float(values[at]), float(values[at + 1]))
    return Split(low, high, of, threshold, float(worst[at]), (at + 1) / len(values))


def _chosen(condition: Expression, a: Expression, b: Expression) -> Expression:
    """a where a condition holds, else b; what is the same around one difference stays outside."""
    if a is b:
        return a
    if (a.operator, a.width, len(a.arguments)) == (b.operator, b.width, len(b.arguments)):
        pairs = list(zip(a.arguments, b.arguments, strict=True))
        if sum(x is not y for x, y in pairs) == 1 and a.operator != "component":
            return rebuild(a, [_chosen(condition, x, y) for x, y in pairs])
    return make("where", condition, a, b)


def between(low: float, high: float) -> Fraction:
    """The shortest decimal above low and not above high."""
    middle = (low + high) / 2
    for digits in range(1, 18):
        short = Fraction(f"{middle:.{digits}g}")
        if low < short <= high:
            return short
    return Fraction(high)
