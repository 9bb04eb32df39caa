"""Scenes on the command line: compile, check, apply, chart."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import tifffile
from cli_process import run
from PIL import ImageCms

from brdfc.colour.difference import ciede2000

SCENE = """tolerance = 0.1
[variables]
incident = "40deg"
reflection = "-10deg"
[channels]
from = "c.tif"
"""
ANGLES = ["--env", "incident=40deg", "--env", "reflection=-10deg"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An image of a matt print whose highlight cannot be seen at these angles, and its scene."""
    place = tmp_path_factory.mktemp("scene")
    random = np.random.default_rng(2)
    ends = np.array([[0.05, 0.2], [0.1, 0.3], [0.3, 0.6], [0.02, 0.1], [0.05, 0.1]])
    image = random.uniform(ends[:, 0], ends[:, 1], (60, 50, 5)).astype(np.float32)
    tifffile.imwrite(place / "c.tif", image, photometric="minisblack", planarconfig="contig")
    (place / "scene.toml").write_text(SCENE)
    done = run("compile", "ward", "-o", "s_mvis.icc", "--scene", "scene.toml", cwd=place)
    assert done.returncode == 0, done.stderr
    assert "image        3,000 pixels" in done.stdout
    assert "left out     the term" in done.stdout
    assert "left out     no longer read: ks, m" in done.stdout
    assert "at most" in done.stdout
    done = run("compile", "ward", "-o", "w_mvis.icc", "--effort", "1", cwd=place)
    assert done.returncode == 0, done.stderr
    return place


def applied(folder: Path, *arguments: str) -> tuple[np.ndarray, str]:
    done = run("apply", *arguments, "-o", "out.tif", *ANGLES, cwd=folder)
    assert done.returncode == 0, done.stderr
    return tifffile.imread(folder / "out.tif"), done.stdout


def test_an_image_goes_through_its_scene_profile(folder: Path) -> None:
    """All five samples are given; the profile takes three of them."""
    whole, _ = applied(folder, "w_mid.icc", "w_mvis.icc", "c.tif")
    scene, _ = applied(folder, "s_mid.icc", "s_mvis.icc", "c.tif")
    assert ciede2000(scene, whole).max() < 0.1


def test_a_model_is_compiled_for_the_image(folder: Path) -> None:
    whole, _ = applied(folder, "w_mid.icc", "w_mvis.icc", "c.tif")
    found, said = applied(folder, "ward", "c.tif", "--tolerance", "0.1")
    assert ciede2000(found, whole).max() < 0.1
    assert "left out" in said
    assert "with the general profile" in said
    assert " saved" in said


def test_a_profile_is_checked_against_a_scene(folder: Path) -> None:
    done = run("check", "s_mvis.icc", "--scene", "scene.toml", cwd=folder)
    assert done.returncode == 0, done.stdout
    assert "ok       difference: CIEDE2000" in done.stdout
    (folder / "other.toml").write_text(SCENE.replace('"-10deg"', '"-20deg..10deg"'))
    done = run("check", "s_mvis.icc", "--scene", "other.toml", cwd=folder)
    assert done.returncode == 1
    assert (
        "error    reflection: -20deg..10deg in the scene; the profile was compiled" in done.stdout
    )
    assert "open     difference: not compared" in done.stdout
    done = run("check", "s_mid.icc", "--scene", "scene.toml", cwd=folder)
    assert done.returncode == 1
    assert "give the MVIS" in done.stderr
    (folder / "silent.toml").write_text("tolerance = 0.1")
    done = run("check", "s_mvis.icc", "--scene", "silent.toml", cwd=folder)
    assert done.returncode == 1
    assert "error    Rd: 0..1" in done.stdout
    assert "error    incident: -90deg..90deg" in done.stdout
    done = run("check", "w_mvis.icc", "--scene", "other.toml", cwd=folder)
    assert done.returncode == 0, done.stdout
    done = run("check", "ward", "--scene", "scene.toml", cwd=folder)
    assert done.returncode == 2


