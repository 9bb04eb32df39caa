from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from brdfc.cli.colour_options import stated_viewing, viewing_options
from brdfc.cli.options import geometry_option, pairs
from brdfc.cli.search_options import end_progress, search_options, shown_progress

if TYPE_CHECKING:
    from brdfc.colour.conditions import ViewingConditions
    from brdfc.compiled import Compiled
    from brdfc.sceneplan import Plan
    from brdfc.scenes.scene import Scene


@click.command("compile")
@click.argument("model")
@click.option(
    "-o", "output", required=True, metavar="FILE", help="The profile to write (the MVIS)."
)
@click.option("--mid", metavar="FILE", help="The MID profile; default: beside the MVIS.")
@click.option(
    "--set",
    "fixed",
    multiple=True,
    metavar="NAME=VALUE",
    help="Fix a quantity now: m=0.2, incident=40deg. Repeatable.",
)
@click.option(
    "--channel",
    "channels",
    multiple=True,
    metavar="NAME",
    help="Take a quantity from each pixel: angles of a curved surface, say. Repeatable.",
)
@click.option(
    "--coefficients",
    metavar="FIT.toml",
    help="Take the defaults of channels from a fit: the values where an image has none.",
)
@click.option("--asm", metavar="FILE", help="Write the calculator text too.")
@click.option(
    "--encode",
    default="calc",
    metavar="mcs|ncolour|brdf-function|brdf-struct|clut:N|curve:N",
    help="A MID and an MVIS (mcs, default); one profile with the angles among its device values "
    "(ncolour), with four angles before them (brdf-function), or with the parameters of a "
    "registered model for a renderer (brdf-struct). And a calculator program (default), a lookup "
    "table of N points a channel, or a calculator with curves of N points; the last two need every "
    "variable fixed with --set. Both: ncolour,clut:17.",
)
@click.option(
    "--angles",
    metavar="radians|degrees|unit",
    help="How angles among the device values are given; unit: 0..1 for their range, zeniths 0..1 "
    "for 0..90 and azimuths for 0..360 degrees. Default: radians for ncolour, unit for "
    "brdf-function.",
)
@click.option(
    "--parameters",
    metavar="channel|parameter",
    help="How a structure's parameters go: all of one channel, then of the next, or the reverse. "
    "Default: channel.",
)
@click.option(
    "--spectral",
    metavar="FROM..TO,STEP",
    help="Reflectances at wavelengths in place of X, Y, Z: 400nm..700nm,10nm. The MVIS leads to "
    "reflectances as well as to XYZ.",
)
@viewing_options
@click.option(
    "--highlight",
    metavar="light|equal",
    help="A highlight without colour has the light's colour, or adds the same to X, Y and Z. "
    "Default: as the model says; most say the light's.",
)
@geometry_option
@search_options
@click.option(
    "--scene",
    metavar="FILE",
    help="Compile for a scene (scene.toml): what cannot be seen in it is left out. Its ranges, "
    "light and tolerance count.",
)
@click.option(
    "--tolerance",
    type=float,
    metavar="dE",
    help="CIEDE2000 that the scene's profile may be off, in place of what the scene says.",
)
@click.option("--explain", is_flag=True, help="Show how the chosen form was derived.")
@click.option("--no-cache", is_flag=True, help="Search anew, and keep nothing.")
def command(
    model: str,
    output: str,
    mid: str | None,
    fixed: tuple[str, ...],
    channels: tuple[str, ...],
    coefficients: str | None,
    asm: str | None,
    encode: str,
    angles: str | None,
    parameters: str | None,
    spectral: str | None,
    highlight: str | None,
    geometry: str | None,
    optimize: str,
    max_error: str | None,
    effort: int | None,
    scene: str | None,
    tolerance: float | None,
    explain: bool,
    no_cache: bool,
    **viewing: Any,
) -> None:
    """Compile MODEL, a .brdf file or a library model, to a MID and an MVIS profile.

    An .xml file, as `brdfc xml` and the ICC's tools write it, is compiled to the profile that it
    describes.

    Equivalent forms of the formula are searched, and the cheapest that is accurate enough is
    taken. The program is checked against the model in high precision over its whole domain before
    anything is written.

    \b
    Example:
      brdfc compile ward -o ward_mvis.icc
      brdfc compile ward -o baked_mvis.icc --set incident=40deg --set reflection=10deg
      brdfc compile ward -o curved_mvis.icc --channel incident --channel reflection
      brdfc compile ward -o exact_mvis.icc --optimize accuracy --explain
      brdfc compile ward -o garnet_mvis.icc --coefficients garnet.toml
      brdfc compile ward -o lamp_mvis.icc --white 0.97,1,0.484
      brdfc compile ward -o angles.icc --encode ncolour
      brdfc compile ward -o scene_mvis.icc --scene scene.toml
      brdfc compile ward -o spectral_mvis.icc --spectral 400nm..700nm,10nm --illuminant A
      brdfc compile display.xml -o display.icc
    """
    if model.lower().endswith(".xml"):
        from brdfc.cli.compile_xml import compile_xml

        compile_xml(model, output)
        return
    from brdfc.calc.price import operations
    from brdfc.compiler import compile_model
    from brdfc.files import refuse_same, write_all
    from brdfc.lang.load import load

    wanted = _scene(scene, tolerance)
    if geometry is None and wanted is not None:
        geometry = wanted.geometry
    if geometry is None and "brdf-function" in encode:
        geometry = "full"  # which is what it takes
    conditions = stated_viewing(**viewing)
    loaded = load(model, geometry, spectral)
    if coefficients is not None:
        from brdfc.fit.result import read_coefficients, with_defaults

        found = read_coefficients(coefficients)
        loaded = with_defaults(loaded, found)
        _require_white(found.white, conditions, coefficients)
    compiled = compile_model(
        loaded,
        pairs(fixed, "--set"),
        channels,
        optimize=optimize,
        max_error=max_error,
        effort=effort,
        encode=encode,
        scene=wanted,
        conditions=conditions,
        highlight=highlight,
        angles=angles,
        parameters=parameters,
        cache=not no_cache,
        progress=shown_progress,
    )
    end_progress()
    files = compiled.files(output, mid)
    files += [(Path(asm), compiled.text.encode())] if asm else []
    refuse_same([path for path, _ in files], [model, coefficients])
    write_all(*files)
    verdict, program = compiled.verdict, compiled.program
    click.echo(f"channels     {_short(' '.join(compiled.roles.channel_names), 200)}")
    names = [f"{q.name} ({q.signature})" for q in compiled.roles.variables]
    click.echo(f"variables    {', '.join(names) or 'none'}")
    if compiled.plan is not None and conditions is None:
        conditions = compiled.plan.at.scene.conditions
    if conditions is not None:
        made = "; its spectrum is made from the white" if conditions.lamp_made else ""
        click.echo(f"light        {conditions}{made}")
    click.echo(
        f"program      {operations(program)} operators, about {compiled.price:.0f} ns "
        f"a pixel on the reference engine; stack {verdict.facts.stack}, "
        f"temporaries {verdict.facts.temporaries}"
    )
    if compiled.form is not None:
        _show_form(compiled, explain)
    if compiled.plan is not None:
        _show_scene(compiled.plan, explain)
    for guard in compiled.guards:
        click.echo(f"guard        {guard.reason}, in {_short(guard.operation)}")
    click.echo(
        f"self-check   worst CIEDE2000 {verdict.worst:.1e} at {verdict.points} points of the domain"
        + (f", {verdict.undefined} of them undefined in the model" if verdict.undefined else "")
    )
    for path, _ in files:
        click.echo(f"wrote        {path}")


