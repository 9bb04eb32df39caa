"""`brdfc fit-image`, as users run it."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
import tifffile
from cli_process import run

sys.path.append(str(Path(__file__).parents[1] / "fit"))
from stacks import coefficients, reflected, write_stack


@pytest.fixture
def stack(tmp_path: Path) -> Path:
    values = reflected("ward", coefficients("ward", 12, 15), 0.01)
    values[0, 0] = np.nan
    write_stack(tmp_path, values)
    return tmp_path


def test_a_stack_is_fitted(stack: Path) -> None:
    done = run(
        "fit-image", "stack.toml", "--model", "ward", "-o", "c.tif", "--quality", "q.tif", cwd=stack
    )
    assert done.returncode == 0, done.stderr
    assert "ward: Rdx, Rdy, Rdz, ks, m" in done.stdout
    assert "180, 179 fitted" in done.stdout
    assert "wrote        q.tif" in done.stdout
    assert "note: 1 pixels with too few usable geometries: NaN" in done.stderr
    assert "note: 120 samples left out" in done.stderr
    found = tifffile.imread(stack / "c.tif")
    assert np.isnan(found[0, 0]).all()
    assert np.nanmax(np.abs(found - coefficients("ward", 12, 15))) < 0.05


def test_options(stack: Path) -> None:
    done = run(
        *("fit-image", "stack.toml", "--model", "ggx", "-o", "c.tif", "--set", "F0=0.04"),
        *("--range", "alpha=0.01..0.9", "--threads", "1", "--memory", "100MB", "--resume"),
        *("--unit", "brdf", "--clip", "100"),
        cwd=stack,
    )
    assert done.returncode == 0, done.stderr
    assert "Rdx, Rdy, Rdz, ks, alpha\n" in done.stdout
    assert tifffile.imread(stack / "c.tif").shape == (12, 15, 5)


def test_most_of_it_cannot_be_fitted(stack: Path) -> None:
    done = run(
        *("fit-image", "stack.toml", "--model", "ward", "-o", "c.tif", "--clip", "1e-9"), cwd=stack
    )
    assert done.returncode == 1
    assert "error: stack.toml: 180 of 180 pixels could not be fitted" in done.stderr
    assert np.isnan(tifffile.imread(stack / "c.tif")).all()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["none.toml", "--model", "ward"], "error: none.toml: cannot be read"),
        (["stack.toml", "--model", "wart"], "wart"),
        (["stack.toml", "--model", "ward", "--unit", "lux"], "'lux' is no unit"),
        (["stack.toml", "--model", "ward", "--set", "q=1"], "'ward' has no 'q'"),
        (["stack.toml", "--model", "ward", "--memory", "10kB"], "--memory"),
        (["stack.toml", "--model", "ward", "--quality", "c.tif"], "two outputs"),
        (["stack.toml", "--model", "ward", "--scheduler", "here"], "no scheduler's address"),
    ],
)
def test_what_cannot_be(stack: Path, arguments: list[str], message: str) -> None:
    done = run("fit-image", *arguments, "-o", "c.tif", cwd=stack)
    assert done.returncode == 1
    assert message in done.stderr
    assert "Traceback" not in done.stderr
    assert not (stack / "c.tif").exists()
