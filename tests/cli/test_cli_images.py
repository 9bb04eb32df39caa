"""`brdfc apply` on images: integers, sweeps, what is written, limits."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import click
import numpy as np
import pytest
import tifffile
from cli_process import run

import brdfc
from brdfc.cli.sweep_options import swept

PROFILES = ("w_mid.icc", "w_mvis.icc")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("images")
    brdfc.compile(brdfc.load("ward")).save(folder / "w_mvis.icc")
    random = np.random.default_rng(2)
    image = random.uniform(0.05, 0.5, (30, 40, 5))
    for name, data in (
        ("f.tif", image.astype(np.float32)),
        ("i.tif", np.round(image * 65535).astype(np.uint16)),
    ):
        tifffile.imwrite(folder / name, data, photometric="minisblack", planarconfig="contig")
    return folder


def test_a_sweep_is_many_pages(folder: Path) -> None:
    sweep = ["--env", "incident=40deg", "--env", "reflection=-10deg..20deg:15deg"]
    done = run("apply", *PROFILES, "f.tif", "-o", "s.tif", *sweep, "--resume", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "1,200 pixels of 3 pages\nwrote s.tif\n"
    with tifffile.TiffFile(folder / "s.tif") as written:
        pages = [page.asarray() for page in written.pages]
    for angle, page in zip((-10, 5, 20), pages, strict=True):
        one = ["--env", "incident=40deg", "--env", f"reflection={angle}deg"]
        run("apply", *PROFILES, "f.tif", "-o", "o.tif", *one, cwd=folder)
        np.testing.assert_array_equal(tifffile.imread(folder / "o.tif"), page)


def test_variables_run_side_by_side_or_stay() -> None:
    assert swept(["a=1deg", "b=2"]) == [("a=1deg", "b=2")]
    assert swept(["a=1,2", "b=3,4", "c=5"]) == [("a=1", "b=3", "c=5"), ("a=2", "b=4", "c=5")]
    assert swept(["a=-0.1..0.2:0.1"]) == [("a=-0.1",), ("a=0.0",), ("a=0.1",), ("a=0.2",)]
    assert swept(["a=(1,2)"]) == [("a=(1,2)",)]


@pytest.mark.parametrize(
    ("environment", "message"),
    [
        (["a=1,2", "b=1,2,3"], "as many values each: a has 2, b has 3"),
        (["a=1..2"], "a range needs its step"),
        (["a=1deg..2deg:1rad"], "different units"),
        (["a=2..1:1"], "leads nowhere"),
        (["a=1..2:0"], "leads nowhere"),
        (["a=1..2:0.3"], "do not end where it does"),
        (["a=0..1e9:1"], "has 1000000001 values, and a sweep at most 10,000"),
        (["a=x..2:1"], "is not a number"),
    ],
)
def test_sweeps_that_cannot_be(environment: list[str], message: str) -> None:
    with pytest.raises(click.UsageError, match=re.escape(message)):
        swept(environment)


def test_integers_have_a_stated_scaling(folder: Path) -> None:
    done = run("apply", *PROFILES, "i.tif", "-o", "o.tif", cwd=folder)
    assert done.returncode == 1
    assert "samples are uint16, and nothing says what they mean" in done.stderr
    assert "hint: state it: --scale 0..1 for all, --scale NAME=LOW..HIGH for one" in done.stderr
    done = run("apply", *PROFILES, "i.tif", "-o", "o.tif", "--scale", "0..1", cwd=folder)
    assert done.returncode == 0, done.stderr
    run("apply", *PROFILES, "f.tif", "-o", "f_o.tif", cwd=folder)
    a, b = (tifffile.imread(folder / name) for name in ("o.tif", "f_o.tif"))
    np.testing.assert_allclose(a, b, rtol=2e-2)
    each = ["Rd=0..1", "ks=0..1", "m=0..1"]
    options = [word for text in each for word in ("--scale", text)]
    done = run("apply", *PROFILES, "i.tif", "-o", "p.tif", *options, cwd=folder)
    assert done.returncode == 0, done.stderr
    np.testing.assert_array_equal(a, tifffile.imread(folder / "p.tif"))
    with tifffile.TiffFile(folder / "o.tif") as tiff:
        assert "samples of the source: 0..65535 are 0..1" in tiff.pages[0].description


@pytest.mark.parametrize(
    ("options", "status", "message"),
    [
        (["--scale", "0-1"], 2, "--scale takes LOW..HIGH or NAME=LOW..HIGH, not '0-1'"),
        (["--scale", "Re=0..1"], 2, "no sample is called 'Re'"),
        (["--scale", "0..1", "--scale", "0..2"], 2, "--scale gives 'all' twice"),
        (["--resume"], 2, "--resume is for sweeps"),
        (["--memory", "much"], 1, "'much' is no size"),
        (["--memory", "1KB"], 1, "and 1MB are allowed"),
        (["--samples", "int8"], 1, "'int8' are no samples"),
        (["--tile", "20"], 1, "tiles of 20 pixels"),
        (["--compression", "jpeg"], 2, "'jpeg'"),
    ],
)
def test_options_that_cannot_be(
    options: list[str], status: int, message: str, folder: Path
) -> None:
    done = run("apply", *PROFILES, "f.tif", "-o", "no.tif", *options, cwd=folder)
    assert (done.returncode, "Traceback" in done.stderr) == (status, False)
    assert message in done.stderr
    assert not (folder / "no.tif").exists()


def test_a_sweep_is_of_profiles(folder: Path) -> None:
    done = run("apply", "ward", "f.tif", "-o", "no.tif", "--env", "incident=1deg,2deg", cwd=folder)
    assert done.returncode == 2
    assert "a sweep is for profiles" in done.stderr


LARGE = (4000, 3000)


@pytest.fixture(scope="module")
def large(folder: Path) -> Path:
    """240 MB of zeros: holes in the file, but not in memory."""
    height, width = LARGE
    path = folder / "large.tif"
    tifffile.imwrite(
        path,
        None,
        shape=(height, width, 5),
        dtype=np.float32,
        photometric="minisblack",
        planarconfig="contig",
        metadata=None,
    )
    return path


def test_memory_does_not_grow_with_the_image(large: Path, folder: Path) -> None:
    code = """
