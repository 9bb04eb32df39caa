"""The examples, each run as its own docstring says, and what they leave behind."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
PAINT = EXAMPLES.parents[1] / "shared" / "data" / "cornell" / "garnet_red.brdf"
"""Beside the checkout; nothing of it is in the project."""


def run(folder: Path, *command: str) -> str:
    """What an example prints, run in a folder of its own."""
    script, *rest = command
    done = subprocess.run(
        [sys.executable, str(EXAMPLES / script), *rest],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def not_blank(path: Path) -> None:
    assert len(Image.open(path).convert("RGB").getcolors(2**24) or []) > 50, path


def test_the_published_workflow(tmp_path: Path) -> None:
    """Its table's residuals, of its cyan, are hundreds of times below the paper's."""
    printed = run(tmp_path, "paper/run.py")
    rows = re.findall(r"\(40; *-?\d+\) +[\d.]+ +([\d.e-]+) +([\d.e-]+) +([\d.e-]+)", printed)
    assert len(rows) == 4
    for paper, median, maximum in rows:
        assert float(median) < 1e-5 < float(paper)
        assert float(maximum) < 5e-5
    for number in range(3, 13):
        not_blank(tmp_path / "paper" / f"figure_{number:02}.png")
        assert (tmp_path / "paper" / f"figure_{number:02}.csv").stat().st_size > 1000
    assert len(list((tmp_path / "paper").glob("xyz_*.tif"))) == 16


def test_the_cylinder(tmp_path: Path) -> None:
    printed = run(tmp_path, "cylinder.py")
    assert "35,100 of 126,000 pixels" in printed
    not_blank(tmp_path / "cylinder" / "cylinder.png")


def test_a_scene(tmp_path: Path) -> None:
    printed = run(tmp_path, "scene.py")
    found = re.findall(r"(scene|image).tif: CIEDE2000 ([\d.e-]+)", printed)
    assert len(found) == 2
    assert all(float(worst) < 1e-3 for _, worst in found)


@pytest.mark.skipif(not PAINT.is_file(), reason="the measured paints are not beside the checkout")
def test_a_measured_spectrum(tmp_path: Path) -> None:
    printed = run(tmp_path, "spectral.py", str(PAINT))
    found = re.findall(r"mean ([\d.]+), .*own: maximum ([\d.e-]+)", printed)
    assert len(found) == 3
    for fitted, exact in found:
        assert float(fitted) < 5
        assert float(exact) < 2e-4
