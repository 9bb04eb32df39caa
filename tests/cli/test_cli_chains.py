"""Chains of profiles on the command line: to the profile of a display, as another wrote it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import tifffile
from cli_process import run
from PIL import ImageCms

import brdfc
from brdfc.icc.curves import Curve
from brdfc.icc.header import Header
from brdfc.icc.profile import Profile
from brdfc.icc.types import Pipeline

PROFILES = ("l_mid.icc", "l_mvis.icc")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Lambert, an image of coefficients, and the sRGB profile of LittleCMS."""
    folder = tmp_path_factory.mktemp("chains")
    brdfc.compile(brdfc.load("lambert")).save(folder / "l_mvis.icc")
    made = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    (folder / "display.icc").write_bytes(made)
    image = np.random.default_rng(3).uniform(0.2, 0.8, (6, 7, 3)).astype(np.float32)
    tifffile.imwrite(folder / "c.tif", image, photometric="minisblack", planarconfig="contig")
    return folder


def test_the_profile_of_a_display_and_srgb_agree(folder: Path) -> None:
    run("apply", *PROFILES, "c.tif", "-o", "s.tif", "--to", "sRGB", cwd=folder)
    to_display = ["--to", "display.icc", "--samples", "uint8"]
    done = run("apply", *PROFILES, "c.tif", "-o", "d.tif", *to_display, cwd=folder)
    assert done.returncode == 0, done.stderr
    ours, theirs = (tifffile.imread(folder / f).astype(int) for f in ("d.tif", "s.tif"))
    assert np.abs(ours - theirs).max() <= 1
    with tifffile.TiffFile(folder / "d.tif") as written:
        page = written.pages[0]
        assert page.photometric == tifffile.PHOTOMETRIC.RGB
        assert page.iccprofile == (folder / "display.icc").read_bytes()
        assert page.description.splitlines()[0] == "device values of RGB"


def test_device_values_have_all_their_digits(folder: Path) -> None:
    pixel = ["--pixel", "0.5,0.5,0.5"]
    done = run("eval", *PROFILES, "display.icc", *pixel, "--json", cwd=folder)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    again = run("eval", *PROFILES, "--to", "display.icc", *pixel, cwd=folder)
    assert again.stdout.split() == [f"{v:.9g}" for v in found["device"][0]]
    shown = run("eval", "display.icc", "--pixel", ",".join(again.stdout.split()), cwd=folder)
    own = run("eval", *PROFILES, *pixel, cwd=folder)
    both = ([float(w) for w in text.split()] for text in (shown.stdout, own.stdout))
    np.testing.assert_allclose(*both, rtol=1e-5)


def test_gray_is_one_image_in_strips_and_in_tiles(folder: Path) -> None:
    header = Header("mntr", colour_space=b"GRAY", pcs=b"XYZ ", version=0x04200000)
    Profile(header, {"kTRC": Curve(gamma=2.0)}).save(folder / "gray.icc")
    options = ["--to", "gray.icc", "--samples", "uint8"]
    found = []
    for layout in ([], ["--tile", "16"], ["--compression", "deflate"]):
        done = run("apply", *PROFILES, "c.tif", "-o", "g.tif", *options, *layout, cwd=folder)
        assert done.returncode == 0, done.stderr
        found.append(tifffile.imread(folder / "g.tif"))
        assert found[-1].shape == (6, 7)
        np.testing.assert_array_equal(found[-1], found[0])


def test_a_device_link_is_not_embedded(folder: Path) -> None:
    header = Header("link", colour_space=b"RGB ", pcs=b"RGB ", version=0x05000000)
    Profile(header, {"A2B0": Pipeline(3, 3, ())}).save(folder / "link.icc")
    done = run("apply", "link.icc", "c.tif", "-o", "e.tif", cwd=folder)
    assert done.returncode == 0, done.stderr
    with tifffile.TiffFile(folder / "e.tif") as written:
        assert written.pages[0].iccprofile is None
    np.testing.assert_array_equal(*(tifffile.imread(folder / name) for name in ("e.tif", "c.tif")))


def test_the_last_profile_is_not_written_over(folder: Path) -> None:
    before = (folder / "display.icc").read_bytes()
    paths = ["-o", "./display.icc", "--to", "display.icc"]
    done = run("apply", *PROFILES, "c.tif", *paths, cwd=folder)
    assert (done.returncode, "would replace an input" in done.stderr) == (1, True)
    assert (folder / "display.icc").read_bytes() == before


def test_intents_differ(folder: Path) -> None:
    pixel = ["--pixel", "0.1,0.1,0.1", "--to", "display.icc"]
    by_intent = [
        run("eval", *PROFILES, *pixel, "--intent", intent, cwd=folder).stdout
        for intent in ("relative", "perceptual")
    ]
    assert by_intent[0] != by_intent[1]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([*PROFILES, "--to", "nothing.icc"], "nothing.icc"),
        ([*PROFILES, "--to", "l_mid.icc"], "profile 3 of 3: colours do not go into a profile"),
        ([*PROFILES, "display.icc", "--to", "XYZ"], "lead to device values of RGB, not to colours"),
        ([*PROFILES, "--to", "device"], "lead to colours, not to device values"),
        ([*PROFILES, "--to", "display.icc", "--adapt", "A"], "changes no device values"),
        ([*PROFILES, "--to", "diplay"], "'diplay' is nothing to render to"),
        (["l_mid.icc", "display.icc"], "after a MID the next profile must be an MVIS"),
        (["l_mvis.icc", "display.icc"], "is an MVIS, and it needs a MID"),
        ([*PROFILES, "--intent", "vivid"], "'vivid' is not one of"),
    ],
)
def test_mistakes_are_told(arguments: list[str], message: str, folder: Path) -> None:
    done = run("eval", *arguments, "--pixel", "0.5,0.5,0.5", cwd=folder)
    assert done.returncode in (1, 2)
    assert message in done.stderr
    assert "Traceback" not in done.stderr


def test_integers_of_device_values_mean_0_to_1(folder: Path) -> None:
    """Of a picture; coefficients need a scale."""
    picture = np.random.default_rng(4).integers(0, 256, (4, 5, 3), np.uint8)
    tifffile.imwrite(folder / "picture.tif", picture, photometric="rgb")
    same = ["display.icc", "display.icc", "picture.tif", "-o", "same.tif", "--samples", "uint8"]
    done = run("apply", *same, cwd=folder)
    assert done.returncode == 0, done.stderr
    np.testing.assert_array_equal(tifffile.imread(folder / "same.tif"), picture)
    refused = run("apply", *PROFILES, "picture.tif", "-o", "no.tif", cwd=folder)
    assert "nothing says what they mean" in refused.stderr
