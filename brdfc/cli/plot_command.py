from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from brdfc.cli.colour_options import adaptation_option, light_options, stated_viewing
from brdfc.cli.options import geometry_option, pairs

if TYPE_CHECKING:
    from brdfc.pictures.sources import Subject

CURVES, BODIES = ("curves", "lobes"), ("sphere", "cylinder")
KINDS = (*CURVES, "strips", *BODIES)
_ONLY_FOR = {
    "reflection": (*CURVES, "strips"),
    "quantity": CURVES,
    "adapts": CURVES,
    "adaptation": CURVES,
    "measured": CURVES,
    "scale": CURVES,
    "reverse": ("curves",),
    "azimuth": BODIES,
    "size": BODIES,
}
"""The kinds that an option is for, where it is not for all of them."""
_OF_MODELS = ("illuminant", "white", "observer", "highlight", "geometry")
"""The options that a profile has decided already."""
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
    "--size", type=click.IntRange(16, 1200), default=480, metavar="N", help="Pixels across a body."
)
@click.option("--title", default="", help="Above the picture.")
@click.option("--csv", "table", metavar="FILE", help="Write the numbers behind the picture, too.")
@light_options
@adaptation_option
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
    from brdfc.files import refuse_same
    from brdfc.pictures.draw import picture_kind, scale
    from brdfc.pictures.sources import open_subjects, source
    from brdfc.pictures.sweep import quantity

    profiles = [s.split(" with ")[0].split(" as ")[0] for s in sources]
    _refuse_idle(kind, all(p.strip().lower().endswith((".icc", ".icm")) for p in profiles))
    picture_kind(output)  # what cannot be drawn is refused before anything is computed
    refuse_same([output, how["table"]], [*profiles, *how["measured"]])
    scale(how["scale"])
    quantity(how["quantity"])
    light = {name: how.pop(name) for name in ("illuminant", "white", "observer")}
    conditions = stated_viewing(**light, surround=None, luminance=None, adaptation=None)
    given = pairs(fixed, "--set")
    found = [source(text, given) for text in sources]
    # A body has directions in space, where its model can take them.
    usual = "full" if kind in BODIES else None
    subjects = open_subjects(found, geometry, conditions, highlight, usual)
    (_draw_bodies if kind in BODIES else _draw_sweeps)(kind, subjects, output, **how)
    click.echo(f"wrote {output}" + (f" and {how['table']}" if how["table"] else ""))


def _refuse_idle(kind: str, only_profiles: bool) -> None:
    """Wrong usage for options that have nothing to say about this picture."""
    context = click.get_current_context()
    flags = {p.name: p.opts[-1] for p in context.command.params}
    for name, flag in flags.items():
        if context.get_parameter_source(name or "") is not ParameterSource.COMMANDLINE:
            continue
        kinds = _ONLY_FOR.get(name or "", KINDS)
        if kind not in kinds:
            raise click.UsageError(f"{flag} is for {' and '.join(kinds)}, not for {kind}")
        if only_profiles and name in _OF_MODELS:
            raise click.UsageError(f"{flag} is for models; a profile has its own")


def _draw_sweeps(
    kind: str,
    subjects: list[Subject],
    output: str,
    *,
    incidents: tuple[str, ...],
    reflection: str | None,
    quantity: str,
    adapts: tuple[str, ...],
    adaptation: str | None,
    measured: tuple[str, ...],
    scale: str,
    reverse: bool,
    exposure: float | None,
    title: str,
    table: str | None,
    **_of_bodies: object,
) -> None:
    from brdfc.pictures.draw import draw_strips, draw_sweeps, write_sweeps
    from brdfc.pictures.sources import angle_of, angles_of
    from brdfc.pictures.sweep import measured_sweeps, sweeps
    from brdfc.pictures.sweep import quantity as quantity_named

    strips = kind == "strips"
    lights = [angle_of(text) for text in incidents or _USUAL_INCIDENTS.get(kind, ("45deg",))]
    seen = angles_of(reflection or _USUAL_REFLECTIONS.get(kind, "-80deg..80deg,1deg"))
    whites = [None if a == "own" else a for a in adapts] or ["D50" if strips else None]
    factor = _exposure(exposure, strips)
    found = sweeps(subjects, lights, seen, whites, factor, adaptation or "bradford")
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
    **_of_curves: object,
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
            xyz, _ = subject.adapted(one.xyz, "D50", "bradford")
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
