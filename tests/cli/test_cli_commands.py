"""The commands as a user runs them: what they print, write, and say of mistakes."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import tifffile
from cli_process import run

import brdfc
from brdfc.calc.program import Program
from brdfc.calc.samples import Samples
from brdfc.calc.tables import LookupTable
from brdfc.calc.text import assemble
from brdfc.colour.difference import D50
from brdfc.profiles.content import Content
from brdfc.profiles.multiplex import profile_pair

ROOT = Path(__file__).parents[2]
GLOSS = """model gloss "Lambert with a gloss that grows with the angle"
  cite "our own"

channel Rd : XYZ    in 0..1 = 0.5   "diffuse reflectance"
channel g  : number in 0..1 = 0.1   "gloss"

env incident : angle in -80deg..80deg = 45deg as inci "incidence"

radiance = cos(incident)*Rd/pi + g*radians(abs(incident))

example incident=0deg Rd=1 g=1 -> (0.318309886, 0.318309886, 0.318309886) within 1e-8
"""


def ward_at_40_and_minus_10() -> list[float]:
    """X, Y, Z of Rd = (0.1, 0.2, 0.6), ks = 0.05, m = 0.15 in float64: the light is D50, and so is
    the highlight."""
    ci, cr = math.cos(math.radians(40)), math.cos(math.radians(10))
    tangent = math.tan(math.radians(25))
    lobe = math.exp(-((tangent / 0.15) ** 2)) / (4 * math.pi * 0.15**2)
    highlight = 0.05 / math.sqrt(ci * cr) * lobe
    return [ci * (r / math.pi + highlight * w) for r, w in zip((0.1, 0.2, 0.6), D50, strict=True)]


WARD = ward_at_40_and_minus_10()


@pytest.fixture(scope="module")
def ward(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("ward")
    done = run("compile", "ward", "-o", "ward_mvis.icc", cwd=folder)
    assert done.returncode == 0, done.stderr
    return folder / "ward_mid.icc", folder / "ward_mvis.icc"


# ---------------------------------------------------------------- help and usage


def test_help_is_quick_to_reach_and_imports_nothing_heavy() -> None:
    script = (
        "import sys\n"
        "from brdfc.cli.main import cli\n"
        "try: cli.main(['--help'], standalone_mode=False)\n"
        "except SystemExit: pass\n"
        "heavy = {'numpy', 'sympy', 'mpmath', 'lark', 'colour', 'matplotlib', 'tifffile', 'PIL'}\n"
        "sys.exit(' '.join(sorted(heavy & set(sys.modules))) or 0)\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "brdfc compile ward -o ward_mvis.icc" in done.stdout


def test_compile_never_waits_for_colour_science_or_matplotlib(tmp_path: Path) -> None:
    script = (
        "import sys, brdfc\n"
        f"brdfc.compile(brdfc.load('ward')).save({str(tmp_path / 'w_mvis.icc')!r})\n"
        "heavy = {'colour', 'matplotlib', 'tifffile', 'PIL', 'scipy'}\n"
        "sys.exit(' '.join(sorted(heavy & set(sys.modules))) or 0)\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", ["apply", "check", "compile", "disasm", "eval", "models"])
def test_every_command_has_help_with_an_example(name: str) -> None:
    done = run(name, "--help")
    assert done.returncode == 0
    assert "Example:" in done.stdout
    assert f"brdfc {name}" in done.stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["complie", "ward"], "did you mean 'compile'?"),
        (["compile", "ward"], "Missing option '-o'"),
        (["compile", "ward", "-o", "x.icc", "--set", "m"], "--set takes NAME=VALUE, not 'm'"),
        (["eval", "a", "b", "--pixel"], "requires an argument"),
        (["models", "a", "b"], "unexpected extra argument"),
    ],
)
def test_wrong_usage_exits_with_2(arguments: list[str], said: str, tmp_path: Path) -> None:
    done = run(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert said in done.stderr
    assert not list(tmp_path.iterdir())


# ---------------------------------------------------------------- compile


def test_compile_writes_both_profiles_and_says_what_it_did(tmp_path: Path) -> None:
    done = run(
        "compile", "ward", "-o", "w.icc", "--mid", "other.icc", "--asm", "w.calc", cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert "channels     Rdx Rdy Rdz ks m\n" in done.stdout
    assert "variables    incident (inci), reflection (refl)\n" in done.stdout
    assert sorted(p.name for p in tmp_path.iterdir()) == ["other.icc", "w.calc", "w.icc"]
    assert (tmp_path / "w.calc").read_text() == brdfc.compile(brdfc.load("ward")).text


def test_the_mid_stands_beside_the_mvis(ward: tuple[Path, Path]) -> None:
    assert ward[0].exists()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--set", "roughness=0.1"], "error: 'ward' has no quantity 'roughness'"),
        (["--set", "mm=0.1"], "did you mean 'm'?"),
        (["--set", "Rdx=0.1"], "'Rdx' is a component of 'Rd'\nhint: give 'Rd' as a whole"),
        (["--set", "incident=40"], "an angle needs its unit"),
        (["--set", "m=0.2deg"], "has no unit"),
        (["--set", "m=5"], "m=5 lies outside its range 0.001..1"),
        (["--set", "m=nan"], "is not a finite number"),
        (["--set", "m=0.1", "--channel", "m"], "cannot be fixed and come with the pixel too"),
        (["--set", "Rd=(1,2)"], "it takes 3 numbers"),
        (["--channel", "incidence"], "did you mean 'incident'?"),
    ],
)
def test_bad_values_are_refused_and_nothing_is_written(
    options: list[str], message: str, tmp_path: Path
) -> None:
    done = run("compile", "ward", "-o", "w_mvis.icc", *options, cwd=tmp_path)
    assert done.returncode == 1
    assert message in done.stderr
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.iterdir())


def test_all_errors_of_a_model_are_shown_with_their_places(tmp_path: Path) -> None:
    (tmp_path / "bad.brdf").write_text(
        GLOSS.replace("g*radians", "gloss*radians").replace("= 45deg as", "= 95deg as")
    )
    done = run("compile", "bad.brdf", "-o", "bad_mvis.icc", cwd=tmp_path)
    assert done.returncode == 1
    assert "bad.brdf:7:41: error: " in done.stderr
    assert "bad.brdf:9:34: error: " in done.stderr
    assert done.stderr.count("^^^") == 2
    assert [p.name for p in tmp_path.iterdir()] == ["bad.brdf"]


def test_a_program_that_cannot_agree_is_not_written(tmp_path: Path) -> None:
    (tmp_path / "cancels.brdf").write_text(
        'model cancels "1/cos^2 - 1 where tan^2 is meant"\n'
        "channel m : roughness in 0.001..1 = 0.1\n"
        "env a : angle in -80deg..80deg = 0deg as a\n"
        "env b : angle in -80deg..80deg = 0deg as b\n"
        "let lobe = exp(-(1/cos((a - b)/2)^2 - 1)/m^2)/(4*pi*m^2)\n"
        "radiance = (lobe, lobe, lobe)\n"
    )
    done = run("compile", "cancels.brdf", "-o", "c_mvis.icc", "--effort", "1", cwd=tmp_path)
    assert done.returncode == 1
    assert "error: the program differs from the model by" in done.stderr
    assert " where a=" in done.stderr
    assert not list(tmp_path.glob("*.icc"))
    # The search knows that 1/cos^2 - 1 is tan^2, which does agree.
    done = run("compile", "cancels.brdf", "-o", "c_mvis.icc", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "form         secant" in done.stdout


def test_an_unwritable_folder_is_said_in_one_line(tmp_path: Path) -> None:
    done = run("compile", "ward", "-o", tmp_path / "no" / "w_mvis.icc")
    assert done.returncode == 1
    assert "cannot write here: No such file or directory" in done.stderr
    assert len(done.stderr.splitlines()) == 1


# ---------------------------------------------------------------- eval


def test_tables_are_interpolated_as_is_said(tmp_path: Path) -> None:
    """A table that is 1 in a corner alone is the least of the inputs in tetrahedra, else their
    product."""
    corner = LookupTable(3, 3, (2, 2, 2), Samples.of([0] * 21 + [1] * 3))
    program = Program(3, 3, assemble("{ in[0,3] clut out[0,3] }"), (corner,))
    pair = profile_pair(Content("corner", program, ("a", "b", "c"), (0.0,) * 3))
    paths = pair.save(tmp_path / "corner_mvis.icc")
    image = tmp_path / "in.tif"
    tifffile.imwrite(image, np.full((2, 2, 3), (0.5, 0.75, 0.25), np.float32), photometric="rgb")
    given = ["--interpolation", "tetrahedral"]
    assert run("eval", *paths, "--pixel", "0.5,0.75,0.25").stdout == "0.09375 0.09375 0.09375\n"
    assert run("eval", *paths, "--pixel", "0.5,0.75,0.25", *given).stdout == "0.25 0.25 0.25\n"
    done = run("apply", *paths, image, "-o", tmp_path / "out.tif", *given)
    assert done.returncode == 0, done.stderr
    assert (tifffile.imread(tmp_path / "out.tif") == np.float32(0.25)).all()


def test_eval_prints_nine_digits_a_line_a_pixel(ward: tuple[Path, Path]) -> None:
    arguments = ["--env", "incident=40deg", "--env", "refl=-10deg"]
    pixels = ["--pixel", "0.1,0.2,0.6,0.05,0.15", "--pixel", "0,0,0,1,0.3"]
    done = run("eval", *ward, *arguments, *pixels)
    assert done.returncode == 0, done.stderr
    lines = [[float(word) for word in line.split()] for line in done.stdout.splitlines()]
    assert lines[0] == pytest.approx(WARD, rel=3e-7)
    assert len(lines) == 2
    as_json = json.loads(run("eval", *ward, *arguments, *pixels, "--json").stdout)
    assert as_json == {"channels": ["Rdx", "Rdy", "Rdz", "ks", "m"], "xyz": lines}


def test_defaults_stand_where_no_variable_is_given(ward: tuple[Path, Path]) -> None:
    bare = run("eval", *ward, "--pixel", "0.1,0.2,0.6,0.05,0.15").stdout
    given = ["--env", "incident=45deg", "--env", "reflection=0deg"]
    assert bare == run("eval", *ward, *given, "--pixel", "0.1,0.2,0.6,0.05,0.15").stdout


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--env", "incident=40"], "an angle needs its unit\nhint: write 40deg"),
        (["--env", "incidnt=40deg"], "did you mean 'incident'?"),
        (["--env", "incident=91deg"], "lies outside the profile's range -90deg..90deg"),
        (["--env", "incident=1deg", "--env", "inci=2deg"], "given twice"),
    ],
)
def test_bad_variables_are_refused(
    options: list[str], message: str, ward: tuple[Path, Path]
) -> None:
    done = run("eval", *ward, *options, "--pixel", "0.1,0.2,0.6,0.05,0.15")
    assert done.returncode == 1
    assert message in done.stderr
    assert not done.stdout


def test_pixels_with_the_wrong_numbers_are_wrong_usage(ward: tuple[Path, Path]) -> None:
    for pixel in ("0.1,0.2", "a,b,c,d,e", "nan,0,0,0,0.1"):
        done = run("eval", *ward, "--pixel", pixel)
        assert done.returncode == 2
        assert "--pixel takes" in done.stderr


# ---------------------------------------------------------------- profiles that are none


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "the file is empty"),
        (b"II*\0" + bytes(200), "a TIFF image"),
        (b"hello " * 50, "text"),
    ],
)
def test_a_file_that_is_no_profile_is_refused(
    content: bytes, message: str, tmp_path: Path, ward: tuple[Path, Path]
) -> None:
    wrong = tmp_path / "wrong.icc"
    wrong.write_bytes(content)
    for command in (
        ["disasm", wrong],
        ["eval", wrong, ward[1], "--pixel", "1"],
        ["eval", ward[0], wrong, "--pixel", "1"],
    ):
        done = run(*command)
        assert done.returncode == 1
        assert "not an ICC profile" in done.stderr
        assert message in done.stderr
        assert "Traceback" not in done.stderr


def test_a_truncated_profile_is_refused(tmp_path: Path, ward: tuple[Path, Path]) -> None:
    cut = tmp_path / "cut.icc"
    cut.write_bytes(ward[1].read_bytes()[:-8])
    done = run("check", cut)
    assert done.returncode == 1
    assert "truncated" in done.stderr


def test_profiles_with_no_channel_in_common_are_refused(
    tmp_path: Path, ward: tuple[Path, Path]
) -> None:
    (tmp_path / "other.brdf").write_text(
        'model other "other"\nchannel q : number in 0..1\nradiance = (q, q, q)\n'
    )
    assert run("compile", "other.brdf", "-o", "o_mvis.icc", cwd=tmp_path).returncode == 0
    done = run("eval", tmp_path / "o_mid.icc", ward[1], "--pixel", "0.5")
    assert done.returncode == 1
    assert "no channel in common" in done.stderr


def test_profiles_in_the_wrong_order_are_said_to_be(ward: tuple[Path, Path]) -> None:
    done = run("eval", ward[1], ward[0], "--pixel", "0.5")
    assert done.returncode == 1
    assert "hint: give the MID first, then the MVIS" in done.stderr


# ---------------------------------------------------------------- disasm, check, models


def test_disasm_prints_text_that_assembles_to_the_same_program(ward: tuple[Path, Path]) -> None:
    from brdfc.calc.text import assemble

    done = run("disasm", ward[1])
    assert done.returncode == 0
    assert done.stdout.startswith("; M2B0, element 0: calculator, 5 channels in, 3 out, ")
    assert assemble(done.stdout) == brdfc.compile(brdfc.load("ward")).program.body


def test_check_says_everything_about_a_model_a_line_each() -> None:
    done = run("check", "ward")
    assert done.returncode == 0, done.stdout
    words = [line.split()[0] for line in done.stdout.splitlines()]
    assert set(words) <= {"ok", "open"}
    for part in ("examples: 4 hold", "self-check: worst CIEDE2000", "proven safe", "rules:"):
        assert part in done.stdout


def test_check_of_a_profile_exits_with_1_on_an_error(tmp_path: Path) -> None:
    from dataclasses import replace

    pair = brdfc.compile(brdfc.load("lambert"))
    tags = dict(pair.mvis.tags)
    del tags["wtpt"]
    replace(pair.mvis, tags=tags).save(tmp_path / "no_white.icc")
    done = run("check", tmp_path / "no_white.icc")
    assert done.returncode == 1
    assert "error" in done.stdout
    assert "wtpt" in done.stdout


def test_models_lists_the_library_and_shows_one() -> None:
    done = run("models")
    listed = {line.split()[0] for line in done.stdout.splitlines()}
    assert {"lambert", "ward", "ward_printed", "cook_torrance", "fresnel"} <= listed
    shown = run("models", "ward").stdout
    for part in ("G. J. Ward", "0.001..1", "(inci)", "radiance =", "default 45deg"):
        assert part in shown
    assert run("models", "word").returncode == 1


# ---------------------------------------------------------------- a user's own model


def test_a_model_of_ones_own_compiles_and_evaluates(tmp_path: Path) -> None:
    (tmp_path / "gloss.brdf").write_text(GLOSS)
    done = run("compile", "gloss.brdf", "-o", "gloss_mvis.icc", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    pixel = ["--pixel", "0.1,0.2,0.6,0.5", "--env", "incident=-60deg"]
    done = run("eval", "gloss_mid.icc", "gloss_mvis.icc", *pixel, cwd=tmp_path)
    xyz = [float(word) for word in done.stdout.split()]
    gloss, diffuse = 0.5 * math.pi / 3, [0.5 * v / math.pi for v in (0.1, 0.2, 0.6)]
    under_d50 = [d + gloss * w for d, w in zip(diffuse, D50, strict=True)]
    assert xyz == pytest.approx(under_d50, rel=2e-7)


def test_angles_may_come_with_the_pixel(tmp_path: Path) -> None:
    options = ["--channel", "incident", "--channel", "reflection"]
    done = run("compile", "ward", "-o", "w_mvis.icc", *options, cwd=tmp_path)
    assert "channels     Rdx Rdy Rdz ks m incident reflection\n" in done.stdout
    pixels = np.array([[[0.1, 0.2, 0.6, 0.05, 0.15, math.radians(40), math.radians(-10)]]])
    tifffile.imwrite(
        tmp_path / "c.tif",
        pixels.astype(np.float32),
        photometric="minisblack",
        planarconfig="contig",
    )
    done = run("apply", "w_mid.icc", "w_mvis.icc", "c.tif", "-o", "xyz.tif", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    xyz = tifffile.imread(tmp_path / "xyz.tif")
    assert xyz[0, 0] == pytest.approx(WARD, rel=3e-7)
