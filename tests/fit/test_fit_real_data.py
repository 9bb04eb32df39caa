"""Real measurements, which lie beside the checkout; nothing of them is in the project."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from brdfc.fit.formats import read_measurements
from brdfc.fit.measurements import Kind
from brdfc.fit.summary import lines, reciprocity
from brdfc.source.errors import MeasurementError

DATA = Path(__file__).resolve().parents[3] / "shared" / "data"
pytestmark = pytest.mark.skipif(not DATA.exists(), reason=f"no measurements at {DATA}")


@pytest.mark.parametrize("name", ["garnet_red", "acryl_blue", "mystique"])
def test_cornell(name: str) -> None:
    m = read_measurements(DATA / "cornell" / f"{name}.brdf")
    assert (len(m), len(m.wavelengths), int(m.in_plane.sum())) == (1439, 31, 125)
    forward = m.in_plane & (m.azimuth_differences > 3)
    assert forward.sum() == 72
    np.testing.assert_allclose(np.degrees(m.incidences), np.arange(10, 81, 10), atol=0.01)
    # The greatest value is near the mirror direction.
    peak = m.directions[np.argmax(m.values.mean(axis=1))]
    assert abs(peak[0] - peak[1]) < np.radians(12)


def test_nist() -> None:
    m = read_measurements(DATA / "nist_ptfe" / "PTFE.data.csv")
    assert (len(m), m.wavelengths) == (1824, (351.0, 532.0, 633.0, 1064.0))
    green = read_measurements(DATA / "nist_ptfe" / "PTFE.data.csv", wavelength=532)
    assert (round(green.values.min(), 3), round(green.values.max(), 3)) == (0.243, 0.662)
    greatest = np.argmax(green.values[:, 0])
    assert green.azimuth_differences[greatest] > np.radians(150)


@pytest.mark.parametrize(
    ("name", "rows", "wavelengths", "dropped", "most"),
    [
        ("starlink/chassis", 708, (532.0,), 16, 8.0e3),
        ("starlink/solar_array", 711, (532.0,), 13, 5.3e4),
        ("merl/aluminum", 1785, (), 0, 2.0e3),
    ],
)
def test_zenith_and_azimuth(
    name: str, rows: int, wavelengths: tuple[float, ...], dropped: int, most: float
) -> None:
    m = read_measurements(DATA / f"{name}_brdf.csv")
    assert (len(m), m.wavelengths, m.kind) == (rows, wavelengths, Kind.SPECTRAL)
    assert m.remarks == (
        (f"{dropped} rows are below the floor of 0.0002: left out",) * bool(dropped)
    )
    assert m.values.max() == pytest.approx(most, rel=0.02)
    peak = m.directions[np.argmax(m.values[:, 0])]
    assert abs(peak[0] - peak[1]) < np.radians(1)
    assert abs(abs(peak[2] - peak[3]) - np.pi) < 1e-9


def test_measured_aluminium_is_reciprocal() -> None:
    found = reciprocity(read_measurements(DATA / "merl" / "aluminum_brdf.csv"))
    assert found is not None
    assert found.pairs == 42
    assert found.median < 0.02


def test_published_fits_are_no_measurements() -> None:
    with pytest.raises(MeasurementError, match="published parameters"):
        read_measurements(DATA / "merl" / "ngan_ward.fit")


def test_summaries() -> None:
    text = "\n".join(lines(read_measurements(DATA / "cornell" / "garnet_red.brdf")))
    assert "31 wavelengths, 400..700 nm" in text
    assert "1,439, 125 of them in the plane" in text
