"""Lights, spectra and renderings on the command line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import tifffile
from cli_process import run

PIXEL = "0.1,0.2,0.1,0.05,0.15"
ENV = ["--env", "incident=40deg"]


def numbers(text: str) -> list[float]:
    return [float(word) for word in text.split()]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Ward under a lamp, Ward of wavelengths, and an image of coefficients for the first."""
    place = tmp_path_factory.mktemp("colour")
    lamp = ["--white", "0.97,1,0.484", "--effort", "1"]
    done = run("compile", "ward", "-o", "lamp_mvis.icc", *lamp, cwd=place)
    assert done.returncode == 0, done.stderr
    light = "light        custom, observer 1931-2, white (0.97, 1, 0.484); its spectrum is made"
    assert light in done.stdout
    wide = ["--spectral", "400nm..700nm,50nm", "--illuminant", "A", "--effort", "1"]
    done = run("compile", "ward", "-o", "wide_mvis.icc", *wide, cwd=place)
    assert done.returncode == 0, done.stderr
    assert "channels     Rd_400 Rd_450" in done.stdout
    image = np.random.default_rng(1).uniform(0.1, 0.3, (4, 5, 5)).astype(np.float32)
    tifffile.imwrite(place / "c.tif", image, photometric="minisblack", planarconfig="contig")
    return place


def evaluated(folder: Path, which: str, *options: str, pixel: str = PIXEL) -> list[float]:
    done = run(
        "eval", f"{which}_mid.icc", f"{which}_mvis.icc", "--pixel", pixel, *options, cwd=folder
    )
    assert done.returncode == 0, done.stderr
    return numbers(done.stdout)


def test_colours_are_adapted_on_request(folder: Path) -> None:
    own = evaluated(folder, "lamp", *ENV)
    under_d65 = evaluated(folder, "lamp", *ENV, "--adapt", "D65")
    assert own != under_d65
    back = evaluated(folder, "lamp", *ENV, "--adapt", "0.97,1,0.484")
    assert back == pytest.approx(own, rel=1e-5)


def test_cielab_and_srgb_come_on_request(folder: Path) -> None:
    lightness, a, b = evaluated(folder, "lamp", *ENV, "--to", "Lab")
    assert 20 < lightness < 30
    assert a < 0
    assert abs(b) < 5
    assert all(v == int(v) for v in evaluated(folder, "lamp", *ENV, "--to", "sRGB"))


def test_reflectances_come_under_any_light(folder: Path) -> None:
    pixel = ",".join(["0.5"] * 7 + ["0.05", "0.15"])
    flat = evaluated(folder, "wide", *ENV, "--to", "spectrum", pixel=pixel)
    assert len(flat) == 7
    assert flat == pytest.approx([flat[0]] * 7)
    x, y, z = evaluated(folder, "wide", *ENV, "--illuminant", "D65", pixel=pixel)
    assert [x / y, z / y] == pytest.approx([0.9505, 1.089], abs=1e-3)
    x, y, z = evaluated(folder, "wide", *ENV, pixel=pixel)
    assert [x / y, z / y] == pytest.approx([1.0985, 0.3558], abs=1e-3)


