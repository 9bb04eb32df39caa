"""The colours of measured reflectance under a light."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from brdfc.colour.conditions import SEEN, ViewingConditions
from brdfc.colour.spectrum import Grid
from brdfc.fit.measurements import Kind, Measurements
from brdfc.source.errors import MeasurementError

Array = NDArray[np.float64]

_WIDEST = 40.0
"""Nanometres between neighbouring wavelengths, above which colours are guesses."""
_STEP = 5.0
"""Nanometres; spectra at uneven wavelengths are read linearly in such steps."""
_SAME_WHITE = 1e-3


def to_xyz(measurements: Measurements, conditions: ViewingConditions) -> Measurements:
    """The same as XYZ under a light, BRDF in 1/sr: a perfect diffuser has the white over pi.

    Spectra are weighted by the light and the observer as ViewingConditions says; those at uneven
    wavelengths are first read linearly in steps of 5 nm, and beyond their ends the value there
    holds. XYZ under another white are adapted by linear Bradford. A single value is taken as
    neutral: the same at all wavelengths. RGB is taken as linear, with the primaries and the white
    of sRGB (IEC 61966-2-1). All but the first are remarked on.

    Raises MeasurementError where the spectra do not cover 400..700 nm, or have steps wider than
    40 nm.
    """
    if measurements.kind is Kind.XYZ and _one_white(measurements, conditions):
        return measurements  # as they are: a missing X is no reason to lose Y
    if measurements.kind is Kind.XYZ:
        matrix, remark = _from_white(measurements, conditions)
    elif measurements.kind is Kind.RGB:
        matrix, remark = _from_rgb(conditions)
    elif len(measurements.wavelengths) < 2:
        matrix, remark = np.array([conditions.white]).T, "a single value: taken as neutral"
    else:
        matrix, remark = _from_spectra(measurements, conditions), ""
    return replace(
        measurements.remarked(*([remark] if remark else [])),
        values=measurements.values @ matrix.T,
        kind=Kind.XYZ,
        wavelengths=(),
        white=conditions.white,
    )


def _from_spectra(measurements: Measurements, conditions: ViewingConditions) -> Array:
    """(3, k) from spectra."""
    wavelengths = np.array(measurements.wavelengths)
    low, high = SEEN
    widest = float(np.diff(wavelengths).max())
    if wavelengths[0] > low or wavelengths[-1] < high or widest > _WIDEST:
        listed = ", ".join(f"{w:g}" for w in wavelengths[:6]) + ", ..." * (len(wavelengths) > 6)
        raise MeasurementError(
            f"{len(wavelengths)} wavelengths ({listed} nm) "
            f"make no colour: {low:g}..{high:g} nm in steps of {_WIDEST:g} nm at most are needed",
            where=measurements.name or None,
            hint="take one of them, which is then neutral: --wavelength NM",
        )
    steps = np.diff(wavelengths)
    if np.ptp(steps) < 1e-6:
        return conditions.reflectances_to_xyz(
            Grid(float(wavelengths[0]), float(wavelengths[-1]), len(wavelengths))
        )
    count = round((wavelengths[-1] - wavelengths[0]) / _STEP) + 1
    even = Grid(float(wavelengths[0]), float(wavelengths[-1]), count)
    units = np.eye(len(wavelengths))
    read = np.stack([np.interp(even.wavelengths, wavelengths, unit) for unit in units], axis=-1)
    return np.asarray(conditions.reflectances_to_xyz(even) @ read)


def _one_white(measurements: Measurements, conditions: ViewingConditions) -> bool:
    white = measurements.white or conditions.white
    return bool(np.abs(np.subtract(white, conditions.white)).max() < _SAME_WHITE)


def _from_white(measurements: Measurements, conditions: ViewingConditions) -> tuple[Array, str]:
    from brdfc.colour.adaptation import adaptation_matrix

    white = measurements.white or conditions.white
    shown = ", ".join(f"{v:.4g}" for v in white)
    return adaptation_matrix(white, conditions.white), f"adapted from the white {shown} (Bradford)"


def _from_rgb(conditions: ViewingConditions) -> tuple[Array, str]:
    from brdfc.colour.adaptation import adaptation_matrix
    from brdfc.colour.library import colour_science

    space = colour_science().RGB_COLOURSPACES["sRGB"]
    to_xyz_d65 = np.asarray(space.matrix_RGB_to_XYZ, dtype=np.float64)
    adapted = adaptation_matrix(to_xyz_d65.sum(axis=1).tolist(), conditions.white)
    return np.asarray(adapted @ to_xyz_d65), "RGB: taken as linear, with the primaries of sRGB"
