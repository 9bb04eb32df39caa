"""What several commands take: NAME=VALUE pairs, and the variables of a run."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from brdfc.cmm.link import Link
    from brdfc.cmm.rendering import Rendering
    from brdfc.icc.profile import Profile


def pairs(values: Iterable[str], option: str) -> dict[str, str]:
    """`NAME=VALUE` texts as a dictionary; wrong usage (exit 2) for any other text."""
    given: dict[str, str] = {}
    for value in values:
        name, separator, text = value.partition("=")
        name = name.strip()
        if not separator or not name or not text.strip():
            raise click.UsageError(f"{option} takes NAME=VALUE, not '{value}'")
        if name in given:
            raise click.UsageError(f"{option} gives '{name}' twice")
        given[name] = text.strip()
    return given


def geometry_option(function: Callable[..., Any]) -> Callable[..., Any]:
    """The --geometry option of commands that read models."""
    return click.option(
        "--geometry",
        metavar="plane|full|FILE",
        help="How directions are given: signed angles in the plane of incidence (plane, the "
        "default), or two zeniths and two azimuths (full).",
    )(function)


def whole_number(least: int, most: int) -> Callable[[click.Context, click.Parameter, str], int]:
    """A callback for an option that takes a whole number, also as `1e7` or `20_000`."""

    def parsed(context: click.Context, option: click.Parameter, text: str) -> int:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not value.is_integer() or not least <= value <= most:
            message = f"'{text}' is no whole number from {least:,} to {most:,}; write, say, 1e6"
            raise click.BadParameter(message, context, option)
        return int(value)

    return parsed


def image_progress() -> Callable[[int, int], None]:
    """Shows how many pixels of an image are done, how fast, and the time left, on a terminal's
    standard error."""
    begun: tuple[float, int] | None = None
    shown = 0.0

    def progress(done: int, total: int) -> None:
        nonlocal begun, shown
        if not sys.stderr.isatty():
            return
        now = time.monotonic()
        if begun is None:  # what was done before this run says nothing of its speed
            begun = (now, done)
        if done < total and now - shown < _REDRAWN:
            return
        shown = now
        rate = (done - begun[1]) / max(now - begun[0], 1e-9)
        left = f"{_duration((total - done) / rate)} left" if rate and done < total else ""
        text = f"{100 * done // total:3d} %  {rate / 1e6:.3g} Mpixel/s  {left}"
        click.echo(f"\r{text:<50}", nl=done == total, err=True)

    return progress


_REDRAWN = 0.2
"""Seconds between two lines of progress."""


def _duration(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes:02d} min"
    return f"{minutes} min {rest:02d} s" if minutes else f"{rest} s"


def environment_option(function: Callable[..., Any]) -> Callable[..., Any]:
    """The --env option of commands that run profiles."""
    return click.option(
        "--env",
        "environment",
        multiple=True,
        metavar="NAME=VALUE",
        help="A variable of the run, angles with their unit: incident=40deg. Repeatable.",
    )(function)


def extrapolate_option(function: Callable[..., Any]) -> Callable[..., Any]:
    """The --extrapolate option of commands that run profiles."""
    return click.option(
        "--extrapolate",
        is_flag=True,
        help="Take variables outside the ranges that the profile was compiled for.",
    )(function)


def engine_option(function: Callable[..., Any]) -> Callable[..., Any]:
    """The --engine option of commands that run profiles over many pixels."""
    return click.option(
        "--engine",
        type=click.Choice(["auto", "compiled", "blocks", "interpreter"]),
        default="auto",
        help="Machine code (needs brdfc[jit]), NumPy in blocks, or an operator at a time. Default: "
        "what is done first.",
    )(function)


def interpolation_option(function: Callable[..., Any]) -> Callable[..., Any]:
    """The --interpolation option of commands that run profiles."""
    return click.option(
        "--interpolation",
        type=click.Choice(["linear", "tetrahedral"]),
        default="linear",
        help="Of lookup tables of three channels; all others are linear. Default: linear.",
    )(function)


def connected(
    profiles: Sequence[str | Profile],
    environment: Iterable[str],
    transform: str | None = None,
    extrapolate: bool = False,
    engine: str = "auto",
    intent: str | None = None,
    interpolation: str = "linear",
) -> Link:
    """Profiles linked, variables read in the units that the profiles declare.

    transform: the tag of the last to use, and intent: see cmm.connect.connect.
    """
    from functools import partial

    from brdfc.cmm.connect import connect
    from brdfc.icc.profile import Profile
    from brdfc.lang.types import TYPES, DeclaredType
    from brdfc.lang.values import parse_value

    loaded = [p if isinstance(p, Profile) else Profile.load(p) for p in profiles]
    given = pairs(environment, "--env")
    linked = partial(
        connect,
        *loaded,
        transform=transform,
        intent=intent,
        engine=engine,
        interpolation=interpolation,
    )
    types: dict[str, DeclaredType] = {}
    for described in linked().stated_variables if given else ():
        types |= dict.fromkeys((described.signature, described.name), described.type)
    values = {}
    for name, text in given.items():
        # A foreign profile does not say what its variables are; the unit the user writes does.
        declared = types.get(name) or TYPES["angle" if text[-3:] in ("deg", "rad") else "number"]
        values[name] = parse_value(text, declared, name)[0]
    return linked(env=values, extrapolate=extrapolate)


def warn_of_display(chosen: Rendering) -> None:
    """Say that a profile was compiled for what a display shows, where something else is wanted."""
    from brdfc.cmm.rendering import Target
    from brdfc.icc.types import Dictionary

    metas = [stage.profile.tags.get("meta") for stage in chosen.link.stages]
    outputs = [meta.get("scene.output") for meta in metas if isinstance(meta, Dictionary)]
    if "sRGB" in outputs and chosen.to is not Target.SRGB:
        click.echo(
            "note: the profile was compiled for sRGB; what that clips is not computed, so other "
            "colours than --to sRGB gives mean nothing there",
            err=True,
        )


def warn_of_defaults(link: Link) -> None:
    """Say which channels the MID does not have; the reference engine would not."""
    if link.defaulted:
        listed = ", ".join(link.defaulted)
        click.echo(f"note: the MID has no channel {listed}; the MVIS's default is used", err=True)
