"""Pictures and angles on the command line."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import tifffile
from cli_process import run

pytest.importorskip("matplotlib", reason="matplotlib (extra `plot`) is not installed")


@pytest.mark.parametrize(
    "arguments",
    [
        [
            "curves",
            "ward",
            "lambert",
            "--incident",
            "30deg",
            "--incident",
            "60deg",
            "--csv",
            "n.csv",
        ],
        [
            "curves",
            "ward",
            "--adapt",
            "own",
            "--adapt",
            "A",
            "--white",
            "0.97,1,0.484",
            "--reverse",
        ],
        ["lobes", "ward with ks=0.3 as shiny", "--scale", "cbrt", "--csv", "n.csv"],
        ["strips", "ward", "--set", "Rd=(0.3,0.2,0.1)", "--csv", "n.csv"],
        ["sphere", "ward", "--size", "32", "--incident", "40deg", "--azimuth", "60deg"],
        ["cylinder", "ward", "--size", "32", "--geometry", "plane", "--csv", "n.csv"],
    ],
    ids=lambda a: f"{a[0]}-{len(a)}",
)
def test_every_kind_of_picture(arguments: list[str], tmp_path: Path) -> None:
    done = run("plot", *arguments, "-o", "p.png", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "wrote p.png" in done.stdout
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "n.csv").exists() == ("--csv" in arguments)


def test_measured_points_stand_beside_curves(tmp_path: Path) -> None:
    (tmp_path / "m.csv").write_text("incident,reflection,Y\n45,40,0.2\n45,50,0.2\n")
    arguments = ["curves", "ward", "--measured", "m.csv", "--csv", "n.csv"]
    done = run("plot", *arguments, "-o", "p.svg", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "m,,45,40," in (tmp_path / "n.csv").read_text()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["curve", "ward"], "is not one of"),
        (["curves", "wrd"], "hint: did you mean 'ward'?"),
        (["curves", "ward", "--quantity", "W"], "'W' is nothing to draw"),
        (["curves", "ward", "--scale", "logg"], "hint: did you mean 'log'?"),
        (["curves", "ward", "--incident", "30"], "write 30deg"),
        (["curves", "ward", "--reflection", "0..90"], "hint: write -80deg..80deg,5deg"),
        (["curves", "ward", "--exposure", "0"], "--exposure takes a number above 0"),
        (["curves", "ward", "--measured", "m.csv"], "m.csv: cannot be read"),
        (["strips", "ward", "--adapt", "A"], "--adapt is for curves and lobes, not for strips"),
        (["strips", "ward", "--measured", "m.csv"], "--measured is for curves and lobes"),
        (["cylinder", "ward", "--reverse"], "--reverse is for curves, not for cylinder"),
        (["curves", "ward", "--size", "64"], "--size is for sphere and cylinder"),
        (["curves", "w.icc", "--white", "1,1,1"], "--white is for models"),
        (["curves", "ward", "--csv", "p.png"], "two outputs would be written here"),
        (
            ["curves", "ward with Rd=(0.1,0.3,0.3)", "--quantity", "a", "--scale", "cbrt"],
            "no CIELAB a* is above 0: a cbrt scale shows none",
        ),
        (["sphere", "ward", "--geometry", "plane"], "hint: use --geometry full"),
        (["curves", "absent.icc"], "absent.icc: cannot be read"),
    ],
)
def test_mistakes_are_explained(arguments: list[str], message: str, tmp_path: Path) -> None:
    done = run("plot", *arguments, "-o", "p.png", cwd=tmp_path)
    assert done.returncode in (1, 2)
    assert message in done.stderr
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.iterdir())


def test_a_model_with_angles_of_its_own_is_drawn_on_a_cylinder(tmp_path: Path) -> None:
    (tmp_path / "gloss.brdf").write_text(
        'model gloss "G"\nchannel Rd : XYZ in 0..1 = 0.5 "d"\n'
        'env incident : angle in -90deg..90deg = 45deg as inci "i"\n'
        "radiance = cos(incident)*Rd/pi\n"
    )
    size = ["--size", "64", "-o", "c.png"]
    done = run("plot", "cylinder", "gloss.brdf", *size, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    done = run("plot", "sphere", "gloss.brdf", *size, cwd=tmp_path)
    assert "has its angles in one plane" in done.stderr


def test_another_kind_of_file_is_refused_at_once(tmp_path: Path) -> None:
    done = run("plot", "curves", "ward", "-o", "p.jpg", cwd=tmp_path)
    assert done.returncode == 1
    assert "no kind of" in done.stderr


# ---------------------------------------------------------------- angles


def write(path: Path, image: np.ndarray) -> None:
    tifffile.imwrite(path, image, photometric="minisblack", planarconfig="contig")


def test_from_normals_to_a_picture(tmp_path: Path) -> None:
    """A cylinder lit from the side: angles of every pixel, and what a colour engine makes of it."""
    x = np.linspace(-0.95, 0.95, 40)
    normals = np.empty((8, 40, 3), np.float32)
    normals[...] = np.stack([x, np.zeros_like(x), np.sqrt(1 - x * x)], axis=-1)
    coefficients = np.empty((8, 40, 5), np.float32)
    coefficients[...] = (0.3, 0.2, 0.1, 0.2, 0.15)
    write(tmp_path / "n.tif", normals)
    write(tmp_path / "c.tif", coefficients)
    scene = ["--light", "1,0,1", "--camera", "0,0,1", "--distant", "--geometry", "plane"]
    files = ["--normals", "n.tif", "--coefficients", "c.tif", "-o", "whole.tif"]
    done = run("angles", *files, *scene, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "samples      coefficients, incident, reflection" in done.stdout
    assert "pixels face away from the light: 90 degrees" in done.stderr
    channels = ["--channel", "incident", "--channel", "reflection", "--effort", "1"]
    done = run("compile", "ward", "-o", "w_mvis.icc", *channels, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    done = run("apply", "w_mid.icc", "w_mvis.icc", "whole.tif", "-o", "xyz.tif", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    luminance = tifffile.imread(tmp_path / "xyz.tif")[0, :, 1]
    # The highlight is where the normal halves 45 degrees.
    assert x[luminance.argmax()] == pytest.approx(math.sin(math.pi / 8), abs=0.05)
    assert luminance[0] == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--light", "1,0"], "--light takes X,Y,Z"),
        (["--light", "0,0,0", "--distant"], "is a direction, and 0,0,0 is none"),
        (["--light", "1,0,inf"], "finite numbers"),
        (["--light", "1,0,1", "--width", "0"], "--width takes a number above 0"),
        (["--light", "1,0,1"], "n.tif: cannot be read"),
    ],
)
def test_angles_that_cannot_be(arguments: list[str], message: str, tmp_path: Path) -> None:
    rest = ["--normals", "n.tif", "--camera", "0,0,1", "-o", "a.tif"]
    done = run("angles", *rest, *arguments, cwd=tmp_path)
    assert done.returncode in (1, 2)
    assert message in done.stderr
    assert not list(tmp_path.iterdir())
