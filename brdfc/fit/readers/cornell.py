"""The Cornell Program of Computer Graphics' measurements, as pbrt (version 2) ships them.

Text with # comments, then one stream of numbers: how many wavelengths; these, in nm; records of
theta_i, phi_i, theta_s, phi_s in radians and the BRDF in 1/sr at each wavelength. The mirror
direction is phi_s = 180 degrees.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from brdfc.fit.columns import measured, role
from brdfc.fit.declared import Declared
from brdfc.fit.measurements import Measurements
from brdfc.fit.tables import MOST_COLUMNS, content_lines, read_text, table
from brdfc.source.errors import MeasurementError

ANGLES = ("theta_i", "phi_i", "theta_s", "phi_s")
Words = Iterator[tuple[int, str]]


def recognises(head: bytes) -> bool:
    """Whether the first words are a whole number and that many, or more, that could be nm."""
    words = [word for _, word in _words(head.decode("utf-8", errors="replace"))]
    if len(words) < 3 or not words[0].isdecimal():
        return False
    wavelengths = words[1 : 1 + min(int(words[0][:6]), len(words) - 2)]
    try:
        return bool(wavelengths) and all(100 <= float(w) <= 20000 for w in wavelengths)
    except ValueError:
        return False


def read(path: Path, said: Declared) -> Measurements:
    """Measurements. Raises MeasurementError, with the line a damaged record begins at."""
    where = str(path)
    words = _words(read_text(path))
    line, first = next(words, (0, ""))
    count = int(first) if first.isdecimal() and len(first) <= 6 else 0
    if not 0 < count <= MOST_COLUMNS - len(ANGLES):
        message = f"'{first[:40]}' where the number of wavelengths belongs"
        raise MeasurementError(message, where=f"{where}, line {line}")
    spectral = [f"{word}nm" for _, word in _record(words, count, where)]
    for name in spectral:
        if not isinstance(role(name), float):
            raise MeasurementError(f"'{name[:40]}' is no wavelength", where=where)
    names = (*ANGLES, *spectral)

    def records() -> Iterator[tuple[int, list[str]]]:
        while record := _record(words, len(names), where):
            yield record[0][0], [word for _, word in record]

    return measured(table(names, records(), where), said, path.stem)


def _words(text: str) -> Words:
    for line, content in content_lines(text):
        for word in content.split():
            yield line, word


def _record(words: Words, length: int, where: str) -> list[tuple[int, str]]:
    """The next words, as many as a record has; none at the end."""
    record = [word for _, word in zip(range(length), words, strict=False)]
    if record and len(record) < length:
        raise MeasurementError(
            f"the last record has {len(record)} of {length} numbers: the file is cut short, or the "
            "number of wavelengths is not what its first line says",
            where=f"{where}, line {record[0][0]}",
        )
    return record
