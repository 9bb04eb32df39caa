from __future__ import annotations

import click


@click.command("xml")
@click.argument("profile")
@click.option("-o", "output", metavar="FILE", help="Where to; default: print it.")
def command(profile: str, output: str | None) -> None:
    """Write PROFILE as XML, in the form of the ICC's own tools, with names for channels and
    temporaries. `brdfc compile FILE.xml` gives the profile back.

    \b
    Example:
      brdfc xml ward_mvis.icc -o ward_mvis.xml
    """
    from brdfc.files import refuse_same, write_whole
    from brdfc.icc.profile import Profile
    from brdfc.xml.profile import to_xml

    refuse_same([output], [profile])
    text = to_xml(Profile.load(profile))
    if output is None:
        click.echo(text, nl=False)
        return
    write_whole(output, text.encode())
    click.echo(f"wrote        {output}")
