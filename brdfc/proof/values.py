"""The values of expressions over boxes: a range for every quantity."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from brdfc.proof import intervals as on
from brdfc.proof.intervals import Array
from brdfc.proof.varying import RULES, Varying, by_truth, side_by_side, square, whole_power
from brdfc.symbolic.expression import Expression, whole_exponent


class Values:
    """What an expression can be in each box; computed once for each.

    quantities: what each varies as, (boxes, components). Where slopes are to narrow what they can,
    middle: the values in the middles of the boxes, and half: of the boxes' sides, (axes, boxes, 1).
    """

    def __init__(
        self,
        quantities: Mapping[str, Varying],
        middle: Values | None = None,
        half: Array | None = None,
    ) -> None:
        self.quantities, self.middle, self.half = quantities, middle, half
        self._known: dict[Expression, Varying] = {}

    def of(self, e: Expression) -> Varying:
        """(boxes or 1, width): one row stands for all boxes."""
        if e not in self._known:
            with np.errstate(all="ignore"):
                found = self._compute(e)
                if self.middle is not None and self.half is not None and len(e.arguments) > 1:
                    found = found.centred(self.middle.of(e), self.half)
                self._known[e] = found
        return self._known[e]

    def _compute(self, e: Expression) -> Varying:
        match e.operator:
            case "const":
                return Varying(on.number(e.value))
            case "pi":
                return Varying(on.enclosure(*on.exactly(float(np.pi))))
            case "quantity":
                return self.quantities[e.name]
            case "vector":
                return side_by_side([self.of(a) for a in e.arguments])
            case "component":
                return self.of(e.arguments[0]).part(e.index)
            case "where":
                condition, *branches = (self.of(a) for a in e.arguments)
                return by_truth(condition.value, *branches)
            case "mul" if e.arguments[0] is e.arguments[1]:
                return square(self.of(e.arguments[0]))
            case "pow" if (exponent := whole_exponent(e)) is not None:
                return whole_power(self.of(e.arguments[0]), exponent)
        return RULES[e.operator](*(self.of(a) for a in e.arguments))
