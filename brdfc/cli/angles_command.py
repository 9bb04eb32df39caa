from __future__ import annotations

import math

import click

from brdfc.cli.options import image_progress


@click.command("angles")
@click.option("--normals", required=True, metavar="N.tif", help="Normals: x, y, z a pixel.")
@click.option("--light", required=True, metavar="X,Y,Z", help="Where the light is.")
@click.option("--camera", required=True, metavar="X,Y,Z", help="Where the camera is.")
@click.option("-o", "output", required=True, metavar="ANGLES.tif", help="The image to write.")
@click.option(
    "--geometry",
    type=click.Choice(["full", "plane"]),
    default="full",
    help="Two zeniths and two azimuths (full, default), or two signed angles (plane), where light, "
    "camera and all normals lie in one plane along x.",
)
@click.option("--distant", is_flag=True, help="Light and camera are directions, far away.")
@click.option(
    "--width",
    type=float,
    default=2.0,
    metavar="W",
    help="Of the image, in the unit of light and camera. Default: 2, from -1 to 1.",
)
@click.option("--heights", metavar="Z.tif", help="Height of every pixel, float32, in that unit.")
@click.option(
    "--coefficients",
    metavar="C.tif",
    help="Samples to put before the angles: the whole image that a profile takes.",
)
def command(
    normals: str,
    light: str,
    camera: str,
    output: str,
    geometry: str,
    distant: bool,
    width: float,
    heights: str | None,
    coefficients: str | None,
) -> None:
    """Compute the angles of every pixel from normals, a light and a camera.

    The surface is seen along -z: x to the right, y up, the middle of the image at 0,0,0. NORMALS is
    a TIFF of float32 vectors, or a normal map of 8 or 16 bits. The angles are float32 samples in
    radians, in the order that `brdfc compile --channel` has them in.

    \b
    Example:
      brdfc angles --normals n.tif --light 2,1,3 --camera 0,0,5 --coefficients c.tif -o c_and_a.tif
      brdfc compile ward -o w_mvis.icc --geometry full --channel incident --channel reflection \\
            --channel incident_azimuth --channel reflection_azimuth
      brdfc apply w_mid.icc w_mvis.icc c_and_a.tif -o picture.tif --to sRGB
    """
    from brdfc.images.angles import angles_to_tiff
    from brdfc.images.directions import NAMES, Arrangement

    if not (math.isfinite(width) and width > 0):
        raise click.UsageError(f"--width takes a number above 0, not {width:g}")
    light_at = _vector(light, "--light", distant)
    scene = Arrangement(light_at, _vector(camera, "--camera", distant), geometry, distant, width)
    faced = angles_to_tiff(normals, output, scene, heights, coefficients, image_progress())
    for count, what in ((faced.from_light, "light"), (faced.from_camera, "camera")):
        if count:
            click.echo(f"note: {count:,} pixels face away from the {what}: 90 degrees", err=True)
    if faced.touched:
        click.echo(
            f"note: the light or the camera is at {faced.touched:,} pixels of the surface: no "
            "direction leads there",
            err=True,
        )
    if faced.leaves_plane > math.radians(0.1):
        away = math.degrees(faced.leaves_plane)
        click.echo(
            f"note: directions leave the plane by up to {away:.1f} degrees; --geometry full keeps "
            "them",
            err=True,
        )
    first = "coefficients, " if coefficients else ""
    click.echo(f"samples      {first}{', '.join(NAMES[geometry])}")
    click.echo(f"wrote        {output}")


def _vector(text: str, option: str, direction: bool) -> tuple[float, float, float]:
    try:
        x, y, z = (float(word) for word in text.split(","))
    except ValueError:
        raise click.UsageError(f"{option} takes X,Y,Z, three numbers, not '{text}'") from None
    if not all(map(math.isfinite, (x, y, z))):
        raise click.UsageError(f"{option} takes finite numbers, not '{text}'")
    if direction and x == y == z == 0:
        raise click.UsageError(f"{option} is a direction, and 0,0,0 is none")
    return x, y, z
