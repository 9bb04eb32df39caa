"""The options of commands that say under which light colours are meant, or are wanted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import click

from brdfc.cli.options import connected

if TYPE_CHECKING:
    from brdfc.cmm.rendering import Rendering
    from brdfc.colour.conditions import ViewingConditions
    from brdfc.icc.profile import Profile

_ILLUMINANT = "A|D50|D65|FL2|...|blackbody:2856K|daylight:6500K|FILE.csv"
_OBSERVER = "1931-2|1964-10|FILE.csv"
_TRANSFORM = "bradford|cat02|cat16|vonkries|xyz"


def _applied(function: Callable[..., Any], *options: Callable[..., Any]) -> Callable[..., Any]:
    for option in reversed(options):
        function = option(function)
    return function


def light_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """The light that colours are under, and who sees them."""
    return _applied(
        function,
        click.option(
            "--illuminant",
            metavar=_ILLUMINANT,
            help="The light the colours are under: by name, temperature, or a file of wavelengths "
            "and powers. Default: D50.",
        ),
        click.option(
            "--white",
            metavar="X,Y,Z",
            help="The light's white as measured. Without --illuminant a smooth lamp that has it "
            "stands for its spectrum.",
        ),
        click.option(
            "--observer",
            metavar=_OBSERVER,
            help="Who sees them: a standard observer, or a file of wavelengths and x, y, z. "
            "Default: 1931-2.",
        ),
    )


def adaptation_option(function: Callable[..., Any]) -> Callable[..., Any]:
    """How colours are adapted on the way to another white."""
    return click.option(
        "--adaptation",
        metavar=_TRANSFORM,
        help="How colours are adapted after D50. Default: bradford, linear.",
    )(function)


def viewing_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """The light, the observer and the surround that a profile is for; see stated_viewing."""
    return _applied(
        function,
        light_options,
        click.option(
            "--surround",
            metavar="average|dim|dark|X,Y,Z",
            help="What is around: a fifth, a tenth or none of the white's luminance, or X,Y,Z in "
            "cd/m2. Default: average.",
        ),
        click.option(
            "--luminance",
            type=float,
            metavar="CD/M2",
            help="Of the white. Default: 159.2, of paper under 500 lx.",
        ),
        click.option(
            "--adaptation",
            metavar=_TRANSFORM,
            help="How the profile's colours come to D50 and back. Default: bradford, linear.",
        ),
    )


def stated_viewing(
    illuminant: str | None,
    white: str | None,
    observer: str | None,
    surround: str | None,
    luminance: float | None,
    adaptation: str | None,
) -> ViewingConditions | None:
    """What the viewing options say; None where none is given."""
    if all(v is None for v in (illuminant, white, observer, surround, luminance, adaptation)):
        return None
    from brdfc.colour.conditions import viewing_conditions

    numbers = None if white is None else three_numbers(white, "--white")
    return viewing_conditions(illuminant, observer, numbers, surround, luminance, adaptation)


def three_numbers(text: str, option: str) -> list[float]:
    try:
        numbers = [float(word) for word in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != 3:
        raise click.UsageError(f"{option} takes X,Y,Z, three numbers and commas, not '{text}'")
    return numbers


def rendering_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """What colours are rendered to, and under which light; see rendered."""
    return _applied(
        function,
        click.option(
            "--to",
            default="XYZ",
            metavar="XYZ|Lab|sRGB|spectrum",
            help="XYZ, where white has Y = 1 (default); CIELAB relative to the white; 8-bit sRGB; "
            "reflectances, of a profile that has them.",
        ),
        click.option(
            "--adapt",
            metavar="D50|D65|A|...|X,Y,Z",
            help="The white that colours are adapted to. Default: the profile's own; D65 for sRGB.",
        ),
        click.option(
            "--illuminant",
            metavar=_ILLUMINANT,
            help="The light that reflectances are seen under, of a profile that has them. Default: "
            "the profile's.",
        ),
        click.option(
            "--observer",
            metavar=_OBSERVER,
            help="Who sees them. Default: the profile's observer.",
        ),
        adaptation_option,
        click.option(
            "--transform",
            metavar="TAG",
            help="The transform of the last profile to use: M2B0, M2S0, A2B1, bAB0. Default: what "
            "the other options need.",
        ),
    )


def rendered(
    profiles: Sequence[str | Profile],
    environment: Sequence[str],
    to: str,
    adapt: str | None,
    illuminant: str | None,
    observer: str | None,
    adaptation: str | None,
    transform: str | None,
    extrapolate: bool = False,
    engine: str = "auto",
    interpolation: str = "linear",
) -> Rendering:
    """Profiles linked, and rendered as the rendering options say."""
    from brdfc.cmm.rendering import Target, rendering, seen_conditions, target

    wanted = target(to)  # what cannot be is refused before a profile is read
    if adaptation is not None and adapt is None and wanted is not Target.SRGB:
        raise click.UsageError("--adaptation says how colours are adapted: give --adapt too")
    seen = illuminant is not None or observer is not None
    if transform is None and (seen or wanted is Target.SPECTRUM):
        transform = "M2S0" if len(profiles) > 1 else "D2B1"
    link = connected(profiles, environment, transform, extrapolate, engine, interpolation)
    conditions = seen_conditions(link, illuminant, observer) if seen else None
    return rendering(link, wanted, adapt, conditions, adaptation or "bradford")
