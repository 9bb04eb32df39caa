"""Runs on a real cluster of processes: the same bytes whatever dies, or a clear message."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import tifffile
from coefficient_images import coefficients, left, write

import brdfc
from brdfc import files
from brdfc.images import cluster, memory
from brdfc.images.apply import apply_to_tiff
from brdfc.images.job import Choices
from brdfc.source.errors import ImageError, MissingExtraError

distributed = pytest.importorskip("distributed", reason="runs on a cluster need distributed")


@pytest.fixture(scope="module")
def workers() -> Iterator[distributed.LocalCluster]:
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0"
    ) as started:
        yield started


@pytest.fixture(autouse=True)
def small_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "WINDOW_PIXELS", 17 * 10)
    monkeypatch.setattr(cluster, "TASK_PIXELS", 17 * 20)


@pytest.mark.parametrize("tile", [0, 16])
@pytest.mark.parametrize("kind", [np.float32, np.uint8])
def test_a_cluster_writes_what_one_machine_does(
    tile: int,
    kind: type,
    workers: distributed.LocalCluster,
    rendering: brdfc.Rendering,
    tmp_path: Path,
) -> None:
    image = coefficients(200)
    image[:, 3, 4] = 0
    scale = {}
    if kind is np.uint8:
        image, scale = np.round(image * 255).astype(kind), {"": (0.0, 1.0)}
    source = write(tmp_path / "in.tif", image, compression="zlib", rowsperstrip=5)
    sweep = [rendering, rendering]
    found = []
    for name, address in (("here.tif", None), ("there.tif", workers.scheduler_address)):
        choices = Choices(tile=tile, scheduler=address, samples="uint16:0..0.4", scale=scale)
        found.append(apply_to_tiff(sweep, source, tmp_path / name, choices=choices))
    assert found[0] == found[1]
    assert found[0].outside == {"m": 200}
    assert (tmp_path / "here.tif").read_bytes() == (tmp_path / "there.tif").read_bytes()
    assert left(tmp_path) == ["here.tif", "in.tif", "there.tif"]


def test_what_a_worker_had_begun_when_it_died_is_done_by_another(
    workers: distributed.LocalCluster, rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    image = coefficients(20_000)
    source = write(tmp_path / "in.tif", image)
    with distributed.Client(workers.scheduler_address, set_as_default=False) as client:
        running = list(client.run(os.getpid).values())
    killed: list[int] = []

    def kill(done: int, total: int) -> None:
        if done > total // 10 and not killed:
            killed.append(running[0])
            os.kill(running[0], signal.SIGKILL)

    choices = Choices(scheduler=workers.scheduler_address)
    apply_to_tiff(rendering, source, tmp_path / "out.tif", "", kill, choices)
    assert killed
    np.testing.assert_array_equal(tifffile.imread(tmp_path / "out.tif"), rendering.apply(image))
    assert left(tmp_path) == ["in.tif", "out.tif"]


def test_what_is_wrong_with_an_image_is_said_as_on_one_machine(
    workers: distributed.LocalCluster, rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    image = coefficients(200)
    image[150, 3, 1] = image[90, 2, 4] = np.nan
    source = write(tmp_path / "in.tif", image)
    choices = Choices(scheduler=workers.scheduler_address)
    with pytest.raises(ImageError, match=r"2 of 17,000 samples .* first at row 90, column 2, 'm'"):
        apply_to_tiff(rendering, source, tmp_path / "out.tif", choices=choices)
    assert left(tmp_path) == ["in.tif"]

    def changed(done: int, total: int) -> None:
        os.utime(source, ns=(1, 1))

    write(source, coefficients(20_000))
    with pytest.raises(ImageError, match=r"in\.tif: the file changed while it was read"):
        apply_to_tiff(rendering, source, tmp_path / "out.tif", "", changed, choices)
    assert left(tmp_path) == ["in.tif"]


def test_an_interruption_leaves_nothing(
    workers: distributed.LocalCluster, rendering: brdfc.Rendering, tmp_path: Path
) -> None:
    source = write(tmp_path / "in.tif", coefficients(2000))

    def stopped(done: int, total: int) -> None:
        raise KeyboardInterrupt

    choices = Choices(scheduler=workers.scheduler_address)
    with pytest.raises(KeyboardInterrupt):
        apply_to_tiff(rendering, source, tmp_path / "out.tif", "", stopped, choices)
    assert left(tmp_path) == ["in.tif"]


@pytest.mark.skipif(not Path("/proc/self/cwd").exists(), reason="needs Linux's /proc")
def test_a_worker_that_does_not_see_the_source(
    workers: distributed.LocalCluster,
    rendering: brdfc.Rendering,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    write(tmp_path / "in.tif", coefficients())
    monkeypatch.chdir(tmp_path)
    hidden = Path("/proc/self/cwd/in.tif")  # every process has another folder there
    choices = Choices(scheduler=workers.scheduler_address)
    with pytest.raises(ImageError, match="a worker does not see it") as raised:
        apply_to_tiff(rendering, hidden, tmp_path / "out.tif", choices=choices)
    assert "every worker needs the source and the result's folder" in str(raised.value)
    monkeypatch.setattr(files, "place_of", Path)  # which would say what folder that is
    with pytest.raises(ImageError, match="a worker cannot write it: No such file"):
        apply_to_tiff(rendering, tmp_path / "in.tif", "/proc/self/cwd/out.tif", choices=choices)
    assert left(tmp_path) == ["in.tif"]


def test_a_scheduler_that_does_not_answer(ward: brdfc.compiled.Compiled, tmp_path: Path) -> None:
    ward.save(tmp_path / "w_mvis.icc")
    write(tmp_path / "in.tif", coefficients())
    start = time.monotonic()
    done = apply_alone(tmp_path, "--scheduler", "tcp://127.0.0.1:1")
    assert time.monotonic() - start < 12
    assert done.returncode == 1
    assert "no scheduler answers: " in done.stderr
    assert "Traceback" not in done.stderr
    assert left(tmp_path) == ["in.tif", "w_mid.icc", "w_mvis.icc"]


def apply_alone(folder: Path, *options: str, check: str = "") -> subprocess.CompletedProcess[str]:
    """`brdfc apply` in a process of its own; check: what is run after it."""
    code = f"import sys; from brdfc.cli.main import main; main(); {check}"
    arguments = ["apply", "w_mid.icc", "w_mvis.icc", "in.tif", "-o", "out.tif", *options]
    return subprocess.run(
        [sys.executable, "-c", code, *arguments], cwd=folder, capture_output=True, text=True
    )


def cluster_run(rendering: brdfc.Rendering, source: Path, target: Path, address: str) -> None:
    apply_to_tiff(rendering, source, target, choices=Choices(scheduler=address))


@pytest.mark.parametrize("address", ["", "host", "nonsense://host:1", "tcp://host:x"])
def test_what_is_no_address(address: str, rendering: brdfc.Rendering, tmp_path: Path) -> None:
    source = write(tmp_path / "in.tif", coefficients())
    with pytest.raises(ImageError, match="is no scheduler's address"):
        cluster_run(rendering, source, tmp_path / "out.tif", address)
    assert left(tmp_path) == ["in.tif"]


def test_a_scheduler_without_workers(
    rendering: brdfc.Rendering, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "_TIMEOUT", 2)
    source = write(tmp_path / "in.tif", coefficients())
    with (
        distributed.LocalCluster(n_workers=0, processes=True, dashboard_address=":0") as empty,
        pytest.raises(ImageError, match="the scheduler has no workers"),
    ):
        cluster_run(rendering, source, tmp_path / "out.tif", empty.scheduler_address)


def test_a_missing_package_is_named_with_its_extra(
    rendering: brdfc.Rendering, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    source = write(tmp_path / "in.tif", coefficients())
    with pytest.raises(MissingExtraError, match=r"brdfc\[distributed\]"):
        cluster_run(rendering, source, tmp_path / "out.tif", "tcp://127.0.0.1:1")


def test_what_cannot_be_done_on_a_cluster(rendering: brdfc.Rendering, tmp_path: Path) -> None:
    source = write(tmp_path / "in.tif", coefficients())
    for more, message in (
        ({"compression": "deflate"}, "nor written by many"),
        ({"resume": True}, "a run on a cluster cannot be resumed"),
    ):
        choices = Choices(scheduler="tcp://127.0.0.1:1", **more)
        with pytest.raises(ImageError, match=message):
            apply_to_tiff(rendering, source, tmp_path / "out.tif", choices=choices)


def test_a_local_run_knows_no_dask(ward: brdfc.compiled.Compiled, tmp_path: Path) -> None:
    ward.save(tmp_path / "w_mvis.icc")
    write(tmp_path / "in.tif", coefficients())
    done = apply_alone(tmp_path, check="sys.exit(bool({'dask', 'distributed'} & set(sys.modules)))")
    assert done.returncode == 0, done.stderr
