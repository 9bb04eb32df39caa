"""Measurements as a table that declares itself; readers/declared_csv.py reads it back."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from brdfc.files import write_whole
from brdfc.fit.measurements import Array, Measurements
from brdfc.laws.reflectance import ANGLES


def write_csv(measurements: Measurements, path: str | Path) -> None:
    """Write measurements as CSV, whole or not at all; read back they are equal, but for remarks."""
    write_whole(path, csv_text(measurements).encode())


def csv_text(measurements: Measurements) -> str:
    """The text of the table, the same for the same measurements."""
    angles, unit = _angles(measurements.directions)
    weighted = bool((measurements.weights != 1).any())
    names = [*ANGLES, *measurements.components, *(["weight"] if weighted else [])]
    name = " ".join(measurements.name.split())
    lines = [f"# name: {name}"] if name else []
    lines += ["# unit: brdf", f"# angles: {unit}"]
    if measurements.white:
        lines.append(f"# white: {','.join(map(repr, measurements.white))}")
    columns = np.hstack([angles, measurements.values, measurements.weights[:, None]])
    rows = columns[:, : len(names)].tolist()
    return "\n".join([*lines, ",".join(names), *(",".join(map(_word, row)) for row in rows), ""])


def _angles(directions: Array) -> tuple[Array, str]:
    """Degrees of few digits where they are the same angles again; radians elsewhere."""
    degrees: Array = np.degrees(directions).round(9)
    same = bool((np.radians(degrees) == directions).all())
    return (degrees, "degrees") if same else (directions, "radians")


def _word(value: float) -> str:
    if math.isnan(value):
        return ""
    text = repr(float(value))
    return text.removesuffix(".0")
