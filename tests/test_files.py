"""Results are whole or absent, also where the process that writes them is killed; and nothing
writes files in another way."""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "brdfc"

WRITERS = {
    "files.py": "the one place",
    "checker.py": "a profile to ask about, in a folder of its own",
    "cli/main.py": "to the null device, what can be printed nowhere",
    "cmm/reference.py": "a request, in a folder of its own",
    "fit/exports.py": "a patch, to a whole_file",
    "images/unfinished.py": "a file that is filled and renamed",
    "images/writing.py": "to a whole_file, or a file that is filled",
}
"""The modules that open files to write, and what."""


def writes(call: ast.Call) -> bool:
    """Whether a call opens a file to write, or writes one."""
    function = call.func
    name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
    owner = getattr(getattr(function, "value", None), "id", "")
    if name == "open":
        modes = [*call.args, *(keyword.value for keyword in call.keywords)]
        texts = {m.value for m in modes if isinstance(m, ast.Constant) and isinstance(m.value, str)}
        return owner == "os" or any(set(text) & set("wax+") and len(text) < 4 for text in texts)
    known = ("write_text", "write_bytes", "TiffWriter", "imwrite", "tofile", "savetxt", "savez")
    return name in known or (owner, name) == ("np", "save")


def test_nothing_else_writes_files() -> None:
    found = {
        str(path.relative_to(PACKAGE))
        for path in PACKAGE.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and writes(node)
    }
    assert found == set(WRITERS)


# --- killed at any moment ------------------------------------------------------------------------

KILLS = 15
"""Of each way to write, spread over the time that it takes."""

RUN = '''
import json, os, signal, sys, time
from pathlib import Path
import numpy as np, tifffile
from brdfc.calc.program import Program
from brdfc.calc.text import assemble
from brdfc.cmm.connect import connect_alone
from brdfc.cmm.rendering import rendering
from brdfc.files import write_all, write_whole
from brdfc.icc.header import Header
from brdfc.icc.profile import Profile
from brdfc.icc.types import Pipeline
from brdfc.images import memory
from brdfc.images.apply import apply_to_tiff
from brdfc.images.job import Choices

memory.WINDOW_PIXELS = 4000
program = Program(3, 3, assemble("{ in[0,3] 0.5 smul[3] out[0,3] }"))
header = Header("scnr", colour_space=b"RGB ", pcs=b"XYZ ")
link = connect_alone(Profile(header, {"A2B0": Pipeline(3, 3, (program,))}))
image = np.random.default_rng(0).uniform(0, 1, (300, 200, 3)).astype(np.float32)
tifffile.imwrite("in.tif", image, photometric="rgb")

def applied(**choices):
    def write(name):
        apply_to_tiff(rendering(link), "in.tif", name, choices=Choices(threads=1, **choices))
    return write

data = bytes(range(256)) * 40_000
WAYS = {
    "a file": lambda name: write_whole(name, data),
    "two files": lambda name: write_all((name, data), (name + "2", data)),
    "an image": applied(),
    "a compressed image": applied(compression="deflate"),
    "an image to be resumed": applied(resume=True),
}

def killed(write, after):
    """Write in a process of its own, and kill it after so many seconds."""
    child = os.fork()
    if child == 0:
        write("out")
        os._exit(0)
    if after is not None:
        time.sleep(after)
        os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)

def there():
    return {path.name: path.read_bytes() for path in Path().glob("out*")}

def tried(write):
    """What is wrong after kills spread over the time that writing takes, how often it was done
    all the same, and the other files that are left: then, and after a run that is not killed."""
    started = time.monotonic()
    killed(write, None)
    taken, new = time.monotonic() - started, there()
    faults, done = [], 0
    for kill in range(KILLS):
        old = {name: b"of yesterday" for name in new if kill % 2}
        for name in new:
            Path(name).unlink(missing_ok=True)
        for name, data in old.items():
            Path(name).write_bytes(data)
        killed(write, taken * kill / KILLS)
        found = there()
        done += found == new
        for name in {*old, *found}:
            if found.get(name) not in (old.get(name), new.get(name)):
                faults.append(f"kill {kill}: {name}")
    left = [sorted({path.name for path in Path().iterdir()} - {*new, "in.tif"})]
    killed(write, None)
    if there() != new:
        faults.append("the last run")
    left.append(sorted({path.name for path in Path().iterdir()} - {*new, "in.tif"}))
    for name in {*new, *left[1]}:
        Path(name).unlink()
    return faults, done, left

KILLS = int(sys.argv[1])
print(json.dumps({way: tried(write) for way, write in WAYS.items()}))
'''


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are killed as POSIX does it")
def test_a_process_that_is_killed_leaves_whole_files_or_none(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", RUN, str(KILLS)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    for faults, times, (left, _) in report.values():
        assert not faults
        assert times < KILLS  # the first is killed before it begins
        assert all(name.startswith(".out") for name in left)
    # Only what is to be resumed is found again, and taken up; other parts are passed over.
    assert report["an image to be resumed"][2][1] == []
