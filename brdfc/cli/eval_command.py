from __future__ import annotations

import json

import click

from brdfc.cli.options import connected, environment_option, warn_of_defaults


@click.command("eval")
@click.argument("mid")
@click.argument("mvis")
@environment_option
@click.option(
    "--pixel",
    "pixels",
    multiple=True,
    required=True,
    metavar="V,V,...",
    help="One pixel, a number a channel, angles in radians. Repeatable.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def command(
    mid: str, mvis: str, environment: tuple[str, ...], pixels: tuple[str, ...], as_json: bool
) -> None:
    """Evaluate pixels through a MID and an MVIS: X, Y, Z with 9 digits, a line a pixel.

    \b
    Example:
      brdfc eval ward_mid.icc ward_mvis.icc --env incident=40deg --env reflection=-10deg \\
            --pixel 0.1,0.2,0.6,0.05,0.15
    """
    link = connected(mid, mvis, environment)
    warn_of_defaults(link)
    xyz = link.apply([_numbers(pixel, link.channels) for pixel in pixels])
    if as_json:
        rows = [[float(f"{v:.9g}") for v in row] for row in xyz.tolist()]
        click.echo(json.dumps({"channels": link.channels, "xyz": rows}))
        return
    for row in xyz.tolist():
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
