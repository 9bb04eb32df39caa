"""Measured reflectance as one table, whatever file or instrument it comes from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from brdfc.source.errors import MeasurementError, ValueGivenError

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
XYZ = tuple[float, float, float]

MOST_ROWS = 1_000_000
"""Directions of a table; a dense goniospectrophotometer's has tens of thousands."""
RIGHT = math.pi / 2
_SAME = math.radians(0.01)
"""Directions closer than this are one: goniometers are not set more exactly."""
_ROUNDED = 1e-9
"""Radians by which a right angle may be exceeded, by rounding."""
_GREATEST = 1e12
"""1/sr; no mirror that was measured comes near."""
_WAVELENGTHS = (100.0, 20000.0)
"""Nanometres."""


class Kind(Enum):
    """What the columns of values are."""

    SPECTRAL = "spectral"
    XYZ = "XYZ"
    RGB = "RGB"


@dataclass(frozen=True, eq=False)
class Measurements:
    """BRDF values in so many directions; made by checked.

    directions: (n, 4) float64, radians: incident zenith, reflection zenith, incident azimuth,
    reflection azimuth (the order of laws.reflectance.ANGLES). Zeniths are 0..pi/2, azimuths
    -pi..pi, from the same direction for both: the mirror side is where they differ by pi.
    values: (n, k) float64, BRDF in 1/sr: of k wavelengths, X, Y, Z or R, G, B; a perfect diffuser
    has the white over pi. NaN where a value is missing.
    wavelengths: nm; () for XYZ, for RGB, and for a single value of a wavelength nobody states.
    weights: (n,), 1 where none is given. white: X, Y, Z of the light, Y = 1, for XYZ. remarks: what
    was noticed on reading, a sentence each.
    """

    directions: Array
    values: Array
    kind: Kind
    wavelengths: tuple[float, ...]
    weights: Array
    white: XYZ | None
    name: str
    remarks: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.directions)

    @property
    def components(self) -> tuple[str, ...]:
        """The names of the columns of values: "450nm", "X", "R", or "value"."""
        if self.kind is not Kind.SPECTRAL:
            return tuple(self.kind.value)
        return tuple(f"{w:.10g}nm" for w in self.wavelengths) or ("value",)

    @property
    def azimuth_differences(self) -> Array:
        """(n,) radians, 0..pi: pi on the mirror side, 0 on the light's."""
        apart = np.abs(self.directions[:, 2] - self.directions[:, 3])
        return np.asarray(np.minimum(apart, 2 * math.pi - apart))

    @property
    def incidences(self) -> Array:
        """The distinct zeniths of incidence, radians, rising, rounded to 0.01 degrees."""
        return np.radians(np.unique(np.round(np.degrees(self.directions[:, 0]), 2)))

    @property
    def in_plane(self) -> Mask:
        """(n,): which directions of reflection lie in the plane of incidence."""
        apart = self.azimuth_differences
        level = np.minimum(apart, math.pi - apart) < _SAME
        return np.asarray(level | (self.directions[:, :2].min(axis=1) < _SAME))

    def selected(self, mask: Mask) -> Measurements:
        """The rows where the mask (n,) is set; MeasurementError where that is none."""
        if not mask.any():
            raise MeasurementError("no directions are left", where=self.name or None)
        rows = self.directions[mask], self.values[mask], self.weights[mask]
        return replace(self, directions=rows[0], values=rows[1], weights=rows[2])

    def remarked(self, *remarks: str) -> Measurements:
        """The same with more remarks."""
        return replace(self, remarks=self.remarks + remarks)


