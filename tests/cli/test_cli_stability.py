"""`brdfc stability` as a user runs it."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from cli_process import run

ROOT = Path(__file__).parents[2]
QUICK = ("--points", "2e4", "--judged", "1000", "--effort", "5")
CANCELLING = """model cancelling "Lambert less most of itself"
  cite "our own"

channel Rd : XYZ in 0..1 = 0.5   "diffuse reflectance"
env incident : angle in -90deg..90deg = 45deg as inci "incidence angle"
constant intensity : number in 0..100 = 1 "light intensity"

radiance = intensity*(cos(incident) + 1000 - 1000)*Rd/pi
"""


@pytest.fixture
def rival(tmp_path: Path) -> Path:
    path = tmp_path / "cancelling.brdf"
    path.write_text(CANCELLING, encoding="utf-8")
    return path


def test_a_report_against_a_rival(tmp_path: Path, rival: Path) -> None:
    table = tmp_path / "r.csv"
    done = run("stability", "lambert", "-o", table, "--against", rival, *QUICK)
    assert done.returncode == 0, done.stderr
    for said in ("compiled     worst ", "as written   worst ", "of 20,000 points", "wrote"):
        assert said in done.stdout
    with table.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    worst = {
        method: max(float(r["worst_bits"]) for r in rows if r["method"] == method and r["lines"])
        for method in ("compiled", "as written")
    }
    assert worst["compiled"] < 3
    assert worst["as written"] > 8
    counted = [r for r in rows if r["stratum"] == "all strata"]
    assert [r["points"] for r in counted] == ["20000", "20000"]


@pytest.mark.parametrize("kind", ["html", "png"])
def test_reports_are_the_same_bytes_in_another_process(tmp_path: Path, kind: str) -> None:
    found = []
    for name in "ab":
        path = tmp_path / f"{name}.{kind}"
        done = run("stability", "lambert", "-o", path, *QUICK)
        assert done.returncode == 0, done.stderr
        assert "no textbook form" in done.stderr or "as written" in done.stdout
        found.append(path.read_bytes())
    assert found[0] == found[1]
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["-o", "r.pdf"], "'.pdf' is no kind of chart"),
        (["-o", "r"], "a name without a suffix"),
        ([], "Missing option '-o'"),
        (["-o", "r.csv", "--points", "many"], "'many' is no whole number from 1 to"),
        (["-o", "r.csv", "--points", "1.5"], "write, say, 1e6"),
        (["-o", "r.csv", "--points", "0"], "'0' is no whole number"),
        (["-o", "r.csv", "--judged", "nan"], "'nan' is no whole number"),
        (["-o", "r.csv", "--points", "inf"], "'inf' is no whole number"),
        (["-o", "r.csv", "--against", "lamber"], "did you mean 'lambert'?"),
        (["-o", "r.csv", "--against", "missing.brdf"], "cannot be read"),
        (
            ["-o", "r.csv", "--against", "ward"],
            "only one of the models has ks, m, mirror, reflection",
        ),
        (["-o", "r.csv", "--set", "m=0.1"], "has no quantity 'm'"),
    ],
)
def test_mistakes_are_explained_and_leave_no_file(
    tmp_path: Path, arguments: list[str], said: str
) -> None:
    done = run("stability", "lambert", *arguments, cwd=tmp_path)
    assert done.returncode in (1, 2)
    assert said in done.stderr
    assert "Traceback" not in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_the_command_has_help_with_an_example() -> None:
    done = run("stability", "--help")
    assert done.returncode == 0
    assert "brdfc stability ward -o ward.html" in done.stdout
