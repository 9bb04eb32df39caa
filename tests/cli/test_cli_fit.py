"""`brdfc fit`, `brdfc select`, and a profile of what was fitted."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest
import tifffile
from cli_process import run

import brdfc
from brdfc.fit.writing import write_csv

sys.path.insert(0, str(Path(__file__).parents[1] / "fit"))
from fitted_cases import TRUTH, directions, made

D50 = np.array([0.9642, 1.0, 0.8249])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("fit")
    write_csv(made("ward", TRUTH["ward"], directions(150), 0.01), folder / "ward.csv")
    write_csv(made("lambert", TRUTH["lambert"], directions(80), 0.01), folder / "matte.csv")
    write_csv(made("ward", TRUTH["ward"], directions(2)), folder / "few.csv")
    return folder


def test_from_measurements_to_a_profile(folder: Path) -> None:
    done = run("fit", "ward.csv", "--model", "ward", "-o", "w.toml", "--csv", "w.csv",
               "--tiff", "w.tif", cwd=folder)  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "model        ward, 5 coefficients\n" in done.stdout
    assert "of 12 starts came to this" in done.stdout
    rows = [line.split(",") for line in (folder / "w.csv").read_text().splitlines()]
    assert [row[0] for row in rows] == ["coefficient", "Rdx", "Rdy", "Rdz", "ks", "m"]
    values = [float(row[1]) for row in rows[1:]]
    assert values == pytest.approx(TRUTH["ward"], rel=0.02)
    patch = tifffile.imread(folder / "w.tif")
    assert patch.shape == (16, 16, 5)
    assert patch[3, 4].tolist() == pytest.approx(values, rel=1e-6)

    done = run("compile", "ward", "--coefficients", "w.toml", "-o", "w_mvis.icc", cwd=folder)
    assert done.returncode == 0, done.stderr
    profile = brdfc.Profile.load(folder / "w_mvis.icc")
    assert profile.tags["mdv "].values == pytest.approx(values, rel=1e-5)  # type: ignore[attr-defined]
    done = run("apply", "w_mid.icc", "w_mvis.icc", "w.tif", "-o", "x.tif", cwd=folder)
    assert done.returncode == 0, done.stderr


def test_a_matte_sample_says_what_it_cannot_know(folder: Path) -> None:
    done = run("fit", "matte.csv", "--model", "ward", "--objective", "cube-root", cwd=folder)
    assert done.returncode == 0
    assert "note: m is not determined by these measurements" in done.stderr


def test_a_renderers_material(folder: Path) -> None:
    done = run("fit", "matte.csv", "--model", "lambert", "--mitsuba", "m.json", cwd=folder)
    assert done.returncode == 0, done.stderr
    material = json.loads((folder / "m.json").read_text())
    assert material["type"] == "diffuse"
    assert all(0 <= v <= 1 for v in material["reflectance"]["value"])
    done = run("fit", "ward.csv", "--model", "ward", "--mitsuba", "m.json", cwd=folder)
    assert done.returncode == 1
    assert "Mitsuba has no 'ward' as it is\nhint: it has lambert" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        (["few.csv", "--model", "ward"], 1, "2 geometries and 6 values for 5 coefficients"),
        (["none.csv", "--model", "ward"], 1, "none.csv: cannot be read"),
        (["ward.csv", "--model", "wart"], 1, "did you mean 'ward'?"),
        (["ward.csv", "--model", "ward", "--objective", "de"], 1, "there is no objective 'de'"),
        (["ward.csv", "--model", "ward", "--set", "q=1"], 1, "'ward' has no 'q'"),
        (["ward.csv", "--model", "ward", "--range", "m=2"], 2, "NAME=LOW..HIGH, not 'm=2'"),
        (["ward.csv", "--model", "ward", "--range", "m=2..1"], 2, "the first is the lesser"),
        (["ward.csv", "--model", "ward", "--weights", "hue=0"], 2, "--weights takes"),
        (["ward.csv", "--model", "ward", "-o", "ward.csv"], 1, "would replace an input"),
        (
            ["ward.csv", "--model", "ward", "--set", "ks=0.05", "--tiff", "p.tif"],
            1,
            "an image has no samples of them",
        ),
    ],
    ids=lambda a: " ".join(a[-2:]) if isinstance(a, list) else "",
)
def test_what_cannot_be_fitted(
    arguments: list[str], status: int, message: str, folder: Path
) -> None:
    done = run("fit", *arguments, cwd=folder)
    assert done.returncode == status, done.stdout + done.stderr
    assert message in done.stderr


def test_a_fit_of_another_model_is_not_compiled(folder: Path) -> None:
    run("fit", "ward.csv", "--model", "ward", "-o", "o.toml", cwd=folder)
    done = run("compile", "lambert", "--coefficients", "o.toml", "-o", "l_mvis.icc", cwd=folder)
    assert done.returncode == 1
    assert "fitted with 'ward', not 'lambert'" in done.stderr
    assert not (folder / "l_mvis.icc").exists()


def test_the_smallest_model(folder: Path) -> None:
    """Of a surface that is Ward's, Ward; with a chart and a table."""
    models = ["--models", "lambert,ward,ggx"]
    done = run("select", "ward.csv", *models, "-o", "s.csv", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-2].startswith("ward is the smallest within one standard error")
    table = (folder / "s.csv").read_text().splitlines()
    chosen = [row.split(",")[0] for row in table if row.endswith("True")]
    assert chosen == ["ward"]
    done = run("select", "matte.csv", "--models", "lambert,ward", "-o", "s.svg", cwd=folder)
    assert "lambert is the smallest" in done.stdout
    assert (folder / "s.svg").read_bytes().startswith(b"<?xml")
    done = run("select", "ward.csv", "--models", "lambert", "--tolerance", "0.5", cwd=folder)
    assert "none reaches 0.5: the nearest is lambert" in done.stdout
    done = run("select", "few.csv", "--models", "lambert", cwd=folder)
    assert done.returncode == 1
    assert "to hold one out, three are needed at least" in done.stderr
