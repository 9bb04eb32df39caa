"""How much a formula changes where parts of it are replaced: enclosures of the change alone.

The difference of two enclosures says nothing about two formulas that are nearly the same. So the
change is followed from the parts that were replaced to the result, by the difference formula of
each operator: a' b' - a b = a' (b' - b) + b (a' - a), exp a' - exp a = exp a expm1(a' - a), and so
on.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from brdfc.proof import intervals as on
from brdfc.proof import varying as of
from brdfc.proof.intervals import Array, Enclosure, hull, mul, sub
from brdfc.proof.values import Values
from brdfc.proof.varying import NONE, SLOPES, Varying, by_truth, number, side_by_side
from brdfc.symbolic.expression import ONE, ZERO, Expression, whole_exponent

_TRUSTED = 1e200
"""A change so many times what changes is not found from that, which may have underflowed."""
_PLAIN = ("mul", "div", "sqrt", "exp", "pow")
"""Operators whose result changes in proportion as their arguments do."""

Argument = tuple[Varying, Varying]
"""The first formula's value, and its change."""


class Changes:
    """Changes from one formula to another, over boxes; each pair of parts is computed once.

    middle: those in the middles of the boxes, and half, as for Values.
    """

    def __init__(
        self, values: Values, middle: Changes | None = None, half: Array | None = None
    ) -> None:
        self.values, self.middle, self.half = values, middle, half
        self._known: dict[tuple[Expression, Expression], Varying] = {}
        self._shares: dict[tuple[Expression, Expression], Varying] = {}

    def of(self, first: Expression, second: Expression) -> Varying:
        """second - first, (boxes or 1, width)."""
        if first is second:
            return NONE
        key = (first, second)
        if key not in self._known:
            with np.errstate(all="ignore"):
                found = self._compute(first, second)
                if self.middle is not None and self.half is not None:
                    found = found.centred(self.middle.of(first, second), self.half)
                self._known[key] = found
        return self._known[key]

    def _compute(self, first: Expression, second: Expression) -> Varying:
        followed = (
            self._followed(first, second)
            or self._fitted(first, second)
            or self._unclamped(first, second)
        )
        value = self.values.of(first)
        apart = self.values.of(second) - value
        if followed is None:
            return apart
        share = self._share(first, second) if first.operator in _PLAIN else None
        if share is not None:
            followed = followed.met((value * share).where(share.value.size < _TRUSTED))
        return followed.met(apart)

    def share(self, first: Expression, second: Expression) -> Varying:
        """(second - first)/first: tighter where first is a product of what varies together."""
        if first is second:
            return NONE
        key = (first, second)
        if key not in self._shares:
            with np.errstate(all="ignore"):
                found = self._share(first, second)
                found = found or self.of(first, second) / self.values.of(first)
                if self.middle is not None and self.half is not None:
                    found = found.centred(self.middle.share(first, second), self.half)
                self._shares[key] = found
        return self._shares[key]

    def _share(self, first: Expression, second: Expression) -> Varying | None:
        """The same through one operator that both have."""
        if not _alike(first, second):
            return None
        match first.operator:
            case "exp":
                return of.expm1(self.of(*_pairs(first, second)[0]))
            case "mul" | "div" | "sqrt" | "pow" | "neg" | "add":
                shares = [self.share(a, b) for a, b in _pairs(first, second)]
        match first.operator:
            case "neg":
                return shares[0]
            case "mul" if _is_square(first) and _is_square(second):
                return shares[0] * (TWO + shares[0])
            case "mul":
                return shares[0] + shares[1] + shares[0] * shares[1]
            case "div":
                return (shares[0] - shares[1]) / (of.number(1.0) + shares[1])
            case "sqrt":
                return of.expm1(HALF * of.log1p(shares[0]))
            case "pow" if shares[1] is NONE:
                return of.expm1(self.values.of(first.arguments[1]) * of.log1p(shares[0]))
            case "add" if NONE in shares:
                changed = 1 if shares[0] is NONE else 0
                a, b = (self.values.of(first.arguments[i]) for i in (changed, 1 - changed))
                return shares[changed] / (of.number(1.0) + b / a)
        return None

    def _followed(self, first: Expression, second: Expression) -> Varying | None:
        """The change through one operator that both have; None where they have none in common."""
        if not _alike(first, second):
            return None
        pairs = _pairs(first, second)
        match first.operator:
            case "vector":
                return side_by_side([self.of(a, b) for a, b in pairs])
            case "component":
                return self.of(*pairs[0]).part(first.index)
            case "where" if pairs[0][0] is pairs[0][1]:
                truth = self.values.of(pairs[0][0]).value
                return by_truth(truth, self.of(*pairs[1]), self.of(*pairs[2]))
            case "pow" if pairs[1][0] is pairs[1][1]:
                exponent = whole_exponent(first)
                if exponent is not None:
                    return _whole_power(*self._argument(*pairs[0]), exponent)
        rule = RULES.get(first.operator)
        if rule is None:
            return None
        return rule(self.values.of(first), *(self._argument(a, b) for a, b in pairs))

    def _fitted(self, first: Expression, second: Expression) -> Varying | None:
        """The change where a function of x became a straight line c + k x: by the mean value
        theorem from the middle of the range of x."""
        if first.operator not in SLOPES:
            return None
        (x,) = first.arguments
        line = _line(second, x)
        if line is None:
            return None
        at = self.values.of(x)
        middle = Enclosure(at.value.middle, at.value.middle)
        offset, factor = (self.values.of(part).value for part in line)
        slope = sub(factor, SLOPES[first.operator](at.value))
        there = sub(on.add(offset, mul(factor, middle)), on.FUNCTIONS[first.operator](middle))
        return at.through(on.add(there, mul(slope, sub(at.value, middle))), slope)

    def _unclamped(self, first: Expression, second: Expression) -> Varying | None:
        """The change where the lesser, or greater, of two became always the one."""
        if first.operator not in ("min", "max") or second not in first.arguments:
            return None
        other = first.arguments[1 if second is first.arguments[0] else 0]
        ahead = self.values.of(second) - self.values.of(other)
        return (of.larger if first.operator == "min" else of.smaller)(ahead, NONE)

    def _argument(self, a: Expression, b: Expression) -> Argument:
        return self.values.of(a), self.of(a, b)