def test_samples_go_by_their_names(folder: Path) -> None:
    """An image whose samples are in another order than the model's channels."""
    image = tifffile.imread(folder / "c.tif")[..., [4, 0, 1, 2, 3]]
    tifffile.imwrite(folder / "o.tif", image, photometric="minisblack", planarconfig="contig")
    named = SCENE.replace('"c.tif"', '"o.tif"\nsamples = ["m", "Rd", "ks"]')
    (folder / "order.toml").write_text(named.replace('"-10deg"', '"20deg"'))
    angles = ["--env", "incident=40deg", "--env", "reflection=20deg"]
    done = run("apply", "w_mid.icc", "w_mvis.icc", "c.tif", "-o", "r.tif", *angles, cwd=folder)
    assert done.returncode == 0, done.stderr
    done = run("apply", "ward", "o.tif", "-o", "o2.tif", "--scene", "order.toml", cwd=folder)
    assert done.returncode == 0, done.stderr
    found = tifffile.imread(folder / "o2.tif")
    assert ciede2000(found, tifffile.imread(folder / "r.tif")).max() < 0.1


def test_what_is_said_has_to_fit_the_image(folder: Path) -> None:
    (folder / "said.toml").write_text(SCENE + "ks = 0.02\n")
    done = run("compile", "ward", "-o", "x.icc", "--scene", "said.toml", cwd=folder)
    assert done.returncode == 1
    assert "'ks' goes from" in done.stderr
    done = run("apply", "ward", "c.tif", "-o", "x.tif", *ANGLES, "--env", "m=0.2", cwd=folder)
    assert done.returncode == 1
    assert "'m' goes from" in done.stderr


def test_a_display_profile_is_not_taken_for_xyz(folder: Path) -> None:
    (folder / "display.toml").write_text('output = "sRGB"\n' + SCENE)
    done = run("compile", "ward", "-o", "d_mvis.icc", "--scene", "display.toml", cwd=folder)
    assert done.returncode == 0, done.stderr
    done = run("apply", "d_mid.icc", "d_mvis.icc", "c.tif", "-o", "x2.tif", cwd=folder)
    assert "compiled for sRGB" in done.stderr
    shown = ["--to", "display.icc", "--pixel", "0.1,0.2,0.4"]
    made = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    (folder / "display.icc").write_bytes(made)
    assert "compiled for sRGB" in run("eval", "d_mid.icc", "d_mvis.icc", *shown, cwd=folder).stderr
    done = run(
        "apply", "d_mid.icc", "d_mvis.icc", "c.tif", "-o", "x3.tif", "--to", "sRGB", cwd=folder
    )
    assert "compiled for sRGB" not in done.stderr


def test_outside_is_refused_unless_asked_for(folder: Path) -> None:
    command = ["eval", "s_mid.icc", "s_mvis.icc", "--pixel", "0.1,0.2,0.4"]
    assert run(*command, "--env", "reflection=-10deg", cwd=folder).returncode == 0
    done = run(*command, "--env", "reflection=30deg", cwd=folder)
    assert done.returncode == 1
    assert "compiled for reflection=-10deg" in done.stderr
    assert run(*command, "--env", "reflection=30deg", "--extrapolate", cwd=folder).returncode == 0


def test_the_chart_has_what_was_left_out(folder: Path) -> None:
    done = run(
        "chart", "ward", "-o", "s.html", "--scene", "scene.toml", "--effort", "5", cwd=folder
    )
    assert done.returncode == 0, done.stderr
    assert "Left out for the scene: the term" in (folder / "s.html").read_text()
    done = run(
        "chart", "ward", "-o", "s.svg", "--scene", "scene.toml", "--layer", "storage", cwd=folder
    )
    assert done.returncode == 2


def test_wrong_usage(folder: Path) -> None:
    done = run("compile", "ward", "-o", "x.icc", "--tolerance", "1", cwd=folder)
    assert done.returncode == 2
    done = run(
        "compile", "ward", "-o", "x.icc", "--scene", "scene.toml", "--tolerance", "0", cwd=folder
    )
    assert done.returncode == 1
    assert "above 0" in done.stderr
    done = run("compile", "ward", "-o", "x.icc", "--scene", "none.toml", cwd=folder)
    assert done.returncode == 1
    done = run(
        "apply", "w_mid.icc", "w_mvis.icc", "c.tif", "-o", "x.tif", "--tolerance", "1", cwd=folder
    )
    assert done.returncode == 2
    done = run("apply", "ward", "c.tif", "-o", "x.tif", "--extrapolate", cwd=folder)
    assert done.returncode == 2
    done = run("scene-chart", "scene.toml", cwd=folder)
    assert done.returncode == 1
    assert "what the samples of the image are" in done.stderr
    assert not (folder / "x.icc").exists()
