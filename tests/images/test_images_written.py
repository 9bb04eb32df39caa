"""What is written: layouts, compressions, kinds of samples, pictures, and what the file says."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
import tifffile
from coefficient_images import coefficients, left, write
from PIL import Image, ImageCms

import brdfc
from brdfc.images import memory
from brdfc.images.apply import apply_to_tiff
from brdfc.images.job import Choices
from brdfc.images.memory import parse_size
from brdfc.source.errors import BrdfcError, ImageError, MissingExtraError, ValueGivenError


@pytest.mark.parametrize("tile", [0, 16, 48])
@pytest.mark.parametrize("compression", ["none", "deflate", "lzw", "zstd"])
@pytest.mark.parametrize(
    "options", [{}, {"tile": (32, 16)}, {"compression": "zlib", "rowsperstrip": 7}], ids=str
)
def test_every_way_to_write_holds_the_same(
    options: dict[str, object],
    compression: str,
    tile: int,
    rendering: brdfc.Rendering,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if compression in ("lzw", "zstd"):
        pytest.importorskip("imagecodecs")
    monkeypatch.setattr(memory, "WINDOW_PIXELS", 200)
    monkeypatch.setattr("brdfc.images.format._STRIP_BYTES", 4 * 12 * 71)
    image = coefficients(90, 71)
    source = write(tmp_path / "in.tif", image, **options)
    chosen = Choices(compression=compression, tile=tile)
    for name in ("a.tif", "b.tif"):
        apply_to_tiff(rendering, source, tmp_path / name, choices=chosen)
    assert (tmp_path / "a.tif").read_bytes() == (tmp_path / "b.tif").read_bytes()
    with tifffile.TiffFile(tmp_path / "a.tif") as written:
        page = written.pages[0]
        np.testing.assert_array_equal(page.asarray(), rendering.apply(image))
        tiled = tile or ("tile" in options and compression != "none")
        assert page.is_tiled == bool(tiled)
        names = {"none": "NONE", "deflate": "ADOBE_DEFLATE", "lzw": "LZW", "zstd": "ZSTD"}
        assert page.compression.name == names[compression]


def test_large_results_are_bigtiff(
    rendering: brdfc.Rendering, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("brdfc.images.format._LARGEST", 1000)
    image = coefficients()
    source = write(tmp_path / "in.tif", image)
    for compression in ("none", "deflate"):
        chosen = Choices(compression=compression)
        apply_to_tiff(rendering, source, tmp_path / "out.tif", choices=chosen)
        with tifffile.TiffFile(tmp_path / "out.tif") as written:
            assert written.is_bigtiff
            np.testing.assert_array_equal(written.asarray(), rendering.apply(image))


def test_sixteen_bits_are_rounded_clipped_and_counted(
    rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    image = coefficients()
    source = write(tmp_path / "in.tif", image)
    chosen = Choices(samples="uint16:0.05..0.25")
    done = apply_to_tiff(rendering, source, tmp_path / "out.tif", choices=chosen)
    exact = (rendering.apply(image).astype(np.float64) - 0.05) / 0.2 * 65535
    written = tifffile.imread(tmp_path / "out.tif")
    assert written.dtype == np.uint16
    np.testing.assert_array_equal(written, np.clip(np.rint(exact), 0, 65535))
    outside = ((exact < -0.5) | (exact > 65535.5)).any(axis=-1)
    assert 0 < done.clipped == outside.sum() < outside.size
    with tifffile.TiffFile(tmp_path / "out.tif") as tiff:
        assert "\nsamples: 0..65535 are 0.05..0.25\n" in tiff.pages[0].description


def test_pictures_have_their_profile_and_eight_or_sixteen_bits(
    rendering: brdfc.Rendering, ward: brdfc.compiled.Compiled, tmp_path: Path
) -> None:
    source = write(tmp_path / "in.tif", coefficients())
    picture = brdfc.rendering(rendering.link, "sRGB")
    for name, samples in (("8.tif", None), ("16.tif", "uint16")):
        apply_to_tiff(picture, source, tmp_path / name, choices=Choices(samples=samples))
    small, large = (tifffile.imread(tmp_path / name) for name in ("8.tif", "16.tif"))
    assert (small.dtype, large.dtype) == (np.uint8, np.uint16)
    np.testing.assert_array_equal(small, np.round(large / 257))
    with Image.open(tmp_path / "8.tif") as opened:
        assert opened.mode == "RGB"
        profile = opened.info["icc_profile"]
    assert profile[24:36] == bytes([7, 228, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0])
    told = ImageCms.getProfileDescription(ImageCms.ImageCmsProfile(io.BytesIO(profile)))
    assert "sRGB" in told


@pytest.mark.parametrize(
    ("to", "samples", "message"),
    [
        ("XYZ", "uint8", "8 bits are for pictures"),
        ("XYZ", "uint17", "'uint17' are no samples"),
        ("XYZ", "uint16:1..0", "'1..0' is no range"),
        ("XYZ", "uint16:a..b", "'a..b' is no range"),
        ("XYZ", "float32:0..1", "floats are written as they are"),
        ("Lab", "uint16", "CIELAB as integers needs the range"),
        ("sRGB", "float32", "a picture in sRGB has 8 or 16 bits"),
        ("sRGB", "uint16:0..1", "a picture in sRGB has 8 or 16 bits"),
    ],
)
def test_samples_that_make_no_sense(
    to: str, samples: str, message: str, rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    source = write(tmp_path / "in.tif", coefficients())
    chosen = brdfc.rendering(rendering.link, to)
    with pytest.raises(ValueGivenError, match=message):
        apply_to_tiff(chosen, source, tmp_path / "out.tif", choices=Choices(samples=samples))
    assert left(tmp_path) == ["in.tif"]


def test_a_missing_codec_is_named_with_its_extra(
    rendering: brdfc.Rendering, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "imagecodecs", None)
    source = write(tmp_path / "in.tif", coefficients())
    with pytest.raises(MissingExtraError, match=r"zstd needs .*\n.*brdfc\[codecs\]"):
        apply_to_tiff(rendering, source, tmp_path / "o.tif", choices=Choices(compression="zstd"))
    assert left(tmp_path) == ["in.tif"]


def test_scalings_are_for_integers_and_of_all_samples(
    rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    floats = write(tmp_path / "f.tif", coefficients())
    with pytest.raises(ImageError, match="taken as they are; --scale is for integers"):
        apply_to_tiff(rendering, floats, tmp_path / "o.tif", choices=Choices(scale={"": (0, 1)}))
    integers = write(tmp_path / "i.tif", coefficients().astype(np.uint8))
    with pytest.raises(ImageError, match="nothing says what they mean: Rdx, Rdy, Rdz, ks\nhint"):
        apply_to_tiff(rendering, integers, tmp_path / "o.tif", choices=Choices(scale={"m": (0, 1)}))


def test_tiles_and_sizes_that_cannot_be(rendering: brdfc.Rendering, tmp_path: Path) -> None:
    source = write(tmp_path / "in.tif", coefficients())
    with pytest.raises(ImageError, match="tiles of 20 pixels"):
        apply_to_tiff(rendering, source, tmp_path / "o.tif", choices=Choices(tile=20))
    assert parse_size("256MB") == 256 * 10**6
    assert parse_size("1.5GiB") == 3 * 2**29
    assert parse_size("4096") == 4096
    for text in ("0", "-1MB", "many", "1TB", "1e99", ""):
        with pytest.raises(BrdfcError, match="is no size"):
            parse_size(text)
