"""What might be left out of a formula: parts of it, each with something cheaper in its place.

Nothing here decides whether that can be seen (omissions.py does). A kind of omission is a function
in KINDS, from one part of the formula and what is known of it to its replacements. Replacements
keep the operator they stand below, x*1 in place of x, so that the change of the result can be
followed from them (proof/changes.py).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from brdfc.proof.intervals import CONDITIONS, FUNCTIONS
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.expression import (
    ONE,
    ZERO,
    Expression,
    component,
    const,
    describe,
    make,
    quantity,
    vector,
    walk,
)
from brdfc.symbolic.intervals import Interval

Array = NDArray[np.float64]

NODES = 33
"""Values of a function that a polynomial in its place is fitted to, at Chebyshev's nodes."""

_OWN_ARGUMENT = ("sin", "tan", "asin", "atan")
"""Functions that are nearly their argument where that is small."""
_LEVELS = 3
_ANY = "x"


@dataclass(frozen=True)
class Replacement:
    """One part of a formula, by what it is replaced, and that in words."""

    part: Expression
    by: Expression
    words: str


@dataclass
class Known:
    """What is known of the parts of a formula.

    domain: the range of every component of every quantity. values: of parts, at points of it.
    alike: names of quantities that may stand for one another. reads: the names of quantities below
    a part.
    """

    domain: Mapping[str, Sequence[Interval]]
    values: Mapping[Expression, Array]
    alike: Sequence[Sequence[str]] = ()
    reads: dict[Expression, frozenset[str]] = field(default_factory=dict)

    def quantities(self, e: Expression) -> frozenset[str]:
        """The names of the quantities below a part."""
        if e not in self.reads:
            for part in walk(e):
                own = [part.name] if part.operator == "quantity" else []
                below = (self.reads[a] for a in part.arguments)
                self.reads[part] = frozenset(own).union(*below)
        return self.reads[e]

    def ends(self, e: Expression) -> tuple[Array, Array] | None:
        """The least and greatest value of each component at the points; None where one is not
        finite."""
        found = self.values[e].reshape(-1, self.values[e].shape[-1])
        low, high = found.min(axis=0), found.max(axis=0)
        good = np.isfinite(low).all() and np.isfinite(high).all()
        return (np.broadcast_to(low, e.width), np.broadcast_to(high, e.width)) if good else None


def replacements(formula: Expression, known: Known) -> Iterator[Replacement]:
    """Everything that might be left out of a formula, larger parts last."""
    for e in walk(formula):
        if e.operator in CONDITIONS or not known.quantities(e):
            continue
        for kind in KINDS:
            yield from (r for r in kind(e, known) if r.by is not e)


_WORK = {"exp": 4, "ln": 4, "log10": 4, "sin": 4, "cos": 4, "tan": 5, "asin": 5, "acos": 5}
_WORK |= {"atan": 5, "atan2": 5, "pow": 3, "cbrt": 4, "div": 2, "sqrt": 2}
_WORK |= {"const": 0, "pi": 0, "quantity": 0, "vector": 0, "component": 0}


def work_in(formula: Expression, known: Known) -> int:
    """Roughly how much there is to do for a pixel: operations on what is not constant, dear ones
    several times."""
    return sum(
        _WORK.get(e.operator, 1) + e.width - 1
        for e in walk(formula)
        if e.arguments and known.quantities(e) and not _idle(e)
    )


def _idle(e: Expression) -> bool:
    """Whether nothing is done: x*1, x/1, x + 0, a choice between two that are the same."""
    match e.operator:
        case "mul" | "div":
            return ONE in e.arguments
        case "add" | "sub":
            return ZERO in e.arguments
        case "where":
            return e.arguments[1] is e.arguments[2]
    return e.operator in ("vector", "component")


def single(value: float) -> Expression:
    """A number as a program holds it."""
    return const(Fraction(float(np.float32(value))))


def _text(e: Expression) -> str:
    return describe(e, _LEVELS)


def _term(e: Expression, _known: Known) -> Iterator[Replacement]:
    if e.operator in ("add", "sub") and ZERO not in e.arguments:
        a, b = e.arguments
        for kept, gone, by in ((b, a, (ZERO, b)), (a, b, (a, ZERO))):
            if kept.width == e.width:
                yield Replacement(e, make(e.operator, *by), f"the term {_text(gone)}")


def _factor(e: Expression, known: Known) -> Iterator[Replacement]:
    if e.operator not in ("mul", "div") or ONE in e.arguments:
        return
    a, b = e.arguments
    sides = [(b, (a, ONE))] + ([(a, (ONE, b))] if e.operator == "mul" else [])
    for gone, by in sides:
        if known.quantities(gone) and max(x.width for x in by) == e.width:
            how = "the factor" if e.operator == "mul" else "the division by"
            yield Replacement(e, make(e.operator, *by), f"{how} {_text(gone)}")