def _is_square(e: Expression) -> bool:
    return e.arguments[0] is e.arguments[1]


def _alike(first: Expression, second: Expression) -> bool:
    same = first.operator == second.operator and first.index == second.index
    return same and 0 < len(first.arguments) == len(second.arguments)


def _pairs(first: Expression, second: Expression) -> list[tuple[Expression, Expression]]:
    return list(zip(first.arguments, second.arguments, strict=True))


def _line(e: Expression, x: Expression) -> tuple[Expression, Expression] | None:
    """(c, k) where an expression is c + k x."""
    if e is x:
        return ZERO, ONE
    if e.operator == "mul" and e.arguments[1] is x and e.arguments[0].operator == "const":
        return ZERO, e.arguments[0]
    if e.operator != "add" or e.arguments[0].operator != "const":
        return None
    rest = _line(e.arguments[1], x)
    return (e.arguments[0], rest[1]) if rest and rest[0] is ZERO else None


TWO, HALF = number(2.0), number(0.5)


def _mul(_value: Varying, a: Argument, b: Argument) -> Varying:
    if a[1] is NONE or b[1] is NONE:
        return b[0] * a[1] if b[1] is NONE else a[0] * b[1]
    return (a[0] + a[1]) * b[1] + b[0] * a[1]


def _div(value: Varying, a: Argument, b: Argument) -> Varying:
    return (a[1] - value * b[1]) / (b[0] + b[1])


def _sqrt(value: Varying, a: Argument) -> Varying:
    return a[1] / (value + of.sqrt(a[0] + a[1]))


def _exp(value: Varying, a: Argument) -> Varying:
    return value * of.expm1(a[1])


def _ln(_value: Varying, a: Argument) -> Varying:
    return of.log1p(a[1] / a[0])


def _sin(_value: Varying, a: Argument) -> Varying:
    half = HALF * a[1]
    return TWO * of.cos(a[0] + half) * of.sin(half)


def _cos(_value: Varying, a: Argument) -> Varying:
    half = HALF * a[1]
    return -(TWO * of.sin(a[0] + half) * of.sin(half))


def _tan(_value: Varying, a: Argument) -> Varying:
    return of.sin(a[1]) / (of.cos(a[0]) * of.cos(a[0] + a[1]))


def _abs(_value: Varying, a: Argument) -> Varying:
    size = a[1].value.size
    return Varying(Enclosure(-size, size), _any_slope(a[1]))


def _extreme(_value: Varying, a: Argument, b: Argument) -> Varying:
    """The lesser, or greater, of two changes by as much as one of them, or something between."""
    return Varying(hull(a[1].value, b[1].value), _any_slope(a[1]) or _any_slope(b[1]))


def _any_slope(change: Varying) -> Enclosure | None:
    """Where kinks move, slopes of the change are not followed."""
    return None if change is NONE else Enclosure(*(end[None] for end in of.UNKNOWN))


def _power(value: Varying, a: Argument, b: Argument) -> Varying:
    """x^y = exp(y ln x), where x is above 0."""
    logarithm = of.ln(a[0])
    changed = _exp(value, (value, _mul(value, (logarithm, _ln(logarithm, a)), b)))
    return changed.where(a[0].low > 0)


def _whole_power(a: Varying, change: Varying, exponent: int) -> Varying:
    """By the mean value theorem: n x^(n - 1) between both."""
    moved = (a + change).value
    between = hull(a.value, moved)

    def changed(n: int) -> Enclosure:
        return mul(change.value, mul(on.exactly(float(n)), on.whole_power(between, n - 1)))

    # n (x'^(n - 1) - x^(n - 1)) times the slope of x, and n x'^(n - 1) times that of the change.
    times = on.exactly(float(exponent))
    slopes = of.summed(
        of.scaled(a.slopes, mul(times, changed(exponent - 1))),
        of.scaled(change.slopes, mul(times, on.whole_power(moved, exponent - 1))),
    )
    found = Varying(changed(exponent), slopes)
    # Across its pole a negative power has no mean value.
    return found if exponent > 0 else found.where((between.low > 0) | (between.high < 0))


def _between(name: str) -> Callable[..., Varying]:
    """The rule of any smooth function: its slope between both arguments, times the change."""

    def rule(_value: Varying, a: Argument) -> Varying:
        between = SLOPES[name](hull(a[0].value, (a[0] + a[1]).value))
        return Varying(mul(a[1].value, between), _any_slope(a[1]))

    return rule


RULES: dict[str, Callable[..., Varying]] = {
    "add": lambda _value, a, b: a[1] + b[1],
    "sub": lambda _value, a, b: a[1] - b[1],
    "neg": lambda _value, a: -a[1],
    "mul": _mul,
    "div": _div,
    "sqrt": _sqrt,
    "exp": _exp,
    "ln": _ln,
    "sin": _sin,
    "cos": _cos,
    "tan": _tan,
    "abs": _abs,
    "min": _extreme,
    "max": _extreme,
    "pow": _power,
    **{name: _between(name) for name in ("cbrt", "asin", "acos", "atan")},
}
"""By operator: from the first formula's value and, for each argument, its value and change."""
