"""Images of coefficients through a link: layouts, bands, and every way an image can be wrong."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import tifffile
from coefficient_images import coefficients, left, write

import brdfc
from brdfc.images import memory
from brdfc.images.apply import apply_to_tiff
from brdfc.images.job import Choices
from brdfc.source.errors import BrdfcError, ImageError

LAYOUTS = [
    {},
    {"planarconfig": "separate"},
    {"planarconfig": "separate", "byteorder": ">", "rowsperstrip": 3},
    {"byteorder": ">"},
    {"rowsperstrip": 4},
    {"rowsperstrip": 4, "byteorder": ">"},
    {"tile": (16, 16)},
    {"tile": (32, 16), "planarconfig": "separate"},
    {"compression": "zlib"},
    {"compression": "zlib", "tile": (16, 16), "planarconfig": "separate"},
    {"compression": "zlib", "rowsperstrip": 5, "predictor": True},
    {"compression": "lzw", "rowsperstrip": 5},
    {"compression": "zstd", "tile": (16, 32)},
    {"compression": "packbits", "tile": (16, 16), "byteorder": ">"},
    {"bigtiff": True},
]
KINDS = {"float32": np.float32, "float16": np.float16, "uint16": np.uint16, "uint8": np.uint8}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("options", LAYOUTS, ids=str)
def test_every_layout_gives_the_same_colours(
    options: dict[str, object],
    kind: str,
    rendering: brdfc.Rendering,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if options.get("compression") in ("lzw", "zstd") or "predictor" in options:
        pytest.importorskip("imagecodecs")
    monkeypatch.setattr(memory, "WINDOW_PIXELS", 17 * 3)
    image = coefficients()
    choices = Choices()
    if kind == "float16":
        image = image.astype(np.float16)
    elif kind != "float32":
        most = np.iinfo(KINDS[kind]).max
        image = np.round(image * most).astype(KINDS[kind])
        choices = Choices(scale={"": (0.0, 1.0), "m": (0.125, 0.5)})
    source = write(tmp_path / "in.tif", image, **options)
    done = apply_to_tiff(rendering, source, tmp_path / "out.tif", choices=choices)
    assert done.pixels == 23 * 17
    assert done.outside == {}
    meant = image.astype(np.float64)
    if kind.startswith("uint"):
        meant[..., :4] /= most
        meant[..., 4] = 0.125 + meant[..., 4] * (0.375 / most)
    expected = rendering.apply(meant.astype(np.float32))
    written = tifffile.imread(tmp_path / "out.tif")
    if kind.startswith("uint"):  # by division here, by one factor there: the last bit may differ
        np.testing.assert_allclose(written, expected, rtol=2e-6)
    else:
        np.testing.assert_array_equal(written, expected)


def test_bands_do_not_show(
    rendering: brdfc.Rendering, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    image = coefficients(height=31)
    source = write(tmp_path / "in.tif", image)
    monkeypatch.setattr(memory, "WINDOW_PIXELS", 17 * 4)
    seen: list[tuple[int, int]] = []
    apply_to_tiff(rendering, source, tmp_path / "out.tif", "XYZ", lambda *at: seen.append(at))
    np.testing.assert_array_equal(tifffile.imread(tmp_path / "out.tif"), rendering.apply(image))
    assert seen == [(17 * row, 17 * 31) for row in (4, 8, 12, 16, 20, 24, 28, 31)]


def test_the_output_is_the_same_every_time_and_says_what_it_is(
    rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    source = write(tmp_path / "in.tif", coefficients())
    for name in ("a.tif", "b.tif"):
        apply_to_tiff(rendering, source, tmp_path / name, "a print of today")
    assert (tmp_path / "a.tif").read_bytes() == (tmp_path / "b.tif").read_bytes()
    with tifffile.TiffFile(tmp_path / "a.tif") as written:
        page = written.pages[0]
        assert page.shape == (23, 17, 3)
        assert page.dtype == np.float32
        *lines, first, profile, transform, run = page.description.split("\n")
    assert first.startswith("profile: Isotropic Ward reflectance (coefficients), ID ")
    assert lines == [
        "XYZ, Y = 1 for white",
        "white: 0.9642 1 0.8249",
        "incident=40.10704deg",
        "reflection=28.64789deg",
    ]
    assert profile.startswith("profile: Isotropic Ward reflectance (appearance), ID ")
    assert (transform, run) == ("transform: M2B0", "a print of today")


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
        (
            lambda image: image.astype(np.uint16),
            "nothing says what they mean: Rdx, Rdy, Rdz, ks, m",
        ),
        (lambda image: image.astype(np.uint32), "samples are uint32"),
        (lambda image: image.astype(np.float64), "samples are float64"),
    ],
)
def test_images_that_do_not_fit_are_refused(
    change, message: str, rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    source = write(tmp_path / "in.tif", change(coefficients()))
    with pytest.raises(ImageError, match=message):
        apply_to_tiff(rendering, source, tmp_path / "out.tif", "XYZ")
    assert left(tmp_path) == ["in.tif"]


def test_rows_written_as_pages_get_a_hint(rendering: brdfc.Rendering, tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "in.tif", coefficients(), photometric="minisblack")
    with pytest.raises(ImageError, match="the file holds 23 images") as raised:
        apply_to_tiff(rendering, tmp_path / "in.tif", tmp_path / "out.tif", "XYZ")
    assert 'planarconfig="contig"' in str(raised.value)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_samples_that_are_no_numbers_are_counted_and_nothing_is_written(
    bad: float, rendering: brdfc.Rendering, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(memory, "WINDOW_PIXELS", 17 * 5)
    image = coefficients()
    image[7, 3, 1] = bad
    image[20, :, 4] = bad
    source = write(tmp_path / "in.tif", image)
    with pytest.raises(ImageError) as raised:
        apply_to_tiff(rendering, source, tmp_path / "out.tif", "XYZ")
    message = "18 of 1,955 samples are NaN or infinite, the first at row 7, column 3, 'Rdy'"
    assert message in str(raised.value)
    assert left(tmp_path) == ["in.tif"]


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
    assert left(tmp_path) == ["in.tif"]
