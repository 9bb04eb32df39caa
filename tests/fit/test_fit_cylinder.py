"""Photographs of a cylinder: their geometry, and what is measured from rendered ones."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import tifffile
from photographed import (
    CAMERA,
    FOCAL,
    HEIGHT,
    LIGHT,
    MATRIX,
    RADIUS,
    WIDTH,
    angles_by_rays,
    edges,
    model_brdf,
    photograph,
)

from brdfc.colour.conditions import viewing_conditions
from brdfc.fit.calibration import White
from brdfc.fit.camera import matrix_from_sensitivities, matrix_of
from brdfc.fit.cylinder import Setup, pixels_from_edges, seen
from brdfc.fit.exposures import Region
from brdfc.fit.measurements import Kind, Measurements
from brdfc.fit.photographs import Photograph, Session, measure
from brdfc.source.errors import BrdfcError, ImageError, MeasurementError

ANGLE = math.radians(40)
SETUP = Setup(RADIUS, CAMERA, LIGHT, ANGLE)
PIXELS = pixels_from_edges(SETUP, *edges(), HEIGHT / 2)
WHITE_RGB = tuple(float(v) for v in np.linalg.inv(MATRIX) @ np.ones(3))


def session(white: float, /, **more: object) -> Session:
    values = tuple(v * white for v in WHITE_RGB)
    whole = Session(SETUP, PIXELS, White(values), matrix=MATRIX)
    return replace(whole, **more)  # type: ignore[arg-type]


def error(m: Measurements) -> np.ndarray:
    """Relative to the model, in each direction."""
    return m.values / model_brdf(m.directions) - 1


def test_edges_give_the_focal_length() -> None:
    assert pytest.approx(FOCAL, rel=1e-12) == PIXELS.focal
    assert PIXELS.axis == WIDTH / 2


@pytest.mark.parametrize("angle", [-70, 0, 25, 90])
def test_angles_are_those_of_rays(angle: float) -> None:
    columns, rows = np.arange(WIDTH) + 0.5, np.array([0.5, HEIGHT / 2, HEIGHT * 3.0])
    expected, distance = angles_by_rays(math.radians(angle), columns, rows)
    at = seen(replace(SETUP, light_angle=math.radians(angle)), PIXELS, columns, rows[:, None])
    beside = np.isnan(expected[..., 0])
    assert (np.isnan(at.directions[..., 0]) == beside).all()
    assert beside.any()
    apart = at.directions - expected
    apart[..., 2:] = np.remainder(apart[..., 2:] + math.pi, 2 * math.pi) - math.pi
    # Where a direction is the normal it has no azimuth; as elsewhere, it is what it adds sideways.
    apart[..., 2:] *= np.sin(expected[..., :2])
    assert np.nanmax(np.abs(apart)) < 1e-6
    np.testing.assert_allclose(at.light_distance[~beside], distance[~beside], rtol=1e-12)


def test_the_middle_and_the_mirror() -> None:
    """Seen along the normal the incidence is about the light's angle; halfway, it is mirrored."""
    middle = seen(SETUP, PIXELS, np.array([WIDTH / 2]), np.array([HEIGHT / 2]))
    incident, reflection = middle.directions[0, :2]
    assert reflection == pytest.approx(0, abs=1e-12)
    expected = math.atan2(LIGHT * math.sin(ANGLE), LIGHT * math.cos(ANGLE) - RADIUS)
    assert incident == pytest.approx(expected, abs=1e-12)
    columns = np.linspace(WIDTH / 2, WIDTH / 2 + 160, 100001)
    directions = seen(SETUP, PIXELS, columns, np.array([HEIGHT / 2])).directions
    at = np.argmin(np.abs(directions[:, 0] - directions[:, 1]))
    assert directions[at, 0] == pytest.approx(ANGLE / 2, rel=0.1)
    assert abs(directions[at, 2] - directions[at, 3]) == pytest.approx(math.pi)


def test_irradiance_is_inverse_square_and_cosine() -> None:
    at = seen(SETUP, PIXELS, np.arange(WIDTH) + 0.5, np.array([HEIGHT / 2]))
    shadow = at.directions[:, 0] > math.pi / 2
    assert shadow.any()
    assert (at.irradiance[shadow] == 0).all()
    lit = at.directions[:, 0] < 1
    expected = np.cos(at.directions[lit, 0]) / at.light_distance[lit] ** 2
    np.testing.assert_allclose(at.irradiance[lit], expected, rtol=1e-12)


