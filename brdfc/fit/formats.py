"""The formats that measurements are read from, and how each is recognised."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from brdfc.fit.declared import Declared, declared
from brdfc.fit.measurements import Measurements
from brdfc.fit.readers import astm, cgats, cornell, declared_csv, merl, nist, zenith_azimuth
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import MeasurementError

_HEAD = 1 << 16
"""Bytes from the beginning of a file that it is recognised by."""


@dataclass(frozen=True)
class Format:
    """title: for people; recognises: from the first bytes; takes: what of declared.Declared it
    leaves open; unit and angles: those that it has unless it is said otherwise."""

    name: str
    title: str
    recognises: Callable[[bytes], bool]
    read: Callable[[Path, Declared], Measurements]
    takes: Sequence[str] = ()
    unit: str | None = None
    angles: str | None = None


_TABLE = ("unit", "angles", "mirror", "white", "wavelength", "floor", "columns")
FORMATS = {
    f.name: f
    for f in (
        Format("merl", "MERL, binary", merl.recognises, merl.read, ("directions", "count")),
        Format("cgats", "CGATS.17 with columns of angles", cgats.recognises, cgats.read, _TABLE),
        Format(
            "nist",
            "NIST, Mueller matrices",
            nist.recognises,
            nist.read,
            ("wavelength", "floor"),
            "brdf",
            "degrees",
        ),
        Format(
            "zenith-azimuth",
            "satellites: columns phi_i theta_i phi_o theta_o brdf, phi the zenith",
            zenith_azimuth.recognises,
            zenith_azimuth.read,
            ("wavelength", "floor"),
            "brdf",
            "degrees",
        ),
        Format("astm", "ASTM E2387 style", astm.recognises, astm.read, _TABLE, "brdf"),
        Format(
            "cornell",
            "Cornell, spectral",
            cornell.recognises,
            cornell.read,
            ("wavelength", "floor"),
            "brdf",
            "radians",
        ),
        Format(
            "csv",
            "a table that declares itself",
            declared_csv.recognises,
            declared_csv.read,
            _TABLE,
        ),
    )
}
"""In the order they are tried in: those that are known by more come first."""


@dataclass(frozen=True)
class _Other:
    """What is no measurements, and what it is."""

    begins: re.Pattern[bytes]
    message: str
    hint: str


_OTHERS = (
    _Other(
        re.compile(rb"\s*analytic\b"),
        "a model of Disney's BRDF Explorer, not measurements",
        "brdfc reads measured reflectance here; the model's formula is the GLSL in the file",
    ),
    _Other(
        re.compile(rb"(?:\s*#[^\n]*\n)*\s*(?:model|module)\s+\w+\s+\""),
        "a model of brdfc, not measurements",
        "brdfc check, brdfc compile and brdfc plot take models",
    ),
    _Other(
        re.compile(rb"(?:\s*#[^\n]*\n)*[^\n]*=\s*Aggregate\("),
        "published parameters of fitted models, not measurements",
        "give the parameters to a model: brdfc plot curves 'ward with ks=0.3'",
    ),
    _Other(re.compile(rb".{36}acsp", re.DOTALL), "an ICC profile, not measurements", ""),
    _Other(
        re.compile(rb"II[*+]\x00|MM\x00[*+]|\x89PNG|\xff\xd8\xff"),
        "an image, not measurements",
        "brdfc measure takes measurements from photographs",
    ),
)


def read_measurements(path: str | Path, format: str | None = None, **said: object) -> Measurements:
    """Measured reflectance from a file.

    format: of FORMATS; None: the file is recognised by its content. said: what the file leaves
    open, see declared.Declared.

    Raises MeasurementError, with the file and the line, for a file of no known format, for one
    that is damaged, and for something said that the format states itself.
    """
    path = Path(path)
    known = _known(path, format)
    told = declared(**said)
    for name in told.said:
        if name not in known.takes:
            takes = ", ".join(known.takes)
            raise MeasurementError(
                f"a file of the format '{known.name}' takes no '{name}'",
                where=str(path),
                hint=f"it takes {takes}",
            )
    return known.read(
        path,
        replace(told, unit=told.unit or known.unit, angles=told.angles or known.angles),
    )


def _known(path: Path, name: str | None) -> Format:
    """The format of a name, or the one that a file is recognised to be in."""
    if name is not None and name not in FORMATS:
        hint = did_you_mean(name, FORMATS) or ", ".join(FORMATS)
        raise MeasurementError(f"there is no format '{name}'", hint=hint)
    try:
        with path.open("rb") as stream:
            head = stream.read(_HEAD)
    except OSError as error:
        raise MeasurementError(f"cannot be read: {error.strerror}", where=str(path)) from error
    if name is not None:
        return FORMATS[name]
    for other in _OTHERS:
        if other.begins.match(head):
            raise MeasurementError(other.message, where=str(path), hint=other.hint or None)
    for known in FORMATS.values():
        if known.recognises(head):
            return known
    raise MeasurementError(
        "no format of measurements is recognised" if head else "the file is empty",
        where=str(path),
        hint=f"name it with --format, one of {', '.join(FORMATS)}",
    )
