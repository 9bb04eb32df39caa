from __future__ import annotations

import sys
from functools import partial

import click


@click.command("check")
@click.argument("target", metavar="MODEL|PROFILE")
@click.option(
    "--scene", metavar="FILE", help="Whether a profile (the MVIS) serves a scene (scene.toml)."
)
def command(target: str, scene: str | None) -> None:
    """Verify everything that can be verified about a model or a profile, one line each.

    Of a profile, as a file or in XML: its structure, the rules of its class, that its calculators
    are safe to run, where they lean on what releases of the reference engine do differently (within
    the ranges that the profile states), and the reference engine's own verdict.

    Lines begin with ok, warning, error, or open (not checked). The exit status is 1 if there is
    an error; warnings do not count.

    \b
    Example:
      brdfc check ward
      brdfc check ward_mvis.icc
      brdfc check inks.xml
      brdfc check ward_mvis.icc --scene scene.toml
    """
    from brdfc.checker import ERROR, check, is_profile

    found = check
    if scene is not None:
        from brdfc.scenecheck import check_scene

        if not is_profile(target):
            raise click.UsageError("--scene takes a profile; compile the model for the scene first")
        found = partial(check_scene, scene_path=scene)
    failed = False
    for finding in found(target):
        failed |= finding.status == ERROR
        line = f"{finding.status:<8} {finding.message}"
        click.echo("".join(c if c.isprintable() else "?" for c in line))
    if failed:
        sys.exit(1)
