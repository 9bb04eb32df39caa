"""A model made ready to compile: roles, formula, and the problem that a search solves."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from brdfc.colour.colorimetry import XYZ_UNDER_D50, Colorimetry
from brdfc.colours import bands
from brdfc.judge.cache import holds, note
from brdfc.judge.examples import check_examples, examples_digest
from brdfc.judge.problem import Problem
from brdfc.lang.model import Model
from brdfc.roles import Roles, Value, assign_roles
from brdfc.source.errors import BrdfcError, ValueGivenError
from brdfc.symbolic.formula import NO_WHITE, Formula, formula
from brdfc.symbolic.intervals import Interval


def prepare(
    model: Model,
    set: Mapping[str, Value],
    channels: Iterable[str],
    cache: bool = False,
    white: Sequence[float] = NO_WHITE,
) -> tuple[Roles, Formula]:
    """The roles of the quantities, and the formula with its constants in, examples checked.

    cache: examples that held before, of the same formula, are not evaluated again. white: that the
    model's colours are under (see symbolic/white.py).
    """
    roles = assign_roles(model, set, channels, white)
    if not roles.channels:
        raise ValueGivenError(
            "no channel is left: a profile needs one value a pixel at least",
            hint="leave one quantity out of --set",
        )
    name = examples_digest(model)
    if not (cache and holds(name)):
        check_examples(model)
        if cache:
            note(name)
    ready = formula(model, roles.constants, white)
    needed = bands(model)
    if ready.width != needed:
        raise BrdfcError(
            f"the radiance of '{model.name}' has {ready.width} components; {needed} are needed",
            where=str(model.radiance.span),
            hint="a colourless radiance y is written (y, y, y)" if ready.width == 1 else None,
        )
    return roles, ready


def problem_of(
    roles: Roles,
    ready: Formula,
    colorimetry: Colorimetry = XYZ_UNDER_D50,
    declared: Mapping[str, Interval] | None = None,
) -> Problem:
    """What a search for forms needs to know; declared: see Problem."""
    quantities, count = roles.channels + roles.variables, len(roles.channel_names)
    return Problem(ready, quantities, roles.bindings(), count, colorimetry, declared)
