from __future__ import annotations

import json
from typing import Any

import click

from brdfc.cli.colour_options import rendered, rendering_options
from brdfc.cli.options import (
    environment_option,
    extrapolate_option,
    interpolation_option,
    warn_of_defaults,
    warn_of_display,
)


@click.command("eval")
@click.argument("profiles", nargs=-1, required=True, metavar="PROFILE...")
@environment_option
@extrapolate_option
@rendering_options
@interpolation_option
@click.option(
    "--pixel",
    "pixels",
    multiple=True,
    required=True,
    metavar="V,V,...",
    help="One pixel, a number a channel; angles in radians, or as the profile was compiled with "
    "--angles. Repeatable.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def command(
    profiles: tuple[str, ...],
    environment: tuple[str, ...],
    pixels: tuple[str, ...],
    as_json: bool,
    **how: Any,
) -> None:
    """Evaluate pixels through a MID and an MVIS, or through one profile whose device values they
    are: X, Y, Z with 9 digits, a line a pixel, unless --to says otherwise.

    \b
    Example:
      brdfc eval ward_mid.icc ward_mvis.icc --env incident=40deg --env reflection=-10deg \\
            --pixel 0.1,0.2,0.6,0.05,0.15
      brdfc eval ward_mid.icc ward_mvis.icc --pixel 0.1,0.2,0.6,0.05,0.15 --to Lab --adapt D65
    """
    chosen = rendered(profiles, environment, **how)
    link = chosen.link
    warn_of_defaults(link)
    warn_of_display(chosen)
    values = chosen.apply([_numbers(pixel, link.channels) for pixel in pixels])
    if as_json:
        rows = [[float(f"{v:.9g}") for v in row] for row in values.tolist()]
        click.echo(json.dumps({"channels": link.channels, chosen.to.value.lower(): rows}))
        return
    for row in values.tolist():
        click.echo(" ".join(f"{value:.9g}" for value in row))


def _numbers(pixel: str, channels: tuple[str, ...]) -> list[float]:
    from math import isfinite

    try:
        numbers = [float(word) for word in pixel.split(",")]
    except ValueError:
        raise click.UsageError(f"--pixel takes numbers and commas, not '{pixel}'") from None
    if len(numbers) != len(channels) or not all(map(isfinite, numbers)):
        listed = ",".join(channels)
        raise click.UsageError(
            f"--pixel takes {len(channels)} finite numbers ({listed}), not '{pixel}'"
        )
    return numbers