def test_floats_give_the_model_back(tmp_path: Path) -> None:
    photograph(tmp_path / "a.tif", ANGLE, 0.2, integers=False)
    m = measure([Photograph(tmp_path / "a.tif", ANGLE)], session(0.2, clip=100.0), "a")
    assert m.kind is Kind.XYZ
    assert m.white == pytest.approx((1, 1, 1))
    assert len(m) > 150
    assert np.abs(error(m)).max() < 1e-3  # over the rows the incidence changes a little
    one_row = session(0.2, clip=100.0, rows=(HEIGHT // 2, HEIGHT // 2 + 1))
    m = measure([Photograph(tmp_path / "a.tif", ANGLE)], one_row, "a")
    assert np.abs(error(m)).max() < 2e-6  # float32
    assert np.degrees(m.directions[:, :2].max()) < 85


def test_noise_dust_and_sixteen_bits(tmp_path: Path) -> None:
    photograph(tmp_path / "a.tif", ANGLE, 12000.0, noise=0.01, dust=100)
    m = measure([Photograph(tmp_path / "a.tif", ANGLE)], session(12000.0))
    directions = m.directions
    # The noise of a mean of 24 rows, from that of the photons of each.
    light = np.cos(directions[:, 0])[:, None]
    relative = 0.01 / np.sqrt(model_brdf(directions) * math.pi * light) / math.sqrt(HEIGHT)
    standard = error(m) / (2 * relative)
    assert 0.2 < standard.std() < 1.5
    assert abs(np.median(error(m))) < 0.002
    assert any("far from their column's median" in remark for remark in m.remarks)


def test_exposures_are_merged(tmp_path: Path) -> None:
    """What clips in one exposure comes from a shorter, and the noise of both is less."""
    white = 50000.0
    for name, exposure in (("long", 1.0), ("short", 0.05)):
        path = tmp_path / f"{name}.tif"
        photograph(path, ANGLE, white, exposure=exposure, noise=0.005)
    long = Photograph(tmp_path / "long.tif", ANGLE)
    short = Photograph(tmp_path / "short.tif", ANGLE, 0.05)
    alone = measure([long], session(white))
    both = measure([long, short], session(white))
    assert any("clipped in all exposures" in remark for remark in alone.remarks)
    assert not any("clipped" in remark for remark in both.remarks)
    assert len(both) > len(alone)
    assert np.abs(error(both)).max() < 0.05
    darkest = both.values.max(axis=1) < np.median(both.values.max(axis=1))
    only = measure([short], session(white))
    assert error(both)[darkest].std() < error(only)[darkest].std() / 2


def test_light_angles_go_into_one_table(tmp_path: Path) -> None:
    photographs = []
    for angle in (-40, 10, 60):
        path = tmp_path / f"{angle}.tif"
        photograph(path, math.radians(angle), 10000.0)
        photographs.append(Photograph(path, math.radians(angle)))
    m = measure(photographs, session(10000.0))
    assert len(m) == sum(len(measure([p], session(10000.0))) for p in photographs)
    assert np.abs(error(m)).max() < 0.02
    zenith = np.degrees(m.directions[:, 0])
    assert zenith.min() < 1
    assert zenith.max() > 80


@pytest.mark.parametrize("reflectance", [1.0, 0.5])
def test_a_white_region_calibrates(reflectance: float, tmp_path: Path) -> None:
    photograph(tmp_path / "a.tif", ANGLE, 8000.0, patch=(260, 280))
    white = White(region=Region(262, 2, 278, HEIGHT - 2), reflectance=reflectance)
    m = measure([Photograph(tmp_path / "a.tif", ANGLE)], session(1.0, white=white))
    clear = np.abs(m.values - reflectance / math.pi).max(axis=1) > 0.01
    np.testing.assert_allclose(
        m.values[clear], model_brdf(m.directions[clear]) * reflectance, rtol=0.01
    )


def test_grey_and_rgb_without_a_matrix(tmp_path: Path) -> None:
    photograph(tmp_path / "a.tif", ANGLE, 8000.0)
    rgb = measure([Photograph(tmp_path / "a.tif", ANGLE)], session(8000.0, matrix=None))
    assert rgb.kind is Kind.RGB
    grey = tifffile.imread(tmp_path / "a.tif")[..., 1]
    tifffile.imwrite(tmp_path / "g.tif", grey, photometric="minisblack")
    white = White((WHITE_RGB[1] * 8000,))
    one = measure([Photograph(tmp_path / "g.tif", ANGLE)], session(1.0, white=white))
    assert one.kind is Kind.SPECTRAL
    np.testing.assert_allclose(one.values[:, 0], rgb.values[:, 1], rtol=1e-3)


def bad(tmp_path: Path, **more: object) -> None:
    photograph(tmp_path / "a.tif", ANGLE, 8000.0)
    measure([Photograph(tmp_path / "a.tif", ANGLE)], session(8000.0, **more))


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"rows": (5, 5)}, "rows 5,5"),
        ({"rows": (0, 1000)}, "not within the image's 24"),
        ({"clip": 0.0}, "no column is lit"),
        ({"white": White((1.0, 2.0))}, "3 values above 0"),
        ({"white": White((0.0,))}, "values above 0"),
        ({"white": White(region=Region(0, 0, 9999, 5))}, "not within the image's 400 x 24"),
        ({"white": White(region=Region(0, 0, 20, 5))}, "lit in no photograph"),
        ({"matrix": -MATRIX}, "the matrix makes X, Y, Z"),
    ],
)
def test_sessions_that_cannot_be(more: dict[str, object], said: str, tmp_path: Path) -> None:
    with pytest.raises(MeasurementError, match=said):
        bad(tmp_path, **more)


