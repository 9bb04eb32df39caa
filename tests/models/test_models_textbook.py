"""The textbook formulas in two arithmetics and two geometries, and the library's examples."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from textbook import (
    NUMPY,
    PRECISE,
    TEXTBOOK,
    directions,
    plane_directions,
    precise,
)
from textbook_samples import SAMPLES, arrays, columns, somewhere

import brdfc
from brdfc.data import data_dir

# Zeniths and azimuths in degrees: the mirror's neighbourhood, behind the light, across, grazing.
POINTS = np.array(
    [[40, 45, 10, 185], [60, 35, -20, -10], [10, 70, 30, 140], [75, 80, 0, 175], [5, 3, 0, 120]]
)


def test_every_model_has_a_sample() -> None:
    assert list(SAMPLES) == list(TEXTBOOK)


@pytest.mark.parametrize("name", TEXTBOOK)
def test_both_arithmetics_agree(name: str) -> None:
    angles = np.radians(POINTS)
    values = SAMPLES[name]
    doubles = TEXTBOOK[name](NUMPY, directions(NUMPY, *columns(angles)), arrays(values))
    assert doubles.shape == (len(POINTS), 3)
    for row, point in zip(doubles, angles, strict=True):
        exact = TEXTBOOK[name](PRECISE, directions(PRECISE, *point), values)
        np.testing.assert_allclose(row, [float(x) for x in exact], rtol=1e-11)


@pytest.mark.parametrize("name", TEXTBOOK)
def test_single_precision_stays_single(name: str) -> None:
    angles, values = np.radians(POINTS), SAMPLES[name]
    where = directions(NUMPY, *columns(angles, np.float32))
    singles = TEXTBOOK[name](NUMPY, where, arrays(values, np.float32))
    assert singles.dtype == np.float32
    doubles = TEXTBOOK[name](NUMPY, directions(NUMPY, *columns(angles)), arrays(values))
    np.testing.assert_allclose(singles, doubles, rtol=2e-4)


@pytest.mark.parametrize("name", TEXTBOOK)
def test_sixty_digits_are_sixty_digits(name: str) -> None:
    """The same angles as numbers of the geometry in the plane and of the full one."""
    plane = precise(name, {"incident": "40", "reflection": "33.1"}, SAMPLES[name])
    azimuths = {"incident_azimuth": 0, "reflection_azimuth": 180}
    full = precise(name, {"incident": 40, "reflection": 33.1} | azimuths, SAMPLES[name])
    assert all(abs(a - b) <= abs(b) * mpmath.mpf("1e-50") for a, b in zip(plane, full, strict=True))


def test_decimal_and_rational_numbers_are_exact() -> None:
    third, decimal = (
        precise("lambert", {"incident": 60, "reflection": 0}, {"Rd": [rd, 0, 1]})
        for rd in ("1/3", 0.3)
    )
    assert mpmath.nstr(third[0] * PRECISE.pi, 55) == "0.1" + 53 * "6" + "7"
    assert mpmath.nstr(decimal[0] * PRECISE.pi, 55) == "0.15"


@pytest.mark.parametrize("orientation", [0.0, 0.7, -2.0])
def test_the_plane_is_a_plane_of_the_full_geometry(orientation: float) -> None:
    angles = np.random.default_rng(2).uniform(-1.5, 1.5, (1000, 2))
    around = np.full((1000, 1), orientation)
    plane = plane_directions(NUMPY, *columns(angles), around)
    full = directions(NUMPY, *columns(angles), around, around + np.pi)
    np.testing.assert_allclose(plane.light, full.light, atol=1e-15)
    np.testing.assert_allclose(plane.viewer, full.viewer, atol=1e-15)


def test_the_half_vector_without_cancellation() -> None:
    """tan^2 of the half angle and d^2, as sines and cosines of the angles only."""
    angles = somewhere(1000, 3)
    i, r, around = angles[:, 0], angles[:, 1], angles[:, 3] - angles[:, 2]
    p, q = np.cos((i + r) / 2) ** 2, np.cos((i - r) / 2) ** 2
    off = np.sin(i) * np.sin(r) * np.cos(around / 2) ** 2
    where = directions(NUMPY, *columns(angles))
    (lx, ly, lz), (vx, vy, vz) = where.light, where.viewer
    tan2 = ((lx + vx) ** 2 + (ly + vy) ** 2) / (lz + vz) ** 2
    np.testing.assert_allclose(np.tan((i - r) / 2) ** 2 + off / (p * q), tan2[:, 0], rtol=1e-9)
    d2 = ((lx + vx) ** 2 + (ly + vy) ** 2 + (lz + vz) ** 2) / 4
    np.testing.assert_allclose(p + off, d2[:, 0], rtol=1e-9)


@pytest.mark.parametrize("name", TEXTBOOK)
def test_beneath_the_horizon_there_is_nothing(name: str) -> None:
    for point in ((91, 30, 0, 180), (30, 91, 0, 180), (91, 92, 0, 90)):
        angles = np.radians([point])
        where = directions(NUMPY, *columns(angles))
        assert (TEXTBOOK[name](NUMPY, where, arrays(SAMPLES[name])) == 0).all()
        below = directions(PRECISE, *angles[0])
        assert TEXTBOOK[name](PRECISE, below, SAMPLES[name]) == [0, 0, 0]
    assert precise(name, {"incident": 90, "reflection": 10}, SAMPLES[name]) == [0, 0, 0]


@pytest.mark.parametrize(
    "name", [name for name in TEXTBOOK if (data_dir("models") / f"{name}.brdf").is_file()]
)
def test_the_library_states_these_values(name: str) -> None:
    """The examples in the library's files, evaluated here."""
    model = brdfc.load(name)
    geometry = {q.name for q in model.quantities if q.type.is_angle}
    for example in model.examples:
        channels = {
            k: example.given[k] if len(example.given[k]) > 1 else example.given[k][0]
            for k in SAMPLES[name]
        }
        angles = {k: round(math.degrees(example.given[k][0]), 10) for k in geometry}
        intensity = example.given["intensity"][0]
        radiance = precise(name, {"reflection": 0} | angles, channels)
        wanted = example.result * 3 if len(example.result) == 1 else example.result
        for value, stated in zip(radiance, wanted, strict=True):
            assert value * intensity == pytest.approx(stated, rel=example.within, abs=1e-300)
