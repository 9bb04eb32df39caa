"""Sources that are cut short, damaged, lie, or change: one message, the source as it was, and
nothing under the target's name."""

from __future__ import annotations

import os
import struct
from pathlib import Path

import numpy as np
import pytest
import tifffile
from coefficient_images import coefficients, left, write

import brdfc
from brdfc.images import memory
from brdfc.images.apply import apply_to_tiff
from brdfc.images.job import Choices
from brdfc.source.errors import ImageError

LAYOUTS = [
    {},
    {"rowsperstrip": 4},
    {"planarconfig": "separate"},
    {"tile": (16, 16)},
    {"compression": "zlib", "tile": (16, 16)},
    {"bigtiff": True, "compression": "zlib", "rowsperstrip": 3},
]


def refused(rendering: brdfc.Rendering, source: Path, match: str, **choices: object) -> None:
    """The source is refused with such a message, and left as it is; nothing is written."""
    before = source.read_bytes()
    target = source.parent / "out.tif"
    with pytest.raises(ImageError, match=match or None) as raised:
        apply_to_tiff(rendering, source, target, choices=Choices(**choices))
    assert str(source) in str(raised.value)
    assert left(source.parent) == [source.name]
    assert source.read_bytes() == before


@pytest.mark.parametrize("options", LAYOUTS, ids=str)
def test_a_file_that_is_cut_short_anywhere(
    options: dict[str, object], rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    whole = write(tmp_path / "in.tif", coefficients(), **options).read_bytes()
    for length in (*range(0, 40, 7), len(whole) // 3, len(whole) // 2, len(whole) - 1):
        (tmp_path / "in.tif").write_bytes(whole[:length])
        refused(rendering, tmp_path / "in.tif", "")


def test_samples_that_are_cut_off_are_said_to_be(
    rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    source = write(tmp_path / "in.tif", coefficients(), rowsperstrip=4)
    source.write_bytes(source.read_bytes()[:-1000])
    refused(rendering, source, "cut short: it has .* bytes, and 1 of its 6 strips lie beyond")


@pytest.mark.parametrize("compression", ["zlib", "zstd", "lzw"])
def test_a_tile_that_cannot_be_decoded_is_named(
    compression: str, rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    if compression != "zlib":
        pytest.importorskip("imagecodecs")
    source = write(tmp_path / "in.tif", coefficients(), tile=(16, 16), compression=compression)
    with tifffile.TiffFile(source) as tiff:
        offset, count = tiff.pages[0].dataoffsets[2], tiff.pages[0].databytecounts[2]
    data = bytearray(source.read_bytes())
    data[offset : offset + count] = bytes(count)
    source.write_bytes(data)
    refused(rendering, source, "the tile at row 16, column 0 cannot be decoded: ")


def test_a_checksum_that_fails_is_noticed(rendering: brdfc.Rendering, tmp_path: Path) -> None:
    source = write(tmp_path / "in.tif", coefficients(), tile=(16, 16), compression="zlib")
    with tifffile.TiffFile(source) as tiff:
        offset, count = tiff.pages[0].dataoffsets[3], tiff.pages[0].databytecounts[3]
    data = bytearray(source.read_bytes())
    data[offset + count - 1] ^= 1
    source.write_bytes(data)
    refused(rendering, source, "the tile at row 16, column 16 cannot be decoded: ")


def tag(data: bytes, code: int, value: int) -> bytes:
    """A little-endian TIFF with another value of a LONG or SHORT tag."""
    (start,) = struct.unpack_from("<I", data, 4)
    (count,) = struct.unpack_from("<H", data, start)
    for entry in range(start + 2, start + 2 + 12 * count, 12):
        found, _, length = struct.unpack_from("<HHI", data, entry)
        if found == code:
            assert length == 1
            return data[: entry + 2] + struct.pack("<HII", 4, 1, value) + data[entry + 12 :]
    raise AssertionError(f"no tag {code}")


WIDTH, HEIGHT, COMPRESSION, ROWS, SAMPLES = 256, 257, 259, 278, 277


@pytest.mark.parametrize(
    ("code", "value"),
    [
        (WIDTH, 2**31),
        (WIDTH, 0),
        (HEIGHT, 2**31),
        (HEIGHT, 0),
        (HEIGHT, 24),
        (COMPRESSION, 8),
        (COMPRESSION, 4711),
        (SAMPLES, 2**30),
        (ROWS, 0),
        (273, 2**32 - 1),
        (279, 2**32 - 1),
        (279, 12),
    ],
)
@pytest.mark.parametrize("compression", [None, "zlib"])
def test_headers_that_lie(
    code: int, value: int, compression: str | None, rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    if compression and code == COMPRESSION and value == 8:
        value = 1  # said to lie there as it is, and it is compressed
    options = {"compression": compression, "rowsperstrip": 23} if compression else {}
    source = write(tmp_path / "in.tif", coefficients(), **options)
    source.write_bytes(tag(source.read_bytes(), code, value))
    refused(rendering, source, "")


def test_a_bomb_is_refused_before_it_is_unpacked(
    rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    source = write(tmp_path / "in.tif", coefficients(), compression="zlib", rowsperstrip=23)
    data = tag(tag(source.read_bytes(), HEIGHT, 2**27), ROWS, 2**27)
    source.write_bytes(data)
    refused(rendering, source, "a strip of it decodes to .* bytes, and at most 1,073,741,824")


def test_a_part_that_takes_more_than_is_allowed(rendering: brdfc.Rendering, tmp_path: Path) -> None:
    image = coefficients(300, 200)
    source = write(tmp_path / "in.tif", image, compression="zlib", rowsperstrip=300)
    refused(
        rendering,
        source,
        "its least part, 60,000 pixels in 300 or more rows, takes 14MB",
        memory=10**6,
    )
    apply_to_tiff(rendering, source, tmp_path / "o.tif", choices=Choices(memory=14 * 10**6))
    np.testing.assert_array_equal(tifffile.imread(tmp_path / "o.tif"), rendering.apply(image))


@pytest.mark.parametrize("change", ["shorter", "longer", "same size"])
@pytest.mark.parametrize("options", [{}, {"compression": "zlib", "rowsperstrip": 2}], ids=str)
def test_a_file_that_changes_while_it_is_read(
    options: dict[str, object],
    change: str,
    rendering: brdfc.Rendering,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(memory, "WINDOW_PIXELS", 17 * 2)
    source = write(tmp_path / "in.tif", coefficients(100), **options)

    def changed(done: int, total: int) -> None:
        if done != 34:
            return
        if change == "shorter":
            os.truncate(source, source.stat().st_size // 2)
        elif change == "longer":
            with source.open("ab") as stream:
                stream.write(b"more")
        else:
            os.utime(source, ns=(1, 1))

    with pytest.raises(ImageError, match="changed while it was read"):
        apply_to_tiff(rendering, source, tmp_path / "out.tif", "", changed)
    assert left(tmp_path) == ["in.tif"]
