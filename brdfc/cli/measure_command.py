from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from brdfc.cli.colour_options import light_options

if TYPE_CHECKING:
    from brdfc.fit.calibration import White
    from brdfc.fit.camera import Array
    from brdfc.fit.photographs import Photograph


@click.command("measure")
@click.argument("images", nargs=-1, required=True)
@click.option("--radius", type=float, required=True, help="Of the cylinder.")
@click.option("--camera-distance", type=float, required=True, help="From the cylinder's axis.")
@click.option("--light-distance", type=float, required=True, help="From the cylinder's axis.")
@click.option(
    "--light-angle",
    "light_angles",
    multiple=True,
    required=True,
    metavar="40deg",
    help="From the camera's direction, seen from the axis; positive is to the right. Once, or once "
    "an image.",
)
@click.option(
    "--exposure",
    "exposures",
    type=float,
    multiple=True,
    metavar="SECONDS",
    help="Once, or once an image; images of one light angle are merged. Default: 1.",
)
@click.option(
    "--edges",
    metavar="LEFT,RIGHT",
    help="Columns of the cylinder's outline, in pixels. Default: the image's own edges.",
)
@click.option("--rows", metavar="TOP,BOTTOM", help="The rows to take. Default: all.")
@click.option(
    "--level", type=float, metavar="ROW", help="At the camera's height. Default: the middle."
)
@click.option(
    "--white-values",
    metavar="R,G,B",
    help="The camera's values of a perfect diffuser that faces the light at the axis, of an "
    "exposure of 1, less dark.",
)
@click.option(
    "--white-region",
    metavar="LEFT,TOP,RIGHT,BOTTOM",
    help="Pixels of the cylinder that see a white standard.",
)
@click.option(
    "--white-reflectance", type=float, default=1.0, metavar="RHO", help="Of that standard."
)
@click.option(
    "--matrix",
    metavar="NINE NUMBERS|FILE",
    help="From the camera's R, G, B to X, Y, Z, row by row.",
)
@click.option(
    "--sensitivities",
    metavar="FILE.csv",
    help="The camera's: wavelength, R, G, B. The matrix is made from them for the light and the "
    "observer.",
)
@light_options
@click.option("--dark", type=float, default=0.0, metavar="VALUE", help="The value of no light.")
@click.option(
    "--clip", type=float, default=0.98, metavar="SHARE", help="Of the greatest value: too bright."
)
@click.option("--limit", default="85deg", metavar="ANGLE", help="The largest angles taken.")
@click.option("-o", "output", required=True, metavar="DATA.csv", help="The table to write.")
def command(
    images: Sequence[str],
    radius: float,
    camera_distance: float,
    light_distance: float,
    light_angles: Sequence[str],
    exposures: Sequence[float],
    edges: str | None,
    rows: str | None,
    level: float | None,
    white_values: str | None,
    white_region: str | None,
    white_reflectance: float,
    matrix: str | None,
    sensitivities: str | None,
    illuminant: str | None,
    white: str | None,
    observer: str | None,
    dark: float,
    clip: float,
    limit: str,
    output: str,
) -> None:
    """Take measurements from photographs of a sample wrapped round a cylinder.

    IMAGES are TIFF files of linear values, 16-bit integers or 32-bit floats, upright, the camera
    far in front of the cylinder's middle (docs/measuring.md has the geometry). Lengths are in one
    unit, whichever.

    \b
    Example:
      brdfc measure a.tif b.tif --radius 27 --camera-distance 1200 --light-distance 900 \\
            --light-angle 40deg --exposure 0.02 --exposure 0.2 --edges 410,3590 \\
            --white-region 700,200,900,400 --white-reflectance 0.97 \\
            --matrix matrix.txt -o print.csv
    """
    from brdfc.files import refuse_same, write_whole
    from brdfc.fit.cylinder import Setup, pixels_from_edges
    from brdfc.fit.photographs import KINDS, Session, measure
    from brdfc.fit.summary import lines
    from brdfc.fit.writing import csv_text
    from brdfc.images.tiff import open_samples

    refuse_same([output], [*images, matrix if matrix and "," not in matrix else None])
    photographs = _photographs(images, light_angles, exposures)
    setup = Setup(radius, camera_distance, light_distance, photographs[0].light_angle)
    with open_samples(images[0], KINDS) as first:
        height, width = first.height, first.width
    left, right = _numbers(edges, 2, "--edges") if edges else (0.0, float(width))
    pixels = pixels_from_edges(setup, left, right, height / 2 if level is None else level)
    taken = [int(v) for v in _numbers(rows, 2, "--rows")] if rows else None
    session = Session(
        setup,
        pixels,
        _white(white_values, white_region, white_reflectance),
        rows=(taken[0], taken[1]) if taken else None,
        matrix=_matrix(matrix, sensitivities, illuminant, white, observer),
        dark=dark,
        clip=clip,
        limit=_angle(limit, "--limit"),
    )
    name = output.replace("\\", "/").rpartition("/")[2].rpartition(".")[0]
    measurements = measure(photographs, session, name)
    write_whole(output, csv_text(measurements).encode())
    for line in lines(measurements):
        click.echo(line)
    click.echo(f"{'wrote':<12} {output}")


