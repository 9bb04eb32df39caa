from __future__ import annotations

import click

from brdfc.cli.options import geometry_option, pairs


@click.command("export")
@click.argument("model")
@click.option("--fpcore", is_flag=True, help="As FPCore 1.2, the format of FPBench.")
@click.option("-o", "output", metavar="FILE", help="Where to write it; default: print it.")
@click.option(
    "--set",
    "fixed",
    multiple=True,
    metavar="NAME=VALUE",
    help="Fix a quantity first: m=0.2, incident=40deg. Repeatable.",
)
@geometry_option
def command(
    model: str, fpcore: bool, output: str | None, fixed: tuple[str, ...], geometry: str | None
) -> None:
    """Write the formula of MODEL, a .brdf file or a library model, for other tools.

    FPCore is what Herbie, FPTaylor, Daisy and others read that judge or improve the accuracy of
    formulas: one function a component, with the declared ranges, angles in radians.

    \b
    Example:
      brdfc export ward --fpcore
      brdfc export ward --fpcore --set incident=40deg -o ward.fpcore
    """
    if not fpcore:
        raise click.UsageError("say in what format: --fpcore")
    from brdfc.files import write_whole
    from brdfc.forms.fpcore import to_fpcore
    from brdfc.lang.load import load
    from brdfc.roles import assign_roles
    from brdfc.symbolic.formula import formula

    loaded = load(model, geometry)
    roles = assign_roles(loaded, pairs(fixed, "--set"), ())
    ready = formula(loaded, roles.constants)
    text = to_fpcore([ready.exact], loaded.name, ready.domain, loaded.quantities, loaded.citations)
    if output is None:
        click.echo(text, nl=False)
    else:
        write_whole(output, text.encode())
        click.echo(f"wrote        {output}")
