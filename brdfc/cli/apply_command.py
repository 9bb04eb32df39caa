from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from brdfc.cli.colour_options import names_a_file, rendered, rendering_options
from brdfc.cli.image_options import choices, image_options
from brdfc.cli.options import (
    engine_option,
    environment_option,
    extrapolate_option,
    geometry_option,
    image_progress,
    interpolation_option,
    pairs,
    warn_of_defaults,
    warn_of_display,
)
from brdfc.cli.search_options import end_progress, shown_progress
from brdfc.cli.stopping import stop_when_told
from brdfc.cli.sweep_options import swept

if TYPE_CHECKING:
    from brdfc.cmm.rendering import Rendering
    from brdfc.compiled import Compiled


@click.command("apply")
@click.argument("files", nargs=-1, required=True, metavar="PROFILE...|MODEL IMAGE")
@click.option("-o", "output", required=True, metavar="OUT.tif", help="The image to write.")
@environment_option
@extrapolate_option
@rendering_options
@click.option(
    "--scene", metavar="FILE", help="With a model: its light, tolerance and ranges (scene.toml)."
)
@click.option(
    "--tolerance",
    type=float,
    metavar="dE",
    help="With a model: CIEDE2000 that the colours may be off. Default: the scene's, or 0.01.",
)
@geometry_option
@engine_option
@interpolation_option
@image_options
def command(
    files: tuple[str, ...],
    output: str,
    environment: tuple[str, ...],
    scene: str | None,
    tolerance: float | None,
    geometry: str | None,
    scale: tuple[str, ...],
    samples: str | None,
    compression: str,
    tile: int | None,
    memory: str | None,
    threads: int | None,
    engine: str,
    resume: bool,
    scheduler: str | None,
    **how: Any,
) -> None:
    """Evaluate IMAGE, a TIFF of coefficients, through a MID and an MVIS, through profiles of device
    values, or through a model compiled for exactly this image.

    Its samples are the channels in the order `brdfc compile` prints them: floats, or integers with
    a --scale. The output is a TIFF: float32 X, Y, Z, with Y = 1 for white, unless --to and
    --samples say otherwise. Images of any size are read, computed and written in parts.

    A variable with several values, `a=1,2` or `a=-60deg..60deg:5deg`, makes a sweep: a page for
    each.

    Any number of profiles make a chain. Where the last is of a display or a printer, or --to names
    one, its device values come out, 0 to 1, and the profile is embedded.

    \b
    Example:
      brdfc apply ward_mid.icc ward_mvis.icc coefficients.tif -o xyz.tif \\
            --env incident=40deg --env reflection=10deg
      brdfc apply ward_mid.icc ward_mvis.icc coefficients.tif -o picture.tif --to sRGB
      brdfc apply ward_mid.icc ward_mvis.icc coefficients.tif -o under_a.tif --adapt A
      brdfc apply ward_mid.icc ward_mvis.icc coefficients.tif -o proof.tif --to press.icc \\
            --samples uint16 --intent relative
      brdfc apply ward coefficients.tif -o xyz.tif --env incident=40deg --env reflection=10deg
      brdfc apply ward_mid.icc ward_mvis.icc scan.tif -o lobe.tif --scale 0..1 --samples uint16 \\
            --env incident=40deg --env reflection=-60deg..60deg:5deg --resume
    """
    from brdfc.checker import is_profile
    from brdfc.files import refuse_same
    from brdfc.icc.profile import Profile
    from brdfc.images.apply import apply_to_tiff

    *profiles, image = files
    if not profiles:
        raise click.UsageError("give the profiles first, then the image")
    refuse_same([output], [*files, how["to"] if names_a_file(how["to"] or "") else None])
    stop_when_told()
    pages = swept(environment)
    if resume and len(pages) == 1:
        raise click.UsageError("--resume is for sweeps: variables with several values")
    if len(profiles) == 1 and not is_profile(profiles[0]):
        if how["extrapolate"]:
            raise click.UsageError("--extrapolate is for profiles: a model is compiled for the run")
        if len(pages) > 1:
            raise click.UsageError("a sweep is for profiles: a model is compiled for one run")
        saved = _Compiled(profiles[0], image, environment, scene, tolerance, geometry, how["to"])
        loaded = [saved.compiled.mid, saved.compiled.mvis]
    else:
        if scene is not None or tolerance is not None or geometry is not None:
            raise click.UsageError("--scene, --tolerance and --geometry are a model's")
        saved = None
        loaded = [Profile.load(path) for path in profiles]
    renderings = [rendered(loaded, page, **how, engine=engine) for page in pages]
    chosen = renderings[0]
    warn_of_defaults(chosen.link)
    warn_of_display(chosen)
    wanted = choices(
        chosen.link, scale, samples, compression, tile, memory, threads, resume, scheduler
    )
    applied = apply_to_tiff(renderings, image, output, "", image_progress(), wanted)
    for name, count in applied.outside.items():
        said = (
            "the profile was compiled for; their colours may be farther off"
            if chosen.link.samples
            else "the model declares; their colours mean nothing"
        )
        click.echo(f"note: {count:,} samples of '{name}' lie outside the range {said}", err=True)
    if applied.clipped:
        click.echo(
            f"note: {applied.clipped:,} pixels lie outside what {_held(chosen)}; each component is "
            "clipped to it",
            err=True,
        )
    click.echo(f"{applied.pixels:,} pixels" + (f" of {len(pages)} pages" if pages[1:] else ""))
    if saved is not None:
        saved.report(image)
    click.echo(f"wrote {output}")


def _held(chosen: Rendering) -> str:
    from brdfc.cmm.rendering import Target

    return "sRGB can show" if chosen.to is Target.SRGB else "the integers stand for"


class _Compiled:
    """A model compiled for an image, and what is said of it."""

    def __init__(
        self,
        name: str,
        image: str,
        environment: tuple[str, ...],
        scene: str | None,
        tolerance: float | None,
        geometry: str | None,
        to: str | None,
    ) -> None:
        from dataclasses import replace

        from brdfc.imagescene import compile_for_image
        from brdfc.lang.load import load
        from brdfc.scenes.scene import Scene, checked_tolerance, read_scene

        given = read_scene(scene) if scene is not None else Scene("--env")
        if tolerance is not None:
            given = replace(given, tolerance=checked_tolerance(tolerance, "--tolerance"))
        given = replace(given, output="sRGB" if (to or "").lower() == "srgb" else "XYZ")
        self.model = load(name, geometry or given.geometry)
        self.compiled, self.took = compile_for_image(
            self.model, image, pairs(environment, "--env"), given, shown_progress
        )
        end_progress()

    def report(self, image: str) -> None:
        """What was left out, and the time that saved."""
        from brdfc.compiler import compile_model
        from brdfc.imagescene import time_saved

        compiled = self.compiled
        assert compiled.plan is not None
        for line in compiled.plan.ledger():
            click.echo(f"left out     {line}")
        at = compiled.plan.at
        general: Compiled = compile_model(
            self.model,
            channels=at.narrowed.pixel,
            conditions=at.scene.conditions,
            highlight=at.scene.highlight,
        )
        found = time_saved(compiled, general, image, self.took)
        click.echo(
            f"{compiled.price:.0f} ns a pixel on the reference engine by the price table, and "
            f"{general.price:.0f} with the general profile"
        )
        saved = found.general - found.scene
        told = f"{saved:.3g} s saved" if saved > 0 else "nothing saved"
        click.echo(
            f"{found.scene:.3g} s here, {found.general:.3g} with the general profile: {told}, for "
            f"{found.compiling:.2g} s of compiling"
        )
