"""From a camera's linear RGB to XYZ: a matrix, given or made from spectral sensitivities."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from brdfc.colour.conditions import SEEN, ViewingConditions
from brdfc.colour.spectrum import read_spectra
from brdfc.files import read_file
from brdfc.fit.tables import number, split
from brdfc.source.errors import MeasurementError

Array = NDArray[np.float64]

_LONGEST = 1 << 16
"""Bytes of a file of nine numbers."""


def matrix_of(text: str) -> Array:
    """(3, 3) from nine numbers, row by row, or from a file that holds them.

    Raises MeasurementError for anything else, and for a matrix that maps colours to a plane.
    """
    where = ""
    words = split(text)
    if len(words) != 9:
        where = text
        content = read_file(text, limit=_LONGEST).decode("utf-8", errors="replace")
        words = [w for line in content.splitlines() for w in split(line.partition("#")[0]) if w]
    values = [number(word, where) for word in words]
    if len(values) != 9 or not np.isfinite(values).all():
        message = f"a matrix has nine finite numbers, three rows of three, not {len(values)}"
        raise MeasurementError(message, where=where or None)
    matrix = np.reshape(values, (3, 3))
    if abs(np.linalg.det(matrix)) < 1e-9 * np.abs(matrix).max() ** 3:
        raise MeasurementError("the matrix maps all colours to a plane", where=where or None)
    return np.asarray(matrix)


def matrix_from_sensitivities(
    path: str | Path, conditions: ViewingConditions
) -> tuple[Array, float]:
    """The matrix (3, 3) that best makes the observer's functions of the camera's, under a light.

    Least squares over wavelengths, both weighted by the light: the best for spectra of which
    nothing is known but that their values vary independently (maximum ignorance; G. Finlayson, M.
    Drew, JOSA A 14(6), 1997). path: a table of wavelengths and the sensitivities of R, G, B. Also
    the part of the observer's functions that is missed, root mean square, 0 where the camera sees
    as the observer does (Luther's condition).
    """
    camera = read_spectra(path, 3, "camera's sensitivity")
    low, high = SEEN
    if camera.grid.start > low or camera.grid.end < high:
        message = f"the sensitivities cover {camera.grid}; {low:g}..{high:g} nm are needed"
        raise MeasurementError(message, where=str(path))
    part = conditions.grid.part(camera.grid.start, camera.grid.end)
    wavelengths = conditions.grid.wavelengths[part]
    power = conditions.power[part]
    seen_by_camera = camera.at(wavelengths) * power
    seen_by_eye = conditions.matching[:, part] * power
    solved, _, rank, _ = np.linalg.lstsq(seen_by_camera.T, seen_by_eye.T, rcond=None)
    if rank < 3:
        raise MeasurementError("two of the camera's sensitivities are the same", where=str(path))
    missed = np.linalg.norm(seen_by_eye - solved.T @ seen_by_camera)
    return np.asarray(solved.T), float(missed / np.linalg.norm(seen_by_eye))
