"""`brdfc compile` of an XML file: the profile that it describes."""

from __future__ import annotations

import click
from click.core import ParameterSource


def compile_xml(path: str, output: str) -> None:
    """Write a document's profile, its programs proven safe; what else is wrong with it is said."""
    from brdfc.files import refuse_same, write_whole
    from brdfc.icc.validate import validate
    from brdfc.inspection import prove
    from brdfc.xml.profile import encoded, load_xml

    _refuse_options()
    refuse_same([output], [path])
    profile = load_xml(path)
    prove(profile, path)
    data = encoded(profile)
    write_whole(output, data)
    for finding in validate(profile):
        click.echo(str(finding), err=True)
    click.echo(f"wrote        {output}, {len(data):,} bytes")


def _refuse_options() -> None:
    """An XML file says all; options for models mean nothing to it."""
    context = click.get_current_context()
    for option in context.command.params:
        given = context.get_parameter_source(option.name or "") is ParameterSource.COMMANDLINE
        if given and option.name not in ("model", "output"):
            raise click.UsageError(
                f"{option.opts[0]} is for models; an XML file is compiled as it is"
            )
