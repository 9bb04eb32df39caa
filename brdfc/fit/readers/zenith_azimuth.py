"""Tables of BRDFs for the brightness of satellites (F. Fankhauser and others, 2023).

Text: # comments, the last of which names the columns phi_i, theta_i, phi_o, theta_o, brdf, between
blanks. In these files phi is the ZENITH, signed, and theta the azimuth, in degrees; the BRDF is in
1/sr. The instrument's floor is 1e-4, and values up to twice that are it.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from brdfc.fit.columns import measured
from brdfc.fit.declared import Declared
from brdfc.fit.measurements import Measurements
from brdfc.fit.tables import content_lines, read_text, split, table

NAMES = ("incident", "incident_azimuth", "reflection", "reflection_azimuth", "value")
FLOOR = 2e-4
_NAMED = re.compile(
    r"^#[ \t]*phi_\w+[ \t]+theta_\w+[ \t]+phi_\w+[ \t]+theta_\w+[ \t]+brdf[ \t\r]*$", re.MULTILINE
)
_WAVELENGTH = re.compile(r"^#.*\blambda\s*=\s*(\d{3,4}(?:\.\d+)?)\s*nm", re.MULTILINE)


def recognises(head: bytes) -> bool:
    """Whether a comment names these columns."""
    return bool(_NAMED.search(head.decode("utf-8", errors="replace")))


def read(path: Path, said: Declared) -> Measurements:
    """Measurements, less what is below the floor. Raises MeasurementError."""
    text = read_text(path)
    rows = ((line, split(content)) for line, content in content_lines(text))
    stated = _WAVELENGTH.search(text)
    declared = replace(
        said,
        floor=FLOOR if said.floor is None else said.floor,
        wavelength=said.wavelength or (float(stated[1]) if stated else None),
    )
    return measured(table(NAMES, rows, str(path)), declared, path.stem)
