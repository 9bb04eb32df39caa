"""Angles from normals, a light and a camera: against unit vectors, and every way to be wrong."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import tifffile

import brdfc
from brdfc.images.angles import angles_to_tiff
from brdfc.images.directions import RIGHT, Arrangement, Faced, angles, positions
from brdfc.source.errors import BrdfcError, ImageError

RANDOM = np.random.default_rng(11)
FLAT = np.array([[0.0, 0.0, 1.0]])


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def write(path: Path, image: np.ndarray) -> Path:
    tifffile.imwrite(path, image, photometric="minisblack", planarconfig="contig")
    return path


def test_a_light_on_the_surface_lights_nothing_there() -> None:
    places = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]])
    faced = Faced()
    found = angles(np.repeat(FLAT, 2, axis=0), places, Arrangement((0, 0, 0), (0, 0, 5)), faced)
    np.testing.assert_allclose(found[:, 0], RIGHT)
    assert faced.touched == 1


def test_what_is_no_number_is_refused(tmp_path: Path) -> None:
    normals = write(tmp_path / "n.tif", np.tile(FLAT.astype(np.float32), (4, 5, 1)))
    heights = np.zeros((4, 5), np.float32)
    heights[2, 3] = np.nan
    scene = Arrangement((0, 0, 1), (0, 0, 5))
    bad = tmp_path / "z.tif"
    tifffile.imwrite(bad, heights, photometric="minisblack")
    for what in ({"heights": bad}, {"coefficients": bad}):
        with pytest.raises(ImageError, match="the first at row 2, column 3"):
            angles_to_tiff(normals, tmp_path / "a.tif", scene, **what)
    with pytest.raises(BrdfcError, match="would replace an input"):
        angles_to_tiff(normals, normals, scene)


def test_angles_are_those_between_unit_vectors() -> None:
    normals = unit(RANDOM.normal(size=(500, 3)) + np.array([0, 0, 8]))
    places = RANDOM.uniform(-1, 1, (500, 3))
    scene = Arrangement((2.0, 1.0, 4.0), (-1.0, 0.5, 5.0))
    found = angles(normals, places, scene, Faced()).astype(np.float64)
    light, viewer = unit(scene.light - places), unit(scene.camera - places)
    np.testing.assert_allclose(np.cos(found[:, 0]), (normals * light).sum(-1), atol=1e-6)
    np.testing.assert_allclose(np.cos(found[:, 1]), (normals * viewer).sum(-1), atol=1e-6)
    between = np.cos(found[:, 2] - found[:, 3])
    expected = (light * viewer).sum(-1) - np.cos(found[:, 0]) * np.cos(found[:, 1])
    sines = np.sin(found[:, 0]) * np.sin(found[:, 1])
    np.testing.assert_allclose(sines * between, expected, atol=1e-6)


def test_azimuths_are_measured_from_x() -> None:
    scene = Arrangement((1.0, 0.0, 1.0), (0.0, 1.0, 1.0), distant=True)
    found = angles(FLAT, np.zeros((1, 3)), scene, Faced())
    np.testing.assert_allclose(found[0], np.radians([45, 45, 0, 90]), atol=1e-7)


def test_a_normal_along_x_has_a_tangent_too() -> None:
    scene = Arrangement((1, 0, 1), (1, 0, 2))
    found = angles(np.array([[5.0, 0, 0]]), np.zeros((1, 3)), scene, Faced())
    assert np.isfinite(found).all()


def test_in_the_plane_the_mirror_direction_has_the_same_sign() -> None:
    """As in the library's plane geometry: light and viewer on opposite sides of the normal."""
    scene = Arrangement((1.0, 0.0, 2.0), (-1.0, 0.0, 2.0), geometry="plane", distant=True)
    faced = Faced()
    incident, reflection = angles(FLAT, np.zeros((1, 3)), scene, faced)[0]
    assert incident == pytest.approx(math.atan(0.5))
    assert reflection == pytest.approx(incident)
    assert faced.leaves_plane == pytest.approx(0)
    same_side = Arrangement((1.0, 0.0, 2.0), (1.0, 0.0, 2.0), geometry="plane", distant=True)
    incident, reflection = angles(FLAT, np.zeros((1, 3)), same_side, Faced())[0]
    assert reflection == pytest.approx(-incident)


def test_what_leaves_the_plane_is_measured() -> None:
    scene = Arrangement((1.0, 1.0, 1.0), (0.0, 0.0, 1.0), geometry="plane", distant=True)
    faced = Faced()
    angles(FLAT, np.zeros((1, 3)), scene, faced)
    assert faced.leaves_plane == pytest.approx(math.asin(1 / math.sqrt(3)))


def test_what_faces_away_is_dark_and_counted() -> None:
    normals = np.array([[0.0, 0, 1], [0, 0, -1], [1, 0, 0.1]])
    scene = Arrangement((-1.0, 0.0, 1.0), (0.0, 0.0, 1.0), distant=True)
    faced = Faced()
    found = angles(normals, np.zeros((3, 3)), scene, faced)
    assert (faced.from_light, faced.from_camera) == (2, 1)
    assert found[1, 0] == found[1, 1] == np.float32(RIGHT)
    assert math.cos(RIGHT) < 0


def test_pixels_lie_where_the_image_puts_them() -> None:
    places = positions(0, 2, 2, 4, 8.0)
    np.testing.assert_allclose(places[0, :, 0], [-3, -1, 1, 3])
    np.testing.assert_allclose(places[:, 0, 1], [1, -1])


