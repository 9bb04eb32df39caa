from __future__ import annotations

import sys

import click

from brdfc.cli.options import connected, environment_option, warn_of_defaults


@click.command("apply")
@click.argument("mid")
@click.argument("mvis")
@click.argument("image")
@click.option("-o", "output", required=True, metavar="OUT.tif", help="The XYZ image to write.")
@environment_option
def command(mid: str, mvis: str, image: str, output: str, environment: tuple[str, ...]) -> None:
    """Evaluate IMAGE, a float32 TIFF of coefficients, through MID and MVIS to XYZ.

    Its samples are the channels in the order `brdfc compile` prints them. The output is a float32
    TIFF of X, Y, Z, with Y = 1 for white.

    \b
    Example:
      brdfc apply ward_mid.icc ward_mvis.icc coefficients.tif -o xyz.tif \\
            --env incident=40deg --env reflection=10deg
    """
    from brdfc.images.apply import apply_to_tiff

    link = connected(mid, mvis, environment)
    warn_of_defaults(link)
    description = "XYZ, Y = 1 for white; " + (", ".join(environment) or "default angles")
    shown = 0

    def progress(done: int, total: int) -> None:
        nonlocal shown
        if sys.stderr.isatty() and 100 * done // total != shown:
            shown = 100 * done // total
            click.echo(f"\r{shown:3d} %", nl=done == total, err=True)

    applied = apply_to_tiff(link, image, output, description, progress)
    for name, count in applied.outside.items():
        click.echo(
            f"note: {count:,} samples of '{name}' lie outside the range the model declares; "
            "their colours mean nothing",
            err=True,
        )
    click.echo(f"{applied.pixels:,} pixels")
    click.echo(f"wrote {output}")
