"""Measurements from photographs of a cylinder: exposures merged, columns averaged, BRDFs.

A camera whose values are linear gives a pixel a value in proportion to the radiance there and to
the exposure. Relative to a perfect diffuser that faces the light at the distance of the axis, whose
radiance is 1/pi of its irradiance,

    f = (value/white) (d/dL)^2 / cos(incidence) / pi

for white the value of that diffuser, d the distance from the light to the pixel's point, dL to the
axis. Vignetting, light from elsewhere and interreflection are not modelled.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from brdfc.fit.calibration import White, coloured, white_values
from brdfc.fit.cylinder import Pixels, Seen, Setup, seen
from brdfc.fit.exposures import Exposed, Region, averaged
from brdfc.fit.measurements import Measurements, checked
from brdfc.images.tiff import CoefficientImage, open_samples
from brdfc.source.errors import MeasurementError

Array = NDArray[np.float64]

KINDS = (np.uint16, np.float32)
"""Of samples: 8 bits are too few, and seldom linear."""
_COLUMNS = 128
"""That are worked on at once, all rows of them."""
_MOST_CLIPPED = 0.1
"""Of a column: where more is clipped, what is left is darker than the surface."""
_SPREAD = math.radians(0.5)
"""By which directions may change within the rows before it is said."""


@dataclass(frozen=True)
class Photograph:
    """exposure: seconds, or in any other unit that all share; light_angle: radians."""

    path: str | Path
    light_angle: float
    exposure: float = 1.0


@dataclass(frozen=True)
class Session:
    """What all photographs share. setup: its light_angle is each photograph's. rows: first and last
    (not included), None for all. matrix: see calibration.coloured. dark and clip: see
    exposures.Exposed. limit: the zenith, radians, beyond which nothing is taken."""

    setup: Setup
    pixels: Pixels
    white: White
    rows: tuple[int, int] | None = None
    matrix: Array | None = field(default=None, compare=False)
    dark: float = 0.0
    clip: float = 0.98
    limit: float = math.radians(85)


@dataclass
class Counts:
    """Pixels clipped in all exposures, or taken for dust; columns left out for the first; radians
    by which zeniths change from the rows' middle to their ends."""

    clipped: int = 0
    dust: int = 0
    columns: int = 0
    spread: float = 0.0


def measure(photographs: Sequence[Photograph], session: Session, name: str = "") -> Measurements:
    """One table of what photographs of a cylinder say, a row a column of each light angle.

    Photographs of one light angle are exposures of one scene, and merged. Over the rows of a
    column, pixels far from the median are left out, and the mean of the others is taken.

    Raises MeasurementError where nothing is left, or what is given does not fit; ImageError for
    files that are no TIFF images of KINDS.
    """
    for photograph in photographs:
        if not (math.isfinite(photograph.exposure) and photograph.exposure > 0):
            message = f"an exposure of {photograph.exposure:g}; it has to be above 0"
            raise MeasurementError(message, where=str(photograph.path))
    counts = Counts()
    tables: list[tuple[Array, Array]] = []
    whites: list[Array] = []
    shape: tuple[int, int, int] | None = None
    for angle in dict.fromkeys(p.light_angle for p in photographs):
        lit = replace(session, setup=replace(session.setup, light_angle=angle))
        group = [p for p in photographs if p.light_angle == angle]
        with ExitStack() as stack:
            images = [stack.enter_context(open_samples(p.path, KINDS)) for p in group]
            for image, photograph in zip(images, group, strict=True):
                shape = _same_shape(image, shape, str(photograph.path))
            exposed = Exposed(images, [p.exposure for p in group], lit.dark, lit.clip)
            whites += _white(exposed, lit)
            tables += _columns(exposed, lit, counts)
    if not tables:
        raise MeasurementError(
            "no column is lit, seen and not clipped",
            hint="check the cylinder's edges, the light's angle and the exposure",
        )
    directions, values = (np.concatenate(part) for part in zip(*tables, strict=True))
    white = white_values(session.white, whites, values.shape[1])
    kind, values, white_xyz = coloured(values, white, session.matrix)
    return checked(
        directions,
        values / math.pi,
        kind,
        white=white_xyz,
        name=name,
        remarks=list(_remarks(counts, len(directions), len(photographs))),
        where=name or str(photographs[0].path),
    )


