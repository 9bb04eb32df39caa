"""CGATS.17 text with columns for angles, as goniospectrophotometers export it.

Between BEGIN_DATA_FORMAT and END_DATA_FORMAT are the names of the columns, between BEGIN_DATA and
END_DATA the rows. XYZ_X, XYZ_Y, XYZ_Z, SPECTRAL_NM450 (or NM450), RGB_R, RGB_G, RGB_B are known;
CGATS.17 has no names for angles, so those that columns.ROLES does not know are given:
--column incident=GEOM_I. Values are radiance factors unless --unit says otherwise: XYZ and RGB in
percent, where a perfect diffuser has Y = 100, spectra not.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from brdfc.fit.columns import measured, role
from brdfc.fit.declared import Declared
from brdfc.fit.measurements import Measurements
from brdfc.fit.tables import number, read_text, table
from brdfc.source.errors import MeasurementError

_WORD = re.compile(r'"[^"]*"|[^\s"]+')
_SECTIONS = ("DATA_FORMAT", "DATA")


def recognises(head: bytes) -> bool:
    """Whether it begins with CGATS.17, or has a data format."""
    return head.lstrip().upper().startswith(b"CGATS") or b"BEGIN_DATA_FORMAT" in head


def read(path: Path, said: Declared) -> Measurements:
    """Measurements of the first data set. Raises MeasurementError."""
    where = str(path)
    stated, sections = _sections(read_text(path), where)
    for section in _SECTIONS:
        if section not in sections:
            raise MeasurementError(f"there is no section {section}", where=where)
    names = [word for _, words in sections["DATA_FORMAT"] for word in words]
    # Identifiers and remarks are text: only what means something is read.
    used = [i for i, name in enumerate(names) if role(name) or name in said.columns.values()]
    broken = _rows(sections["DATA"], len(names), where)
    kept = ((line, [words[i] for i in used]) for line, words in broken)
    rows = table([names[i] for i in used], kept, where)
    if "NUMBER_OF_SETS" in stated:
        line, word = stated["NUMBER_OF_SETS"]
        if number(word, f"{where}, line {line}") != len(rows.lines):
            message = f"NUMBER_OF_SETS is {word}, and there are {len(rows.lines):,}"
            raise MeasurementError(message, where=f"{where}, line {line}")
    factors = "XYZ_X" not in names and any(isinstance(role(name), float) for name in names)
    unit = said.unit or ("radiance-factor" if factors else "percent")
    remark = f"values are read as {unit}; --unit says otherwise"
    return measured(rows, replace(said, unit=unit), path.stem, [] if said.unit else [remark])


Lines = list[tuple[int, list[str]]]


def _sections(text: str, where: str) -> tuple[dict[str, tuple[int, str]], dict[str, Lines]]:
    """The keywords, each with its line and value, and the lines of each section's first."""
    stated: dict[str, tuple[int, str]] = {}
    sections: dict[str, Lines] = {}
    inside = ""
    for line, content in enumerate(text.splitlines(), start=1):
        words = [word.strip('"') for word in _WORD.findall(content.partition("#")[0])]
        if not words:
            continue
        if words[0] == f"END_{inside}":
            inside = ""
            if "DATA" in sections:
                break
        elif inside:
            sections[inside].append((line, words))
        elif words[0].removeprefix("BEGIN_") in _SECTIONS and words[0].startswith("BEGIN_"):
            inside = words[0].removeprefix("BEGIN_")
            sections[inside] = []
        else:
            stated[words[0]] = line, " ".join(words[1:])
    if inside:
        raise MeasurementError(
            f"BEGIN_{inside} has no END_{inside}", where=where, hint="the file may be cut short"
        )
    return stated, sections


def _rows(lines: Lines, length: int, where: str) -> Iterator[tuple[int, list[str]]]:
    """The rows, which may be broken over lines: the names say how long they are."""
    row: list[str] = []
    start = 0
    for line, words in lines:
        start = start if row else line
        row += words
        if len(row) > length or (row and not length):
            message = f"a row of {len(row)} values where {length} columns are named"
            raise MeasurementError(message, where=f"{where}, line {start}")
        if len(row) == length:
            yield start, row
            row = []
    if row:
        message = f"the last row has {len(row)} of {length} values"
        raise MeasurementError(message, where=f"{where}, line {start}")
