"""NIST's tables of Mueller matrix BRDFs (T. A. Germer, 2017).

CSV with one line of names: lambda in micrometres, theta_i, phi_i, theta_r, phi_r in degrees, f_r11
in 1/sr, then the normalised elements of the Mueller matrix, which are left out: light is taken as
unpolarised. theta_i is negative, on the side opposite to the mirror's.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from brdfc.fit.columns import measured
from brdfc.fit.declared import Declared
from brdfc.fit.measurements import Measurements
from brdfc.fit.tables import content_lines, read_text, split, table
from brdfc.source.errors import MeasurementError

_NAMES = ("lambda", "thetai", "phii", "thetar", "phir", "value")
_HEADS = (("lambda", "thetai", "phi", "thetar", "phir"), ("lambda", "thetai", "phii", "thetar"))
"""How the line of names begins, as published and as described."""


def recognises(head: bytes) -> bool:
    """Whether the first line has NIST's names."""
    first = head.decode("utf-8", errors="replace").partition("\n")[0]
    names = tuple(split(first.strip().lstrip("\ufeff")))
    return any(names[: len(start)] == start for start in _HEADS)


def read(path: Path, said: Declared) -> Measurements:
    """Measurements, all wavelengths of a direction in one row. Raises MeasurementError."""
    rows = ((line, split(content)) for line, content in content_lines(read_text(path)))
    _, names = next(rows, (0, []))
    if not recognises(",".join(names).encode()):
        raise MeasurementError("its first line has other names than NIST's", where=str(path))
    whole = table(names, rows, str(path))
    first = np.array(whole.numbers[:, : len(_NAMES)])
    with np.errstate(over="ignore"):  # an infinite wavelength is refused
        first[:, 0] *= 1000
    return measured(replace(whole, names=_NAMES, numbers=first), said, path.stem)
