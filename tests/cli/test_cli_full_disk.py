"""Commands that write, on a disk without room: one error that names the file, what was there stays,
and nothing else is left."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import tifffile
from cli_process import run

pytest.importorskip("resource", reason="sizes of files are limited as POSIX does it")

EXAMPLES = Path(__file__).parents[2] / "examples" / "xml"
OLD = b"of yesterday"
PAIR = ("in_mid.icc", "in_mvis.icc", "c.tif")
CYLINDER = (
    *("--radius", "27", "--camera-distance", "700", "--light-distance", "500"),
    *("--light-angle", "30deg", "--white-values", "0.5", "--matrix", "1,0,0,0,1,0,0,0,1"),
)
PLACES = ("--light", "2,1,3", "--camera", "0,0,5")

# The files that a command writes, and the command.
COMMANDS: dict[str, tuple[str, ...]] = {
    "l_mvis.icc l_mid.icc": ("compile", "lambert", "--effort", "1", "-o", "l_mvis.icc"),
    "i.icc": ("compile", str(EXAMPLES / "inks.xml"), "-o", "i.icc"),
    "o.xml": ("xml", "in_mvis.icc", "-o", "o.xml"),
    "o.fpcore": ("export", "lambert", "--fpcore", "-o", "o.fpcore"),
    "a.tif": ("angles", "--normals", "n.tif", *PLACES, "-o", "a.tif"),
    "t.csv": ("measure", "photo.tif", *CYLINDER, "-o", "t.csv"),
    "d.csv": ("data", "m.csv", "--csv", "d.csv"),
    "x.tif": ("apply", *PAIR, "-o", "x.tif"),
    "z.tif": ("apply", *PAIR, "-o", "z.tif", "--compression", "deflate"),
    "r.tif": ("apply", *PAIR, "--env", "incident=9deg,8deg", "-o", "r.tif", "--resume"),
    "p.svg": ("plot", "curves", "lambert", "-o", "p.svg"),
}

RUN = """
import json, resource, sys
from brdfc.cli.main import cli
from brdfc.source.errors import BrdfcError

def answer(arguments):
    try:
        cli.main(arguments, prog_name="brdfc", standalone_mode=False)
    except BrdfcError as error:
        return str(error)

commands = json.loads(sys.argv[1])
resource.setrlimit(resource.RLIMIT_FSIZE, (10, 10))  # bytes
print("\\n" + json.dumps([answer(arguments) for arguments in commands]))
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the commands read, and older results under the names of what they write."""
    folder = tmp_path_factory.mktemp("full")
    done = run("compile", "lambert", "--effort", "1", "-o", "in_mvis.icc", cwd=folder)
    assert done.returncode == 0, done.stderr
    layout = {"photometric": "rgb", "planarconfig": "contig"}
    tifffile.imwrite(folder / "c.tif", np.full((60, 50, 3), 0.25, np.float32), **layout)
    tifffile.imwrite(folder / "n.tif", np.full((6, 5, 3), (0, 0, 1), np.float32), **layout)
    tifffile.imwrite(folder / "photo.tif", np.full((8, 300, 3), 0.25, np.float32), **layout)
    rows = [f"45,{angle},0.2,0.21,0.19\n" for angle in range(-60, 61, 10)]
    (folder / "m.csv").write_text("# unit: brdf\nincident,reflection,X,Y,Z\n" + "".join(rows))
    return folder


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.fixture(scope="module")
def answers(folder: Path) -> dict[str, str | None]:
    """What each command says, all run by one process; the folder is then as it was."""
    for names in COMMANDS:
        for name in names.split():
            (folder / name).write_bytes(OLD)
    before = contents(folder)
    done = subprocess.run(
        [sys.executable, "-c", RUN, json.dumps(list(COMMANDS.values()))],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    assert contents(folder) == before
    return dict(zip(COMMANDS, json.loads(done.stdout.splitlines()[-1]), strict=True))


@pytest.mark.parametrize("names", COMMANDS)
def test_the_error_names_the_file(names: str, answers: dict[str, str | None]) -> None:
    said = answers[names]
    if COMMANDS[names][0] == "plot":
        pytest.importorskip("matplotlib", reason="matplotlib (extra `plot`) is not installed")
    assert said in [f"{name}: cannot be written: File too large" for name in names.split()]


@pytest.mark.parametrize("command", [("models",), ("disasm", "in_mvis.icc")])
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
def test_what_is_printed_to_a_full_disk(command: tuple[str, ...], folder: Path) -> None:
    with open("/dev/full", "w") as full:
        code = "from brdfc.cli.main import main; main()"
        arguments = [sys.executable, "-c", code, *command]
        done = subprocess.run(arguments, cwd=folder, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 1
    assert done.stderr == ("error: standard output: cannot be written: No space left on device\n")


@pytest.mark.parametrize("target", [os.devnull, "."])
def test_what_is_no_file_is_not_replaced(target: str, folder: Path) -> None:
    done = run("xml", "in_mvis.icc", "-o", target, cwd=folder)
    assert done.returncode == 1
    assert done.stderr.startswith(f"error: {target}: cannot be written: it is no file")
    assert Path(os.devnull).is_char_device()


def test_what_a_link_leads_to_is_replaced(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "real.xml").write_bytes(OLD)
    (tmp_path / "link.xml").symlink_to("real.xml")
    assert run("xml", "in_mvis.icc", "-o", tmp_path / "link.xml", cwd=folder).returncode == 0
    assert (tmp_path / "link.xml").is_symlink()
    assert b"<IccProfile>" in (tmp_path / "real.xml").read_bytes()
