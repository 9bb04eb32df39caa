"""Spectra at equal steps of wavelength, and the tables that people keep them in."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.files import read_file
from brdfc.source.errors import SpectrumError

MOST_STEPS = 4096
"""Wavelengths of a spectrum: a tenth of a nanometre over all that is visible."""
_LONGEST = 1 << 20
"""Bytes of a table: a wavelength and some values in every line, a few thousand lines at most."""


@dataclass(frozen=True)
class Grid:
    """Wavelengths from start to end, both included, in nanometres, at so many equal steps."""

    start: float
    end: float
    steps: int

    @property
    def wavelengths(self) -> NDArray[np.float64]:
        return np.linspace(self.start, self.end, self.steps)

    def part(self, start: float, end: float) -> slice:
        """The wavelengths that lie within start..end."""
        inside = np.flatnonzero((self.wavelengths >= start) & (self.wavelengths <= end))
        return slice(int(inside[0]), int(inside[-1]) + 1) if len(inside) else slice(0, 0)

    def __str__(self) -> str:
        return f"{self.start:g}..{self.end:g} nm"


def interpolation(source: Grid, target: NDArray[np.float64]) -> NDArray[np.float64]:
    """The matrix (target, source) that reads a spectrum at other wavelengths: linear between its
    own, and beyond its ends the value there. So do colour engines that apply iccMAX profiles."""
    identity = np.eye(source.steps)
    columns = [np.interp(target, source.wavelengths, column) for column in identity]
    return np.stack(columns, axis=-1)


@dataclass(frozen=True)
class Spectra:
    """One spectrum or several on a grid; values: (spectra, steps)."""

    grid: Grid
    values: NDArray[np.float64]

    @staticmethod
    def of(distribution: Any) -> Spectra:
        """The values of a spectral distribution, or of several, of colour-science."""
        wavelengths = np.asarray(distribution.wavelengths, dtype=np.float64)
        values = np.atleast_2d(np.asarray(distribution.values, dtype=np.float64).T)
        ends = float(wavelengths[0]), float(wavelengths[-1])
        return Spectra(Grid(*ends, len(wavelengths)), values)

    def at(self, wavelengths: NDArray[np.float64]) -> NDArray[np.float64]:
        """(spectra, wavelengths), see interpolation."""
        return np.stack([np.interp(wavelengths, self.grid.wavelengths, v) for v in self.values])

    def in_steps(self, most: float) -> Spectra:
        """The same in steps no wider than so many nanometres, linear between its own."""
        span = self.grid.end - self.grid.start
        parts = math.ceil(span / (self.grid.steps - 1) / most - 1e-9)
        if parts <= 1:
            return self
        grid = Grid(self.grid.start, self.grid.end, (self.grid.steps - 1) * parts + 1)
        return Spectra(grid, self.at(grid.wavelengths))

    def cut(self, start: float, end: float) -> Spectra:
        """The same between two wavelengths."""
        part = self.grid.part(start, end)
        kept = self.grid.wavelengths[part]
        return Spectra(Grid(float(kept[0]), float(kept[-1]), len(kept)), self.values[:, part])


def names_a_file(text: str) -> bool:
    """Whether a user means a file, where a name is possible too."""
    return "/" in text or "\\" in text or text.lower().endswith((".csv", ".txt", ".tsv"))


def read_spectra(path: str | Path, count: int, what: str) -> Spectra:
    """A table of text: in every line a wavelength in nanometres, then count values, separated by
    commas, semicolons, tabs or spaces; lines that begin with no number before the first that does
    are headings, # begins a comment.

    Wavelengths rise in equal steps. Raises SpectrumError, with the line, for anything else, for a
    gap, and for values that are negative or no finite numbers. what: for messages, "illuminant".
    """
    rows = _rows(path, count, what)
    if len(rows) > MOST_STEPS:
        raise SpectrumError(f"{len(rows):,} wavelengths are too many", where=str(path))
    if len(rows) < 3:
        raise SpectrumError(f"{len(rows)} wavelengths; a spectrum has 3 at least", where=str(path))
    wavelengths = np.array([wavelength for _, wavelength, _ in rows])
    steps = np.diff(wavelengths)
    step = float(np.sort(steps)[(len(steps) - 1) // 2])
    for (line, wavelength, _), before, found in zip(rows[1:], wavelengths, steps, strict=False):
        where = f"{path}, line {line}"
        if found <= 0:
            message = f"{wavelength:g} nm comes after {before:g} nm; wavelengths have to rise"
            raise SpectrumError(message, where=where)
        if abs(found - step) > 1e-6 * max(step, 1):
            raise SpectrumError(
                f"a gap: {wavelength:g} nm follows {before:g} nm, where the steps are {step:g} nm",
                where=where,
                hint="put in what is missing, or take every so many lines, for equal steps",
            )
    grid = Grid(float(wavelengths[0]), float(wavelengths[-1]), len(rows))
    values = np.array([v for _, _, v in rows]).T
    if not values.any():
        raise SpectrumError(f"the {what} is 0 everywhere", where=str(path))
    return Spectra(grid, values)


def _rows(path: str | Path, count: int, what: str) -> list[tuple[int, float, list[float]]]:
    """(line, wavelength, values) of each line of a table."""
    try:
        text = read_file(path, limit=_LONGEST).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise SpectrumError("this is no text", where=str(path)) from None
    rows: list[tuple[int, float, list[float]]] = []
    for line, content in enumerate(io.StringIO(text), start=1):
        words = _words(content.partition("#")[0])
        if not words:
            continue
        where = f"{path}, line {line}"
        try:
            numbers = [float(word) for word in words]
        except ValueError:
            if not rows and not _is_number(words[0]):
                continue  # a heading
            raise SpectrumError(f"not all numbers: {content.strip()[:60]!r}", where=where) from None
        if len(numbers) != count + 1:
            columns = "a wavelength and " + ("a value" if count == 1 else f"{count} values")
            raise SpectrumError(f"{len(numbers)} numbers where {columns} are needed", where=where)
        if not all(map(math.isfinite, numbers)):
            raise SpectrumError(f"no finite number at {numbers[0]:g} nm", where=where)
        if min(numbers) < 0:
            raise SpectrumError(f"the {what} is negative at {numbers[0]:g} nm", where=where)
        rows.append((line, numbers[0], numbers[1:]))
    return rows


def _words(content: str) -> Sequence[str]:
    for separator in ",;\t":
        if separator in content:
            return [word.strip(" \"'\r\n") for word in content.split(separator)]
    return content.split()


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