def sphere(size: int = 48) -> tuple[np.ndarray, np.ndarray]:
    """Normals and heights of a unit sphere, and of the ground around it."""
    place = positions(0, size, size, size, 2.2)
    inside = (place[..., :2] ** 2).sum(-1) < 0.98
    height = np.sqrt(np.clip(1 - (place[..., :2] ** 2).sum(-1), 0, None))
    normals = np.where(inside[..., None], np.dstack([place[..., :2], height]), [0, 0, 1])
    return normals.astype(np.float32), np.where(inside, height, 0).astype(np.float32)


def test_a_sphere_shines_where_its_normal_halves_light_and_view(tmp_path: Path) -> None:
    """The whole way: normals to angles, angles beside coefficients, profiles, XYZ."""
    normals, heights = sphere()
    coefficients = np.empty((*heights.shape, 5), np.float32)
    coefficients[...] = (0.1, 0.1, 0.1, 0.2, 0.15)
    scene = Arrangement((3.0, 2.0, 4.0), (0.0, 0.0, 50.0), width=2.2)
    paths = [
        write(tmp_path / f"{name}.tif", image)
        for name, image in (("n", normals), ("z", heights), ("c", coefficients))
    ]
    target = tmp_path / "whole.tif"
    angles_to_tiff(paths[0], target, scene, paths[1], paths[2])
    names = ("incident", "reflection", "incident_azimuth", "reflection_azimuth")
    with tifffile.TiffFile(target) as written:
        assert written.pages[0].shape == (48, 48, 9)
        about = f"coefficients, then angles in radians: {', '.join(names)}"
        assert written.pages[0].description == about
        pixels = written.asarray()
    np.testing.assert_array_equal(pixels[..., :5], coefficients)
    made = brdfc.compile(brdfc.load("ward", "full"), channels=names, effort=1)
    assert made.roles.channel_names[5:] == names
    luminance = brdfc.connect(made.mid, made.mvis).apply(pixels)[..., 1]
    row, column = np.unravel_index(luminance.argmax(), luminance.shape)
    light = unit(np.array(scene.light) - [*normals[row, column, :2], heights[row, column]])
    halfway = unit(light + np.array([0, 0, 1]))
    assert np.degrees(np.arccos(halfway @ unit(normals[row, column]))) < 4
    assert luminance[(pixels[..., 5] >= 1.5708)].max(initial=0) == 0


@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
def test_normal_maps_of_integers(kind: type, tmp_path: Path) -> None:
    normals, _ = sphere()
    most = np.iinfo(kind).max
    integers = np.round((normals + 1) / 2 * most).astype(kind)
    scene = Arrangement((3.0, 2.0, 4.0), (0.0, 0.0, 5.0))
    found = []
    for name, image in (("f", normals), ("i", integers)):
        source = write(tmp_path / f"{name}.tif", image)
        angles_to_tiff(source, tmp_path / f"{name}_a.tif", scene)
        found.append(tifffile.imread(tmp_path / f"{name}_a.tif"))
    assert np.abs(found[0][..., :2] - found[1][..., :2]).max() < 8 / most + 1e-4


def test_bands_make_no_difference(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    normals, heights = sphere(20)
    source, raised = write(tmp_path / "n.tif", normals), write(tmp_path / "z.tif", heights)
    scene = Arrangement((3.0, 2.0, 4.0), (0.0, 0.0, 5.0))
    angles_to_tiff(source, tmp_path / "whole.tif", scene, raised)
    monkeypatch.setattr("brdfc.images.tiff.BAND_PIXELS", 60)
    seen: list[tuple[int, int]] = []
    angles_to_tiff(source, tmp_path / "bands.tif", scene, raised, None, lambda *at: seen.append(at))
    assert seen[0] == (60, 400)
    np.testing.assert_array_equal(
        tifffile.imread(tmp_path / "whole.tif"), tifffile.imread(tmp_path / "bands.tif")
    )


@pytest.mark.parametrize(
    ("normals", "message"),
    [
        (np.zeros((4, 5, 3), np.float32), "20 normals of this part have no direction"),
        (np.full((4, 5, 3), np.nan, np.float32), "row 0, column 0"),
        (np.ones((4, 5, 2), np.float32), "a normal has 3"),
        (np.ones((4, 5, 3), np.float64), "its samples are float64"),
    ],
)
def test_normals_that_are_none(normals: np.ndarray, message: str, tmp_path: Path) -> None:
    source = write(tmp_path / "n.tif", normals)
    with pytest.raises(ImageError, match=message):
        angles_to_tiff(source, tmp_path / "a.tif", Arrangement((1, 1, 1), (0, 0, 1)))
    assert not (tmp_path / "a.tif").exists()


def test_images_of_another_size_do_not_fit(tmp_path: Path) -> None:
    source = write(tmp_path / "n.tif", sphere(8)[0])
    other = write(tmp_path / "z.tif", np.zeros((8, 9), np.float32))
    scene = Arrangement((1, 1, 1), (0, 0, 1))
    with pytest.raises(ImageError, match="8 rows of 9 heights, 8 rows of 8 normals"):
        angles_to_tiff(source, tmp_path / "a.tif", scene, other)
    with pytest.raises(ImageError, match="8 rows of 9 coefficients"):
        angles_to_tiff(source, tmp_path / "a.tif", scene, None, other)
    wide = write(tmp_path / "w.tif", np.zeros((8, 8, 2), np.float32))
    with pytest.raises(ImageError, match="2 samples; a height is one"):
        angles_to_tiff(source, tmp_path / "a.tif", scene, wide)
