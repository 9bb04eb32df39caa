"""The whole way from a checked model to a pair of profiles, one stage after the other."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from brdfc import __version__
from brdfc.calc.price import operations, price
from brdfc.calc.program import Program
from brdfc.calc.text import disassemble
from brdfc.codegen.schedule import schedule
from brdfc.codegen.select import Binding, ChannelBinding, VariableBinding, select
from brdfc.icc.profile import Profile
from brdfc.judge.examples import check_examples
from brdfc.judge.samples import sample
from brdfc.judge.selfcheck import LIMIT, Verdict, self_check
from brdfc.lang.model import Model, Quantity, Role
from brdfc.lang.values import parse_value
from brdfc.profiles.metadata import metadata, range_text, value_text
from brdfc.profiles.multiplex import ProfilePair, profile_pair
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import BrdfcError, ValueGivenError
from brdfc.symbolic.formula import Formula, formula

XYZ_COMPONENTS = 3


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


@dataclass(frozen=True)
class Compiled:
    """A compiled model: its profiles, and everything worth knowing of how they came about."""

    model: Model
    roles: Roles
    formula: Formula
    program: Program
    verdict: Verdict
    pair: ProfilePair

    @property
    def mid(self) -> Profile:
        return self.pair.mid

    @property
    def mvis(self) -> Profile:
        return self.pair.mvis

    @property
    def text(self) -> str:
        """The calculator text of the MVIS."""
        return disassemble(self.program.body)

    def save(self, mvis: str | Path, mid: str | Path | None = None) -> tuple[Path, Path]:
        """Write both profiles; see ProfilePair.save."""
        return self.pair.save(mvis, mid)


Value = float | str | Sequence[float]


def compile_model(
    model: Model, set: Mapping[str, Value] | None = None, channels: Iterable[str] = ()
) -> Compiled:
    """Compile a model to a MID and an MVIS.

    set: quantities fixed now, by name or four-letter signature: numbers (radians for angles, one
    a component), or text as on the command line ("40deg"). channels: variables or constants that
    come with each pixel instead. Raises ModelError, ValueGivenError, or SelfCheckError when the
    program does not agree with the model.
    """
    roles = assign_roles(model, set or {}, channels)
    if not roles.channels:
        raise ValueGivenError(
            "no channel is left: a profile needs one value a pixel at least",
            hint="leave one quantity out of --set",
        )
    check_examples(model)
    ready = formula(model, roles.constants)
    if ready.width != XYZ_COMPONENTS:
        raise BrdfcError(
            f"the radiance of '{model.name}' has {ready.width} components; XYZ needs 3",
            where=str(model.radiance.span),
            hint="a colourless radiance y is written (y, y, y)" if ready.width == 1 else None,
        )
    bindings = roles.bindings()
    program = schedule(select(ready.prepared, bindings), len(roles.channel_names))
    samples = sample(ready.domain, roles.channels, roles.variables)
    verdict = self_check(program, ready.exact, bindings, samples)
    pair = _profiles(model, roles, program, verdict)
    return Compiled(model, roles, ready, program, verdict, pair)


def assign_roles(model: Model, set: Mapping[str, Value], channels: Iterable[str]) -> Roles:
    """Which quantity is what, after --set and --channel; ValueGivenError for what cannot be."""
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


def _profiles(model: Model, roles: Roles, program: Program, verdict: Verdict) -> ProfilePair:
    types = {q.name: q.type for q in model.quantities}
    constants = {n: value_text(v, types[n]) for n, v in roles.constants.items()}
    facts = {
        "program": f"{operations(program)} operators, {price(program):.0f} ns a pixel "
        "by the price table",
        # No measured figure here: its last digits change with the machine, the bytes must not.
        "selfcheck": f"CIEDE2000 below {LIMIT} at {verdict.points} points of the domain",
        "compiler": f"brdfc {__version__}",
    }
    meta = metadata(model, roles.channels, roles.variables, constants, facts)
    defaults = [value for q in roles.channels for value in q.default]
    return profile_pair(model.title, program, roles.channel_names, defaults, meta)
