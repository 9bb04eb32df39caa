"""`brdfc measure` on the command line, on generated images of a plain diffuser."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import tifffile
from cli_process import run

SETUP = ["--radius", "27", "--camera-distance", "700", "--light-distance", "500"]


def flat(path: Path, value: float = 0.25) -> None:
    """A cylinder that has one value all over: its BRDF grows where the light falls flat."""
    tifffile.imwrite(path, np.full((8, 300, 3), value, np.float32), photometric="rgb")


def test_a_table_from_photographs(tmp_path: Path) -> None:
    flat(tmp_path / "a.tif")
    flat(tmp_path / "b.tif", 0.125)
    done = run(
        "measure",
        *("a.tif", "b.tif", *SETUP, "--light-angle", "30deg", "--exposure", "1"),
        *("--exposure", "0.5", "--white-values", "0.5", "--matrix", "1,0,0,0,1,0,0,0,1"),
        *("-o", "t.csv"),
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    assert "columns of 2 photographs" in done.stdout
    assert "XYZ under the white 1, 1, 1" in done.stdout
    rows = np.genfromtxt(tmp_path / "t.csv", delimiter=",", skip_header=5)
    assert np.degrees(rows[:, 0].min()) < 0.5
    nearest = rows[np.argmin(rows[:, 0])]
    # There the surface faces the light, nearer by a radius.
    expected = 0.5 / math.pi * ((500 - 27) / 500) ** 2
    assert nearest[5] == pytest.approx(expected, rel=1e-2)
    assert run("data", "t.csv", cwd=tmp_path).returncode == 0


USUAL = ["a.tif", *SETUP, "--light-angle", "30deg", "-o", "t.csv"]
WHITE = ["--white-values", "0.5"]


@pytest.mark.parametrize(
    ("arguments", "status", "said"),
    [
        (USUAL, 2, "give one of --white-values and --white-region"),
        ([*USUAL, *WHITE, "--light-angle", "3deg"], 2, "--light-angle is given 2 times"),
        ([*USUAL, *WHITE, "--edges", "10"], 2, "--edges takes 2 numbers"),
        ([*USUAL, *WHITE, "--illuminant", "A"], 2, "for --sensitivities"),
        ([*USUAL, *WHITE, "--limit", "85"], 1, "deg"),
        ([*USUAL, *WHITE, "--radius", "900"], 1, "within the cylinder"),
        ([*USUAL, *WHITE, "-o", "a.tif"], 1, "would replace an input"),
        (["none.tif", *USUAL[1:], *WHITE], 1, "cannot be read"),
    ],
)
def test_what_cannot_be(arguments: list[str], status: int, said: str, tmp_path: Path) -> None:
    flat(tmp_path / "a.tif")
    done = run("measure", *arguments, cwd=tmp_path)
    assert done.returncode == status
    assert said in done.stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.tif"]
