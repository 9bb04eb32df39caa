"""The table: what is refused, what is remarked on, what it knows of itself; its colours."""

from __future__ import annotations

import math

import numpy as np
import pytest
from generated import generated, grid, reflected

from brdfc.colour.conditions import viewing_conditions
from brdfc.fit.colours import to_xyz
from brdfc.fit.measurements import Kind, checked
from brdfc.source.errors import MeasurementError

ONE = np.radians([[45.0, 10.0, 0.0, 180.0]])


@pytest.mark.parametrize(
    ("directions", "values", "more", "said"),
    [
        (np.array([[math.nan, 0, 0, 0]]), np.ones((1, 1)), {}, "an angle is missing"),
        (ONE, np.array([[math.inf]]), {}, "infinite"),
        (ONE, np.array([[math.nan]]), {}, "no row has a value"),
        (ONE * 3, np.ones((1, 1)), {}, "no row has a value"),
        (-ONE, np.ones((1, 1)), {}, "zenith is below 0"),
        (ONE, np.ones((1, 1)), {"weights": np.array([-1.0])}, "weight"),
        (ONE, np.ones((1, 2)), {"wavelengths": (400, 400)}, "twice"),
        (ONE, np.ones((1, 1)), {"wavelengths": (0.5,)}, "0.5 nm"),
        (ONE, np.ones((2, 1)), {}, "values for"),
        (np.zeros((0, 4)), np.ones((0, 1)), {}, "no directions"),
    ],
)
def test_what_cannot_be_is_refused(directions, values, more, said) -> None:
    with pytest.raises(MeasurementError, match=said):
        checked(directions, values, Kind.SPECTRAL, where="here", **more)


def test_a_row_is_named_by_its_line() -> None:
    with pytest.raises(MeasurementError, match="f, line 17: a value that is infinite"):
        checked(ONE, np.array([[math.inf]]), Kind.SPECTRAL, where="f", lines=[17])


def test_what_is_left_out_or_odd_is_remarked_on() -> None:
    directions = np.radians([[45, 10, 0, 540], [45, 100, 0, 0], [45, 20, 0, 0], [45, 30, 0, -190]])
    values = np.array([[0.1], [0.1], [np.nan], [-0.1]])
    m = checked(directions, values, Kind.SPECTRAL)
    assert len(m) == 2
    assert [r.split(":")[0] for r in m.remarks] == [
        "1 rows are beyond 90 degrees, behind the surface",
        "1 rows have no value",
        "1 values are negative",
    ]
    assert (np.abs(m.directions[:, 2:]) <= math.pi).all()
    np.testing.assert_allclose(np.degrees(m.azimuth_differences), [180, 170])


def test_it_knows_incidences_and_the_plane() -> None:
    m = generated()
    np.testing.assert_allclose(np.degrees(m.incidences), [10, 30, 45, 60])
    assert m.in_plane.sum() == len(m) * 2 // 5
    assert len(m.selected(m.in_plane)) == m.in_plane.sum()
    with pytest.raises(MeasurementError, match="no directions are left"):
        m.selected(np.zeros(len(m), bool))


def test_columns_are_put_in_the_order_of_wavelengths() -> None:
    m = checked(ONE, np.array([[2.0, 1.0]]), Kind.SPECTRAL, wavelengths=(500, 400))
    assert m.wavelengths == (400.0, 500.0)
    assert m.values.tolist() == [[1.0, 2.0]]


def test_a_perfect_diffuser_has_the_white_over_pi() -> None:
    lamp = viewing_conditions("A")
    flat = np.full((1, 31), 1 / math.pi)
    even = tuple(float(w) for w in range(400, 701, 10))
    uneven = tuple(w + (3.0 if 400 < w < 700 and w % 20 else 0.0) for w in even)
    for wavelengths in (even, uneven, (532.0,)):
        m = checked(ONE, flat[:, : len(wavelengths)], Kind.SPECTRAL, wavelengths=wavelengths)
        np.testing.assert_allclose(to_xyz(m, lamp).values[0] * math.pi, lamp.white, rtol=1e-9)
    rgb = checked(ONE, flat[:, :3], Kind.RGB)
    np.testing.assert_allclose(to_xyz(rgb, lamp).values[0] * math.pi, lamp.white, rtol=1e-9)
    xyz = checked(ONE, flat[:, :3] * (0.95, 1, 1.09), Kind.XYZ, white=(0.95, 1, 1.09))
    adapted = to_xyz(xyz, lamp)
    np.testing.assert_allclose(adapted.values[0] * math.pi, lamp.white, rtol=1e-9)
    assert adapted.white == lamp.white
    assert "adapted" in adapted.remarks[-1]


def test_few_wavelengths_make_no_colour() -> None:
    m = generated(Kind.SPECTRAL, (351.0, 532.0, 633.0, 1064.0))
    with pytest.raises(MeasurementError, match="make no colour"):
        to_xyz(m, viewing_conditions())


def test_the_generated_surface_is_reciprocal() -> None:
    directions = grid()
    np.testing.assert_allclose(
        reflected(directions), reflected(directions[:, [1, 0, 3, 2]]), rtol=1e-9
    )
