"""A formula fitted to a scene: nothing that cannot be seen there is left in it.

The scene's ranges alone make some of a formula needless; of the rest, what is proved invisible is
left out (omissions.py); then the quantities that nothing reads any more are dropped, a colour's
components one by one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from brdfc.codegen.estimate import estimated_price
from brdfc.judge.problem import Problem
from brdfc.lang.model import Quantity
from brdfc.lang.types import TYPES
from brdfc.scenes.candidates import Replacement
from brdfc.scenes.omissions import Lean, leave_out
from brdfc.symbolic.build import Simpler
from brdfc.symbolic.constants import fold_constants
from brdfc.symbolic.expression import Expression, describe, quantity, substituted, walk
from brdfc.symbolic.formula import Formula, simplest
from brdfc.symbolic.guards import guarded
from brdfc.symbolic.intervals import Interval
from brdfc.symbolic.ranges import Ranges
from brdfc.symbolic.rewrite import rewrite
from brdfc.symbolic.simplify import simplified

RESERVED = 0.1
"""Of a tolerance: kept for the rounding of the program; at least ROUNDING."""
ROUNDING = 4e-4
"""CIEDE2000 that 32-bit floats cost, of a good form."""


def reserved(tolerance: float) -> float:
    """What of a tolerance the program's own rounding may take; the rest is for omissions."""
    return min(tolerance, max(RESERVED * tolerance, ROUNDING))


@dataclass(frozen=True)
class Fitted:
    """lean: what is left of the formula, and what was left out; formula: what is left, of the
    quantities that it reads. channels, variables: those quantities; unread: the names
    of channels and variables that are dropped. always: what the ranges alone made needless, in
    words. declared: the ranges that the model itself declares for the quantities: there a program
    has to be finite."""

    lean: Lean
    formula: Formula
    channels: tuple[Quantity, ...]
    variables: tuple[Quantity, ...]
    unread: tuple[str, ...]
    always: tuple[str, ...]
    declared: Mapping[str, Interval]


def fit(
    problem: Problem,
    channels: Sequence[Quantity],
    variables: Sequence[Quantity],
    ranges: Mapping[str, Sequence[Interval]],
    tolerance: float,
    simpler: Sequence[Simpler] = (),
) -> Fitted:
    """Fit a problem, of a scene's formula and quantities, to a tolerance.

    problem: whose domain is the scene's, and whose guards are for the ranges that the model
    declares. ranges: of components, where the scene knows more than the domain. simpler: what the
    model's definitions say is simpler than parts of the exact formula.
    """
    formula = problem.formula
    domain = {
        q.name: tuple(ranges.get(q.name) or (formula.domain[q.name],) * q.type.value.width)
        for q in (*channels, *variables)
    }

    def price(e: Expression) -> float:
        return estimated_price(problem.graph(simplest(e, formula.domain)))

    def light(e: Expression) -> Expression:
        # Not `simplest`: products in another order would hide which parts were replaced.
        return rewrite(fold_constants(e), Ranges(formula.domain), simplified)

    lean = leave_out(
        light(formula.exact),
        domain,
        problem.colorimetry,
        tolerance - reserved(tolerance),
        price,
        _alike(channels),
        [Replacement(light(s.part), light(s.by), s.words) for s in simpler],
    )
    tidy = simplest(lean.formula, formula.domain)
    read = _read(tidy)
    if not any(q.name in read for q in channels):  # a profile has one channel at least
        read[channels[0].name] = set(range(channels[0].type.value.width))
    single = {
        (q.name, i): q.component_names[i]
        for q in channels
        for i in read.get(q.name, ())
        if len(read[q.name]) < q.type.value.width
    }
    kept = [part for q in channels for part in _kept(q, read.get(q.name, set()), domain[q.name])]
    used = [q for q in variables if q.name in read]
    owner = {q.name: q.name for q in (*kept, *used)} | {
        new: old for (old, _), new in single.items()
    }
    names = {n for q in (*kept, *used) for n in q.component_names}
    every = [n for q in (*channels, *variables) for n in q.component_names]
    declared = problem.declared or formula.domain
    ends = {q.name: Interval(q.low, q.high) for q in kept if owner[q.name] != q.name}
    ends |= {q.name: formula.domain[q.name] for q in (*kept, *used) if q.name not in ends}
    return Fitted(
        lean,
        Formula(_apart(tidy, single), ends, formula.white),
        tuple(kept),
        tuple(used),
        tuple(n for n in every if n not in names),
        tuple(_needless(formula, declared)),
        {name: declared[old] for name, old in owner.items()},
    )


def _alike(channels: Sequence[Quantity]) -> list[list[str]]:
    """Names of channels of one type and range: one may stand for another."""
    groups: dict[tuple[str, float, float], list[str]] = {}
    for q in channels:
        groups.setdefault((q.type.name, q.low, q.high), []).append(q.name)
    return [names for names in groups.values() if len(names) > 1]


def _read(e: Expression) -> dict[str, set[int]]:
    """The components of each quantity that an expression reads."""
    whole = {a for part in walk(e) if part.operator != "component" for a in part.arguments} | {e}
    found: dict[str, set[int]] = {}
    for part in walk(e):
        if part.operator == "quantity" and part in whole:
            found[part.name] = set(range(part.width))
        elif part.operator == "component" and part.arguments[0].operator == "quantity":
            found.setdefault(part.arguments[0].name, set()).add(part.index)
    return found


def _kept(q: Quantity, used: set[int], ranges: Sequence[Interval]) -> Iterator[Quantity]:
    """A channel, or those of its components that are read, each a channel of its own."""
    if len(used) == q.type.value.width:
        yield q
        return
    for i in sorted(used):
        yield replace(
            q,
            name=q.component_names[i],
            type=TYPES["number"],
            low=ranges[i].low,
            high=ranges[i].high,
            default=(q.default[i],),
        )


def _apart(e: Expression, single: Mapping[tuple[str, int], str]) -> Expression:
    """With the components that have become channels of their own under their new names."""
    new = {
        part: quantity(single[part.arguments[0].name, part.index], 1)
        for part in walk(e)
        if part.operator == "component" and (part.arguments[0].name, part.index) in single
    }
    return substituted(e, new)


def _needless(formula: Formula, declared: Mapping[str, Interval]) -> Iterator[str]:
    """What of the formula the scene's ranges decide, and the model's do not."""
    here, everywhere = Ranges(formula.domain), Ranges(declared)
    for e in walk(formula.exact):
        if e.operator not in ("where", "min", "max"):
            continue
        decided = [_decided(e, ranges) for ranges in (here, everywhere)]
        if decided[0] and not decided[1]:
            yield decided[0]
    before, after = (
        {g.operation for g in guarded(formula.exact, ranges)[1]} for ranges in (everywhere, here)
    )
    for operation in sorted(before - after):
        yield f"a guard on {operation}"


def _decided(e: Expression, ranges: Ranges) -> str:
    """What an expression always is, in words; empty where that is not known."""
    if e.operator == "where":
        truth = ranges.of(e.arguments[0])
        if truth.low >= 1 or truth.high <= 0:
            always = "always" if truth.low >= 1 else "never"
            return f"the choice by {describe(e.arguments[0], 3)}, which {always} holds"
        return ""
    a, b = (ranges.of(argument) for argument in e.arguments)
    if a.undefined or b.undefined or not (a.high <= b.low or b.high <= a.low):
        return ""
    first = (a.high <= b.low) == (e.operator == "min")
    kept = e.arguments[0 if first else 1]
    return f"a {e.operator}imum, which is always {describe(kept, 3)}"