def checked(
    directions: Array,
    values: Array,
    kind: Kind,
    *,
    wavelengths: Sequence[float] = (),
    weights: Array | None = None,
    white: Sequence[float] | None = None,
    name: str = "",
    remarks: Sequence[str] = (),
    where: str = "",
    lines: Sequence[int] = (),
) -> Measurements:
    """Measurements, once what they hold is known to be what it should be: all readers end here.

    The arrays are as in Measurements, azimuths of any size. Rows beyond 90 degrees, and those
    without any value, are left out; those and negative values are remarked on. where and lines:
    the file and the line of each row, for messages.

    Raises MeasurementError for numbers of rows or columns that do not fit, angles that are no
    numbers, infinite values, weights below 0, wavelengths or a white that cannot be.
    """
    if not 0 < len(directions) <= MOST_ROWS:
        much = "no directions" if not len(directions) else f"{len(directions):,} are too many"
        raise MeasurementError(f"{much}; 1 to {MOST_ROWS:,} are read", where=where)
    columns = values.shape[1] if values.ndim == 2 else 0
    wanted = 3 if kind is not Kind.SPECTRAL else len(wavelengths) or 1
    if columns != wanted or len(directions) != len(values) or directions.shape[1:] != (4,):
        message = f"{values.shape} values for {directions.shape} directions and {wanted} components"
        raise MeasurementError(message, where=where)
    weighted = np.ones(len(values)) if weights is None else np.asarray(weights, dtype=np.float64)

    def refuse(wrong: NDArray[np.bool_] | np.bool_, message: str, hint: str | None = None) -> None:
        if np.any(wrong):
            row = int(np.argmax(wrong))
            place = f"{where}, line {lines[row]}" if len(lines) else f"{where}, row {row + 1}"
            raise MeasurementError(message, where=place, hint=hint)

    refuse(~np.isfinite(directions).all(axis=1), "an angle is missing, or no finite number")
    refuse(
        (np.abs(values) > _GREATEST).any(axis=1),
        f"a value that is infinite, or above {_GREATEST:g} 1/sr",
        "leave missing values empty, or nan",
    )
    refuse(~(np.isfinite(weighted) & (weighted >= 0)), "a weight is no number from 0 upwards")
    refuse((directions[:, :2] < 0).any(axis=1), "a zenith is below 0")
    order = _rising(wavelengths, where)
    zenith = directions[:, :2].max(axis=1)
    empty = np.isnan(values).all(axis=1)
    behind = zenith > RIGHT + _ROUNDED
    noticed = list(remarks)
    if behind.any():
        noticed.append(f"{behind.sum():,} rows are beyond 90 degrees, behind the surface: left out")
    if empty.any():
        noticed.append(f"{empty.sum():,} rows have no value: left out")
    kept = ~(behind | empty)
    if not kept.any():
        raise MeasurementError(
            "no row has a value and angles within 90 degrees",
            where=where,
            hint="check the unit of the angles, degrees or radians",
        )
    negative = int((values[kept] < 0).sum())
    if negative:
        noticed.append(f"{negative:,} values are negative: kept, as noise about 0 has them")
    cleared = np.array(directions[kept], dtype=np.float64)
    cleared[:, :2] = np.minimum(cleared[:, :2], RIGHT)
    turned = np.abs(cleared) > math.pi
    cleared[turned] = np.remainder(cleared[turned] + math.pi, 2 * math.pi) - math.pi
    return Measurements(
        directions=cleared,
        values=np.array(values[kept][:, order] if len(order) else values[kept], dtype=np.float64),
        kind=kind,
        wavelengths=tuple(float(wavelengths[i]) for i in order),
        weights=weighted[kept],
        white=_white(white, kind, where),
        name=name,
        remarks=tuple(noticed),
    )


def _rising(wavelengths: Sequence[float], where: str) -> list[int]:
    """The order in which wavelengths rise."""
    low, high = _WAVELENGTHS
    for wavelength in wavelengths:
        if not low <= wavelength <= high:
            message = f"a wavelength of {wavelength:g} nm; {low:g}..{high:g} are possible"
            raise MeasurementError(message, where=where)
    if len(set(wavelengths)) < len(wavelengths):
        raise MeasurementError("a wavelength is given twice", where=where)
    return sorted(range(len(wavelengths)), key=lambda i: wavelengths[i])


def _white(white: Sequence[float] | None, kind: Kind, where: str) -> XYZ | None:
    from brdfc.colour.conditions import normalised_white
    from brdfc.colour.difference import D50

    if kind is not Kind.XYZ:
        return None
    try:
        return D50 if white is None else normalised_white(white)
    except ValueGivenError as error:
        raise MeasurementError(error.message, where=where, hint=error.hint) from None
