from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import click

from brdfc.cli.options import geometry_option

if TYPE_CHECKING:
    from brdfc.lang.model import Breach, Definition, Model

_WIDTH = 96


@click.command("models")
@click.argument("name", required=False)
@geometry_option
def command(name: str | None, geometry: str | None) -> None:
    """List the model library; with NAME the formula, parameters, ranges and citation.

    NAME may also be the path of a .brdf file.

    \b
    Example:
      brdfc models
      brdfc models ward
    """
    from brdfc.lang.load import library, load, load_file

    if name is None:
        for entry_name, entry in library().items():
            click.echo(f"{entry_name:<30} {entry.kind:<8} {entry.title}")
        return
    from brdfc.lang.model import Model

    found = load_file(name, geometry)
    click.echo(f"{found.name}: {found.title}\n")
    for citation in found.citations:
        click.echo(textwrap.fill(citation, _WIDTH, subsequent_indent="  "))
    if isinstance(found, Model):
        # Breaches are stated in all directions, which the geometry of this model may not have.
        everywhere = load(name, "full") if found.geometry else found
        _show_model(found, everywhere.breaches)
    else:
        _show_definitions(found.definitions)
    for note in found.notes:
        click.echo(textwrap.fill(f"- {note}", _WIDTH, subsequent_indent="  "))


def _show_model(model: Model, breaches: tuple[Breach, ...]) -> None:
    from brdfc.profiles.metadata import range_text, value_text
    from brdfc.symbolic.typeset import typeset

    _show_definitions(model.definitions)
    click.echo("\nradiance =\n" + textwrap.indent(typeset(model.radiance.body, _WIDTH), "    "))
    click.echo()
    named = [q.name + (f" ({q.signature})" if q.signature else "") for q in model.quantities]
    width = max(map(len, named), default=0)
    for q, called in zip(model.quantities, named, strict=True):
        ends = range_text(q.low, q.high, q.type)
        click.echo(
            f"{q.role.value:<9} {called:<{width}} {q.type.name:<12} {ends:<16} "
            f"default {value_text(q.default, q.type):<8} {q.description}"
        )
    if model.geometry:
        click.echo(f"\ngeometry: {model.geometry} (brdfc models {model.geometry})")
    if model.laws:
        click.echo(f"\nlaws claimed: {', '.join(map(str, model.laws))}")
    for breach in breaches:
        click.echo(f"law broken: {breach.law}, but {breach.figure:g}: {breach.note}")
    click.echo(f"examples: {len(model.examples)}\n")


def _show_definitions(definitions: tuple[Definition, ...]) -> None:
    from brdfc.symbolic.typeset import typeset

    for d in definitions:
        arguments = "" if d.parameters is None else f"({', '.join(p.name for p in d.parameters)})"
        about = f"   {d.description}" if d.description else ""
        click.echo(f"\n{d.name}{arguments} ={about}")
        click.echo(textwrap.indent(typeset(d.body, _WIDTH), "    "))