def _photographs(
    images: Sequence[str], light_angles: Sequence[str], exposures: Sequence[float]
) -> list[Photograph]:
    from brdfc.fit.photographs import Photograph

    angles = [_angle(text, "--light-angle") for text in light_angles]
    times = list(exposures or (1.0,))
    for option, given in (("--light-angle", len(angles)), ("--exposure", len(times))):
        if given not in (1, len(images)):
            raise click.UsageError(
                f"{option} is given {given} times, for {len(images)} images: once, or once for each"
            )
    angles = angles * (len(images) // len(angles))
    times = times * (len(images) // len(times))
    return [Photograph(*one) for one in zip(images, angles, times, strict=True)]


def _white(values: str | None, region: str | None, reflectance: float) -> White:
    from brdfc.fit.calibration import White
    from brdfc.fit.exposures import Region

    if (values is None) == (region is None):
        raise click.UsageError("give one of --white-values and --white-region")
    if not (math.isfinite(reflectance) and 0 < reflectance <= 1.5):
        raise click.UsageError("--white-reflectance takes a number above 0, and not far above 1")
    if values is not None:
        return White(tuple(_numbers(values, None, "--white-values")))
    left, top, right, bottom = (int(v) for v in _numbers(region or "", 4, "--white-region"))
    return White(region=Region(left, top, right, bottom), reflectance=reflectance)


def _matrix(
    matrix: str | None,
    sensitivities: str | None,
    illuminant: str | None,
    white: str | None,
    observer: str | None,
) -> Array | None:
    from brdfc.cli.colour_options import stated_viewing
    from brdfc.colour.conditions import viewing_conditions
    from brdfc.fit.camera import matrix_from_sensitivities, matrix_of

    conditions = stated_viewing(illuminant, white, observer, None, None, None)
    if sensitivities is None:
        if conditions is not None:
            raise click.UsageError("a light and an observer are for --sensitivities")
        return None if matrix is None else matrix_of(matrix)
    if matrix is not None:
        raise click.UsageError("give one of --matrix and --sensitivities")
    found, missed = matrix_from_sensitivities(sensitivities, conditions or viewing_conditions())
    click.echo(f"{'matrix':<12} {'; '.join(' '.join(f'{v:.4g}' for v in row) for row in found)}")
    click.echo(f"{'missed':<12} {missed:.1%} of the observer's functions")
    return found


def _angle(text: str, option: str) -> float:
    from brdfc.lang.types import TYPES
    from brdfc.lang.values import parse_value

    return parse_value(text, TYPES["angle"], option)[0]


def _numbers(text: str, count: int | None, option: str) -> list[float]:
    try:
        numbers = [float(word) for word in text.split(",")]
    except ValueError:
        numbers = []
    wrong = len(numbers) != count if count else len(numbers) not in (1, 3)
    if wrong or not all(map(math.isfinite, numbers)):
        how = f"{count} numbers" if count else "one number or three"
        raise click.UsageError(f"{option} takes {how} and commas, not '{text}'")
    return numbers