import re
from brdfc.cli.main import main
main()
print(re.search(r"VmHWM:\\s*(\\d+) kB", open("/proc/self/status").read())[1])
"""
    if not Path("/proc/self/status").exists():
        pytest.skip("the peak of a process's memory is read from /proc, as Linux has it")
    peaks = {}
    for name in ("f.tif", "large.tif"):
        arguments = ["apply", *PROFILES, name, "-o", "o.tif", "--memory", "30MB"]
        arguments += ["--engine", "blocks"]  # the compiler takes as much again, once
        done = subprocess.run(
            [sys.executable, "-c", code, *arguments], cwd=folder, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        peaks[name] = int(done.stdout.split()[-1]) * 1024
    assert peaks["large.tif"] - peaks["f.tif"] < 40e6
    (folder / "o.tif").unlink()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interruption_leaves_nothing(number: int, large: Path, folder: Path) -> None:
    code = "from brdfc.cli.main import main; main()"
    arguments = ["apply", *PROFILES, "large.tif", "-o", "cut.tif", "--to", "sRGB"]
    arguments += ["--engine", "interpreter"]  # which is not done before it is interrupted
    child = subprocess.Popen(
        [sys.executable, "-c", code, *arguments],
        cwd=folder,
        stderr=subprocess.PIPE,
        text=True,
        # What runs in the background of a shell passes it over, and so would its children.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    while not any(folder.glob(".cut.tif.*")):
        assert child.poll() is None
    os.kill(child.pid, number)
    assert child.communicate(timeout=30)[1].strip() == "interrupted"
    assert child.returncode == 130
    assert not [*folder.glob(".cut.tif*"), *folder.glob("cut.tif")]


def test_every_engine_and_number_of_threads_writes_the_same(folder: Path) -> None:
    written = set()
    for more in (["auto"], ["blocks", "--threads", "1"], ["compiled"], ["interpreter"]):
        done = run("apply", *PROFILES, "f.tif", "-o", "e.tif", "--engine", *more, cwd=folder)
        assert done.returncode == 0, done.stderr
        written.add((folder / "e.tif").read_bytes())
    assert len(written) == 1
    done = run("apply", *PROFILES, "f.tif", "-o", "e.tif", "--engine", "gpu", cwd=folder)
    assert done.returncode == 2
    assert "'gpu' is not one of" in done.stderr
