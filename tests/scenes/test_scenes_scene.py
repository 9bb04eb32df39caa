"""Scene files: what they say, and that every mistake in one is told with its key."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import tifffile

import brdfc
from brdfc.lang.model import Model
from brdfc.scenes.ranges import Narrowed, narrowed
from brdfc.scenes.scene import Scene, read_scene
from brdfc.source.errors import BrdfcError, ImageError, SceneError

NO_WHITE = (1.0, 1.0, 1.0)


@pytest.fixture(scope="module")
def ward() -> Model:
    return brdfc.load("ward")


def scene(folder: Path, text: str) -> Scene:
    path = folder / "scene.toml"
    path.write_text(text)
    return read_scene(path)


def in_scene(folder: Path, model: Model, text: str) -> Narrowed:
    return narrowed(scene(folder, text), model, NO_WHITE)


def image(folder: Path, pixels: np.ndarray) -> None:
    tifffile.imwrite(
        folder / "c.tif", pixels.astype(np.float32), photometric="minisblack", planarconfig="contig"
    )


def test_everything_a_scene_may_say(tmp_path: Path, ward: Model) -> None:
    given = scene(
        tmp_path,
        """
        model = "ward"
        tolerance = 0.1
        output = "srgb"
        [light]
        white = [0.97, 1.0, 0.484]
        highlight = "equal"
        [variables]
        incident = "40deg"
        reflection = "-20deg..20deg"
        [channels]
        Rd = ["0.1..0.2", 0.3, "0.3..0.6"]
        ks = 0.05
        m = "0.1..0.2"
        """,
    )
    assert (given.model, given.tolerance, given.output) == ("ward", 0.1, "sRGB")
    assert given.conditions is not None
    assert given.conditions.white == (0.97, 1.0, 0.484)
    found = narrowed(given, ward, NO_WHITE)
    assert found.fixed == {"incident": pytest.approx((0.6981317,)), "ks": (0.05,)}
    assert found.ends["Rd"] == ((0.1, 0.2), (0.3, 0.3), (0.3, 0.6))
    assert found.ranges["reflection"][0].high == pytest.approx(0.3490659)


BAD = {
    "[channels\n": "not a TOML file",
    "tolerence = 1": "tolerence",
    "tolerance = 0": "tolerance",
    "tolerance = -1": "tolerance",
    "tolerance = nan": "tolerance",
    'tolerance = "much"': "tolerance",
    'output = "CMYK"': "output",
    "share = 1.5": "share",
    "share = 0.01": "share",
    "light = 5": "light",
    "[light]\nwhite = [1, 2]": "light.white",
    "[light]\nwite = [1, 1, 1]": "light.wite",
    '[light]\nilluminant = "Z9"': "light",
    '[light]\nhighlight = "blue"': "light.highlight",
    '[variables]\nincidence = "40deg"': "variables.incidence",
    "[variables]\nincident = 40": "variables.incident",
    '[variables]\nincident = "50deg..40deg"': "variables.incident",
    '[variables]\nincident = "100deg"': "variables.incident",
    '[variables]\nincident = ""': "variables.incident",
    "[variables]\nincident = true": "variables.incident",
    '[variables]\nm = "0.1..0.2"': "variables.m",
    '[channels]\nm = "0.2..0.1"': "channels.m",
    '[channels]\nm = "0..0.1"': "channels.m",
    '[channels]\nm = "nan..0.1"': "channels.m",
    '[channels]\nks = "0..1..2"': "channels.ks",
    '[channels]\nRd = ["0.1..0.2"]': "channels.Rd",
    '[channels]\nF0 = "0.1..0.2"': "channels.F0",
    "[channels]\nks = 0.1\n[constants]\nks = 0.1": "constants.ks",
    "[channels]\nfrom = 5": "channels.from",
    '[channels]\nsamples = ["ks"]': "channels.samples",
}


@pytest.mark.parametrize("text", BAD, ids=lambda t: t.replace("\n", " ")[:40])
def test_a_mistake_names_its_key(text: str, tmp_path: Path, ward: Model) -> None:
    with pytest.raises(SceneError) as caught:
        in_scene(tmp_path, ward, text)
    assert BAD[text] in str(caught.value)
    assert "scene.toml" in str(caught.value)


def test_a_scene_that_is_no_file(tmp_path: Path) -> None:
    with pytest.raises(BrdfcError):
        read_scene(tmp_path / "none.toml")
    (tmp_path / "b.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SceneError, match="no text"):
        read_scene(tmp_path / "b.toml")


FROM = '[channels]\nfrom = "c.tif"\n'


def test_ranges_are_measured_from_an_image(tmp_path: Path, ward: Model) -> None:
    pixels = np.random.default_rng(1).uniform(0.1, 0.2, (40, 50, 5))
    pixels[..., 3] = 0.05
    image(tmp_path, pixels)
    found = in_scene(tmp_path, ward, FROM + 'm = "0.1..0.4"')
    assert found.measured is not None
    assert found.measured.pixels == 2000
    assert found.fixed["ks"] == (np.float32(0.05),)
    assert found.ends["m"] == ((0.1, 0.4),)
    low, high = found.ends["Rd"][0]
    assert (low, high) == (np.float32(pixels[..., 0].min()), np.float32(pixels[..., 0].max()))


def test_angles_in_the_image_come_with_the_pixel(tmp_path: Path, ward: Model) -> None:
    image(tmp_path, np.full((4, 4, 2), 0.1) + np.linspace(0, 0.1, 16).reshape(4, 4, 1))
    found = in_scene(tmp_path, ward, FROM + 'samples = ["m", "incident"]')
    assert found.pixel == ("incident",)
    assert found.ends["incident"][0] == pytest.approx((0.1, 0.2))


def test_an_outlier_is_noticed_and_may_be_left_out(tmp_path: Path, ward: Model) -> None:
    pixels = np.random.default_rng(1).uniform(0.1, 0.2, (100, 100, 5))
    pixels[50, 50, 4] = 0.9
    image(tmp_path, pixels)
    found = in_scene(tmp_path, ward, FROM).measured
    assert found is not None
    assert found.stretched == ("m",)
    assert found.ranges[4][1] == np.float32(0.9)
    trimmed = in_scene(tmp_path, ward, "share = 0.001\n" + FROM).measured
    assert trimmed is not None
    assert trimmed.ranges[4][1] < 0.201
    assert 1 <= trimmed.outside <= 10


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_an_image_with_no_number_in_it(value: float, tmp_path: Path, ward: Model) -> None:
    pixels = np.full((8, 8, 5), 0.1)
    pixels[3, 5, 2] = value
    image(tmp_path, pixels)
    with pytest.raises(ImageError, match="row 3, column 5, channel 3"):
        in_scene(tmp_path, ward, FROM)


def test_an_image_beyond_the_model(tmp_path: Path, ward: Model) -> None:
    image(tmp_path, np.full((8, 8, 5), 1.5))
    with pytest.raises(SceneError, match="beyond the model's range"):
        in_scene(tmp_path, ward, FROM)


def test_an_image_of_other_samples(tmp_path: Path, ward: Model) -> None:
    image(tmp_path, np.full((8, 8, 4), 0.1))
    with pytest.raises(SceneError, match="4 samples a pixel; 5 are needed"):
        in_scene(tmp_path, ward, FROM)
    with pytest.raises(SceneError, match="named twice"):
        in_scene(tmp_path, ward, FROM + 'samples = ["ks", "ks", "m", "incident"]')


def test_a_constant_image_keeps_a_channel(tmp_path: Path, ward: Model) -> None:
    image(tmp_path, np.full((8, 8, 5), 0.1))
    found = in_scene(tmp_path, ward, FROM)
    assert set(found.fixed) == {"ks", "m"}
    assert found.ends["Rd"] == ((np.float32(0.1), np.float32(0.1)),) * 3
