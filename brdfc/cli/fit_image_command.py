from __future__ import annotations

import time

import click

from brdfc.cli.fit_options import fixed_of, ranges_of
from brdfc.cli.options import image_progress
from brdfc.cli.stopping import stop_when_told


@click.command("fit-image")
@click.argument("stack", metavar="STACK.toml|STACK.csv")
@click.option("--model", "name", required=True, metavar="MODEL", help="A .brdf file, or a name.")
@click.option(
    "-o", "output", required=True, metavar="OUT.tif", help="The image of coefficients to write."
)
@click.option(
    "--quality",
    metavar="QUALITY.tif",
    help="Write how good each pixel's fit is: the root mean square that is left, whether it "
    "converged, and how many geometries were usable.",
)
@click.option("--unit", metavar="UNIT", help="Of the values: brdf, radiance-factor, ...")
@click.option(
    "--clip", type=float, metavar="VALUE", help="Samples from here on are saturated: left out."
)
@click.option(
    "--keep", is_flag=True, help="Write the coefficients of fits that did not converge, too."
)
@click.option(
    "--set", "fixed", multiple=True, metavar="NAME=VALUE", help="Do not fit this one. Repeatable."
)
@click.option(
    "--range",
    "ranges",
    multiple=True,
    metavar="NAME=LOW..HIGH",
    help="The range of a quantity, in place of what the model declares. Repeatable.",
)
@click.option(
    "--memory", metavar="SIZE", help="What buffers may take in all: 256MB, 1GiB. Default: 192MB."
)
@click.option(
    "--threads",
    type=click.IntRange(1, 1024),
    metavar="N",
    help="How many compute at once. Default: as many as there are processors.",
)
@click.option(
    "--resume",
    is_flag=True,
    help="Keep what is done when it is interrupted, and go on from what an earlier run kept.",
)
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="Have it done by a Dask cluster on a shared storage: tcp://host:8786. Needs "
    "brdfc[distributed].",
)
def command(
    stack: str,
    name: str,
    output: str,
    quality: str | None,
    unit: str | None,
    clip: float | None,
    keep: bool,
    fixed: tuple[str, ...],
    ranges: tuple[str, ...],
    memory: str | None,
    threads: int | None,
    resume: bool,
    scheduler: str | None,
) -> None:
    """Fit a model to every pixel of a stack of images, each seen in its own geometry.

    STACK lists the images and their angles, see docs/pixels.md. What is written is what
    `brdfc apply` takes. A pixel whose fit did not converge, or that has too few usable samples, is
    NaN. The exit status is 1 where more than half of the pixels are.

    \b
    Example:
      brdfc fit-image stack.toml --model ward -o coefficients.tif --quality quality.tif
      brdfc fit-image stack.csv --model ggx -o ggx.tif --set F0=0.04 --clip 0.98 --resume
    """
    from brdfc.fit.fit import in_ranges
    from brdfc.fit.pixel_image import Options, fit_stack
    from brdfc.fit.stack import read_stack
    from brdfc.images.memory import USUAL, parse_size
    from brdfc.lang.load import load
    from brdfc.source.errors import FitError

    stop_when_told()
    model = load(name, "full")
    read = read_stack(stack, unit)
    for remark in read.remarks:
        click.echo(f"note: {remark}", err=True)
    limit = USUAL if memory is None else parse_size(memory)
    begun = time.perf_counter()
    found = fit_stack(
        in_ranges(model, ranges_of(ranges)),
        read,
        output,
        quality,
        fixed=fixed_of(model, fixed),
        options=Options(clip, keep, limit, threads, resume, scheduler),
        progress=image_progress(),
    )
    took = time.perf_counter() - begun
    click.echo(f"{'model':<13}{model.name}: {', '.join(found.coefficients)}")
    click.echo(f"{'geometries':<13}{len(read.files)}")
    click.echo(f"{'pixels':<13}{found.pixels:,}, {found.fitted:,} fitted, in {took:.3g} s")
    written = "written all the same" if keep else "NaN"
    for count, what in (
        (found.failed, f"pixels whose fit did not converge: {written}"),
        (found.few, "pixels with too few usable geometries: NaN"),
        (found.left_out, "samples left out: no numbers, negative or saturated"),
    ):
        if count:
            click.echo(f"note: {count:,} {what}", err=True)
    for path in filter(None, (output, quality)):
        click.echo(f"{'wrote':<13}{path}")
    if 2 * found.fitted < found.pixels:
        raise FitError(
            f"{found.pixels - found.fitted:,} of {found.pixels:,} pixels could not be fitted",
            where=stack,
            hint="check the unit, the angles, and whether the model is the right one",
        )