@pytest.mark.parametrize(
    ("options", "kind", "facts"),
    [
        ([], np.float32, ["XYZ, Y = 1 for white", "white: 0.97 1 0.484"]),
        (["--to", "Lab"], np.float32, ["CIELAB", "white: 0.97 1 0.484"]),
        (["--to", "sRGB"], np.uint8, ["sRGB"]),
        (["--adapt", "D65"], np.float32, ["XYZ, Y = 1 for white", "adapted to D65"]),
    ],
)
def test_images_say_what_they_are(
    options: list[str], kind: type, facts: list[str], folder: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out.tif"
    profiles = ["lamp_mid.icc", "lamp_mvis.icc"]
    done = run("apply", *profiles, "c.tif", "-o", str(out), *ENV, *options, cwd=folder)
    assert done.returncode == 0, done.stderr
    with tifffile.TiffFile(out) as written:
        page = written.pages[0]
        assert (page.shape, page.dtype) == ((4, 5, 3), kind)
        told = page.description.split("\n")
    assert told[: len(facts)] == facts
    assert {"incident=40deg", "reflection=0deg", "transform: M2B0"} <= set(told)  # defaults too
    profiles = [line for line in told if line.startswith("profile: ")]
    assert [line.split(", ID ")[0].split(" (")[1] for line in profiles] == [
        "coefficients)",
        "appearance)",
    ]


def test_an_image_of_reflectances(folder: Path, tmp_path: Path) -> None:
    image = np.full((2, 3, 9), 0.2, np.float32)
    tifffile.imwrite(tmp_path / "c.tif", image, photometric="minisblack", planarconfig="contig")
    profiles = [str(folder / "wide_mid.icc"), str(folder / "wide_mvis.icc")]
    options = ["--to", "spectrum", *ENV]
    done = run("apply", *profiles, "c.tif", "-o", "r.tif", *options, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert tifffile.imread(tmp_path / "r.tif").shape == (2, 3, 7)


def test_what_srgb_cannot_show_is_counted(folder: Path, tmp_path: Path) -> None:
    image = np.full((2, 3, 5), 0.1, np.float32)
    image[0, :, 1] = 0.9  # a green that no display has
    tifffile.imwrite(tmp_path / "c.tif", image, photometric="minisblack", planarconfig="contig")
    profiles = [str(folder / "lamp_mid.icc"), str(folder / "lamp_mvis.icc")]
    done = run("apply", *profiles, "c.tif", "-o", "p.tif", "--to", "sRGB", cwd=tmp_path)
    assert "note: 3 pixels lie outside what sRGB can show; each component is clipped" in done.stderr


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--white", "0.97,0,0.484"], "error: the white's Y is 0"),
        (["--white", "0.97,1"], "Error: --white takes X,Y,Z"),
        (["--illuminant", "D64"], "hint: did you mean 'D65'?"),
        (["--illuminant", "absent.csv"], "error: absent.csv: cannot be read"),
        (["--illuminant", "gap.csv"], "gap.csv, line 3: a gap: 430 nm follows 410 nm"),
        (["--illuminant", "A", "--observer", "1931"], "hint: did you mean '1931-2'?"),
        (["--surround", "dimm"], "hint: did you mean 'dim'?"),
        (["--adaptation", "brad"], "hint: did you mean 'bradford'?"),
        (["--spectral", "400nm..705nm,10nm"], "10nm steps do not lead from 400nm to 705nm"),
        (["--spectral", "visible"], "hint: write 400nm..700nm,10nm"),
        (["--highlight", "equel"], "hint: did you mean 'equal'?"),
        (["--adaptation", "cat16"], "there is nothing to adapt"),
        (["--luminance", "1e-50"], "error: the luminance is 1e-50"),
        (["--spectral", "1000nm..1700nm,100nm"], "colours need 400..700 nm"),
        (["--mid", "w_mvis.icc"], "w_mvis.icc: two outputs would be written here"),
        (["--asm", "nowhere/w.txt"], "nowhere/w.txt: cannot write here"),
    ],
)
def test_mistakes_are_explained_and_nothing_is_written(
    options: list[str], message: str, tmp_path: Path
) -> None:
    (tmp_path / "gap.csv").write_text("400,1\n410,1\n430,1\n440,1\n450,1\n")
    done = run("compile", "ward", "-o", "w_mvis.icc", *options, cwd=tmp_path)
    assert done.returncode in (1, 2)
    assert message in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["gap.csv"]


def test_a_light_needs_reflectances(folder: Path) -> None:
    profiles = ["lamp_mid.icc", "lamp_mvis.icc"]
    done = run("eval", *profiles, "--pixel", PIXEL, "--illuminant", "A", cwd=folder)
    assert "error: profile 2 of 2: the profile has no 'M2S0' transform" in done.stderr
    assert "hint: compile the model with --spectral" in done.stderr


def test_what_is_not_said_of_the_viewing_is_the_profiles(folder: Path, tmp_path: Path) -> None:
    """A light beside the profile's own observer, or the reverse."""
    wide = ["--spectral", "400nm..700nm,50nm", "--illuminant", "A", "--observer", "1964-10"]
    options = ["--effort", "1", "--adaptation", "cat16"]
    done = run("compile", "ward", "-o", "a_mvis.icc", *wide, *options, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    pixel = "0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.05,0.15"
    for adapt in ([], ["--adapt", "D50"]):
        own = evaluated(tmp_path, "a", *ENV, *adapt, pixel=pixel)
        for said in (["--illuminant", "A"], ["--observer", "1964-10"]):
            found = evaluated(tmp_path, "a", *ENV, *adapt, *said, pixel=pixel)
            assert found == pytest.approx(own, rel=2e-6)
    assert evaluated(tmp_path, "a", *ENV, "--observer", "1931-2", pixel=pixel) != own


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--transform", "A2M0"], "'A2M0' does not lead from multiplex channels to colours"),
        (["--adaptation", "cat16"], "give --adapt too"),
        (["--transform", "M2S1"], "has no 'M2S1' transform"),
    ],
)
def test_what_makes_no_sense_of_a_rendering(options: list[str], message: str, folder: Path) -> None:
    done = run("eval", "lamp_mid.icc", "lamp_mvis.icc", "--pixel", PIXEL, *options, cwd=folder)
    assert done.returncode in (1, 2)
    assert message in done.stderr
    one = run("eval", "lamp_mid.icc", "--pixel", PIXEL, "--transform", "A2M0", cwd=folder)
    assert "the last of 1 profiles is a MID, and it needs an MVIS" in one.stderr


def test_an_output_replaces_no_profile(folder: Path) -> None:
    files = ["lamp_mid.icc", "lamp_mvis.icc", "c.tif"]
    before = (folder / "lamp_mvis.icc").read_bytes()
    done = run("apply", *files, "-o", "lamp_mvis.icc", cwd=folder)
    assert "lamp_mvis.icc: the output would replace an input" in done.stderr
    assert (folder / "lamp_mvis.icc").read_bytes() == before


def test_a_model_for_three_components_says_so(tmp_path: Path) -> None:
    wide = ["--spectral", "400nm..700nm,10nm"]
    done = run("compile", "print_layer", "-o", "p_mvis.icc", *wide, cwd=tmp_path)
    assert done.returncode == 1
    assert "a vector of 31 has no component 'x'" in done.stderr
    assert "hint: a formula of .x, .y, .z is for X, Y, Z alone" in done.stderr
