"""`brdfc check` and `brdfc inspect` of profiles that are safe, portable, or neither."""

from __future__ import annotations

from pathlib import Path

import pytest
from cli_process import run

from brdfc.calc.program import Program
from brdfc.calc.text import assemble
from brdfc.profiles.content import Content
from brdfc.profiles.multiplex import profile_pair

INNER = Program(1, 1, assemble("{ in 3 in div add out }"))


def save(folder: Path, text: str) -> None:
    """A pair of profiles whose MVIS has this main function, and a calculator to call."""
    program = Program(2, 3, assemble("{" + text + "}"), (INNER,))
    profile_pair(Content("A test", program, ("x", "y"), (0.0, 0.0))).save(folder / "t_mvis.icc")


def test_warnings_name_their_places_and_do_not_fail(tmp_path: Path) -> None:
    save(tmp_path, "in[0,2] calc(0) trnc in(1) cos out[0,3]")
    done = run("check", "t_mvis.icc", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert [line for line in done.stdout.splitlines() if line.startswith("warning")] == [
        "warning  tag 'M2B0', element 0, op 2: 'trnc': the value may reach 2^31 or be NaN (any "
        "number or NaN); older releases give -2147483648, newer ones +-2147483648, and 0 of NaN",
        "warning  tag 'M2B0', element 0, sub-element 0, op 3: 'div': the divisor may be 0 (any "
        "number or NaN); older releases give an infinity or NaN, newer ones 0",
    ]
    shown = run("inspect", "t_mvis.icc", "--no-engine", cwd=tmp_path).stdout
    assert "portability   tag 'M2B0', element 0, op 2: 'trnc': the value may reach" in shown


def test_so_of_the_same_in_xml(tmp_path: Path) -> None:
    save(tmp_path, "in[0,2] 1 vmax div 1 1 out[0,3]")
    run("xml", "t_mvis.icc", "-o", "t.xml", cwd=tmp_path)
    profile = run("check", "t_mvis.icc", cwd=tmp_path)
    document = run("check", "t.xml", cwd=tmp_path)
    assert document.stdout == profile.stdout
    assert "element 0, op 2: 'div'" not in document.stdout
    (tmp_path / "t.xml").write_text("<IccProfile>")
    broken = run("check", "t.xml", cwd=tmp_path)
    assert broken.returncode == 1
    assert broken.stderr.startswith("t.xml:1:")


def test_a_program_that_is_refused_fails(tmp_path: Path) -> None:
    save(tmp_path, "in[0,2] 1 out[0,3]")
    data = (tmp_path / "t_mvis.icc").read_bytes()
    place = data.index(b"data\x3f\x80")
    (tmp_path / "t.icc").write_bytes(data[:place] + b"pop \0\0\0\0" + data[place + 8 :])
    done = run("check", "t.icc", cwd=tmp_path)
    assert done.returncode == 1
    assert "error    tag 'M2B0', element 0, op 2: 'out' needs 3 values, 1 are on" in done.stdout


def test_many_remarks_are_cut_short(tmp_path: Path) -> None:
    save(tmp_path, "in " + "in div " * 300 + "1 1 out[0,3]")
    lines = run("check", "t_mvis.icc", cwd=tmp_path).stdout.splitlines()
    warned = [line for line in lines if line.startswith("warning  tag")]
    assert len(warned) == 21
    assert warned[-1].endswith("element 0: 280 such places more")


@pytest.mark.parametrize("name", ["a\x1b[2Jb", "a\nok b"])
def test_names_from_outside_do_not_reach_the_terminal(tmp_path: Path, name: str) -> None:
    program = Program(1, 3, assemble("{ in copy(1,2) out[0,3] }"))
    profile_pair(Content("A test", program, (name,), (0.0,))).save(tmp_path / "t_mvis.icc")
    done = run("check", "t_mvis.icc", cwd=tmp_path)
    assert "\x1b" not in done.stdout
    assert "\nok b" not in done.stdout
