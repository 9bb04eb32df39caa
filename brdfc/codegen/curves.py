"""Which parts of a formula become sampled curves, and how they are sampled.

A part that depends on one scalar channel alone, costs more than looking it up, and does not jump
becomes a curve of that channel. Products are regrouped first, so that ks e^(-k/m^2) / m^2 has one
curve of m, not two.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.curves import CurveSet, SampledCurve
from brdfc.calc.price import nanoseconds
from brdfc.calc.samples import Samples
from brdfc.codegen.schedule import schedule
from brdfc.codegen.select import Binding, ChannelBinding, CurveBinding, select
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.expression import (
    ONE,
    Expression,
    const,
    make,
    quantity,
    rebuild,
    walk,
)
from brdfc.symbolic.intervals import LARGEST, Interval, single

_Array = NDArray[np.float64]

_JUMPING = frozenset(
    ("lt", "le", "gt", "ge", "eq", "ne", "and", "or", "not", "where", "sign", "floor", "ceil",
     "trunc", "round")
)  # fmt: skip
"""Operators whose result may jump; a line between two samples would miss it."""

_PAYS = 4.0
"""A transformed channel is worth its operator where the error falls as much as it would by twice
the points: the error of linear interpolation goes with the square of the step."""


@dataclass(frozen=True)
class _Scale:
    """Equal steps in f(x) instead of x: dense where f is steep. Inputs start at `least`."""

    of: Callable[[Expression], Expression]
    forward: Callable[[_Array], _Array]
    inverse: Callable[[_Array], _Array]
    least: float


_SCALES = (
    _Scale(lambda x: x, lambda x: x, lambda t: t, -LARGEST),
    _Scale(lambda x: make("sqrt", x), np.sqrt, np.square, 0.0),
    _Scale(lambda x: make("ln", x), np.log, np.exp, 1e-30),
    _Scale(lambda x: make("mul", x, x), np.square, np.sqrt, 0.0),
)


@dataclass
class Curves:
    """Collects the curves of one formula; see replaced."""

    bindings: Mapping[str, Binding]
    domain: Mapping[str, Interval]
    points: int
    inputs: int
    elements: list[CurveSet] = field(default_factory=list)
    found: dict[str, CurveBinding] = field(default_factory=dict)
    _channels: dict[Expression, frozenset[Expression]] = field(default_factory=dict)
    _curves: dict[Expression, Expression | None] = field(default_factory=dict)
    _done: dict[Expression, Expression] = field(default_factory=dict)

    def replaced(self, e: Expression) -> Expression:
        """The expression with curves as quantities, which are in `found` by their names."""
        if e not in self._done:
            self._done[e] = self._curve(e) or self._regrouped(e) or self._rebuilt(e)
        return self._done[e]

    def _rebuilt(self, e: Expression) -> Expression:
        return rebuild(e, [self.replaced(a) for a in e.arguments])

    def _regrouped(self, e: Expression) -> Expression | None:
        """A product with all factors of one channel, and the constants, together in a curve."""
        if e.operator not in ("mul", "div") or e.width > 1:
            return None
        above, below = _factors(e)
        for channel in self._scalars(e):
            groups = []
            for factors in (above, below):
                mine = [f for f in factors if self.channels(f) <= {channel}]
                groups.append((mine, [f for f in factors if f not in mine]))
            (over, rest_over), (under, rest_under) = groups
            curve = self._curve(_quotient(over, under)) if over or under else None
            if curve is not None:
                return self.replaced(_quotient([curve, *rest_over], rest_under))
        return None

    def _scalars(self, e: Expression) -> list[Expression]:
        """The scalar channels e depends on, in the order of the pixel."""
        scalars = [c for c in self.channels(e) if c.width == 1 and c.name not in self.found]
        return sorted(scalars, key=self._position)

    def _position(self, channel: Expression) -> int:
        binding = self.bindings[_quantity_of(channel).name]
        assert isinstance(binding, ChannelBinding)
        return binding.start + channel.index

    def channels(self, e: Expression) -> frozenset[Expression]:
        """What e depends on: scalar quantities, components of vector ones, whole vectors."""
        for part in walk(e):
            if part not in self._channels:
                leaf = part.operator == "quantity" or _quantity_of(part) is not part
                below = (self._channels[a] for a in part.arguments)
                self._channels[part] = frozenset([part]) if leaf else frozenset().union(*below)
        return self._channels[e]

    def _curve(self, e: Expression) -> Expression | None:
        """A quantity that stands for e, looked up; None where that is not possible or dearer."""
        if e not in self._curves:
            self._curves[e] = self._new_curve(e)
        return self._curves[e]

    def _new_curve(self, e: Expression) -> Expression | None:
        channels = self._scalars(e)
        if e.width > 1 or len(self.channels(e)) != 1 or len(channels) != 1 or e is channels[0]:
            return None
        if any(part.operator in _JUMPING for part in walk(e)):
            return None
        sampled = self._sampled(e, channels[0])
        if sampled is None:
            return None
        curve, argument = sampled
        name = f"curve {len(self.elements)}"
        binding = CurveBinding(len(self.elements), argument)
        looked_up = quantity(name, 1)
        if self._price(e, {}) <= self._price(looked_up, {name: binding}):
            return None
        self.elements.append(CurveSet((curve,)))
        self.found[name] = binding
        return looked_up

    def _price(self, e: Expression, curves: Mapping[str, CurveBinding]) -> float:
        program = schedule(select(e, {**self.bindings, **curves}), self.inputs)
        return nanoseconds(program.body)

    def _sampled(
        self, e: Expression, channel: Expression
    ) -> tuple[SampledCurve, Expression] | None:
        """The curve of the least error, and what it is a function of; None where not finite."""
        interval = self.domain[_quantity_of(channel).name]
        best: tuple[float, SampledCurve, Expression] | None = None
        # NaN becomes the least value here: with a NaN for a position, engines read anywhere.
        safe = make("max", channel, const(Fraction(interval.low)))
        for scale in _SCALES:
            if interval.low < scale.least or interval.single:
                continue
            ends = scale.forward(np.array([interval.low, interval.high]))
            first, last = single(ends[0]), single(ends[1])
            steps = np.linspace(first, last, 2 * self.points - 1)
            x = np.clip(scale.inverse(steps), interval.low, interval.high)
            exact = _along(e, channel, x)
            if not (np.abs(exact) <= LARGEST).all():
                continue
            values = exact[::2]
            error = float(np.max(np.abs(exact[1::2] - (values[1:] + values[:-1]) / 2)))
            if best is None or error * _PAYS < best[0]:
                best = error, SampledCurve(first, last, Samples.of(values)), scale.of(safe)
        return best[1:] if best else None


def _along(e: Expression, channel: Expression, x: _Array) -> _Array:
    """Values of a function of one channel."""
    whole = _quantity_of(channel)
    values = np.repeat(x[:, None], whole.width, axis=1)
    return evaluate(e, {whole.name: values})[:, 0]


def _quantity_of(e: Expression) -> Expression:
    """The quantity of which e is a component; e itself if it is none."""
    if e.operator == "component" and e.arguments[0].operator == "quantity":
        return e.arguments[0]
    return e


def _factors(e: Expression) -> tuple[list[Expression], list[Expression]]:
    """The scalar factors of a product, and those of its divisor."""
    if e.operator not in ("mul", "div"):
        return [e], []
    (above, below), (other, under) = map(_factors, e.arguments)
    if e.operator == "div":
        other, under = under, other
    return above + other, below + under


def _quotient(above: list[Expression], below: list[Expression]) -> Expression:
    over = reduce(lambda x, y: make("mul", x, y), above) if above else ONE
    return make("div", over, reduce(lambda x, y: make("mul", x, y), below)) if below else over
