from __future__ import annotations

import click

from brdfc.cli.options import pairs


@click.command("compile")
@click.argument("model")
@click.option("-o", "output", required=True, metavar="FILE", help="The MVIS profile to write.")
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
@click.option("--asm", metavar="FILE", help="Write the calculator text too.")
def command(
    model: str,
    output: str,
    mid: str | None,
    fixed: tuple[str, ...],
    channels: tuple[str, ...],
    asm: str | None,
) -> None:
    """Compile MODEL, a .brdf file or a library model, to a MID and an MVIS profile.

    The program is checked against the model in high precision over its whole domain before
    anything is written.

    \b
    Example:
      brdfc compile ward -o ward_mvis.icc
      brdfc compile ward -o baked_mvis.icc --set incident=40deg --set reflection=10deg
      brdfc compile ward -o curved_mvis.icc --channel incident --channel reflection
    """
    from brdfc.calc.price import operations, price
    from brdfc.compiler import compile_model
    from brdfc.files import write_whole
    from brdfc.lang.load import load

    compiled = compile_model(load(model), pairs(fixed, "--set"), channels)
    mid_path, mvis_path = compiled.save(output, mid)
    if asm:
        write_whole(asm, compiled.text.encode())
    verdict, program = compiled.verdict, compiled.program
    click.echo(f"channels     {' '.join(compiled.roles.channel_names)}")
    names = [f"{q.name} ({q.signature})" for q in compiled.roles.variables]
    click.echo(f"variables    {', '.join(names) or 'none'}")
    click.echo(
        f"program      {operations(program)} operators, about {price(program):.0f} ns "
        f"a pixel on the reference engine; stack {verdict.facts.stack}, "
        f"temporaries {verdict.facts.temporaries}"
    )
    for guard in compiled.formula.guards:
        click.echo(f"guard        {guard.reason}, in {_short(guard.operation)}")
    click.echo(
        f"self-check   worst CIEDE2000 {verdict.worst:.1e} at {verdict.points} points of the domain"
        + (f", {verdict.undefined} of them undefined in the model" if verdict.undefined else "")
    )
    for path in (mid_path, mvis_path, *([asm] if asm else [])):
        click.echo(f"wrote        {path}")


def _short(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "..."
