"""Several runs of one link over one image: pages, and how they outlive an interruption."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import tifffile
from coefficient_images import coefficients, left, write

import brdfc
from brdfc.images import memory
from brdfc.images.apply import Applied, apply_to_tiff
from brdfc.images.job import Choices
from brdfc.source.errors import BrdfcError, ImageError

KEPT = [".out.tif.journal", ".out.tif.part"]


@pytest.fixture(scope="module")
def sweep(ward: brdfc.compiled.Compiled) -> list[brdfc.Rendering]:
    angles = np.radians([-10, 0, 35])
    runs = [{"incident": 0.7, "reflection": float(angle)} for angle in angles]
    return [brdfc.rendering(brdfc.connect(ward.mid, ward.mvis, env=env)) for env in runs]


@pytest.fixture(autouse=True)
def small_windows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "WINDOW_PIXELS", 17 * 4)


class Stopped(Exception):
    pass


def stopped_at(share: float):
    def progress(done: int, total: int) -> None:
        if done >= share * total:
            raise Stopped

    return progress


@pytest.mark.parametrize("tile", [0, 16])
@pytest.mark.parametrize("compression", ["none", "deflate"])
def test_a_sweep_is_a_page_for_each_run(
    compression: str, tile: int, sweep: list[brdfc.Rendering], tmp_path: Path
) -> None:
    image = coefficients(40)
    image[0, 0, 4] = 0  # outside the range of m
    source = write(tmp_path / "in.tif", image)
    chosen = Choices(compression=compression, tile=tile)
    done = apply_to_tiff(sweep, source, tmp_path / "out.tif", choices=chosen)
    assert done.outside == {"m": 1}  # of the source, once
    with tifffile.TiffFile(tmp_path / "out.tif") as written:
        assert len(written.pages) == 3
        for page, rendering in zip(written.pages, sweep, strict=True):
            np.testing.assert_array_equal(page.asarray(), rendering.apply(image))
        texts = [page.description.split("\n") for page in written.pages]
        assert [text[3] for text in texts] == [
            "reflection=-10deg",
            "reflection=0deg",
            "reflection=35deg",
        ]


@pytest.mark.parametrize("tile", [0, 16])
@pytest.mark.parametrize("share", [0.2, 0.5, 1.0])
def test_what_is_resumed_is_what_runs_through(
    share: float, tile: int, sweep: list[brdfc.Rendering], tmp_path: Path
) -> None:
    image = coefficients(100)
    image[:, 3, 4] = 0
    source = write(tmp_path / "in.tif", image)
    chosen = Choices(resume=True, tile=tile, samples="uint16:0..0.3")
    whole = apply_to_tiff(sweep, source, tmp_path / "whole.tif", choices=chosen)
    assert left(tmp_path) == ["in.tif", "whole.tif"]
    with pytest.raises(Stopped):
        apply_to_tiff(sweep, source, tmp_path / "out.tif", "", stopped_at(share), chosen)
    assert left(tmp_path) == [*KEPT, "in.tif", "whole.tif"]
    seen: list[int] = []
    again = apply_to_tiff(
        sweep, source, tmp_path / "out.tif", "", lambda done, total: seen.append(done), chosen
    )
    assert left(tmp_path) == ["in.tif", "out.tif", "whole.tif"]
    assert (tmp_path / "out.tif").read_bytes() == (tmp_path / "whole.tif").read_bytes()
    assert again == whole == Applied(1700, again.clipped, {"m": 100})
    assert min(seen, default=1700) > share * 1700 - 17 * 16  # what was done was not done again


def test_what_is_done_is_kept_while_it_runs(
    sweep: list[brdfc.Rendering], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("brdfc.images.unfinished._EVERY", 0)
    source = write(tmp_path / "in.tif", coefficients(100))
    rows = []

    def progress(done: int, total: int) -> None:
        rows.append(json.loads((tmp_path / KEPT[0]).read_text())["rows"])

    apply_to_tiff(sweep, source, tmp_path / "out.tif", "", progress, Choices(resume=True))
    assert rows == list(range(4, 101, 4))


def test_a_run_of_something_else_is_not_gone_on_with(
    sweep: list[brdfc.Rendering], rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    source = write(tmp_path / "in.tif", coefficients(100))
    target = tmp_path / "out.tif"
    resume = Choices(resume=True)
    with pytest.raises(Stopped):
        apply_to_tiff(sweep, source, target, "", stopped_at(0.5), resume)
    for renderings, choices, other in (
        ([*sweep[:2], rendering], resume, "other variables, options"),
        (sweep, Choices(resume=True, tile=16), "other options"),
    ):
        with pytest.raises(ImageError, match=other):
            apply_to_tiff(renderings, source, target, choices=choices)
    write(source, coefficients(100))
    with pytest.raises(ImageError, match="other source"):
        apply_to_tiff(sweep, source, target, choices=resume)
    assert left(tmp_path) == [*KEPT, "in.tif"]


@pytest.mark.parametrize("text", ["", "{}", "[]", '{"run": 1}', "[" * 100_000])
def test_a_damaged_journal_is_refused(
    text: str, sweep: list[brdfc.Rendering], tmp_path: Path
) -> None:
    source = write(tmp_path / "in.tif", coefficients(100))
    with pytest.raises(Stopped):
        apply_to_tiff(
            sweep, source, tmp_path / "out.tif", "", stopped_at(0.5), Choices(resume=True)
        )
    (tmp_path / KEPT[0]).write_text(text)
    with pytest.raises(ImageError, match=r"damaged(.|\n)*remove it and"):
        apply_to_tiff(sweep, source, tmp_path / "out.tif", choices=Choices(resume=True))


def test_a_part_that_is_another_file_is_refused(
    sweep: list[brdfc.Rendering], tmp_path: Path
) -> None:
    source = write(tmp_path / "in.tif", coefficients(100))
    with pytest.raises(Stopped):
        apply_to_tiff(
            sweep, source, tmp_path / "out.tif", "", stopped_at(0.5), Choices(resume=True)
        )
    (tmp_path / KEPT[1]).unlink()
    with pytest.raises(ImageError, match="damaged, or its file"):
        apply_to_tiff(sweep, source, tmp_path / "out.tif", choices=Choices(resume=True))


def test_nothing_is_kept_without_resume_or_of_what_cannot_be(
    sweep: list[brdfc.Rendering], tmp_path: Path
) -> None:
    image = coefficients(100)
    source = write(tmp_path / "in.tif", image)
    with pytest.raises(Stopped):
        apply_to_tiff(sweep, source, tmp_path / "out.tif", "", stopped_at(0.5))
    assert left(tmp_path) == ["in.tif"]
    image[90, 2, 1] = np.inf
    write(source, image)
    with pytest.raises(ImageError, match="1 of 8,500 samples"):
        apply_to_tiff(sweep, source, tmp_path / "out.tif", choices=Choices(resume=True))
    assert left(tmp_path) == ["in.tif"]
    with pytest.raises(BrdfcError, match="can neither be resumed nor"):
        apply_to_tiff(
            sweep,
            source,
            tmp_path / "out.tif",
            choices=Choices(resume=True, compression="deflate"),
        )


def test_two_runs_at_once_do_not_write_one_file(
    sweep: list[brdfc.Rendering], tmp_path: Path
) -> None:
    source = write(tmp_path / "in.tif", coefficients(100))
    chosen = Choices(resume=True)

    def another(done: int, total: int) -> None:
        with pytest.raises(ImageError, match="another run is writing this"):
            apply_to_tiff(sweep, source, tmp_path / "out.tif", choices=chosen)

    apply_to_tiff(sweep, source, tmp_path / "out.tif", "", another, chosen)
    assert left(tmp_path) == ["in.tif", "out.tif"]
