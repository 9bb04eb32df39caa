"""Targets that cannot be written, and runs that are stopped: nothing is left, and what was there
before stays."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from coefficient_images import coefficients, left, write

import brdfc
from brdfc.files import whole_file
from brdfc.images import memory
from brdfc.images.apply import apply_to_tiff
from brdfc.images.job import Choices
from brdfc.source.errors import BrdfcError, ImageError


@pytest.mark.parametrize("compression", ["none", "deflate"])
def test_a_disk_that_is_full(
    compression: str, ward: brdfc.compiled.Compiled, tmp_path: Path
) -> None:
    ward.save(tmp_path / "w_mvis.icc")
    write(tmp_path / "in.tif", coefficients(300, 300))
    code = (
        "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000)); "
        "from brdfc.cli.main import main; main()"
    )
    arguments = ["apply", "w_mid.icc", "w_mvis.icc", "in.tif", "-o", "out.tif"]
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments, "--compression", compression],
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 1
    assert done.stderr == "error: out.tif: cannot be written: File too large\n"
    assert left(tmp_path) == ["in.tif", "w_mid.icc", "w_mvis.icc"]


def test_a_disk_without_room_is_noticed_first(
    rendering: brdfc.Rendering, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = write(tmp_path / "in.tif", coefficients())
    monkeypatch.setattr("shutil.disk_usage", lambda _: SimpleNamespace(free=1))
    with pytest.raises(ImageError, match=r"the result takes 4\.69e-06 GB, and 1e-09 GB are free"):
        apply_to_tiff(rendering, source, tmp_path / "out.tif")
    assert left(tmp_path) == ["in.tif"]


@pytest.mark.parametrize("compression", ["none", "deflate"])
@pytest.mark.parametrize("stop", [KeyboardInterrupt, RuntimeError])
def test_what_stops_leaves_nothing(
    stop: type[BaseException],
    compression: str,
    rendering: brdfc.Rendering,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(memory, "WINDOW_PIXELS", 17 * 2)
    source = write(tmp_path / "in.tif", coefficients(100))

    def stopped(done: int, total: int) -> None:
        if done > total // 2:
            raise stop

    chosen = Choices(compression=compression)
    with pytest.raises(stop):
        apply_to_tiff(rendering, source, tmp_path / "out.tif", "", stopped, chosen)
    assert left(tmp_path) == ["in.tif"]


def test_an_older_target_stays_where_the_run_fails(
    rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    image = coefficients()
    image[3, 3, 3] = np.nan
    source = write(tmp_path / "in.tif", image)
    (tmp_path / "out.tif").write_bytes(b"of yesterday")
    for compression in ("none", "deflate"):
        choices = Choices(compression=compression)
        with pytest.raises(ImageError, match="1 of 1,955 samples are NaN"):
            apply_to_tiff(rendering, source, tmp_path / "out.tif", choices=choices)
        assert (tmp_path / "out.tif").read_bytes() == b"of yesterday"
        assert left(tmp_path) == ["in.tif", "out.tif"]


def test_a_folder_that_is_not_there(rendering: brdfc.Rendering, tmp_path: Path) -> None:
    source = write(tmp_path / "in.tif", coefficients())
    with pytest.raises(BrdfcError, match="cannot write here: No such file"):
        apply_to_tiff(rendering, source, tmp_path / "no" / "out.tif")
    with pytest.raises(BrdfcError), whole_file(tmp_path / "no" / "out.tif"):
        pass
