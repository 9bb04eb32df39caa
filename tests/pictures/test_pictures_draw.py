"""Pictures: what they show, that they are the same every time, and what cannot be drawn."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from brdfc.pictures.bodies import light_direction, lit
from brdfc.pictures.draw import (
    draw_bodies,
    draw_strips,
    draw_sweeps,
    write_bodies,
    write_sweeps,
)
from brdfc.pictures.sources import Subject, open_subjects, source
from brdfc.pictures.sweep import Sweep, sweeps
from brdfc.source.errors import BrdfcError, ValueGivenError

pytest.importorskip("matplotlib", reason="matplotlib (extra `plot`) is not installed")

ANGLES = np.radians(np.arange(-80.0, 81, 5))


def subjects(*texts: str, geometry: str | None = None) -> list[Subject]:
    return open_subjects([source(text, {}) for text in texts], geometry, None, None)


@pytest.fixture(scope="module")
def found() -> list[Sweep]:
    return sweeps(subjects("ward", "lambert"), np.radians([30.0, 60.0]), ANGLES, [None, "A"])


@pytest.mark.parametrize("kind", ["svg", "png"])
@pytest.mark.parametrize("lobes", [False, True])
@pytest.mark.parametrize("scale", ["linear", "log", "cbrt"])
def test_the_same_picture_every_time(
    kind: str, lobes: bool, scale: str, found: list[Sweep], tmp_path: Path
) -> None:
    for name in ("a", "b"):
        path = tmp_path / f"{name}.{kind}"
        draw_sweeps(found, path, "Y", "Ward", lobes=lobes, scale=scale)
    assert (tmp_path / f"a.{kind}").read_bytes() == (tmp_path / f"b.{kind}").read_bytes()


def test_every_curve_is_drawn_and_named(found: list[Sweep], tmp_path: Path) -> None:
    from matplotlib import rc_context

    with rc_context({"svg.fonttype": "none"}):
        draw_sweeps(found, tmp_path / "c.svg", "Y", "Two models", reverse=True)
    # Text is drawn as paths; what can be counted are the lines.
    text = (tmp_path / "c.svg").read_text()
    assert len(re.findall(r'<g id="axes_\d">', text)) == 2
    assert len(set(re.findall(r"stroke: (#[0-9a-f]{6}); stroke-width: 1.6", text))) == 4


def test_one_thing_that_is_turned_fits_one_panel(tmp_path: Path) -> None:
    turned = sweeps(subjects("ward"), np.radians([0.0, 30, 60]), ANGLES)
    draw_sweeps(turned, tmp_path / "c.svg", "L", "Ward")
    assert (tmp_path / "c.svg").read_text().count('<g id="axes_') == 1


def test_strips_have_the_colours_of_the_sweeps(tmp_path: Path) -> None:
    """The middle of each patch, in the picture itself."""
    own = sweeps(subjects("lambert with Rd=(0.2,0.3,0.1)"), [0.0], ANGLES, ["D50"], math.pi)
    clipped = draw_strips(own, tmp_path / "s.png", "Lambert")
    assert clipped == 0
    picture = np.asarray(Image.open(tmp_path / "s.png").convert("RGB"))
    from brdfc.colour.picture import srgb

    expected, _ = srgb(own[0].xyz[:1])
    assert (np.abs(picture.astype(int) - expected[0]).max(axis=-1) <= 1).mean() > 0.1


def test_what_srgb_cannot_show_is_counted(tmp_path: Path) -> None:
    bright = sweeps(subjects("ward with ks=1 m=0.1"), [0.3], ANGLES, ["D50"], math.pi)
    assert draw_strips(bright, tmp_path / "s.svg", "Ward") > 0
    one = lit(
        subjects("ward with ks=1 m=0.1", geometry="full")[0], "sphere", 40, (0.5, 0.2, 1), 3.0
    )
    assert draw_bodies([("ward", one)], tmp_path / "b.png", "A sphere") > 0


# ---------------------------------------------------------------- bodies


def test_a_lambert_sphere_is_as_bright_as_the_cosine() -> None:
    """The exact picture: normal times light over pi."""
    (subject,) = subjects("lambert with Rd=(0.9642,1,0.8249)", geometry="full")
    light = light_direction(0.6, 0.8)
    one = lit(subject, "sphere", 64, light, math.pi)
    rows, columns = np.nonzero(one.inside)
    x, y = (columns + 0.5 - 32) * 2.3 / 64, (32 - rows - 0.5) * 2.3 / 64
    normal = np.stack([x, y, np.sqrt(1 - x * x - y * y)], axis=-1)
    np.testing.assert_allclose(one.xyz[:, 1], np.maximum(normal @ light, 0), atol=1e-6)


def test_a_cylinder_is_the_same_in_both_geometries() -> None:
    light = light_direction(0.8, 0.0)
    plane, full = (
        lit(subjects("ward", geometry=g)[0], "cylinder", 48, light, 1.0) for g in ("plane", "full")
    )
    np.testing.assert_array_equal(plane.inside, full.inside)
    np.testing.assert_allclose(plane.xyz, full.xyz, atol=1e-6)


def test_bodies_that_cannot_be(tmp_path: Path) -> None:
    (flat,) = subjects("ward")
    for body, light in (("sphere", (1.0, 0.0, 1.0)), ("cylinder", (0.0, 1.0, 1.0))):
        with pytest.raises(ValueGivenError, match="angles in one plane"):
            lit(flat, body, 16, light, 1.0)
    with pytest.raises(ValueGivenError, match="no body 'cone'"):
        lit(flat, "cone", 16, (1.0, 0.0, 1.0), 1.0)


# ---------------------------------------------------------------- numbers, and what cannot be drawn


def test_the_numbers_behind_a_picture(found: list[Sweep], tmp_path: Path) -> None:
    write_sweeps(found, tmp_path / "n.csv")
    lines = (tmp_path / "n.csv").read_text().splitlines()
    assert lines[0] == "source,adapted to,incident,reflection,X,Y,Z,L,a,b"
    assert len(lines) == 1 + 2 * 2 * 2 * len(ANGLES)
    assert lines[1].startswith("ward,,30,-80,")
    one = lit(subjects("lambert", geometry="full")[0], "sphere", 16, (0, 0, 1), 1.0)
    write_bodies([("lambert", one)], tmp_path / "b.csv")
    assert len((tmp_path / "b.csv").read_text().splitlines()) == 1 + int(one.inside.sum())


@pytest.mark.parametrize("name", ["c.jpg", "c", "c.html", "c.csv"])
def test_other_kinds_of_files_are_refused(name: str, found: list[Sweep], tmp_path: Path) -> None:
    with pytest.raises(BrdfcError, match=r"no kind of|has a suffix"):
        draw_sweeps(found, tmp_path / name, "Y", "Ward")
    assert not list(tmp_path.iterdir())