def _require_white(
    fitted: tuple[float, ...], conditions: ViewingConditions | None, where: str
) -> None:
    """FitError where colours were fitted under another light than the profile is for."""
    from brdfc.colour.difference import D50
    from brdfc.source.errors import FitError

    white = conditions.white if conditions is not None else D50
    if max(abs(a - b) for a, b in zip(fitted, white, strict=True)) > 1e-3:
        shown = ", ".join(f"{v:.4g}" for v in fitted)
        raise FitError(
            f"the colours were fitted under the white {shown}, and the profile is for another",
            where=where,
            hint="give brdfc fit and brdfc compile the same --illuminant or --white",
        )


def _scene(path: str | None, tolerance: float | None) -> Scene | None:
    from dataclasses import replace

    from brdfc.scenes.scene import checked_tolerance, read_scene

    if path is None:
        if tolerance is not None:
            raise click.UsageError("--tolerance is a scene's: give --scene, or --max-error")
        return None
    scene = read_scene(path)
    if tolerance is None:
        return scene
    return replace(scene, tolerance=checked_tolerance(tolerance, "--tolerance"))


def _show_scene(plan: Plan, explain: bool) -> None:
    found, lean = plan.at.narrowed.measured, plan.fitted.lean
    if found is not None:
        click.echo(f"image        {found.pixels:,} pixels")
        rows = zip(found.names, found.ends, found.percentiles, found.ranges, strict=True)
        for name, ends, middle, kept_to in rows:
            kept = f", kept to {kept_to[0]:.6g}..{kept_to[1]:.6g}" if kept_to != ends else ""
            click.echo(
                f"             {name}: {ends[0]:.6g}..{ends[1]:.6g} (percentiles 1 and 99: "
                f"{middle[0]:.6g}..{middle[1]:.6g}){kept}"
            )
        for name in found.stretched if plan.at.scene.share == 0 else ():
            click.echo(
                f"note: few pixels stretch the range of '{name}'; a share of pixels that may be "
                "off (share = 0.001) would leave them out",
                err=True,
            )
        if found.outside:
            click.echo(f"             {found.outside:,} pixels lie outside what is kept to")
    click.echo(
        f"scene        CIEDE2000 within {plan.at.scene.tolerance:g} for {plan.at.scene.output}"
    )
    for line in plan.ledger():
        click.echo(f"left out     {line}")
    if lean.omissions:
        click.echo(f"together     {plan.said(lean.bound)}")
    for k in lean.kept[: None if explain else _KEPT]:
        click.echo(f"kept         {k.words}: {k.why}; would save {k.saved:.0f} ns")


_KEPT = 3
"""Lines on what was kept for want of a proof; --explain shows all."""


def _show_form(compiled: Compiled, explain: bool) -> None:
    from brdfc.judge.cache import steps_text

    form = compiled.form
    assert form is not None
    last = form.derivation[-1].measured
    click.echo(f"form         {steps_text(form.derivation)}")
    click.echo(
        f"             worst {last.bits:.1f} bits, CIEDE2000 {last.de:.1e} at {form.points:,} "
        f"points; {compiled.goal}, of {form.forms} forms"
    )
    if not compiled.goal.accepts(last):
        click.echo("note: no form reaches that; this is the most accurate that was found", err=True)
    if explain:
        for step in form.derivation:
            if step.rule:
                click.echo(f"  {step.rule}: {step.before}  ->  {step.after}")
            m = step.measured
            click.echo(
                f"    {step.price:.0f} ns, worst {m.bits:.2f} bits (mean {m.mean_bits:.2f}), "
                f"CIEDE2000 {m.de:.1e}"
            )


def _short(text: str, most: int = 60) -> str:
    return text if len(text) <= most else text[: most - 3] + "..."
