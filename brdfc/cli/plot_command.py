from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import click

from brdfc.cli.colour_options import stated_viewing, viewing_options
from brdfc.cli.options import geometry_option, pairs

if TYPE_CHECKING:
    from brdfc.pictures.sources import Subject

KINDS = ("curves", "lobes", "strips", "sphere", "cylinder")
_USUAL_INCIDENTS = {"strips": ("-30deg", "0deg", "45deg", "60deg")}
_USUAL_REFLECTIONS = {"strips": "-80deg..80deg,5deg"}


@click.command("plot")
@click.argument("kind", type=click.Choice(KINDS))
@click.argument("sources", nargs=-1, required=True, metavar="SOURCE...")
@click.option("-o", "output", required=True, metavar="FILE", help="A .svg or .png file.")
@click.option(
    "--incident",
    "incidents",
    multiple=True,
    metavar="ANGLE",
    help="Where the light is; repeatable. Default: 45deg; of strips -30, 0, 45 and 60deg.",
)
@click.option(
    "--reflection",
    metavar="FROM..TO,STEP",
    help="Where it is seen from. Default: -80deg..80deg,1deg; of strips in steps of 5deg.",
)
@click.option(
    "--quantity", default="Y", metavar="X|Y|Z|L|a|b|C", help="What curves are of. Default: Y."
)
@click.option(
    "--adapt",
    "adapts",
    multiple=True,
    metavar="own|D50|D65|A|...",
    help="The white that colours are adapted to, own for none; repeatable: a curve for each.",
)
@click.option("--set", "fixed", multiple=True, metavar="NAME=VALUE", help="For every source.")
@click.option(
    "--measured",
    multiple=True,
    metavar="FILE.csv",
    help="Points beside the curves: incident, reflection in degrees, and X, Y, Z or Y. Repeatable.",
)
@click.option("--scale", default="linear", metavar="linear|log|cbrt", help="Of the values.")
@click.option("--reverse", is_flag=True, help="Angles fall from left to right.")
@click.option(
    "--exposure",
    type=float,
    metavar="K",
    help="XYZ is multiplied by it. Default: 1; of strips and bodies pi, which makes a perfect "
    "diffuser, lit along the normal, white.",
)
@click.option(
    "--azimuth",
    default="0deg",
    metavar="ANGLE",
    help="Of a body's light: 0deg from the right (default), 90deg from above.",
)
@click.option(
    "--size", type=click.IntRange(16, 4000), default=320, metavar="N", help="Pixels across a body."
)
@click.option("--title", default="", help="Above the picture.")
@click.option("--csv", "table", metavar="FILE", help="Write the numbers behind the picture, too.")
@viewing_options
@click.option("--highlight", metavar="light|equal", help="See brdfc compile; of models.")
@geometry_option
def command(
    kind: str,
    sources: tuple[str, ...],
    output: str,
    fixed: tuple[str, ...],
    geometry: str | None,
    highlight: str | None,
    **how: Any,
) -> None:
    """Draw what surfaces look like: curves and lobes over the reflection angle, strips of colours,
    a lit sphere or cylinder.

    SOURCE is a model or a profile, with values and a name if wanted: 'ward with ks=0.1 m=0.2 as
    cyan'. What it is given no value for has its default.

    \b
    Example:
      brdfc plot curves ward ggx -o y.svg --incident 30deg --incident 60deg
      brdfc plot curves lamp_mvis.icc -o y.png --adapt own --adapt D65 --reverse
      brdfc plot lobes ward -o lobe.svg --scale cbrt
      brdfc plot strips 'ward with Rd=(0.1,0.15,0.35) as cyan' -o cyan.png
      brdfc plot sphere ward ggx -o balls.png --incident 40deg
    """
    from brdfc.pictures.draw import picture_kind, scale
    from brdfc.pictures.sources import open_subjects, source
    from brdfc.pictures.sweep import quantity

    picture_kind(output)  # what cannot be drawn is refused before anything is computed
    scale(how["scale"])
    quantity(how["quantity"])
    viewing = (
        how.pop(n)
        for n in ("illuminant", "white", "observer", "surround", "luminance", "adaptation")
    )
    conditions = stated_viewing(*viewing)
    given = pairs(fixed, "--set")
    bodies = kind in ("sphere", "cylinder")
    if bodies and geometry is None and not all(s.endswith((".icc", ".icm")) for s in sources):
        geometry = "full"
    found = [source(text, given) for text in sources]
    subjects = open_subjects(found, geometry, conditions, highlight)
    (_draw_bodies if bodies else _draw_sweeps)(kind, subjects, output, **how)
    click.echo(f"wrote {output}" + (f" and {how['table']}" if how["table"] else ""))


