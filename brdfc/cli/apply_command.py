from __future__ import annotations

from typing import Any

import click

from brdfc.cli.colour_options import rendered, rendering_options
from brdfc.cli.options import environment_option, extrapolate_option, row_progress, warn_of_defaults


@click.command("apply")
@click.argument("files", nargs=-1, required=True, metavar="PROFILE... IMAGE")
@click.option("-o", "output", required=True, metavar="OUT.tif", help="The image to write.")
@environment_option
@extrapolate_option
@rendering_options
def command(files: tuple[str, ...], output: str, environment: tuple[str, ...], **how: Any) -> None:
    """Evaluate IMAGE, a float32 TIFF of coefficients, through a MID and an MVIS, or through one
    profile whose device values they are.

    Its samples are the channels in the order `brdfc compile` prints them. The output is a TIFF:
    float32 X, Y, Z, with Y = 1 for white, unless --to says otherwise.

    \b
    Example:
      brdfc apply ward_mid.icc ward_mvis.icc coefficients.tif -o xyz.tif \\
            --env incident=40deg --env reflection=10deg
      brdfc apply ward_mid.icc ward_mvis.icc coefficients.tif -o picture.tif --to sRGB
      brdfc apply ward_mid.icc ward_mvis.icc coefficients.tif -o under_a.tif --adapt A
    """
    from brdfc.files import refuse_same
    from brdfc.images.apply import apply_to_tiff

    *profiles, image = files
    if not profiles:
        raise click.UsageError("give the profiles first, then the image")
    refuse_same([output], files)
    chosen = rendered(profiles, environment, **how)
    warn_of_defaults(chosen.link)
    run = ", ".join(environment) or "default angles"
    applied = apply_to_tiff(chosen, image, output, run, row_progress())
    for name, count in applied.outside.items():
        click.echo(
            f"note: {count:,} samples of '{name}' lie outside the range the model declares; "
            "their colours mean nothing",
            err=True,
        )
    if applied.clipped:
        click.echo(
            f"note: {applied.clipped:,} pixels lie outside what sRGB can show; each component is "
            "clipped to it",
            err=True,
        )
    click.echo(f"{applied.pixels:,} pixels")
    click.echo(f"wrote {output}")
