"""What is to be compiled: a formula, its quantities, and where a program gets them from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from brdfc.codegen.nodes import Node
from brdfc.codegen.select import Binding, VariableBinding, select
from brdfc.colour.colorimetry import XYZ_UNDER_D50, Colorimetry
from brdfc.judge.samples import sample
from brdfc.judge.strata import Points, points
from brdfc.lang.model import Quantity
from brdfc.symbolic.expression import Expression, walk
from brdfc.symbolic.formula import Formula
from brdfc.symbolic.guards import guarded
from brdfc.symbolic.intervals import Interval
from brdfc.symbolic.ranges import Ranges

EFFORT = 300
"""Forms measured by default, of a formula with so few parts that WORK is not exceeded."""
WORK = 9_500
"""Forms times parts of the formula, by default: about the same time for any formula."""


@dataclass(frozen=True)
class Problem:
    """What is to be compiled, and its surroundings. colorimetry: what its results look like.
    declared: ranges beyond the formula's domain in which a program has to be finite, if any."""

    formula: Formula
    quantities: tuple[Quantity, ...]
    bindings: Mapping[str, Binding]
    inputs: int
    colorimetry: Colorimetry = XYZ_UNDER_D50
    declared: Mapping[str, Interval] | None = None

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

    @property
    def safe_ranges(self) -> Ranges:
        """The ranges that guards are for. New each time: what those of a whole search still learn
        depends on the forms before."""
        return Ranges(self.declared or self.formula.domain)

    @property
    def default_effort(self) -> int:
        """How many forms are measured unless someone says otherwise."""
        parts = sum(1 for _ in walk(self.start))
        return max(10, min(EFFORT, WORK // parts))

    def points(self, scale: int) -> Points:
        """Points of the domain in strata, scale for each share of them."""
        return points(self.ranges.domain, self.quantities, scale)

    def final_points(self, scale: int) -> Points:
        """The same, and those of the self-check: the form that is chosen must not fail it."""
        variables = tuple(
            q for q in self.quantities if isinstance(self.bindings[q.name], VariableBinding)
        )
        channels = tuple(q for q in self.quantities if q not in variables)
        checked = sample(self.formula.domain, channels, variables)
        return self.points(scale).joined(checked.points(), "self-check")

    def graph(self, e: Expression) -> Node:
        """The operators of a form, guarded."""
        return select(guarded(e, self.safe_ranges)[0], self.bindings)
