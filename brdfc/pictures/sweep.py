"""Colours over the reflection angle, by incidence and white: the data of curves and strips."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from brdfc.colour.difference import lab
from brdfc.files import read_file
from brdfc.pictures.sources import AZIMUTHS, INCIDENT, REFLECTION, XYZ, Array, Subject
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import BrdfcError, ValueGivenError

QUANTITIES = {
    "X": "X",
    "Y": "Y",
    "Z": "Z",
    "L": "CIELAB L*",
    "a": "CIELAB a*",
    "b": "CIELAB b*",
    "C": "CIELAB C*ab",
}
"""What a curve can be of, and its name on an axis."""
_COLUMNS = ("incident", "reflection", "X", "Y", "Z")
_LONGEST = 1 << 24


@dataclass(frozen=True)
class Sweep:
    """One subject at one incidence under one white.

    incident and reflection: degrees; xyz: (angles, 3); white: that CIELAB is relative to. adapt:
    the name of the white, None where it is the subject's own; measured: single points.
    """

    label: str
    incident: float
    reflection: Array
    xyz: Array
    white: XYZ
    adapt: str | None = None
    measured: bool = False

    def values(self, quantity: str) -> Array:
        """X, Y, Z, L*, a*, b* or C* (a name of QUANTITIES)."""
        if quantity in "XYZ":
            return np.asarray(self.xyz[:, "XYZ".index(quantity)])
        lightness, a, b = lab(self.xyz, self.white).T
        values: Array = {"L": lightness, "a": a, "b": b, "C": np.hypot(a, b)}[quantity]
        return values


def quantity(text: str) -> str:
    """A name of QUANTITIES, with or without a star; ValueGivenError for another."""
    name = text.removesuffix("*")
    if name not in QUANTITIES:
        hint = did_you_mean(name, QUANTITIES) or ", ".join(QUANTITIES)
        raise ValueGivenError(f"'{text}' is nothing to draw", hint=hint)
    return name


def sweeps(
    subjects: Sequence[Subject],
    incidents: Sequence[float],
    reflection: Array,
    adapts: Sequence[str | None] = (None,),
    exposure: float = 1.0,
    transform: str = "bradford",
) -> list[Sweep]:
    """Every subject at every incidence under every white. Angles are radians, in the plane of
    incidence: the mirror direction is reflection = +incident. exposure: XYZ is multiplied by it;
    transform: how colours are adapted. Raises ValueGivenError for angles that are out of range."""
    found = []
    for incident in incidents:
        for subject in subjects:
            _check_ranges(subject, {INCIDENT: np.array([incident]), REFLECTION: reflection})
            own = exposure * subject.colours(in_plane(subject, incident, reflection))
            for adapt in adapts:
                xyz, white = subject.adapted(own, adapt, transform)
                angles = (_degrees(incident), np.degrees(reflection))
                found.append(Sweep(subject.label, *angles, xyz, white, adapt))
    return found


def _check_ranges(subject: Subject, angles: Mapping[str, Array]) -> None:
    for name, values in angles.items():
        low, high = subject.ranges.get(name, (-math.pi / 2, math.pi / 2))
        if subject.full:
            low = -high  # zeniths: a sign turns the azimuth
        for value in (float(values.min()), float(values.max())):
            if not low - 1e-6 <= value <= high + 1e-6:
                raise ValueGivenError(
                    f"{name}={_degrees(value):g}deg lies outside the range of '{subject.label}', "
                    f"{_degrees(low):g}deg..{_degrees(high):g}deg"
                )


def _degrees(radians: float) -> float:
    """Degrees as they were written: 30, not 29.999999999999996."""
    return round(float(np.degrees(radians)), 9)


def in_plane(subject: Subject, incident: float, reflection: Array) -> Mapping[str, Array]:
    """Signed angles in the plane of incidence as a subject takes them."""
    light = np.full_like(reflection, incident)
    if not subject.full:
        return {INCIDENT: light, REFLECTION: reflection}
    # Opposite azimuths are the mirror side; a negative angle is on the other.
    mirrored = np.sign(light) * np.sign(reflection) >= 0
    return {
        INCIDENT: np.abs(light),
        REFLECTION: np.abs(reflection),
        AZIMUTHS[0]: np.zeros_like(reflection),
        AZIMUTHS[1]: np.where(mirrored, np.pi, 0.0),
    }


def measured_sweeps(path: str | Path, incidents: Sequence[float], white: XYZ) -> list[Sweep]:
    """Measured points of a table, those of each incidence (radians) together.

    The file is CSV with a heading: incident, reflection (degrees), and X, Y, Z or Y alone. Raises
    BrdfcError, with the line, for anything else.
    """
    try:
        text = read_file(path, limit=_LONGEST).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise BrdfcError("this is no text", where=str(path)) from None
    lines = [
        (number, [cell.strip() for cell in line.split(",")])
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.startswith("#")
    ]
    (_, heading), *rows = lines or [(0, [])]
    names = {name: place for place, name in enumerate(heading)}
    for needed in ("incident", "reflection", "Y"):
        if needed not in names:
            listed = ", ".join(names) or "none"
            raise BrdfcError(
                f"no column '{needed}'; the columns are {listed}",
                where=str(path),
                hint="the heading is: incident,reflection,X,Y,Z",
            )
    table = []
    for line, row in rows:
        where = f"{path}, line {line}"
        try:
            values = {n: float(row[names[n]]) for n in _COLUMNS if n in names}
        except (IndexError, ValueError):
            raise BrdfcError("not all numbers", where=where) from None
        if not np.isfinite(list(values.values())).all():
            raise BrdfcError("no finite number", where=where)
        y = values["Y"]
        colour = (values.get("X", y * white[0]), y, values.get("Z", y * white[2]))
        table.append((values["incident"], values["reflection"], *colour))
    points = np.array(table).reshape(-1, 5)
    found = list(_by_incidence(points, incidents, Path(path).stem, white))
    if not found:
        wanted = ", ".join(f"{_degrees(i):g}" for i in incidents)
        there = ", ".join(f"{a:g}" for a in np.unique(points[:, 0])[:12]) or "none"
        raise BrdfcError(
            f"no point at the incidence {wanted} deg", where=str(path), hint=f"it has {there} deg"
        )
    return found


def _by_incidence(
    table: Array, incidents: Sequence[float], label: str, white: XYZ
) -> Iterator[Sweep]:
    for incident in map(_degrees, incidents):
        chosen = table[np.abs(table[:, 0] - incident) < 0.5]
        if len(chosen):
            ordered = chosen[np.argsort(chosen[:, 1], kind="stable")]
            angles, xyz = ordered[:, 1], ordered[:, 2:]
            yield Sweep(label, incident, angles, xyz, white, measured=True)


def sweep_rows(found: Sequence[Sweep]) -> Iterator[list[str]]:
    """The data of sweeps as rows of a table, the heading first."""
    yield ["source", "adapted to", "incident", "reflection", "X", "Y", "Z", "L", "a", "b"]
    for one in found:
        colours = np.hstack([one.xyz, lab(one.xyz, one.white)])
        for angle, row in zip(one.reflection, colours, strict=True):
            numbers = [f"{value:.9g}" for value in (one.incident, angle, *row)]
            yield [one.label, one.adapt or "", *numbers]