def _constant(e: Expression, known: Known) -> Iterator[Replacement]:
    if e.operator == "quantity":
        ends = known.domain[e.name]
        middle = np.array([(i.low + i.high) / 2 for i in ends])
    else:
        found = known.ends(e)
        if found is None:
            return
        middle = (found[0] + found[1]) / 2
    parts = [single(v) for v in middle]
    by = parts[0] if e.width == 1 else vector(parts)
    shown = ", ".join(f"{v:.6g}" for v in middle)
    yield Replacement(e, by, f"{_text(e)}, taken as {shown}")


def _polynomial(e: Expression, known: Known) -> Iterator[Replacement]:
    """A function of one quantity, or of one argument, as a straight line or a parabola in it."""
    if e.width > 1 or e.operator in ("quantity", "component"):
        return
    names = known.quantities(e)
    if len(names) == 1 and len(known.domain[next(iter(names))]) == 1:
        name = next(iter(names))
        x, ends, function = quantity(name, 1), known.domain[name][0], e
        low, high = ends.low, ends.high
    elif e.operator in FUNCTIONS:
        x = e.arguments[0]
        found = known.ends(x)
        if found is None:
            return
        low, high = float(found[0][0]), float(found[1][0])
        function = make(e.operator, quantity(_ANY, 1))
    else:
        return
    if e is x or not low < high:
        return
    nodes = (low + high) / 2 + (high - low) / 2 * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
    name = x.name if function is e else _ANY
    values = evaluate(function, {name: nodes[:, None]})[:, 0]
    if not np.isfinite(values).all():
        return
    for degree, shape in ((1, "a straight line"), (2, "a parabola")):
        fitted = np.polynomial.Polynomial.fit(nodes, values, degree).convert()
        if len(fitted.coef) == degree + 1:  # else it is a polynomial of less, or a constant
            by = _horner(np.asarray(fitted.coef, dtype=np.float64), x)
            yield Replacement(e, by, f"{_text(e)}, taken as {shape} in {_text(x)}")


def _horner(coefficients: Array, x: Expression) -> Expression:
    """c0 + x*(c1 + x*c2), a line as c0 + c1*x."""
    first, second, *rest = (single(c) for c in coefficients)
    if not rest:
        return make("add", first, make("mul", second, x))
    return make("add", first, make("mul", x, make("add", second, make("mul", rest[0], x))))


def _argument(e: Expression, _known: Known) -> Iterator[Replacement]:
    if e.operator in _OWN_ARGUMENT:
        (x,) = e.arguments
        yield Replacement(e, x, f"{e.operator} of {_text(x)}, taken as that itself")


def _branch(e: Expression, _known: Known) -> Iterator[Replacement]:
    if e.operator == "where":
        condition, *branches = e.arguments
        for kept in branches:
            if kept.width == e.width and branches[0] is not branches[1]:
                by = make("where", condition, kept, kept)
                yield Replacement(e, by, f"the choice by {_text(condition)}")


def _extreme(e: Expression, _known: Known) -> Iterator[Replacement]:
    if e.operator in ("min", "max"):
        for kept, other in (e.arguments, e.arguments[::-1]):
            if kept.width == e.width:
                words = f"the {e.operator}imum of {_text(kept)} and {_text(other)}"
                yield Replacement(e, kept, words)


def _colourless(e: Expression, known: Known) -> Iterator[Replacement]:
    """The components of a quantity as fixed multiples of one of them: coloured to mono."""
    if e.operator != "quantity" or e.width == 1:
        return
    middle = [(i.low + i.high) / 2 for i in known.domain[e.name]]
    one = e.width // 2
    if middle[one] > 0:
        only = component(e, one)
        parts = [make("mul", single(m / middle[one]), only) for m in middle]
        parts[one] = only
        yield Replacement(e, vector(parts), f"the hue of {e.name}: one component for all")


def _tied(e: Expression, known: Known) -> Iterator[Replacement]:
    """One quantity for another of its kind: anisotropic to isotropic."""
    if e.operator != "quantity":
        return
    for names in known.alike:
        if e.name in names:
            for name in names:
                if name != e.name and _overlap(known.domain[e.name], known.domain[name]):
                    yield Replacement(e, quantity(name, e.width), f"{e.name}: {name} in its place")


def _overlap(a: Sequence[Interval], b: Sequence[Interval]) -> bool:
    return all(x.low <= y.high and y.low <= x.high for x, y in zip(a, b, strict=True))


KINDS: tuple[Callable[[Expression, Known], Iterator[Replacement]], ...] = (
    _term,
    _factor,
    _constant,
    _polynomial,
    _argument,
    _branch,
    _extreme,
    _colourless,
    _tied,
)
