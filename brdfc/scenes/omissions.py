"""Leaving out of a formula what cannot be seen in a scene, with a proof for each omission.

Replacements (candidates.py) are tried where they save most for what they change. One is made when
branch and bound (proof/subdivide.py) proves that the formula with it, and with all made before,
differs from the whole formula by no more than a limit anywhere in the scene. Where the boxes that
a proof may take do not suffice, the part is kept, and the reason is kept too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from brdfc.colour.colorimetry import Colorimetry
from brdfc.proof.pair import Pair
from brdfc.proof.subdivide import SOME, Bound, bound, spread
from brdfc.scenes.candidates import Known, Replacement, replacements, work_in
from brdfc.symbolic.evaluate import evaluate_parts
from brdfc.symbolic.expression import Expression, substituted
from brdfc.symbolic.intervals import Interval

NOTHING = Bound(0.0, 0.0, {}, 0)
"""Of what is left as it is."""
POINTS = 384
"""Points of the domain at which a replacement is tried before a proof is."""
BOXES = 3_000
"""That one proof may take, before the part is kept."""
ALL_BOXES = 14_000
"""That all proofs of a scene may take."""
FINAL_BOXES = 7_000
"""That the bound on the whole may take, beyond."""
POLISH = 300
"""That may follow a proof, for a bound nearer to what was seen."""
PASSES = 3
PRICED = 48
"""Replacements whose saving is found exactly, in a pass; a rough count of operations chooses."""
MISSES = 10
"""Proofs that do not succeed, after which a pass ends."""
LIKELY = 0.8
"""A replacement that was seen to come nearer to the limit than this is not worth a proof."""
_FREE = 0.03
"""Of the limit: what a change costs at least, when savings are weighed against it."""
_SLACK = 0.05
"""Of the limit: until a last bound is sought, one need not be nearer to what was seen."""
_WORTH = 1.0
"""Nanoseconds a pixel that an omission has to save."""


@dataclass(frozen=True)
class Omission:
    """What was left out. bound: on what it and all before it change; saved: nanoseconds."""

    words: str
    bound: Bound
    saved: float


@dataclass(frozen=True)
class Kept:
    """What would have saved something but was kept, and why."""

    words: str
    saved: float
    why: str


@dataclass(frozen=True)
class Lean:
    """formula: what is left. omissions: in the order they were made. kept: the dearest of what was
    not left out for want of a proof. bound: on the difference of this formula from the whole one.
    """

    formula: Expression
    omissions: tuple[Omission, ...]
    kept: tuple[Kept, ...]
    bound: Bound


def leave_out(
    formula: Expression,
    domain: Mapping[str, Sequence[Interval]],
    colorimetry: Colorimetry,
    limit: float,
    price: Callable[[Expression], float],
    alike: Sequence[Sequence[str]] = (),
    simpler: Sequence[Replacement] = (),
) -> Lean:
    """The cheapest formula found that is proved to differ by at most a limit, in CIEDE2000.

    domain: the range of every component of every quantity. price: nanoseconds a pixel of a
    formula. alike: quantities that may stand for one another. simpler: replacements that someone
    knows of, beside the kinds of candidates.py.
    """
    if limit <= 0:
        return Lean(formula, (), (), NOTHING)
    work = _Work(formula, domain, colorimetry, limit, price, alike, tuple(simpler))
    for _ in range(PASSES):
        if not work.once():
            break
    return work.result()


@dataclass
class _Work:
    """lean: the formula so far, cost: its price. points: of the scene; truth: the whole formula's
    values there, values: of the parts of the lean one. boxes: that proofs took. made, kept: what
    was left out, and what not. prices: of formulas; failed: steps that could not be proved."""

    whole: Expression
    domain: Mapping[str, Sequence[Interval]]
    colorimetry: Colorimetry
    limit: float
    price: Callable[[Expression], float]
    alike: Sequence[Sequence[str]]
    simpler: tuple[Replacement, ...]
    lean: Expression = field(init=False)
    cost: float = field(init=False)
    boxes: int = 0
    made: list[Omission] = field(default_factory=list)
    kept: dict[str, Kept] = field(default_factory=dict)
    prices: dict[Expression, float] = field(default_factory=dict)
    failed: set[tuple[Expression, Expression]] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.lean, self.cost = self.whole, self.price(self.whole)
        pair = self.pair(self.whole)
        points = spread(pair, POINTS)
        self.points = pair.by_name(points)
        self.values = evaluate_parts(self.whole, self.points)
        self.truth = self.values[self.whole]

    def pair(self, lean: Expression) -> Pair:
        return Pair(self.whole, lean, self.colorimetry, self.domain)

    def once(self) -> bool:
        """Try everything that may be left out of the lean formula; whether something was."""
        known = Known(self.domain, self.values, self.alike)
        likely = []
        before = work_in(self.lean, known)
        for r in (*self.simpler, *replacements(self.lean, known)):
            lean = substituted(self.lean, {r.part: r.by})
            less = before - work_in(lean, known)
            if less > 0 and (change := self.seen(lean)) <= LIKELY * self.limit:
                weight = change + _FREE * self.limit
                likely.append((less / weight, weight, r, lean))
        likely.sort(key=lambda t: -t[0])
        tried = [
            ((self.cost - self.priced(lean)) / weight, r) for _, weight, r, lean in likely[:PRICED]
        ]
        tried.sort(key=lambda t: -t[0])
        made = misses = 0
        for _, r in tried:
            if misses < MISSES:
                outcome = self.tried(r)
                made, misses = made + (outcome is True), misses + (outcome is False)
        return made > 0

    def priced(self, lean: Expression) -> float:
        if lean not in self.prices:
            self.prices[lean] = self.price(lean)
        return self.prices[lean]

    def seen(self, lean: Expression) -> float:
        """The largest difference at the points; infinite where it is unknown."""
        values = evaluate_parts(lean, self.points, self.values)[lean]
        with np.errstate(all="ignore"):
            found = self.colorimetry.difference(values, self.truth)
        defined = np.isfinite(self.truth).all(axis=-1)
        found = np.broadcast_to(found, np.broadcast_shapes(found.shape, defined.shape))
        worst = float(np.max(found, where=defined, initial=0.0))
        return worst if np.isfinite(worst) else np.inf

    def tried(self, r: Replacement) -> bool | None:
        """Make a replacement if it still saves something and is proved to keep to the limit; None
        where there was nothing to prove."""
        lean = substituted(self.lean, {r.part: r.by})
        if lean is self.lean or (self.lean, lean) in self.failed:
            return None
        saved = self.cost - self.priced(lean)
        if saved < _WORTH or self.seen(lean) > LIKELY * self.limit:
            return None
        budget = min(BOXES, ALL_BOXES - self.boxes)
        if budget < SOME:
            return None
        proved = bound(self.pair(lean), self.limit, budget, POLISH, _SLACK * self.limit)
        self.boxes += proved.boxes
        if proved.most > self.limit:
            self.failed.add((self.lean, lean))
            if proved.seen <= self.limit:
                why = f"seen to change {proved.seen:.2g}, proved to change no more than "
                why += f"{proved.most:.2g} with {proved.boxes:,} boxes"
                self.kept[r.words] = Kept(r.words, saved, why)
            return False
        self.kept.pop(r.words, None)
        self.made.append(Omission(r.words, proved, saved))
        self.lean, self.cost = lean, self.cost - saved
        self.values = evaluate_parts(lean, self.points, self.values)
        return True

    def result(self) -> Lean:
        kept = tuple(sorted(self.kept.values(), key=lambda k: -k.saved))
        if not self.made:
            return Lean(self.lean, (), kept, NOTHING)
        final = bound(self.pair(self.lean), self.limit, FINAL_BOXES, FINAL_BOXES)
        proved = self.made[-1].bound.most
        if final.seen <= proved < final.most:  # another order of boxes proved more
            final = replace(final, most=proved)
        return Lean(self.lean, tuple(self.made), kept, final)