def _same_shape(
    image: CoefficientImage, shape: tuple[int, int, int] | None, where: str
) -> tuple[int, int, int]:
    """The image's height, width and channels, once they are those of the others."""
    found = (image.height, image.width, image.channels)
    if image.channels not in (1, 3):
        message = f"{image.channels} samples a pixel; 1 or 3 are needed"
        raise MeasurementError(message, where=where)
    if found != (shape or found):
        message = f"rows, columns and samples are {found}, those of the others {shape}"
        raise MeasurementError(message, where=where)
    return found


def _columns(exposed: Exposed, lit: Session, counts: Counts) -> Iterator[tuple[Array, Array]]:
    """(directions (n, 4), values (n, channels)) of columns; values over irradiance."""
    height, width = exposed.images[0].height, exposed.images[0].width
    top, bottom = lit.rows or (0, height)
    if not 0 <= top < bottom <= height:
        raise MeasurementError(f"rows {top},{bottom} are not within the image's {height}")
    ends = np.array([[(top + bottom) / 2], [top], [bottom]], dtype=np.float64)
    for left in range(0, width, _COLUMNS):
        region = Region(left, top, min(left + _COLUMNS, width), bottom)
        along = seen(lit.setup, lit.pixels, region.places[0], ends)
        kept = _within(along, lit.limit)[0]
        if not kept.any():
            continue
        directions = along.directions[:, kept]
        change = np.abs(directions[1:, :, :2] - directions[0, :, :2])
        counts.spread = max(counts.spread, float(np.nanmax(change)))
        values, clipped = _over_irradiance(exposed, lit, region)
        mean, dust = averaged(values[:, kept])
        clear = clipped[:, kept].mean(axis=0) <= _MOST_CLIPPED
        counts.clipped += int(clipped[:, kept].sum())
        counts.columns += int((~clear).sum())
        counts.dust += dust
        usable = clear & np.isfinite(mean).all(axis=1)
        if usable.any():
            yield directions[0, usable], mean[usable]


def _within(at: Seen, limit: float) -> NDArray[np.bool_]:
    """What is lit and seen at zeniths up to a limit; NaN is not."""
    return np.asarray((at.directions[..., :2] <= limit).all(axis=-1))


def _over_irradiance(
    exposed: Exposed, lit: Session, region: Region
) -> tuple[Array, NDArray[np.bool_]]:
    """Exposed.values over the irradiance of each pixel's point, 1 where it faces the light at the
    axis; NaN in the shadow."""
    values, clipped = exposed.values(region)
    light = seen(lit.setup, lit.pixels, *region.places).irradiance * lit.setup.light_distance**2
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(values / np.where(light > 0, light, np.nan)[..., None]), clipped


def _white(exposed: Exposed, lit: Session) -> Iterator[Array]:
    """The median (channels,) over irradiance of the white region, where it is lit, not clipped."""
    region = lit.white.region
    if region is None:
        return
    image = exposed.images[0]
    inside = 0 <= region.left < region.right <= image.width
    if not (inside and 0 <= region.top < region.bottom <= image.height):
        message = f"the white region is not within the image's {image.width} x {image.height}"
        raise MeasurementError(message, hint="it is LEFT,TOP,RIGHT,BOTTOM in pixels")
    columns, rows = region.places
    if _within(seen(lit.setup, lit.pixels, columns, rows), lit.limit).all():
        values, clipped = _over_irradiance(exposed, lit, region)
        if clipped.mean() <= _MOST_CLIPPED:
            yield np.nanmedian(values, axis=(0, 1))


def _remarks(counts: Counts, columns: int, photographs: int) -> Iterator[str]:
    yield f"{columns:,} columns of {photographs} photographs of a cylinder"
    if counts.clipped:
        yield f"{counts.clipped:,} pixels are clipped in all exposures: left out"
    if counts.columns:
        yield f"{counts.columns:,} columns have too many of them: left out"
    if counts.dust:
        yield f"{counts.dust:,} pixels are far from their column's median: left out"
    if counts.spread > _SPREAD:
        degrees = math.degrees(counts.spread)
        yield f"angles change by {degrees:.1f} degrees within the rows; take fewer: --rows"
