"""The plain table that declares what it holds, which brdfc writes too.

    # unit: radiance-factor
    # angles: degrees
    # white: 0.9642,1,0.8249
    incident,reflection,incident_azimuth,reflection_azimuth,X,Y,Z,weight
    45,10,0,180,0.31,0.33,0.27,1

Comments `# key: value` before the names of the columns declare; others are comments. Columns mean
what columns.ROLES says, or a wavelength (450nm); all but the zeniths and the values may be absent,
and values may be empty.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from brdfc.fit.columns import measured, role
from brdfc.fit.declared import Declared
from brdfc.fit.measurements import Measurements
from brdfc.fit.tables import content_lines, number, read_text, split, table
from brdfc.source.diagnostics import nearest
from brdfc.source.errors import MeasurementError

KEYS = ("name", "unit", "angles", "mirror", "white", "wavelength")
"""What comments can declare."""


def recognises(head: bytes) -> bool:
    """Whether the first line that is no comment names columns of zeniths."""
    for _, content in content_lines(head.decode("utf-8", errors="replace").lstrip("\ufeff")):
        return {"incident", "reflection"} <= {role(word) for word in split(content)}
    return False


def read(path: Path, said: Declared) -> Measurements:
    """Measurements; what is said goes before what the file declares. Raises MeasurementError."""
    text = read_text(path)
    rows = content_lines(text)
    line, first = next(rows, (0, ""))
    names = split(first)
    if not {"incident", "reflection"} <= {role(word) for word in names} and not said.columns:
        raise MeasurementError(
            "no line names the columns: incident, reflection, ...", where=f"{path}, line {line}"
        )
    states = declarations(text, line, str(path))
    unit, angles = said.unit or states.get("unit"), said.angles or states.get("angles")
    if unit is None:
        raise MeasurementError(
            "the unit of the values is not declared",
            where=str(path),
            hint="put '# unit: brdf' or '# unit: radiance-factor' first, or give --unit",
        )
    declared = replace(
        said,
        unit=unit,
        angles=angles,
        mirror=said.mirror or states.get("mirror"),
        white=said.white or _white(states, str(path)),
        wavelength=said.wavelength or _wavelength(states, str(path)),
    )
    separator = next((s for s in ",;\t" if s in first), None)
    words = ((at, [w.strip(" \t\"'") for w in row.split(separator)]) for at, row in rows)
    read_rows = table(names, words, str(path))
    return measured(read_rows, declared, states.get("name", path.stem))


def declarations(text: str, until: int, where: str, keys: Sequence[str] = KEYS) -> dict[str, str]:
    """What the comments before a line declare, of these keys; MeasurementError for a key that is
    declared twice, or nearly one of them."""
    states: dict[str, str] = {}
    for line, content in enumerate(text.splitlines()[: until - 1], start=1):
        key, colon, value = content.lstrip("# \t").partition(":")
        key = key.strip().lower()
        if not colon or not key.isidentifier():
            continue
        if key in states:
            raise MeasurementError(f"'{key}' is declared twice", where=f"{where}, line {line}")
        if key in keys:
            states[key] = value.strip()
        elif near := nearest(key, keys):
            raise MeasurementError(
                f"nothing is declared by '{key}'",
                where=f"{where}, line {line}",
                hint=f"did you mean '{near}'?",
            )
    return states


def _white(states: Mapping[str, str], where: str) -> tuple[float, float, float] | None:
    if "white" not in states:
        return None
    words = states["white"].split(",")
    if len(words) != 3:
        raise MeasurementError("a white is X,Y,Z", where=where)
    x, y, z = (number(word.strip(), where) for word in words)
    return x, y, z


def _wavelength(states: Mapping[str, str], where: str) -> float | None:
    if "wavelength" not in states:
        return None
    nanometres = number(states["wavelength"].removesuffix("nm").strip(), where)
    if not math.isfinite(nanometres):
        raise MeasurementError("the wavelength is no number", where=where)
    return nanometres