def test_photographs_that_cannot_be(tmp_path: Path) -> None:
    photograph(tmp_path / "a.tif", ANGLE, 8000.0)
    path = tmp_path / "b.tif"
    with pytest.raises(MeasurementError, match="exposure of 0"):
        measure([Photograph(tmp_path / "a.tif", ANGLE, 0.0)], session(1.0))
    for image, said in (
        (np.zeros((24, 401, 3), np.uint16), "those of the others"),
        (np.zeros((24, 400, 2), np.uint16), "2 samples a pixel"),
        (np.zeros((24, 400, 3), np.uint8), "16-bit integers or 32-bit floats are needed"),
    ):
        tifffile.imwrite(path, image, photometric="minisblack", planarconfig="contig")
        for angle in (ANGLE, 0.1):
            both = [Photograph(tmp_path / "a.tif", ANGLE), Photograph(path, angle)]
            with pytest.raises((MeasurementError, ImageError), match=said):
                measure(both, session(1.0))


@pytest.mark.parametrize(
    ("numbers", "said"),
    [
        ((0.0, 700, 500, 0), "finite numbers"),
        ((27.0, 20, 500, 0), "the camera at 20"),
        ((27.0, 700, 27, 0), "the light at 27"),
        ((27.0, 700, 500, 40), "degrees is beyond 180"),
        ((27.0, math.nan, 500, 0), "finite numbers"),
    ],
)
def test_setups_that_cannot_be(numbers: tuple[float, ...], said: str) -> None:
    with pytest.raises(MeasurementError, match=said):
        Setup(*numbers)
    with pytest.raises(MeasurementError, match="LEFT,RIGHT"):
        pixels_from_edges(SETUP, 10, 10, 0)


def test_the_matrix_of_a_camera_that_sees_as_the_observer_does(tmp_path: Path) -> None:
    conditions = viewing_conditions("A")
    camera = np.linalg.inv(MATRIX) @ conditions.matching
    camera = np.maximum(camera, 0) + 0.0
    inside = conditions.matching.copy()
    table = np.column_stack([conditions.grid.wavelengths, inside.T])
    np.savetxt(tmp_path / "eye.csv", table, delimiter=",", fmt="%.17g")
    found, missed = matrix_from_sensitivities(tmp_path / "eye.csv", conditions)
    np.testing.assert_allclose(found, np.eye(3), atol=1e-9)
    assert missed < 1e-9
    table[:, 1:] = camera.T
    np.savetxt(tmp_path / "camera.csv", table, delimiter=",", fmt="%.17g")
    found, missed = matrix_from_sensitivities(tmp_path / "camera.csv", conditions)
    assert 0 < missed < 0.3
    table[:, 2] = table[:, 1]
    np.savetxt(tmp_path / "same.csv", table, delimiter=",", fmt="%.17g")
    with pytest.raises(MeasurementError, match="are the same"):
        matrix_from_sensitivities(tmp_path / "same.csv", conditions)


def test_matrices_given(tmp_path: Path) -> None:
    text = "1,2,3, 4,5,6, 7,8,10"
    (tmp_path / "m.txt").write_text("# a matrix\n1 2 3\n4 5 6\n7 8 10\n")
    np.testing.assert_array_equal(matrix_of(text), matrix_of(str(tmp_path / "m.txt")))
    for wrong in ("1,2,3,4,5,6,7,8,x", "1,2,3,4,5,6,7,8,9", str(tmp_path / "none.txt")):
        with pytest.raises(BrdfcError):
            matrix_of(wrong)
