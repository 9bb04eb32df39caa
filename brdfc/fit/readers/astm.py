"""Text in the style of ASTM E2387 (and E1392): a header of keywords, then the table.

Lines KEYWORD value, until VARS, whose value names the columns, between commas: theta_i, phi_i,
theta_s, phi_s, then R,G,B or X,Y,Z or wavelengths (550nm) or one value. Every further line is a
row, between commas or blanks. Of the other keywords NUM_POINTS, the number of rows, is held
against the table. The standard leaves the unit of angles to the header's reader: degrees, unless
--angles radians is said; values are BSDF in 1/sr unless --unit is.
"""

from __future__ import annotations

import re
from pathlib import Path

from brdfc.fit.columns import measured
from brdfc.fit.declared import Declared
from brdfc.fit.measurements import Measurements
from brdfc.fit.tables import content_lines, number, read_text, split, table
from brdfc.source.errors import MeasurementError

_VARS = re.compile(rb"^[ \t]*VARS[ \t=]+\S", re.MULTILINE)


def recognises(head: bytes) -> bool:
    """Whether a line begins with the keyword VARS."""
    return bool(_VARS.search(head))


def read(path: Path, said: Declared) -> Measurements:
    """Measurements. Raises MeasurementError."""
    where = str(path)
    lines = content_lines(read_text(path))
    stated: dict[str, tuple[int, str]] = {}
    for line, content in lines:
        keyword, *value = re.split(r"[ \t=]+", content, maxsplit=1)
        stated[keyword.upper()] = line, value[0] if value else ""
        if keyword.upper() == "VARS":
            break
    else:
        raise MeasurementError("no line VARS names the columns", where=where)
    names = split(stated["VARS"][1])
    read_rows = table(names, ((line, split(content)) for line, content in lines), where)
    if "NUM_POINTS" in stated:
        line, word = stated["NUM_POINTS"]
        if number(word, f"{where}, line {line}") != len(read_rows.lines):
            raise MeasurementError(
                f"NUM_POINTS is {word}, and there are {len(read_rows.lines):,} rows",
                where=f"{where}, line {line}",
                hint="the file may be cut short",
            )
    return measured(read_rows, said, path.stem)