def _draw_sweeps(
    kind: str,
    subjects: list[Subject],
    output: str,
    *,
    incidents: tuple[str, ...],
    reflection: str | None,
    quantity: str,
    adapts: tuple[str, ...],
    measured: tuple[str, ...],
    scale: str,
    reverse: bool,
    exposure: float | None,
    azimuth: str,
    size: int,
    title: str,
    table: str | None,
) -> None:
    from brdfc.pictures.draw import draw_strips, draw_sweeps, write_sweeps
    from brdfc.pictures.sources import angle_of, angles_of
    from brdfc.pictures.sweep import measured_sweeps, sweeps
    from brdfc.pictures.sweep import quantity as quantity_named

    strips = kind == "strips"
    lights = [angle_of(text) for text in incidents or _USUAL_INCIDENTS.get(kind, ("45deg",))]
    seen = angles_of(reflection or _USUAL_REFLECTIONS.get(kind, "-80deg..80deg,1deg"))
    whites = [None if a == "own" else a for a in adapts] or [None]
    if strips:
        if adapts:
            raise click.UsageError("strips are sRGB, which is seen under D65: leave out --adapt")
        whites = ["D50"]
    factor = _exposure(exposure, strips)
    found = sweeps(subjects, lights, seen, whites, factor)
    if measured and strips:
        raise click.UsageError("--measured goes with curves and lobes")
    for path in measured:
        found += measured_sweeps(path, lights, subjects[0].white)
    note = "" if factor == 1 else f"Exposure {factor:.4g}."
    named = title or f"{', '.join(s.label for s in subjects)}: what is seen, by direction"
    if strips:
        clipped = draw_strips(found, output, named, note)
        _say_clipped(clipped, "patches")
    else:
        options = {"scale": scale, "reverse": reverse, "note": note}
        what = quantity_named(quantity)
        draw_sweeps(found, output, what, named, lobes=kind == "lobes", **options)  # type: ignore[arg-type]
    if table:
        write_sweeps(found, table)


def _draw_bodies(
    kind: str,
    subjects: list[Subject],
    output: str,
    *,
    incidents: tuple[str, ...],
    exposure: float | None,
    azimuth: str,
    size: int,
    title: str,
    table: str | None,
    **_others: object,
) -> None:
    from dataclasses import replace

    from brdfc.pictures.bodies import light_direction, lit
    from brdfc.pictures.draw import draw_bodies, write_bodies
    from brdfc.pictures.sources import angle_of

    factor = _exposure(exposure, True)
    turn = angle_of(azimuth)
    drawn = []
    for text in incidents or ("45deg",):
        light = light_direction(angle_of(text), turn)
        for subject in subjects:
            one = lit(subject, kind, 2 * size, light, factor)  # drawn at half the size
            xyz, _ = subject.adapted(one.xyz, "D50")
            label = subject.label if len(incidents) < 2 else f"{subject.label}, light at {text}"
            drawn.append((label, replace(one, xyz=xyz)))
    named = title or f"A {kind}, lit from {', '.join(incidents or ('45deg',))}"
    clipped = draw_bodies(drawn, output, named, f"Exposure {factor:.4g}.")
    _say_clipped(clipped, "pixels")
    if table:
        write_bodies(drawn, table)


def _exposure(given: float | None, picture: bool) -> float:
    if given is None:
        return math.pi if picture else 1.0
    if not (math.isfinite(given) and given > 0):
        raise click.UsageError(f"--exposure takes a number above 0, not {given:g}")
    return given


def _say_clipped(count: int, what: str) -> None:
    if count:
        from brdfc.pictures.draw import RULE

        click.echo(f"note: {count:,} {what} lie outside sRGB; {RULE}", err=True)
