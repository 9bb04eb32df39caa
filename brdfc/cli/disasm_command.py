from __future__ import annotations

import click


@click.command("disasm")
@click.argument("profile")
def command(profile: str) -> None:
    """Print the calculator text of each calculator element of PROFILE.

    The text can be given back to any assembler of the ICC's calculator language; lines that begin
    with ; are comments.

    \b
    Example:
      brdfc disasm ward_mvis.icc
    """
    from brdfc.calc.listing import listing
    from brdfc.icc.profile import Profile
    from brdfc.icc.types import Pipeline

    found = False
    for signature, tag in Profile.load(profile).tags.items():
        if isinstance(tag, Pipeline):
            for index, element in enumerate(tag.elements):
                for text in listing(element, f"{signature}, element {index}"):
                    found = True
                    click.echo(text, nl=False)
    if not found:
        click.echo("; no calculator element in this profile")
