"""Enclosures of functions of position: of the value in a box, and of the slopes along its axes.

With slopes the mean value theorem gives a second enclosure, from the value in the middle of the
box, whose excess falls with the square of the box's width; that of the value's own arithmetic falls
only with the width (A. Neumaier, Interval Methods for Systems of Equations, 1990, 2.3).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from brdfc.proof import intervals as on
from brdfc.proof.intervals import Array, Enclosure, Mask, add, div, exactly, hull, mul, neg, sub

UNKNOWN = Enclosure(np.array([[-np.inf]]), np.array([[np.inf]]))


@dataclass(frozen=True, eq=False)
class Varying:
    """value: (boxes or 1, width). slopes: (axes, boxes or 1, width), the derivatives along the axes
    of the boxes, or Lipschitz bounds where there are kinks; None where all of them are 0."""

    value: Enclosure
    slopes: Enclosure | None = None

    @property
    def low(self) -> Array:
        return self.value.low

    @property
    def high(self) -> Array:
        return self.value.high

    def __add__(self, other: Varying) -> Varying:
        return Varying(add(self.value, other.value), summed(self.slopes, other.slopes))

    def __neg__(self) -> Varying:
        return Varying(neg(self.value), neg(self.slopes) if self.slopes else None)

    def __sub__(self, other: Varying) -> Varying:
        return self + -other

    def __mul__(self, other: Varying) -> Varying:
        slopes = summed(scaled(self.slopes, other.value), scaled(other.slopes, self.value))
        return Varying(mul(self.value, other.value), slopes)

    def __truediv__(self, other: Varying) -> Varying:
        quotient = div(self.value, other.value)
        above = summed(self.slopes, scaled(other.slopes, neg(quotient)))
        return Varying(quotient, div(above, other.value) if above else None)

    def within(self, value: Enclosure) -> Varying:
        """The same, where the value is known to lie in another enclosure too."""
        return Varying(on.meet(self.value, value), self.slopes)

    def met(self, other: Varying) -> Varying:
        """The same, as another enclosure of it has it too."""
        if not (self.slopes and other.slopes):
            return Varying(on.meet(self.value, other.value))
        return Varying(on.meet(self.value, other.value), on.meet(self.slopes, other.slopes))

    def where(self, good: Mask) -> Varying:
        """The same, and unknown where it is not good: (boxes or 1, width)."""
        if good.all():
            return self
        value, slopes = (
            e and Enclosure(np.where(good, e.low, -np.inf), np.where(good, e.high, np.inf))
            for e in (self.value, self.slopes)
        )
        assert value is not None
        return Varying(value, slopes or _wide(UNKNOWN))

    def centred(self, middle: Varying, half: Array) -> Varying:
        """Narrowed by the mean value theorem, from the value in the middles of the boxes; half: of
        their sides, (axes, boxes, 1)."""
        if self.slopes is None:
            return self
        reach = np.where(half > 0, self.slopes.size, 0.0) * half
        away = reach.sum(axis=0) * (1 + 1e-12)
        return self.within(on.enclosure(middle.low - away, middle.high + away))

    def through(self, value: Enclosure, slope: Enclosure) -> Varying:
        """A function of it, with this value and derivative."""
        return Varying(value, scaled(self.slopes, slope))

    def part(self, index: int) -> Varying:
        """One component."""
        if self.low.shape[-1] == 1:
            return self

        def of(e: Enclosure) -> Enclosure:  # what is the same for all components has one
            one = e.low.shape[-1] == 1
            return e if one else Enclosure(*(end[..., index : index + 1] for end in e))

        return Varying(of(self.value), of(self.slopes) if self.slopes else None)


def summed(a: Enclosure | None, b: Enclosure | None) -> Enclosure | None:
    return add(a, b) if a and b else a or b


def scaled(slopes: Enclosure | None, factor: Enclosure) -> Enclosure | None:
    return mul(slopes, factor) if slopes else None


def constant(value: Enclosure) -> Varying:
    """What does not vary."""
    return Varying(value)


def number(value: float) -> Varying:
    """A number that float64 holds."""
    return Varying(exactly(value))


NONE = number(0.0)


def side_by_side(parts: list[Varying]) -> Varying:
    """Scalars as the components of a vector."""
    value = _joined([p.value for p in parts])
    if all(p.slopes is None for p in parts):
        return Varying(value)
    return Varying(value, _joined([p.slopes or exactly(0.0) for p in parts]))


def _joined(parts: list[Enclosure]) -> Enclosure:
    lows, highs = (np.broadcast_arrays(*ends) for ends in zip(*parts, strict=True))
    return Enclosure(np.concatenate(lows, axis=-1), np.concatenate(highs, axis=-1))


def of_either(parts: list[Varying], value: Enclosure) -> Varying:
    """A value that changes as one of several does."""
    slopes = [p.slopes or exactly(0.0) for p in parts]
    changes = any(p.slopes for p in parts)
    return Varying(value, hull(*slopes) if changes else None)


# ---------------------------------------------------------------- functions


def sqrt(x: Varying) -> Varying:
    root = on.sqrt(x.value)
    return x.through(root, div(exactly(0.5), root))


def exp(x: Varying) -> Varying:
    value = on.exp(x.value)
    return x.through(value, value)


def expm1(x: Varying) -> Varying:
    return x.through(on.expm1(x.value), on.exp(x.value))


def ln(x: Varying) -> Varying:
    return x.through(on.ln(x.value), on.reciprocal(x.value))


def log1p(x: Varying) -> Varying:
    return x.through(on.log1p(x.value), on.reciprocal(add(exactly(1.0), x.value)))


def sin(x: Varying) -> Varying:
    return x.through(on.sin(x.value), on.cos(x.value))


def cos(x: Varying) -> Varying:
    return x.through(on.cos(x.value), neg(on.sin(x.value)))


def square(x: Varying) -> Varying:
    return x.through(on.square(x.value), mul(exactly(2.0), x.value))


def whole_power(x: Varying, exponent: int) -> Varying:
    slope = mul(exactly(float(exponent)), on.whole_power(x.value, exponent - 1))
    return x.through(on.whole_power(x.value, exponent), slope)


def power(x: Varying, y: Varying) -> Varying:
    """x^y = exp(y ln x)."""
    value = on.power(x.value, y.value)
    logarithm = y * ln(x)
    return logarithm.through(value, value)


def atan2(y: Varying, x: Varying) -> Varying:
    squared = square(x) + square(y)
    slopes = summed(
        scaled(y.slopes, div(x.value, squared.value)),
        scaled(x.slopes, div(neg(y.value), squared.value)),
    )
    behind = x.low <= 0  # where the angle may jump by a turn
    if slopes and behind.any():
        slopes = Enclosure(
            np.where(behind, -np.inf, slopes.low), np.where(behind, np.inf, slopes.high)
        )
    return Varying(on.atan2(y.value, x.value), slopes)


def absolute(x: Varying) -> Varying:
    return of_either([x, -x], on.absolute(x.value))


def smaller(a: Varying, b: Varying) -> Varying:
    return by_truth(_below(a.value, b.value), a, b, kink=True)


def larger(a: Varying, b: Varying) -> Varying:
    return by_truth(_below(b.value, a.value), a, b, kink=True)


def _below(a: Enclosure, b: Enclosure) -> Enclosure:
    return on.truth(a.high <= b.low, a.low >= b.high)


def by_truth(
    truth: Enclosure, value: Varying, otherwise: Varying, *, kink: bool = False
) -> Varying:
    """value where a condition holds in the whole box, otherwise where it never does; either where
    it may. kink: the function does not jump where the condition changes."""
    surely, never = truth.low >= 1, truth.high <= 0
    chosen = _selected(surely, never, value.value, otherwise.value)
    if not (value.slopes or otherwise.slopes):
        return Varying(chosen, None if kink or (surely | never).all() else _wide(UNKNOWN))
    slopes = _selected(
        surely, never, value.slopes or exactly(0.0), otherwise.slopes or exactly(0.0)
    )
    if not kink:
        sure = surely | never
        slopes = Enclosure(np.where(sure, slopes.low, -np.inf), np.where(sure, slopes.high, np.inf))
    return Varying(chosen, slopes)


def _selected(surely: Mask, never: Mask, a: Enclosure, b: Enclosure) -> Enclosure:
    either = hull(a, b)
    return Enclosure(
        *(np.where(surely, x, np.where(never, y, z)) for x, y, z in zip(a, b, either, strict=True))
    )


def _wide(e: Enclosure) -> Enclosure:
    """As slopes along any number of axes."""
    return Enclosure(e.low[None], e.high[None])


def _stepped(function: Callable[[Array], Array]) -> Callable[[Varying], Varying]:
    def rule(x: Varying) -> Varying:
        value = Enclosure(function(x.low), function(x.high))
        return Varying(value, None if (value.low == value.high).all() else _wide(UNKNOWN))

    return rule


def _condition(rule: Callable[..., Enclosure]) -> Callable[..., Varying]:
    return lambda *arguments: Varying(rule(*(a.value for a in arguments)))


def _smooth(name: str) -> Callable[[Varying], Varying]:
    return lambda x: x.through(on.FUNCTIONS[name](x.value), SLOPES[name](x.value))


SLOPES: dict[str, Callable[[Enclosure], Enclosure]] = {
    "exp": on.exp,
    "ln": on.reciprocal,
    "log10": lambda x: div(on.LOG10, x),
    "sqrt": lambda x: div(exactly(0.5), on.sqrt(x)),
    "cbrt": lambda x: div(on.THIRD, on.square(on.cbrt(x))),
    "sin": on.cos,
    "cos": lambda x: neg(on.sin(x)),
    "tan": lambda x: on.reciprocal(on.square(on.cos(x))),
    "asin": lambda x: on.reciprocal(on.sqrt(sub(exactly(1.0), on.square(x)))),
    "acos": lambda x: neg(SLOPES["asin"](x)),
    "atan": lambda x: on.reciprocal(add(exactly(1.0), on.square(x))),
}
"""The derivatives of functions of one argument."""

RULES: dict[str, Callable[..., Varying]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "neg": lambda a: -a,
    "pow": power,
    **{name: _smooth(name) for name in SLOPES},
    "atan2": atan2,
    "abs": absolute,
    "min": smaller,
    "max": larger,
    "sign": _stepped(np.sign),
    "floor": _stepped(np.floor),
    "ceil": _stepped(np.ceil),
    "trunc": _stepped(np.trunc),
    "round": _stepped(lambda x: np.trunc(x + np.copysign(0.5, x))),
    **{name: _condition(rule) for name, rule in on.CONDITIONS.items()},
}
"""By operator of an expression."""
