"""The options of commands that read measurements: what a file leaves open."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import click

from brdfc.cli.options import pairs

if TYPE_CHECKING:
    from brdfc.fit.measurements import Measurements

_OPTIONS = (
    click.option("--format", "format_name", metavar="NAME", help="Default: seen from its content."),
    click.option("--unit", metavar="UNIT", help="Of the values: brdf, radiance-factor, ..."),
    click.option("--angles", metavar="degrees|radians", help="The unit of the angles."),
    click.option(
        "--mirror",
        metavar="+|-",
        help="Without azimuths: the sign of reflection angles on the mirror side. Default: +.",
    ),
    click.option("--data-white", metavar="X,Y,Z", help="The white that XYZ values are under."),
    click.option(
        "--wavelength", type=float, metavar="NM", help="Take this one; or that of single values."
    ),
    click.option("--floor", type=float, metavar="VALUE", help="Leave out what is below."),
    click.option(
        "--column",
        "columns",
        multiple=True,
        metavar="MEANING=NAME",
        help="Which column is which: incident=GEOM_I. Repeatable.",
    ),
    click.option(
        "--directions", metavar="plane|even", help="What to draw of a dense table (MERL)."
    ),
    click.option("--count", type=int, metavar="N", help="How many directions to draw."),
)


def measurement_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """What a file of measurements leaves open; see read."""
    for option in reversed(_OPTIONS):
        function = option(function)
    return function


def read(
    path: str,
    format_name: str | None,
    unit: str | None,
    angles: str | None,
    mirror: str | None,
    data_white: str | None,
    wavelength: float | None,
    floor: float | None,
    columns: Sequence[str],
    directions: str | None,
    count: int | None,
) -> Measurements:
    """The measurements of a file, as the options say."""
    from brdfc.cli.colour_options import three_numbers
    from brdfc.fit.formats import read_measurements

    return read_measurements(
        path,
        format_name,
        unit=unit,
        angles=angles,
        mirror=mirror,
        white=None if data_white is None else tuple(three_numbers(data_white, "--data-white")),
        wavelength=wavelength,
        floor=floor,
        columns=pairs(columns, "--column"),
        directions=directions,
        count=count,
    )
