"""The range of every expression under what is known: the declared domain, and conditions met."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from brdfc.lang.model import Quantity
from brdfc.symbolic.bounds import RULES, square, whole_power
from brdfc.symbolic.expression import Expression, whole_exponent
from brdfc.symbolic.intervals import INF, Interval, above, below, hull, meet, single
from brdfc.symbolic.trigonometry import widest_above

_NEGATED = {"lt": "ge", "le": "gt", "gt": "le", "ge": "lt", "eq": "ne", "ne": "eq"}
_MIRRORED = {"lt": "gt", "le": "ge", "gt": "lt", "ge": "le", "eq": "eq", "ne": "ne"}


MOST_ASSUMED = 100
"""Sets of facts kept apart. Conditions inside one another could make any number of sets, each with
ranges of its own; after so many, no condition teaches anything more."""


def domain(quantities: tuple[Quantity, ...]) -> dict[str, Interval]:
    """The declared ranges as float32 has them: 90deg is slightly more than a right angle."""
    return {q.name: Interval(single(q.low), single(q.high)) for q in quantities}


@dataclass(frozen=True, eq=False)
class Ranges:
    """Ranges of expressions over a domain; facts narrow some (see assuming)."""

    domain: Mapping[str, Interval]
    facts: Mapping[Expression, Interval] = field(default_factory=dict)
    _known: dict[Expression, Interval] = field(default_factory=dict)
    _inside: dict[tuple[Expression, bool], Ranges] = field(default_factory=dict)
    _all: list[Ranges] = field(default_factory=list)

    def of(self, expression: Expression) -> Interval:
        """The range of values a float32 program gets for an expression."""
        known = self._known.get(expression)
        if known is None:
            known = self._bound(expression)
            fact = self.facts.get(expression)
            if fact is not None:
                known = meet(known, fact)
            self._known[expression] = known
        return known

    def _bound(self, e: Expression) -> Interval:
        match e.operator:
            case "const":
                constant = single(e.value)
                return Interval(constant, constant)
            case "pi":
                return Interval(single(math.pi), single(math.pi))
            case "quantity":
                return self.domain[e.name]
            case "vector":
                return hull(*(self.of(a) for a in e.arguments))
            case "component":
                return self.of(e.arguments[0])
            case "where":
                condition, value, otherwise = e.arguments
                truth = self.of(condition)
                if truth.low >= 1:
                    return self.assuming(condition, True).of(value)
                if truth.high <= 0:
                    return self.assuming(condition, False).of(otherwise)
                return hull(
                    self.assuming(condition, True).of(value),
                    self.assuming(condition, False).of(otherwise),
                )
            case "mul" if e.arguments[0] is e.arguments[1]:
                return square(self.of(e.arguments[0]))
            case "pow" if (exponent := whole_exponent(e)) is not None:
                return whole_power(self.of(e.arguments[0]), exponent)
            case _:
                return RULES[e.operator](*(self.of(a) for a in e.arguments))

    def assuming(self, condition: Expression, holds: bool) -> Ranges:
        """The same, where a condition is known to hold, or not to.

        One and the same object where that teaches nothing new, and for the same question twice,
        so that a pass may keep what it did by expression and ranges.
        """
        key = (condition, holds)
        if key not in self._inside:
            facts = dict(self.facts)
            if len(self._all) < MOST_ASSUMED:
                self._learn(condition, holds, facts)
            inside = self
            if facts != self.facts:
                inside = Ranges(self.domain, facts, _all=self._all)
                self._all.append(inside)
            self._inside[key] = inside
        return self._inside[key]

    def _learn(self, e: Expression, holds: bool, facts: dict[Expression, Interval]) -> None:
        if e.operator == "not":
            self._learn(e.arguments[0], not holds, facts)
        elif (e.operator == "and" and holds) or (e.operator == "or" and not holds):
            for argument in e.arguments:
                self._learn(argument, holds, facts)
        elif e.operator in _NEGATED:
            left, right = e.arguments
            relation = e.operator if holds else _NEGATED[e.operator]
            self._learn_bound(left, relation, self.of(right), facts)
            self._learn_bound(right, _MIRRORED[relation], self.of(left), facts)

    def _learn_bound(
        self, e: Expression, relation: str, other: Interval, facts: dict[Expression, Interval]
    ) -> None:
        bound = {
            "lt": Interval(-INF, below(other.high)),
            "le": Interval(-INF, other.high),
            "gt": Interval(above(other.low), INF),
            "ge": Interval(other.low, INF),
            "eq": other,
        }.get(relation)
        if bound is None or e.operator == "const":
            return
        facts[e] = meet(facts.get(e, self.of(e)), bound)
        if e.operator == "cos" and relation in ("gt", "ge") and other.low >= 0:
            self._learn_angle(e.arguments[0], other.low, facts)
        if e.operator == "abs":
            self._learn_size(e.arguments[0], facts[e], facts)
        # A bound on the lesser of two, from below, holds for both; likewise for the greater.
        if (e.operator == "min" and relation in ("gt", "ge")) or (
            e.operator == "max" and relation in ("lt", "le")
        ):
            for argument in e.arguments:
                self._learn_bound(argument, relation, other, facts)

    def _learn_size(self, e: Expression, size: Interval, facts: dict[Expression, Interval]) -> None:
        known = facts.get(e, self.of(e))
        facts[e] = meet(known, Interval(-size.high, size.high, gap=max(size.low, 0.0)))

    def _learn_angle(self, e: Expression, cosine: float, facts: dict[Expression, Interval]) -> None:
        """A cosine above a bound keeps its angle near 0, where no other period is in reach."""
        known = facts.get(e, self.of(e))
        if -1.5 * math.pi < known.low and known.high < 1.5 * math.pi:
            widest = widest_above(cosine)
            facts[e] = meet(known, Interval(-widest, widest))
