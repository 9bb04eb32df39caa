"""What a table of measurements covers, and how far it can be trusted: figures, in lines."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.fit.measurements import Array, Kind, Measurements

_DIGITS = 2
"""Decimals of a degree that directions are compared to."""
_FLOOR_ROWS = 5
"""Rows that share the smallest value, from which on it looks like an instrument's floor."""
_MOST_LISTED = 12


@dataclass(frozen=True)
class Reciprocity:
    """How well values agree where light and viewer are exchanged: pairs of directions measured both
    ways, and the relative difference from their mean, at the median and at worst. With an isotropic
    surface, light at incidence i seen at r is the same as light at r seen at i."""

    pairs: int
    median: float
    worst: float
    worst_at: tuple[float, float, float]
    """Both zeniths and the azimuth difference, degrees."""


def reciprocity(measurements: Measurements) -> Reciprocity | None:
    """None where no direction is measured both ways."""
    forward = _places(measurements)
    values = _means(measurements)
    kept = np.isfinite(values)
    distinct, row = np.unique(forward[kept], axis=0, return_inverse=True)
    row = row.ravel()
    means = np.bincount(row, values[kept]) / np.bincount(row)
    at = {tuple(place): mean for place, mean in zip(distinct.tolist(), means, strict=True)}
    found = [
        (abs(mean - at[r, i, a]) / max(abs(mean + at[r, i, a]) / 2, 1e-300), (i, r, a))
        for (i, r, a), mean in at.items()
        if i < r and (r, i, a) in at
    ]
    if not found:
        return None
    worst, place = max(found)
    return Reciprocity(len(found), float(np.median([d for d, _ in found])), float(worst), place)


def duplicates(measurements: Measurements) -> int:
    """Rows whose direction is that of an earlier row."""
    rounded = np.round(np.degrees(measurements.directions), _DIGITS)
    return len(rounded) - len(np.unique(rounded, axis=0))


def floor(measurements: Measurements) -> tuple[float, int] | None:
    """The smallest value and how many rows share it, where that looks like a floor."""
    values = _means(measurements)
    least = np.nanmin(values)
    rows = int((values == least).sum())
    return (float(least), rows) if rows >= _FLOOR_ROWS else None


def lines(measurements: Measurements) -> Iterator[str]:
    """The figures, a line each, for people."""
    m = measurements
    values = m.values[np.isfinite(m.values)]
    yield _line("name", m.name or "none")
    yield _line("values", f"{_components(m)}, BRDF in 1/sr")
    in_plane = int(m.in_plane.sum())
    yield _line("directions", f"{len(m):,}, {in_plane:,} of them in the plane of incidence")
    yield _line("incidences", _listed(m.incidences))
    zenith, azimuth = np.degrees(m.directions[:, 1]), np.degrees(m.azimuth_differences)
    yield _line("reflection", f"zeniths {_range(zenith)} degrees")
    yield _line("azimuth", f"{_range(azimuth)} degrees between light and viewer (mirror at 180)")
    yield _line("range", f"{_range(values)} 1/sr")
    positive = values[values > 0]
    if len(positive):
        decades = math.log10(float(positive.max()) / float(positive.min()))
        yield _line("dynamic", f"{decades:.1f} decades above 0")
    for count, what in (
        (int(np.isnan(m.values).sum()), "missing"),
        (int((values < 0).sum()), "negative"),
        (int((values == 0).sum()), "zero"),
        (duplicates(m), "duplicate directions"),
    ):
        if count:
            yield _line(what.split()[0], f"{count:,} {'values' if ' ' not in what else 'rows'}")
    if found := floor(m):
        yield _line("floor", f"{found[1]:,} rows have the smallest value {found[0]:.4g}")
    yield _line("reciprocity", _reciprocity_text(reciprocity(m)))
    yield from (_line("note", remark) for remark in m.remarks)


def _line(title: str, text: str) -> str:
    return f"{title:<12} {text}"


def _components(m: Measurements) -> str:
    if m.kind is Kind.XYZ and m.white:
        return f"XYZ under the white {', '.join(f'{v:.4g}' for v in m.white)}"
    if m.kind is Kind.RGB:
        return "RGB"
    if len(m.wavelengths) > 1:
        return f"{len(m.wavelengths)} wavelengths, {m.wavelengths[0]:g}..{m.wavelengths[-1]:g} nm"
    return f"one at {m.wavelengths[0]:g} nm" if m.wavelengths else "one, of no stated wavelength"


def _listed(radians: Array) -> str:
    degrees = [f"{v:.4g}" for v in np.degrees(radians)]
    if len(degrees) > _MOST_LISTED:
        return f"{len(degrees):,}, {degrees[0]}..{degrees[-1]} degrees"
    return f"{', '.join(degrees)} degrees"


def _range(values: NDArray[np.float64]) -> str:
    return f"{values.min() + 0.0:.4g}..{values.max() + 0.0:.4g}"


def _reciprocity_text(found: Reciprocity | None) -> str:
    if found is None:
        return "no direction is measured both ways"
    i, r, azimuth = found.worst_at
    return (
        f"{found.pairs:,} pairs measured both ways: {found.median:.1%} apart at the median, "
        f"{found.worst:.1%} at worst ({i:g} and {r:g}, azimuth {azimuth:g} degrees)"
    )


def _places(measurements: Measurements) -> Array:
    """(n, 3) degrees, rounded: zeniths, and the azimuth between, which means nothing at 0."""
    columns = (*measurements.directions[:, :2].T, measurements.azimuth_differences)
    places = np.round(np.degrees(np.stack(columns, axis=1)), _DIGITS) + 0.0
    places[(places[:, :2] == 0).any(axis=1), 2] = 0
    return np.asarray(places)


def _means(measurements: Measurements) -> Array:
    """The mean over the components there are, of each row."""
    return np.asarray(np.nanmean(measurements.values, axis=1))
