"""MERL's binary tables of isotropic materials (W. Matusik and others, SIGGRAPH 2003).

Three 32-bit integers, 90, 90, 180, then for red, green and blue a double in every cell of
half-angle theta_h, difference angle theta_d and its azimuth phi_d, little-endian, theta_h slowest.
theta_h goes as the square of its index, so that highlights are resolved; phi_d is 0..180 degrees,
as reciprocity makes the rest the same. Values times (1, 1.15, 1.66)/1500 are BRDF in 1/sr of linear
RGB; those below 0 are missing. The coordinates are S. Rusinkiewicz's (EGWR 1998).

A million and a half cells are more than a fit needs; a subset of directions is drawn:

    plane   in the plane of incidence: zeniths 5, 10, ..., 85 degrees, and reflections where the
            table has its half-angles, so that they are dense about the mirror direction
    even    so many cells (--count, 4000), evenly spread over the table's own coordinates
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.fit.declared import Declared
from brdfc.fit.measurements import MOST_ROWS, RIGHT, Kind, Measurements, checked
from brdfc.fit.units import chosen
from brdfc.source.errors import MeasurementError

Array = NDArray[np.float64]

SHAPE = (90, 90, 180)
"""Cells of theta_h, theta_d, phi_d."""
CELLS = math.prod(SHAPE)
SCALES = np.array([1.0, 1.15, 1.66]) / 1500
_HEADER = np.array(SHAPE, "<i4").tobytes()
SIZE = len(_HEADER) + 3 * CELLS * 8

SUBSETS = {"plane": None, "even": None}
_COUNT = 4000
_STEEPEST = math.radians(85)
"""The measurements hardly go beyond: cells there were filled in."""


def recognises(head: bytes) -> bool:
    """Whether it begins with the numbers of cells."""
    return head.startswith(_HEADER)


def read(path: Path, said: Declared) -> Measurements:
    """Measurements of a subset of directions, 0 azimuth of incidence. Raises MeasurementError."""
    where = str(path)
    subset = chosen(said.directions or "plane", SUBSETS, "subset of directions", where)
    count = _COUNT if said.count is None else said.count
    if not 0 < count <= MOST_ROWS:
        raise MeasurementError(f"1 to {MOST_ROWS:,} directions can be drawn, not {count:,}")
    cells = _mapped(path)
    directions = _in_plane() if subset == "plane" else _evenly(count)
    values = np.asarray(cells[:, indices(directions)], dtype=np.float64).T * SCALES
    # A cell is missing where any colour is: the others were measured through the same hole.
    missing = (values < 0).any(axis=1) | np.isnan(values).any(axis=1)
    values[missing] = np.nan
    return checked(
        directions,
        values,
        Kind.RGB,
        name=path.stem,
        remarks=[f"a subset of MERL's {CELLS:,} cells: {subset}"],
        where=where,
    )


def _mapped(path: Path) -> Any:
    """(3, cells), read as they are used."""
    try:
        size = path.stat().st_size
        with path.open("rb") as stream:
            header = stream.read(len(_HEADER))
    except OSError as error:
        raise MeasurementError(f"cannot be read: {error.strerror}", where=str(path)) from error
    if header != _HEADER or size != SIZE:
        numbers = np.frombuffer(header[: len(header) // 4 * 4], "<i4").tolist()
        raise MeasurementError(
            f"its header is {numbers} and its size {size:,} bytes; MERL's isotropic tables have "
            f"{list(SHAPE)} and {SIZE:,}",
            where=str(path),
            hint="the file may be cut short, or be of another kind",
        )
    return np.memmap(path, "<f8", "r", offset=len(_HEADER), shape=(3, CELLS))


def indices(directions: Array) -> NDArray[np.intp]:
    """The cell of each direction (n, 4), as MERL's own reader finds it."""
    light, viewer = (_vector(directions[:, i], directions[:, i + 2]) for i in (0, 1))
    half = light + viewer
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    across = np.hypot(half[:, 0], half[:, 1])
    theta_h, phi_h = np.arctan2(across, half[:, 2]), np.arctan2(half[:, 1], half[:, 0])
    # The light as seen from the half vector: turned by -phi_h about z, then by -theta_h about y.
    x = np.cos(phi_h) * light[:, 0] + np.sin(phi_h) * light[:, 1]
    y = np.cos(phi_h) * light[:, 1] - np.sin(phi_h) * light[:, 0]
    z = light[:, 2]
    x, z = np.cos(theta_h) * x - np.sin(theta_h) * z, np.sin(theta_h) * x + np.cos(theta_h) * z
    theta_d = np.arctan2(np.hypot(x, y), z)
    phi_d = np.remainder(np.arctan2(y, x) + _TINY, math.pi)
    shares = np.sqrt(theta_h / RIGHT), theta_d / RIGHT, phi_d / math.pi
    h, d, p = (
        np.minimum((share * cells + _TINY).astype(np.intp), cells - 1)
        for share, cells in zip(shares, SHAPE, strict=True)
    )
    return np.asarray((h * SHAPE[1] + d) * SHAPE[2] + p)


