"""Which quantity of a model comes from where in one compilation."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from brdfc.codegen.select import Binding, ChannelBinding, VariableBinding
from brdfc.lang.model import Model, Quantity, Role
from brdfc.lang.values import parse_value
from brdfc.profiles.metadata import range_text, value_text
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import ValueGivenError
from brdfc.symbolic.formula import NO_WHITE

Value = float | str | Sequence[float]
"""What a quantity may be fixed to: numbers, radians for angles, or text as on the command line."""


@dataclass(frozen=True)
class Roles:
    """Where each quantity comes from in one compilation: the pixel, the run, or fixed now."""

    channels: tuple[Quantity, ...]
    variables: tuple[Quantity, ...]
    constants: Mapping[str, tuple[float, ...]]

    @property
    def channel_names(self) -> tuple[str, ...]:
        """A name a sample of a pixel: Rdx, Rdy, Rdz, ks, m."""
        return tuple(name for q in self.channels for name in q.component_names)

    def bindings(self) -> dict[str, Binding]:
        """Channels side by side in the order of their declaration; variables by signature."""
        bound: dict[str, Binding] = {}
        start = 0
        for q in self.channels:
            bound[q.name] = ChannelBinding(start, q.type.value.width)
            start += q.type.value.width
        for q in self.variables:
            bound[q.name] = VariableBinding(q.signature, q.default[0])
        return bound


def assign_roles(
    model: Model,
    set: Mapping[str, Value],
    channels: Iterable[str],
    white: Sequence[float] = NO_WHITE,
) -> Roles:
    """Which quantity is what, after --set and --channel, where colours are measured under a white;
    ValueGivenError for what cannot be."""
    model = replace(model, quantities=tuple(q.under(white) for q in model.quantities))
    fixed = {}
    for name, value in set.items():
        q = _quantity(model, name)
        fixed[q.name] = _checked(q, value)
    pixel = {_quantity(model, name).name for name in channels}
    both = sorted(pixel & fixed.keys())
    if both:
        raise ValueGivenError(f"'{both[0]}' cannot be fixed and come with the pixel too")
    left = [q for q in model.quantities if q.name not in fixed]
    for q in left:
        if q.role is Role.CONSTANT and q.name not in pixel:
            fixed[q.name] = q.default
    return Roles(
        tuple(q for q in left if q.role is Role.CHANNEL or q.name in pixel),
        tuple(q for q in left if q.role is Role.ENV and q.name not in pixel),
        fixed,
    )


def _quantity(model: Model, name: str) -> Quantity:
    found = model.quantity(name)
    if found is not None:
        return found
    for q in model.quantities:
        if name in q.component_names:
            raise ValueGivenError(
                f"'{name}' is a component of '{q.name}'", hint=f"give '{q.name}' as a whole"
            )
    known = [q.name for q in model.quantities]
    raise ValueGivenError(
        f"'{model.name}' has no quantity '{name}'",
        hint=did_you_mean(name, known) or f"it has {', '.join(known)}",
    )


def _checked(q: Quantity, value: Value) -> tuple[float, ...]:
    if isinstance(value, str):
        values = parse_value(value, q.type, q.name)
    else:
        width = q.type.value.width
        given = (value,) if isinstance(value, (int, float)) else tuple(value)
        values = given * width if len(given) == 1 else given
        if len(values) != width or not all(map(math.isfinite, values)):
            raise ValueGivenError(f"'{q.name}' takes {width} finite numbers, not {value}")
    slack = 1e-9 * max(abs(q.low), abs(q.high))
    for v in values:
        if not q.low - slack <= v <= q.high + slack:
            ends = range_text(q.low, q.high, q.type)
            shown = value_text(values, q.type)
            raise ValueGivenError(f"{q.name}={shown} lies outside its range {ends}")
    return values
