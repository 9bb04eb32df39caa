from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import click

from brdfc.cli.options import geometry_option, pairs
from brdfc.cli.search_options import end_progress, search_options, shown_progress

if TYPE_CHECKING:
    from brdfc.sceneplan import Plan


@click.command("chart")
@click.argument("model")
@click.option(
    "-o", "output", required=True, metavar="FILE", help="A .svg, .png, .html or .csv file."
)
@click.option("--set", "fixed", multiple=True, metavar="NAME=VALUE", help="Fix a quantity first.")
@click.option("--channel", "channels", multiple=True, metavar="NAME", help="Take from the pixel.")
@click.option(
    "--layer",
    "layers",
    multiple=True,
    type=click.Choice(["forms", "encodings", "storage", "engines"]),
    help="What to chart: forms (default); encodings: calculator against tables; storage: "
    "coefficients in fewer bits; engines: time measured here. Repeatable.",
)
@click.option(
    "--scene",
    metavar="FILE",
    help="Chart what is left of the model in a scene (scene.toml), with a table of what is left "
    "out.",
)
@geometry_option
@search_options
def command(
    model: str,
    output: str,
    fixed: tuple[str, ...],
    channels: tuple[str, ...],
    layers: tuple[str, ...],
    scene: str | None,
    geometry: str | None,
    optimize: str,
    max_error: str | None,
    effort: int | None,
) -> None:
    """Chart speed against accuracy: every equivalent form of MODEL that a search finds.

    Price is the time a pixel takes on the ICC's reference engine, by the price table; error is the
    worst over the model's domain, in bits and in CIEDE2000. The page (.html) shows each formula
    under the pointer. The layer of encodings sets the calculator against lookup tables and sampled
    curves; it needs every variable fixed.

    \b
    Example:
      brdfc chart ward -o ward.svg
      brdfc chart ward -o ward.html --effort 1000
      brdfc chart ward -o scene.html --scene scene.toml
      brdfc chart ward -o tables.svg --layer encodings --set incident=40deg --set reflection=10deg
    """
    from brdfc.chartpoints import engine_points, form_points, rivals
    from brdfc.charts.draw import chart_kind, draw
    from brdfc.charts.points import front
    from brdfc.compiler import compile_model, explore_model
    from brdfc.lang.load import load

    chart_kind(output)  # a chart that cannot be drawn is refused before the search
    wanted = layers or ("forms",)
    planned, notes = None, []
    if scene is not None:
        if wanted != ("forms",):
            raise click.UsageError("a scene's chart has the layer of forms only")
        if optimize != "balanced" or max_error is not None:
            raise click.UsageError("how exact the program has to be is said by the scene")
        planned = _planned(model, scene, geometry, pairs(fixed, "--set"), channels)
        loaded = planned.at.model
        notes = [f"Left out for the scene: {line}" for line in planned.ledger()]
        bound = planned.said(planned.fitted.lean.bound)
        notes.append(
            f"Differences above are from what is left; from the whole formula that is {bound}."
        )
    else:
        loaded = load(model, geometry)
    given = pairs(fixed, "--set")
    explored = explore_model(
        loaded,
        given,
        channels,
        optimize=optimize,
        max_error=max_error,
        effort=effort,
        progress=shown_progress,
        planned=planned,
    )
    end_progress()
    if planned is not None:
        points = form_points(explored, planned.problem.ranges)
    else:
        others = rivals(loaded, given, channels, explored)
        points = form_points(explored, others.problem.ranges) if "forms" in wanted else []
        points += others.encodings() if "encodings" in wanted else []
        points += others.storage() if "storage" in wanted else []
    if "engines" in wanted:
        compiled = compile_model(
            loaded, given, channels, optimize=optimize, max_error=max_error, effort=effort
        )
        points += engine_points(compiled, explored)
    draw(points, output, f"{loaded.name}: speed against accuracy", notes)
    for note in notes:
        click.echo(note)
    click.echo(f"{len(points)} points" + ("" if explored.finished else ", more with --effort"))
    if explored.stopped:
        click.echo("note: the search ran out of time; these are the best so far", err=True)
    for error, name in (("bits", "worst bits"), ("de", "worst CIEDE2000")):
        click.echo(f"front of price and {name}:")
        for p in front(points, error):
            chosen = "  <- chosen" if p.chosen else ""
            rules = "; ".join(p.steps) or "as written"
            click.echo(
                f"  {p.price:6.0f} ns  {p.bits:5.2f} bits  {p.de:.1e} CIEDE2000  {rules}{chosen}"
            )
    click.echo(f"wrote {output}")


def _planned(
    model: str,
    scene: str,
    geometry: str | None,
    fixed: Mapping[str, str],
    channels: tuple[str, ...],
) -> Plan:
    from brdfc.colours import colours_of
    from brdfc.lang.load import load
    from brdfc.sceneplan import in_scene, plan_for
    from brdfc.scenes.scene import read_scene

    given = read_scene(scene)
    loaded = load(model, geometry or given.geometry)
    colours = colours_of(loaded, given.conditions, given.highlight)
    return plan_for(in_scene(loaded, given, colours, fixed, channels))
