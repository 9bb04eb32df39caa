from __future__ import annotations

import sys

import click

from brdfc.cli.search_options import end_progress


@click.command("scene-chart")
@click.argument("scene")
@click.option(
    "-o",
    "output",
    metavar="FILE",
    help="A .svg or .png picture, or a .csv table; none: only print.",
)
def command(scene: str, output: str | None) -> None:
    """Compare every model of the library that has the channels SCENE needs: what a pixel costs, and
    how far the colours are from those of the richest model.

    SCENE is a scene file. The richest model is the one it names (model = "ward"), or the most
    elaborate one that has all it speaks of. Each model is compiled for the scene; what a model has
    beyond the scene has its default. The cheapest within the scene's tolerance is marked.

    \b
    Example:
      brdfc scene-chart scene.toml
      brdfc scene-chart scene.toml -o models.svg
    """
    from brdfc.scenemodels import compare_models
    from brdfc.scenes.scene import read_scene

    kind = _kind(output)
    read = read_scene(scene)
    found = compare_models(read, _progress)
    end_progress()
    click.echo(f"channels needed: {', '.join(found.needed)}")
    for r in found.rivals:
        marks = ["the richest"] if r.richest else []
        marks += ["<- the cheapest adequate"] if r.chosen else []
        click.echo(
            f"  {r.price:6.0f} ns  {r.difference:8.2g} CIEDE2000  "
            f"{'ok ' if r.adequate else 'off'}  {r.name:<30} {' '.join(marks)}".rstrip()
        )
    for why in sorted(set(found.left_out.values())):
        names = ", ".join(name for name, reason in found.left_out.items() if reason == why)
        click.echo(f"not compared ({why}): {names}")
    if output is None:
        return
    from brdfc.files import write_whole

    title = f"Models for {scene}: the cheapest within CIEDE2000 {read.tolerance:g}"
    if kind == ".csv":
        lines = ["name,price,difference,adequate,richest,chosen"]
        lines += [
            f"{r.name},{r.price!r},{r.difference!r},{r.adequate},{r.richest},{r.chosen}"
            for r in found.rivals
        ]
        write_whole(output, ("\n".join(lines) + "\n").encode())
    else:
        from brdfc.charts.rows import Row, rendered

        rows = [
            Row(r.name, r.price, r.difference, r.adequate, r.chosen, "richest" if r.richest else "")
            for r in found.rivals
        ]
        write_whole(output, rendered(rows, read.tolerance, title, kind[1:]))
    click.echo(f"wrote {output}")


def _kind(output: str | None) -> str:
    """The suffix of the output; what cannot be drawn is refused before models are compiled."""
    from brdfc.charts.draw import chart_kind
    from brdfc.source.errors import BrdfcError

    if output is None:
        return ""
    kind = chart_kind(output)
    if kind == ".html":
        raise BrdfcError(
            "'.html' is no kind of this chart", where=output, hint=".svg, .png or .csv"
        )
    return kind


def _progress(done: int, total: int) -> None:
    if sys.stderr.isatty():
        click.echo(f"\rcompiling models {done}/{total} ", nl=False, err=True)
