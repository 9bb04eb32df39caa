"""`brdfc data` on the command line."""

from __future__ import annotations

from pathlib import Path

import pytest
from cli_process import run

TABLE = "# unit: radiance-factor\nincident,reflection,Y,X,Z\n45,0,0.5,0.4,0.6\n60,60,2,2,2\n"


def test_a_summary_a_plot_and_a_plain_table(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="matplotlib (extra `plot`) is not installed")
    (tmp_path / "m.csv").write_text(TABLE)
    done = run("data", "m.csv", "-o", "c.png", "--csv", "plain.csv", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "directions   2, 2 of them in the plane of incidence" in done.stdout
    assert "wrote        plain.csv" in done.stdout
    assert (tmp_path / "c.png").read_bytes().startswith(b"\x89PNG")
    again = run("data", "plain.csv", cwd=tmp_path)
    assert again.stdout.splitlines()[1:] == done.stdout.splitlines()[1:-2]


@pytest.mark.parametrize(
    ("arguments", "status", "said"),
    [
        (["none.csv"], 1, "none.csv: cannot be read"),
        (["m.csv", "-o", "c.jpg"], 1, "'.jpg' is no kind of picture"),
        (["m.csv", "--csv", "m.csv"], 1, "would replace an input"),
        (["m.csv", "--column", "incident"], 2, "--column takes NAME=VALUE"),
        (["m.csv", "--format", "nits"], 1, "did you mean 'nist'"),
        (["m.csv", "--directions", "plane"], 1, "takes no 'directions'"),
        (["m.csv", "--unit", "lux"], 1, "'lux' is no unit of values"),
    ],
)
def test_what_cannot_be(arguments: list[str], status: int, said: str, tmp_path: Path) -> None:
    (tmp_path / "m.csv").write_text(TABLE)
    done = run("data", *arguments, cwd=tmp_path)
    assert done.returncode == status
    assert said in done.stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == ["m.csv"]