_TINY = 1e-9
"""What is on the edge of a cell, but for rounding, is in it."""


def _in_plane() -> Array:
    incident = np.radians(np.arange(5.0, 86.0, 5.0))
    halves = ((np.arange(SHAPE[0]) + 0.5) / SHAPE[0]) ** 2 * RIGHT
    offsets = np.concatenate([-2 * halves[::-1], 2 * halves])
    light = np.repeat(incident, len(offsets))
    signed = light + np.tile(offsets, len(incident))
    kept = np.abs(signed) <= _STEEPEST
    light, signed = light[kept], signed[kept]
    azimuth = np.where(signed >= 0, math.pi, 0.0)
    return np.stack([light, np.abs(signed), np.zeros_like(light), azimuth], axis=1)


def _evenly(count: int) -> Array:
    """Directions at the middles of cells, by M. Roberts' sequence in three dimensions (2018)."""
    generalised_golden = 1.2207440846057596  # x^4 = x + 1
    found: list[Array] = []
    total = start = 0
    while total < count:
        places = np.arange(start + 1, start + 1 + 2 * count)[:, None]
        shares = (0.5 + places / generalised_golden ** np.arange(1, 4)) % 1.0
        drawn = _from_cells(np.floor(shares * SHAPE))
        drawn = drawn[(drawn[:, :2] <= _STEEPEST).all(axis=1)]
        found.append(drawn)
        total, start = total + len(drawn), start + 2 * count
    return np.concatenate(found)[:count]


def _from_cells(cells: Array) -> Array:
    """(n, 4) directions at the middles of cells (n, 3) of theta_h, theta_d, phi_d."""
    share_h, share_d, share_p = ((cells + 0.5) / SHAPE).T
    theta_h, theta_d, phi_d = share_h**2 * RIGHT, share_d * RIGHT, share_p * math.pi
    half = _vector(theta_h, np.zeros_like(theta_h))
    x, y, z = _vector(theta_d, phi_d).T
    cosine, sine = np.cos(theta_h), np.sin(theta_h)
    light = np.stack([cosine * x + sine * z, y, cosine * z - sine * x], axis=1)
    viewer = 2 * (half * light).sum(axis=1, keepdims=True) * half - light
    (ti, pi_), (tr, pr) = (
        (np.arctan2(np.hypot(v[:, 0], v[:, 1]), v[:, 2]), np.arctan2(v[:, 1], v[:, 0]))
        for v in (light, viewer)
    )
    turned = np.remainder(pr - pi_ + math.pi, 2 * math.pi) - math.pi
    return np.stack([ti, tr, np.zeros_like(ti), turned], axis=1)


def _vector(zenith: Array, azimuth: Array) -> Array:
    across = np.sin(zenith)
    return np.stack([across * np.cos(azimuth), across * np.sin(azimuth), np.cos(zenith)], axis=1)
