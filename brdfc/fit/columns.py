"""From named columns of numbers to measurements: what a column means, and what follows."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from brdfc.fit.declared import Declared
from brdfc.fit.measurements import Kind, Measurements, checked
from brdfc.fit.tables import MOST_COLUMNS, Table
from brdfc.fit.units import ANGLES, MIRRORS, UNITS, chosen, to_brdf, to_radians
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import MeasurementError

Array = NDArray[np.float64]

ROLES: Mapping[str, str] = {
    "incident": r"incident|incidence|inci|theta_?i|theta_?in",
    "reflection": r"reflection|reflected|viewing|refl|theta_?[sro]|theta_?out",
    "incident_azimuth": r"incident_azimuth|iazi|phi_?i|phi_?in",
    "reflection_azimuth": r"reflection_azimuth|razi|phi_?[sro]|phi_?out",
    "weight": r"weight",
    "wavelength": r"wavelength|lambda",
    "value": r"value|brdf|bsdf",
    "X": r"(xyz_)?x",
    "Y": r"(xyz_)?y",
    "Z": r"(xyz_)?z",
    "R": r"(rgb_)?r",
    "G": r"(rgb_)?g",
    "B": r"(rgb_)?b",
}
"""What a column can mean, and the names that it has in files, whatever their case."""
_SPECTRAL = re.compile(r"(?:spectral_|spec_)?(?:nm)?_?(\d{3,5}(?:\.\d+)?)(?:_?nm)?", re.IGNORECASE)

_MOST_NUMBERS = 1 << 25
"""That rows of one wavelength each are gathered into."""


def role(name: str) -> str | float | None:
    """What a column of this name means: a name of ROLES, a wavelength in nm, or nothing."""
    for meaning, pattern in ROLES.items():
        if re.fullmatch(pattern, name, re.IGNORECASE):
            return meaning
    spectral = _SPECTRAL.fullmatch(name)
    return float(spectral[1]) if spectral else None


def measured(table: Table, said: Declared, name: str, remarks: Sequence[str] = ()) -> Measurements:
    """Measurements from a table whose columns have names that role knows, or that said.columns
    gives. said: with nothing left open, the unit has to be there.

    Zeniths may be signed: below 0 is the other side of the normal. Without azimuths they are angles
    in the plane of incidence, and light is at 0 azimuth. Rows that hold one wavelength each are
    gathered by direction.

    Raises MeasurementError.
    """
    where = table.where
    places = _places(table.names, said.columns, where)
    if "wavelength" in places:
        table = _gathered(table, places)
        places = _places(table.names, {}, where)
    kind, wavelengths, at = _components(places, said, where)
    table, below = _above(table, at, said.floor)
    unit = chosen(said.unit or "", UNITS, "unit of values", where)
    angle = chosen(said.angles or "degrees", ANGLES, "unit of angles", where)
    mirror = MIRRORS[chosen(said.mirror or "+", MIRRORS, "side of the mirror: + or -", where)]
    zeniths, suspicion = to_radians(
        np.stack([table.numbers[:, places[n]] for n in ("incident", "reflection")], axis=1),
        angle,
        where,
    )
    if "reflection_azimuth" in places and said.mirror:
        raise MeasurementError("a file with azimuths says itself where the mirror is", where=where)
    if "incident_azimuth" in places and "reflection_azimuth" not in places:
        raise MeasurementError("the light has an azimuth, and the viewer has none", where=where)
    azimuths = _azimuths(table, places, angle, mirror)
    return checked(
        # A negative zenith is the same direction as a positive one, half a turn away.
        np.hstack([np.abs(zeniths), azimuths + np.where(zeniths < 0, math.pi, 0.0)]),
        to_brdf(table.numbers[:, at], unit, zeniths[:, 0], zeniths[:, 1]),
        kind,
        wavelengths=wavelengths,
        weights=table.numbers[:, places["weight"]] if "weight" in places else None,
        white=said.white,
        name=name,
        remarks=[*remarks, *filter(None, (below, suspicion))],
        where=where,
        lines=table.lines,
    )


def _above(table: Table, at: Sequence[int], floor: float | None) -> tuple[Table, str]:
    """The rows that have a value above the floor, and a remark on the others."""
    if floor is None:
        return table, ""
    kept = ~(table.numbers[:, at] < floor).all(axis=1)
    if not kept.any():
        raise MeasurementError(f"no value is above the floor {floor:g}", where=table.where)
    lines = np.asarray(table.lines)[kept].tolist()
    remark = f"{(~kept).sum():,} rows are below the floor of {floor:g}: left out"
    return replace(table, numbers=table.numbers[kept], lines=lines), "" if kept.all() else remark


def _places(names: Sequence[str], given: Mapping[str, str], where: str) -> dict[str | float, int]:
    """The number of the column of each meaning."""
    places: dict[str | float, int] = {}
    for meaning, name in given.items():
        if meaning not in ROLES:
            hint = did_you_mean(meaning, ROLES) or ", ".join(ROLES)
            raise MeasurementError(f"no column means '{meaning}'", hint=hint)
        if name not in names:
            hint = did_you_mean(name, names) or ", ".join(names[:20])
            raise MeasurementError(f"there is no column '{name}'", where=where, hint=hint)
        places[meaning] = names.index(name)
    taken = set(places.values())
    for place, name in enumerate(names):
        found = role(name)
        if found is None or place in taken or found in given:
            continue
        if found in places:
            raise MeasurementError(
                f"the columns '{names[places[found]]}' and '{name}' mean the same", where=where
            )
        places[found] = place
    for needed in ("incident", "reflection"):
        if needed not in places:
            raise MeasurementError(
                f"no column has the zenith '{needed}'; there are {', '.join(names[:12])}",
                where=where,
                hint=f"name it: --column {needed}=NAME",
            )
    return places


def _azimuths(table: Table, places: Mapping[str | float, int], unit: str, mirror: float) -> Array:
    """(n, 2) radians."""
    count = len(table.numbers)
    if "reflection_azimuth" not in places:
        # In the plane: light at azimuth 0, and where its sign is the mirror's, reflection at pi.
        return np.tile([0.0, math.pi if mirror > 0 else 0.0], (count, 1))
    light = (
        table.numbers[:, places["incident_azimuth"]]
        if "incident_azimuth" in places
        else np.zeros(count)
    )
    both = np.stack([light, table.numbers[:, places["reflection_azimuth"]]], axis=1)
    return ANGLES[unit](both)


def _components(
    places: Mapping[str | float, int], said: Declared, where: str
) -> tuple[Kind, list[float], list[int]]:
    """What the values are, their wavelengths, and the columns they are in."""
    for kind in (Kind.XYZ, Kind.RGB):
        found = [places[c] for c in kind.value if c in places]
        if len(found) == 3:
            return kind, [], found
    spectral = sorted(w for w in places if isinstance(w, float))
    if spectral and said.wavelength is not None:
        if said.wavelength not in spectral:
            listed = ", ".join(f"{w:g}" for w in spectral[:20])
            message = f"there are no values at {said.wavelength:g} nm"
            raise MeasurementError(message, where=where, hint=f"there are {listed}")
        spectral = [said.wavelength]
    if spectral:
        return Kind.SPECTRAL, spectral, [places[w] for w in spectral]
    if "value" in places:
        known = [] if said.wavelength is None else [said.wavelength]
        return Kind.SPECTRAL, known, [places["value"]]
    raise MeasurementError(
        "no columns have values: X, Y, Z or R, G, B or wavelengths as 450nm, or value",
        where=where,
        hint="name them: --column Y=NAME",
    )


def _gathered(table: Table, places: Mapping[str | float, int]) -> Table:
    """Rows of one wavelength (nm) each as rows of all, NaN where one is missing."""
    if "value" not in places:
        raise MeasurementError("a column of wavelengths needs a column of values beside it")
    names = [n for n in places if isinstance(n, str) and n not in ("wavelength", "value")]
    keys = table.numbers[:, [places[n] for n in names]]
    wavelength = np.round(table.numbers[:, places["wavelength"]], 6)
    distinct, column = np.unique(wavelength, return_inverse=True)
    if len(distinct) > MOST_COLUMNS or len(keys) * len(distinct) > _MOST_NUMBERS:
        message = f"{len(distinct):,} wavelengths in {len(keys):,} rows are too many"
        raise MeasurementError(message, where=table.where)
    spectral = [f"{w:.10g}nm" for w in distinct]
    for name in spectral:
        if not isinstance(role(name), float):
            raise MeasurementError(f"'{name}' is no wavelength", where=table.where)
    # Repeated measurements of a direction stay rows of their own: the n-th of each wavelength.
    times: dict[tuple[bytes, int], int] = {}
    row_of: dict[tuple[bytes, int], int] = {}
    rows = []
    for key, which in zip(map(bytes, keys), column.tolist(), strict=True):
        time = times[key, which] = times.get((key, which), 0) + 1
        rows.append(row_of.setdefault((key, time), len(row_of)))
    numbers = np.full((len(row_of), len(names) + len(distinct)), np.nan)
    numbers[rows, : len(names)] = keys
    numbers[rows, len(names) + column] = table.numbers[:, places["value"]]
    lines = np.zeros(len(row_of), int)
    lines[rows[::-1]] = table.lines[::-1]
    return replace(table, names=(*names, *spectral), numbers=numbers, lines=lines.tolist())
