"""Images of coefficients through a link: layouts, bands, and every way an image can be wrong."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import tifffile

import brdfc
from brdfc.images import tiff
from brdfc.images.apply import apply_to_tiff
from brdfc.source.errors import BrdfcError, ImageError


@pytest.fixture(scope="module")
def rendering() -> brdfc.Rendering:
    compiled = brdfc.compile(brdfc.load("ward"))
    env = {"incident": 0.7, "reflection": 0.5}
    return brdfc.rendering(brdfc.connect(compiled.mid, compiled.mvis, env=env))


def coefficients(height: int = 23, width: int = 17) -> np.ndarray:
    random = np.random.default_rng(3)
    image = random.uniform(0, 1, (height, width, 5)).astype(np.float32)
    image[..., 4] = random.uniform(0.05, 0.5, (height, width))
    return image


def write(path: Path, image: np.ndarray, **options: object) -> Path:
    layout = {"photometric": "minisblack", "planarconfig": "contig", **options}
    data = np.moveaxis(image, -1, 0) if layout["planarconfig"] == "separate" else image
    tifffile.imwrite(path, data, **layout)
    return path


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"planarconfig": "separate"},
        {"byteorder": ">"},
        {"rowsperstrip": 4},
        {"tile": (16, 16)},
        {"compression": "zlib"},
        {"bigtiff": True},
    ],
    ids=str,
)
def test_every_layout_gives_the_same_colours(
    options: dict[str, object], rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    image = coefficients()
    source = write(tmp_path / "in.tif", image, **options)
    done = apply_to_tiff(rendering, source, tmp_path / "out.tif", "XYZ")
    assert done.pixels == 23 * 17
    assert done.outside == {}
    np.testing.assert_array_equal(tifffile.imread(tmp_path / "out.tif"), rendering.apply(image))


def test_bands_do_not_show(
    rendering: brdfc.Rendering, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    image = coefficients(height=31)
    source = write(tmp_path / "in.tif", image)
    monkeypatch.setattr(tiff, "BAND_PIXELS", 17 * 4)
    seen: list[tuple[int, int]] = []
    apply_to_tiff(rendering, source, tmp_path / "out.tif", "XYZ", lambda *at: seen.append(at))
    np.testing.assert_array_equal(tifffile.imread(tmp_path / "out.tif"), rendering.apply(image))
    assert seen == [(4, 31), (8, 31), (12, 31), (16, 31), (20, 31), (24, 31), (28, 31), (31, 31)]


def test_the_output_is_the_same_every_time_and_says_what_it_is(
    rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    source = write(tmp_path / "in.tif", coefficients())
    for name in ("a.tif", "b.tif"):
        apply_to_tiff(rendering, source, tmp_path / name, "incident=40deg")
    assert (tmp_path / "a.tif").read_bytes() == (tmp_path / "b.tif").read_bytes()
    with tifffile.TiffFile(tmp_path / "a.tif") as written:
        page = written.pages[0]
        assert page.shape == (23, 17, 3)
        assert page.dtype == np.float32
        assert page.description == "XYZ, Y = 1 for white; incident=40deg"


def test_samples_outside_the_declared_range_are_counted(
    rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    image = coefficients()
    image[0, :3, 4] = 0
    image[1, 0, 0] = 1.5
    done = apply_to_tiff(rendering, write(tmp_path / "in.tif", image), tmp_path / "out.tif", "XYZ")
    assert done.outside == {"Rd": 1, "m": 3}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda image: image[..., :4], "4 samples a pixel, the profile takes 5: Rdx, Rdy, Rdz"),
        (lambda image: image.astype(np.uint16), "samples are uint16; 32-bit floats"),
        (lambda image: image.astype(np.float16), "samples are float16"),
        (lambda image: image.astype(np.float64), "samples are float64"),
    ],
)
def test_images_that_do_not_fit_are_refused(
    change, message: str, rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    source = write(tmp_path / "in.tif", change(coefficients()))
    with pytest.raises(ImageError, match=message):
        apply_to_tiff(rendering, source, tmp_path / "out.tif", "XYZ")
    assert [p.name for p in tmp_path.iterdir()] == ["in.tif"]


def test_rows_written_as_pages_get_a_hint(rendering: brdfc.Rendering, tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "in.tif", coefficients(), photometric="minisblack")
    with pytest.raises(ImageError, match="the file holds 23 images") as raised:
        apply_to_tiff(rendering, tmp_path / "in.tif", tmp_path / "out.tif", "XYZ")
    assert 'planarconfig="contig"' in str(raised.value)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_samples_that_are_no_numbers_are_counted_and_nothing_is_written(
    bad: float, rendering: brdfc.Rendering, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tiff, "BAND_PIXELS", 17 * 5)
    image = coefficients()
    image[7, 3, 1] = bad
    image[20, :, 4] = bad
    source = write(tmp_path / "in.tif", image)
    with pytest.raises(ImageError) as raised:
        apply_to_tiff(rendering, source, tmp_path / "out.tif", "XYZ")
    message = "18 of 1,955 samples are NaN or infinite, the first at row 7, column 3, 'Rdy'"
    assert message in str(raised.value)
    assert [p.name for p in tmp_path.iterdir()] == ["in.tif"]


def test_what_is_no_tiff_is_refused(rendering: brdfc.Rendering, tmp_path: Path) -> None:
    good = write(tmp_path / "good.tif", coefficients()).read_bytes()
    contents = {
        "missing.tif": None,
        "empty.tif": b"",
        "text.tif": b"hello" * 100,
        "header.tif": good[:8],
        "cut.tif": good[: len(good) // 2],
        "loop.tif": b"II*\0\x08\0\0\0" + b"\x00\x00\x08\0\0\0",
    }
    for name, content in contents.items():
        path = tmp_path / name
        if content is not None:
            path.write_bytes(content)
        with pytest.raises(ImageError) as raised:
            apply_to_tiff(rendering, path, tmp_path / "out.tif", "XYZ")
        assert str(path) in str(raised.value)
        assert not (tmp_path / "out.tif").exists()


def test_the_input_is_never_its_own_output(rendering: brdfc.Rendering, tmp_path: Path) -> None:
    source = write(tmp_path / "in.tif", coefficients())
    before = source.read_bytes()
    with pytest.raises(BrdfcError, match="would replace an input"):
        apply_to_tiff(rendering, source, tmp_path / "." / "in.tif", "XYZ")
    assert source.read_bytes() == before


def test_an_interruption_leaves_no_file(rendering: brdfc.Rendering, tmp_path: Path) -> None:
    source = write(tmp_path / "in.tif", coefficients())

    def interrupted(_done: int, _total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        apply_to_tiff(rendering, source, tmp_path / "out.tif", "XYZ", interrupted)
    assert [p.name for p in tmp_path.iterdir()] == ["in.tif"]
