"""The options of commands that fit models to measurements."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import click

from brdfc.cli.colour_options import light_options
from brdfc.cli.measurement_options import measurement_options, read
from brdfc.cli.options import pairs

if TYPE_CHECKING:
    from brdfc.fit.measurements import Measurements
    from brdfc.lang.model import Model


def fit_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """The measurements, the light they are seen under, and ranges of coefficients."""
    for option in (
        click.option(
            "--range",
            "ranges",
            multiple=True,
            metavar="NAME=LOW..HIGH",
            help="The range of a quantity, in place of what the model declares. Repeatable.",
        ),
        light_options,
        measurement_options,
    ):
        function = option(function)
    return function


def seen(
    path: str,
    illuminant: str | None,
    white: str | None,
    observer: str | None,
    objective: str = "de2000",
    **said: Any,
) -> Measurements:
    """The measurements of a file as X, Y, Z under a light; camera RGB stays what it is where no
    colour difference is asked for."""
    from brdfc.cli.colour_options import three_numbers
    from brdfc.colour.conditions import viewing_conditions
    from brdfc.fit.colours import to_xyz
    from brdfc.fit.measurements import Kind

    measured = read(path, **said)
    if measured.kind is Kind.RGB and objective != "de2000":
        return measured
    numbers = None if white is None else three_numbers(white, "--white")
    return to_xyz(measured, viewing_conditions(illuminant, observer, numbers))


def ranges_of(texts: Iterable[str]) -> dict[str, tuple[float, float]]:
    """`NAME=LOW..HIGH` texts, numbers or angles with their unit."""
    from brdfc.lang.types import TYPES
    from brdfc.lang.values import parse_value

    found = {}
    for name, text in pairs(texts, "--range").items():
        low, dots, high = text.partition("..")
        declared = TYPES["angle" if text[-3:] in ("deg", "rad") else "number"]
        if not dots:
            raise click.UsageError(f"--range takes NAME=LOW..HIGH, not '{name}={text}'")
        ends = [parse_value(part, declared, name)[0] for part in (low, high)]
        if not ends[0] < ends[1]:
            raise click.UsageError(f"--range {name}={text}: the first is the lesser")
        found[name] = (ends[0], ends[1])
    return found


def fixed_of(model: Model, texts: Iterable[str]) -> dict[str, tuple[float, ...]]:
    """`NAME=VALUE` texts of a model's quantities."""
    from brdfc.lang.model import Role
    from brdfc.lang.values import parse_value
    from brdfc.source.diagnostics import did_you_mean
    from brdfc.source.errors import ValueGivenError

    found = {}
    for name, text in pairs(texts, "--set").items():
        quantity = model.quantity(name)
        if quantity is None:
            known = [q.name for q in model.quantities]
            hint = did_you_mean(name, known) or ", ".join(known)
            raise ValueGivenError(f"'{model.name}' has no '{name}'", hint=hint)
        values = tuple(parse_value(text, quantity.type, name))
        if quantity.role is not Role.CHANNEL:
            raise ValueGivenError(
                f"'{name}' is no coefficient of '{model.name}'",
                hint="directions come with the measurements; --set is for channels",
            )
        if not all(quantity.low <= value <= quantity.high for value in values):
            raise ValueGivenError(
                f"{name}={text} lies outside {quantity.low:g}..{quantity.high:g}",
                hint=f"--range {name}=LOW..HIGH takes another range",
            )
        found[name] = values
    return found
