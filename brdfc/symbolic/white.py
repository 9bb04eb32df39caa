"""A formula on XYZ under a white, from one on reflectances in three bands.

Models are written for reflectances: a perfect diffuser has 1 in each component, and a highlight
without colour adds the same to each. Colours measured under a light have its white instead, and
such a highlight has the light's colour. So under a white W a quantity q of type XYZ is read as
q/W, and the radiance is multiplied by W. In sums the two cancel where they meet: of `Rd/pi + s`
remains `Rd/pi + s W`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from brdfc.symbolic.expression import ONE, Expression, const, make, rebuild, vector, walk


def under_white(
    exact: Expression, colours: Mapping[str, float], white: Sequence[float]
) -> Expression:
    """The formula on XYZ under a white.

    colours: the quantities of type XYZ, and the greatest reflectance each is declared for; more is
    taken as that, where a formula does more with it than add and scale. A white of 1, 1, 1 changes
    nothing.
    """
    if all(component == 1 for component in white):
        return exact
    by = vector([const(Fraction(str(float(component)))) for component in white])
    relative: dict[Expression, Expression] = {}
    done: dict[Expression, Expression] = {}
    for e in walk(exact):
        done[e] = rebuild(e, [done[a] for a in e.arguments])
        if e.operator == "quantity" and e.name in colours:
            most = const(Fraction(str(float(colours[e.name]))))
            done[e] = make("min", make("div", e, by), most)
            relative[done[e]] = e
    return _Scaled(by, relative).times(done[exact])


@dataclass
class _Scaled:
    """by: what expressions are multiplied by; relative: of each quantity over that, the quantity
    itself; open: whether the two cancel somewhere in an expression."""

    by: Expression
    relative: Mapping[Expression, Expression]
    done: dict[Expression, Expression] = field(default_factory=dict)
    open: dict[Expression, bool] = field(default_factory=dict)

    def times(self, e: Expression) -> Expression:
        if e not in self.done:
            self.done[e] = self.relative.get(e) or self.multiplied(e)
        return self.done[e]

    def multiplied(self, e: Expression) -> Expression:
        if e.operator == "const" and e.value == 0:
            return e
        if e is ONE:
            return self.by
        if self.cancels(e):
            a, *others = e.arguments
            match e.operator:
                case "where":
                    return rebuild(e, (a, *(self.times(o) for o in others)))
                case "add" | "sub":
                    return rebuild(e, (self.times(a), self.times(others[0])))
                case "neg":
                    return rebuild(e, (self.times(a),))
                case "div":
                    return rebuild(e, (self.times(a), others[0]))
                case "mul" if self.cancels(a):
                    return rebuild(e, (self.times(a), others[0]))
                case "mul":
                    return rebuild(e, (a, self.times(others[0])))
        return make("mul", e, self.by)

    def cancels(self, e: Expression) -> bool:
        """Whether a quantity over the white is reached by sums and products alone."""
        if e not in self.open:
            match e.operator:
                case "add" | "sub" | "mul":
                    found = any(map(self.cancels, e.arguments))
                case "where":
                    found = any(map(self.cancels, e.arguments[1:]))
                case "neg" | "div":
                    found = self.cancels(e.arguments[0])
                case _:
                    found = False
            self.open[e] = e in self.relative or found
        return self.open[e]
