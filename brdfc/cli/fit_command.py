from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING, Any

import click

from brdfc.cli.fit_options import fit_options, fixed_of, ranges_of, seen
from brdfc.cli.options import pairs

if TYPE_CHECKING:
    from brdfc.fit.result import Fit


@click.command("fit")
@click.argument("data")
@click.option("--model", "name", required=True, metavar="MODEL", help="A .brdf file, or a name.")
@click.option("-o", "output", metavar="FIT.toml", help="Write the coefficients.")
@click.option(
    "--objective",
    default="de2000",
    metavar="de2000|cube-root|log|l2",
    help="What is made small: the mean CIEDE2000 (default), or squares on a scale.",
)
@click.option(
    "--weights",
    metavar="lightness=A,chroma=B,hue=C",
    help="How much differences of lightness, chroma and hue count in CIEDE2000. Default: 1 each.",
)
@click.option(
    "--set", "fixed", multiple=True, metavar="NAME=VALUE", help="Do not fit this one. Repeatable."
)
@click.option("--starts", type=click.IntRange(1, 1000), help="Where to start from. Default: 12.")
@click.option("--seed", type=click.IntRange(0), default=1, help="Of the starts. Default: 1.")
@click.option(
    "--method",
    type=click.Choice(["least-squares", "nelder-mead"]),
    default="least-squares",
    help="The second is the published workflow's, to compare with.",
)
@click.option(
    "--bootstrap",
    type=click.IntRange(20, 10_000),
    default=None,
    metavar="N",
    help="Take the intervals from so many fits to measurements drawn anew.",
)
@click.option("--csv", "table", metavar="FIT.csv", help="Write a table of the coefficients.")
@click.option("--tiff", "patch", metavar="PATCH.tif", help="Write a small image of them.")
@click.option("--mitsuba", metavar="BSDF.json", help="Write it as Mitsuba 3 reads it.")
@fit_options
def command(
    data: str,
    name: str,
    output: str | None,
    objective: str,
    weights: str | None,
    fixed: tuple[str, ...],
    starts: int | None,
    seed: int,
    method: str,
    bootstrap: int | None,
    table: str | None,
    patch: str | None,
    mitsuba: str | None,
    ranges: tuple[str, ...],
    **said: Any,
) -> None:
    """Fit a model's coefficients to measurements, and say how sure they are.

    DATA is what `brdfc data` reads. Spectra are fitted as X, Y, Z under a light. The intervals are
    of 95 %. What the measurements do not determine is named.

    \b
    Example:
      brdfc fit garnet_red.brdf --model ward -o garnet.toml
      brdfc fit data.csv --model ggx --range ks=0..10 --set F0=0.04 --bootstrap 100
      brdfc compile ward --coefficients garnet.toml -o garnet_mvis.icc
    """
    from brdfc.files import refuse_same, write_all
    from brdfc.fit.exports import csv_text, mitsuba_text, require_mitsuba, write_patch
    from brdfc.fit.fit import fit
    from brdfc.fit.fitting import STARTS, Method
    from brdfc.lang.load import load
    from brdfc.source.errors import FitError

    refuse_same([output, table, patch, mitsuba], [data])
    model = load(name, "full")
    if mitsuba:
        require_mitsuba(model.name)
    found = fit(
        model,
        seen(data, objective=objective, **said),
        objective=objective,
        factors=_factors(weights),
        fixed=fixed_of(model, fixed),
        ranges=ranges_of(ranges),
        starts=starts or STARTS,
        seed=seed,
        method=Method(method),
        bootstrap=bootstrap or 0,
    )
    _show(found)
    if not found.converged:
        raise FitError(
            "the search did not converge, and nothing was written",
            where=data,
            hint="try --starts with more, a model with fewer coefficients, or --set some of them",
        )
    files = [(output, found.to_toml)] if output else []
    files += [(table, lambda: csv_text(found))] if table else []
    files += [(mitsuba, lambda: mitsuba_text(found))] if mitsuba else []
    written = [(path, text().encode()) for path, text in files]
    if patch:  # the first to fail
        write_patch(found, patch)
    write_all(*written)
    for path in (output, table, mitsuba, patch):
        if path:
            click.echo(f"{'wrote':<13}{path}")


def _show(found: Fit) -> None:
    click.echo(f"{'model':<13}{found.model}, {len(found.estimates)} coefficients")
    click.echo(f"{'data':<13}{found.data}, {found.measurements:,} measurements")
    for e in found.estimates:
        click.echo(f"  {e.name:<11}{e.value:<11.5g} {e.low:.5g} .. {e.high:.5g}")
    if found.difference is None:
        click.echo(f"{'left':<13}{found.loss:.4g}, root mean square of {found.objective}")
    else:
        mean, most, worst = found.difference
        click.echo(f"{'CIEDE2000':<13}mean {mean:.3f}, 95 % {most:.3f}, worst {worst:.3f}")
        rows = [f"{d:g}: {m:.2f}" for d, m, _ in found.by_incidence]
        if len(rows) <= 20:
            click.echo(f"{'by incidence':<13}{', '.join(rows)} (degrees, mean)")
    starts = f"{found.agreed} of {found.starts} starts came to this"
    click.echo(f"{'search':<13}{starts}{'' if found.converged else '; DID NOT CONVERGE'}")
    for remark in found.remarks:
        click.echo(f"note: {remark}", err=True)
    sys.stdout.flush()


def _factors(text: str | None) -> tuple[float, float, float]:
    """kL, kC, kH of weights; a weight of 2 halves the factor."""
    names = ("lightness", "chroma", "hue")
    given = pairs(text.split(",") if text else (), "--weights")
    unknown = set(given) - set(names)
    try:
        weights = [float(given.get(name, "1")) for name in names]
    except ValueError:
        weights = [0.0]
    if unknown or not all(0 < weight < math.inf for weight in weights):
        raise click.UsageError(f"--weights takes lightness=A,chroma=B,hue=C, not '{text}'")
    return 1 / weights[0], 1 / weights[1], 1 / weights[2]
