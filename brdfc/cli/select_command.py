from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import click

from brdfc.cli.fit_options import fit_options, ranges_of, seen
from brdfc.cli.search_options import end_progress

if TYPE_CHECKING:
    from brdfc.fit.selection import Selection


@click.command("select")
@click.argument("data")
@click.option("--models", metavar="A,B,...", help="Default: the isotropic ones of the library.")
@click.option(
    "--tolerance",
    type=float,
    metavar="dE",
    help="Take the smallest whose mean CIEDE2000, held out, is this at most.",
)
@click.option("-o", "output", metavar="FILE", help="A .svg or .png picture, or a .csv table.")
@fit_options
def command(
    data: str,
    models: str | None,
    tolerance: float | None,
    output: str | None,
    ranges: tuple[str, ...],
    **said: Any,
) -> None:
    """Choose the smallest model that measurements support.

    Each is fitted to all incidences but some, and judged by those. Of the models within one
    standard error of the best that way, on a scale of what is seen, the one with the fewest
    coefficients is chosen. What a pixel costs in the calculator stands beside it.

    \b
    Example:
      brdfc select garnet_red.brdf -o models.svg
      brdfc select data.csv --models lambert,ward,ggx --tolerance 2
    """
    from brdfc.charts.draw import chart_kind
    from brdfc.compiler import compile_model
    from brdfc.files import refuse_same, write_whole
    from brdfc.fit.selection import MODELS, select
    from brdfc.lang.load import load
    from brdfc.scenes.scene import checked_tolerance
    from brdfc.source.errors import BrdfcError

    kind = chart_kind(output) if output else ""
    if kind == ".html":
        raise BrdfcError(
            "'.html' is no kind of this chart", where=output, hint=".svg, .png or .csv"
        )
    refuse_same([output], [data])
    names = [name.strip() for name in models.split(",")] if models else list(MODELS)
    loaded = [load(name, "full") for name in names]
    paths = {model.name: name for model, name in zip(loaded, names, strict=True)}
    measured = seen(data, **said)
    for remark in measured.remarks:
        click.echo(f"note: {remark}", err=True)
    if tolerance is not None:
        tolerance = checked_tolerance(tolerance, "--tolerance")
    found = select(
        measured,
        loaded,
        lambda name: compile_model(load(paths[name]), cache=True).price,
        tolerance,
        ranges_of(ranges),
        _progress,
    )
    end_progress()
    _show(found)
    if output:
        write_whole(output, _written(found, measured.name, kind))
        click.echo(f"wrote {output}")


def _progress(name: str) -> None:
    if sys.stderr.isatty():
        click.echo(f"\r{'fitting ' + name:<40}", nl=False, err=True)


def _show(found: Selection) -> None:
    click.echo(
        f"  {'model':<20}{'coefficients':>12}{'ns/pixel':>10}{'fit dE':>9}{'held out':>10}"
        f"{'seen':>9}{'+-':>8}{'BIC':>9}"
    )
    for c in found.candidates:
        mark = "  <- chosen" if c is found.chosen else ""
        mark += "" if c.fit.converged else "  (the search did not converge)"
        click.echo(
            f"  {c.name:<20}{c.parameters:>12}{c.cost:>10.0f}{c.inside:>9.3f}{c.outside:>10.3f}"
            f"{c.seen:>9.4f}{c.error:>8.4f}{c.criterion:>9.0f}{mark}"
        )
    for name, why in found.left_out.items():
        click.echo(f"  {name:<20}not fitted: {why}")
    if found.chosen is None and found.tolerance is None:
        click.echo("no search converged: none can be chosen")
    elif found.chosen is None:
        nearest = found.nearest
        click.echo(
            f"none reaches {found.tolerance:g}: the nearest is {nearest.name} with "
            f"{nearest.outside:.3f}, held out"
        )
    elif found.tolerance is not None:
        click.echo(f"{found.chosen.name} is the smallest that reaches {found.tolerance:g}")
    else:
        click.echo(f"{found.chosen.name} is the smallest within one standard error of the best")


def _written(found: Selection, data: str, kind: str) -> bytes:
    if kind == ".csv":
        lines = ["model,coefficients,price,inside,outside,seen,error,criterion,chosen"]
        lines += [
            f"{c.name},{c.parameters},{c.cost!r},{c.inside!r},{c.outside!r},{c.seen!r},"
            f"{c.error!r},{c.criterion!r},{c is found.chosen}"
            for c in found.candidates
        ]
        return ("\n".join(lines) + "\n").encode()
    from brdfc.charts.choice import Point, rendered

    points = [
        Point(c.name, c.parameters, c.cost, c.inside, c.outside, c is found.chosen)
        for c in found.candidates
    ]
    return rendered(points, found.tolerance, f"Models for {data}", kind[1:])
