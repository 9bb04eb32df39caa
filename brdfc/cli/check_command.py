from __future__ import annotations

import sys

import click


@click.command("check")
@click.argument("target", metavar="MODEL|PROFILE")
def command(target: str) -> None:
    """Verify everything that can be verified about a model or a profile, one line each.

    Lines begin with ok, warning, error, or open (not checked). The exit status is 1 if there is
    an error.

    \b
    Example:
      brdfc check ward
      brdfc check ward_mvis.icc
    """
    from brdfc.checker import ERROR, check

    failed = False
    for finding in check(target):
        failed |= finding.status == ERROR
        click.echo(f"{finding.status:<8} {finding.message}")
    if failed:
        sys.exit(1)
