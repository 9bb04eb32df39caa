"""Measurements that are generated, not measured: a diffuse surface with a highlight, in XYZ, in
spectra, or as one value."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from brdfc.fit.measurements import Kind, Measurements, checked

Array = NDArray[np.float64]
WAVELENGTHS = tuple(float(w) for w in range(400, 701, 20))


def reflected(directions: Array) -> Array:
    """(n,) 1/sr: reciprocal."""
    incident, reflection, light, viewer = directions.T
    # The length of the sum of both directions, laid flat: 0 where one mirrors the other.
    along = 2 * incident * reflection * np.cos(viewer - light)
    apart = np.sqrt(np.maximum(incident**2 + reflection**2 + along, 0))
    return 0.1 + np.exp(-((apart / 0.2) ** 2)) * (incident + reflection + 1)


def grid(degrees: list[float] | None = None) -> Array:
    """(n, 4) radians: zeniths, azimuths of 0 for light, and of every 45 degrees for the viewer."""
    zeniths = degrees or [10.0, 30.0, 45.0, 60.0]
    rows = [(i, r, 0.0, a) for i in zeniths for r in zeniths for a in (-135, -90, 0, 45, 180)]
    return np.radians(np.array(rows))


def generated(kind: Kind = Kind.XYZ, wavelengths: tuple[float, ...] = WAVELENGTHS) -> Measurements:
    directions = grid()
    columns = 3 if kind is not Kind.SPECTRAL else len(wavelengths) or 1
    values = reflected(directions)[:, None] * np.linspace(0.5, 1.5, columns)
    spectral = wavelengths if kind is Kind.SPECTRAL else ()
    return checked(directions, values, kind, wavelengths=spectral, name="generated")


def degrees_of(directions: Array) -> Array:
    return directions * (180 / math.pi)


def same(a: Measurements, b: Measurements, close: float = 0.0) -> None:
    """The measurements are equal, but for remarks and names."""
    assert a.kind is b.kind
    assert a.wavelengths == b.wavelengths
    assert a.white == b.white
    for one, other in (
        (a.directions, b.directions),
        (a.values, b.values),
        (a.weights, b.weights),
    ):
        np.testing.assert_allclose(one, other, rtol=close, atol=close)
