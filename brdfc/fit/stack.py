"""A stack: images of one surface, each in one geometry; what a file says of them.

    unit = "radiance-factor"       # of units.UNITS
    colours = "XYZ"                # or RGB; images of one sample need none
    white = [0.9642, 1.0, 0.8249]  # that XYZ values are under; D50
    scale = "0..1"                 # what 0 and the greatest integer mean
    mirror = "+"                   # see measurements: the sign of the mirror side in the plane

    [[image]]
    file = "a.tif"                 # relative to the folder of this file
    incident = "40deg"
    reflection = "-10deg"
    incident_azimuth = "0deg"      # all of a stack have azimuths, or none
    reflection_azimuth = "90deg"

The same as a plain table: declarations as comments, then file,incident,reflection in degrees.

    # unit: radiance-factor
    file,incident,reflection
    a.tif,40,-10
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.fit.columns import measured, role
from brdfc.fit.declared import Declared
from brdfc.fit.measurements import Kind
from brdfc.fit.readers.declared_csv import declarations
from brdfc.fit.tables import Table, content_lines, read_text, split, table
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import MeasurementError, ValueGivenError

Array = NDArray[np.float64]

MOST_IMAGES = 4096
_KEYS = ("unit", "colours", "white", "scale", "mirror")
_DECLARED = (*_KEYS, "angles")
_ANGLES = ("incident", "reflection", "incident_azimuth", "reflection_azimuth")


@dataclass(frozen=True, eq=False)
class Stack:
    """files: of the images; directions: (n, 4) radians, as of measurements; factors: (n,), what a
    value is multiplied by to be a BRDF in 1/sr, NaN where a cosine vanishes; kind: of three samples
    a pixel; white: X, Y, Z of the light; scale: what 0 and the greatest integer mean, None where it
    is not said; remarks: what was noticed."""

    path: str
    files: tuple[Path, ...]
    directions: Array
    factors: Array
    kind: Kind
    white: tuple[float, float, float]
    scale: tuple[float, float] | None
    remarks: tuple[str, ...]


def read_stack(path: str | Path, unit: str | None = None) -> Stack:
    """The stack of a file, TOML or a plain table; unit: goes before what the file says.

    Raises MeasurementError, with the place in the file, for what no stack says.
    """
    text = read_text(path)
    first = next(content_lines(text), (0, ""))[1]
    listed = "file" in split(first)
    names, rows, says = _listed(text, str(path)) if listed else _sections(text, str(path))
    if unit is not None:
        says["unit"] = unit
    if "unit" not in says:
        raise MeasurementError(
            "the unit of the values is not declared",
            where=str(path),
            hint='write unit = "brdf" or unit = "radiance-factor", or give --unit',
        )
    if not 0 < len(names) <= MOST_IMAGES:
        raise MeasurementError(
            f"{len(names):,} images; 1 to {MOST_IMAGES:,} make a stack", where=str(path)
        )
    return _checked(names, rows, says, Path(path))


def _checked(names: Sequence[str], rows: Table, says: Mapping[str, str], path: Path) -> Stack:
    """The stack, once its geometries are known to be what they should be."""
    # A value of 1 in each image's geometry: what it becomes is the factor.
    ones = np.ones((len(names), 1))
    unity = Table((*rows.names, "value"), np.hstack([rows.numbers, ones]), rows.lines, str(path))
    said = Declared(unit=says["unit"], angles=says.get("angles"), mirror=says.get("mirror"))
    found = measured(unity, said, Path(path).stem)
    if len(found) != len(names):
        raise MeasurementError(
            f"{len(names) - len(found)} of {len(names)} images are seen or lit from 90 degrees or "
            "beyond",
            where=str(path),
            hint="leave them out",
        )
    colours = says.get("colours", "XYZ")
    if colours not in ("XYZ", "RGB"):
        raise MeasurementError(f"'{colours}' are no colours: XYZ or RGB", where=str(path))
    folder = Path(path).parent
    return Stack(
        str(path),
        tuple(folder / name for name in names),
        found.directions,
        found.values[:, 0],
        Kind(colours),
        _white(says.get("white"), str(path)),
        _scale(says.get("scale"), str(path)),
        found.remarks,
    )


def _listed(text: str, where: str) -> tuple[list[str], Table, dict[str, str]]:
    """Names, angles and declarations of a plain table."""
    rows = content_lines(text)
    line, first = next(rows)
    columns = split(first)
    place = columns.index("file")
    names, words = [], []
    for at, row in rows:
        found = split(row)
        if len(found) != len(columns):
            message = f"{len(found)} values where {len(columns)} columns are named"
            raise MeasurementError(message, where=f"{where}, line {at}")
        names.append(found.pop(place))
        words.append((at, found))
    others = [column for column in columns if column != "file"]
    for column in others:
        if role(column) not in _ANGLES:
            hint = did_you_mean(column, _ANGLES) or ", ".join(_ANGLES)
            raise MeasurementError(f"'{column}' is no column of a stack", where=where, hint=hint)
    return names, table(others, words, where), declarations(text, line, where, _DECLARED)


def _sections(text: str, where: str) -> tuple[list[str], Table, dict[str, str]]:
    """The same of a TOML file; angles become radians."""
    try:
        data = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise MeasurementError(f"not a TOML file: {error}", where=where) from None
    images = data.pop("image", [])
    if not (isinstance(images, list) and images and all(isinstance(i, dict) for i in images)):
        raise MeasurementError("sections [[image]] are needed, one a geometry", where=where)
    says = {key: _text(key, value, where) for key, value in data.items()}
    given = [a for a in _ANGLES if any(a in image for image in images)]
    given += [a for a in _ANGLES[:2] if a not in given]
    names, numbers = [], []
    for number, image in enumerate(images, 1):
        here = f"{where}: image {number}"
        for key in image:
            if key not in ("file", *_ANGLES):
                hint = did_you_mean(key, ("file", *_ANGLES)) or ", ".join(("file", *_ANGLES))
                raise MeasurementError(f"an image has no '{key}'", where=here, hint=hint)
        if not (isinstance(image.get("file"), str) and image["file"]):
            raise MeasurementError('file = "NAME.tif" is needed', where=here)
        names.append(image["file"])
        numbers.append([_angle(image, name, here) for name in given])
    lines = list(range(1, len(names) + 1))
    found = Table(tuple(given), np.array(numbers, dtype=np.float64), lines, where)
    return names, found, says | {"angles": "radians"}


def _text(key: str, value: Any, where: str) -> str:
    if key not in _KEYS:
        hint = did_you_mean(key, _KEYS) or ", ".join((*_KEYS, "[[image]]"))
        raise MeasurementError(f"a stack has no '{key}'", where=where, hint=hint)
    if key == "white" and isinstance(value, list):
        return ",".join(map(str, value))
    if not isinstance(value, str):
        raise MeasurementError(f"{key}: a text in quotes is needed", where=where)
    return value


def _angle(image: Mapping[str, Any], name: str, where: str) -> float:
    from brdfc.lang.types import TYPES
    from brdfc.lang.values import parse_value

    text = image.get(name)
    if not isinstance(text, str):
        raise MeasurementError(f'{name} = "40deg" is needed', where=where)
    try:
        return parse_value(text, TYPES["angle"], name)[0]
    except ValueGivenError as error:
        raise MeasurementError(error.message, where=where, hint=error.hint) from None


def _white(text: str | None, where: str) -> tuple[float, float, float]:
    from brdfc.colour.conditions import normalised_white
    from brdfc.colour.difference import D50

    if text is None:
        return D50
    try:
        numbers: Sequence[float] = [float(word) for word in text.split(",")]
        if len(numbers) != 3:
            raise ValueError(text)
        return normalised_white(numbers)
    except ValueError:
        raise MeasurementError("a white is X,Y,Z", where=where) from None
    except ValueGivenError as error:
        raise MeasurementError(error.message, where=where, hint=error.hint) from None


def _scale(text: str | None, where: str) -> tuple[float, float] | None:
    from brdfc.images.samples import ends

    if text is None:
        return None
    low, _, high = text.partition("..")
    try:
        return ends(low, high)
    except ValueGivenError as error:
        raise MeasurementError(f"scale: {error.message}", where=where, hint=error.hint) from None
