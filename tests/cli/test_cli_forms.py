"""Commands that search for forms: what they choose, show and refuse."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from cli_process import run

import brdfc

ANGLES = ["--set", "incident=40deg", "--set", "reflection=10deg"]


def test_explain_shows_every_step_with_figures_before_and_after(tmp_path: Path) -> None:
    done = run("compile", "ward", "-o", "w_mvis.icc", "--explain", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    compiled = brdfc.compile(brdfc.load("ward"))
    assert compiled.form is not None
    for step in compiled.form.derivation:
        assert f"  {step.rule}: " in done.stdout or not step.rule
        assert f"worst {step.measured.bits:.2f} bits" in done.stdout
    prices = [step.price for step in compiled.form.derivation]
    assert prices[-1] < prices[0]


def test_the_choice_and_its_figures_are_in_the_metadata(tmp_path: Path) -> None:
    compiled = brdfc.compile(brdfc.load("ward"))
    meta = compiled.mvis.tags["meta"]
    assert "exponential below" in meta.get("form")
    assert "bits, CIEDE2000" in meta.get("form.error")


def test_accuracy_costs_and_pays() -> None:
    model = brdfc.load("ward")
    balanced, accurate = (brdfc.compile(model, optimize=o) for o in ("balanced", "accuracy"))
    assert balanced.form is not None
    assert accurate.form is not None
    last = [c.form.derivation[-1] for c in (balanced, accurate)]
    assert last[1].measured.bits < last[0].measured.bits - 0.5
    assert last[1].price > last[0].price


def test_a_largest_error_is_kept() -> None:
    compiled = brdfc.compile(brdfc.load("ward"), max_error="24ulp")
    assert compiled.form is not None
    assert 2 ** compiled.form.derivation[-1].measured.bits - 1 <= 24


def test_the_same_bytes_with_and_without_the_cache() -> None:
    model = brdfc.load("cook_torrance")
    kept = [brdfc.compile(model).mvis.to_bytes() for _ in range(2)]
    assert kept[0] == kept[1] == brdfc.compile(model, cache=False).mvis.to_bytes()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--optimize", "sped"], "did you mean 'speed'?"),
        (["--max-error", "3"], "write 0.01dE (CIEDE2000) or 8ulp"),
        (["--encode", "clit:9"], "did you mean 'clut'?"),
        (["--encode", "curve:99"], "may set"),
        (["--encode", "clut:9", *ANGLES], "take more points, or allow more with --max-error"),
        (["--encode", "clut:99", *ANGLES], "MiB is the most"),
    ],
)
def test_what_cannot_be_is_said(options: list[str], message: str, tmp_path: Path) -> None:
    done = run("compile", "ward", "-o", "w_mvis.icc", *options, cwd=tmp_path)
    assert done.returncode == 1
    assert message in done.stderr
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.iterdir())


def test_tables_compile_where_they_are_good_enough(tmp_path: Path) -> None:
    options = ["--encode", "curve:1024", *ANGLES]
    done = run("compile", "ward", "-o", "w_mvis.icc", *options, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    done = run("eval", "w_mid.icc", "w_mvis.icc", "--pixel", "0.1,0.2,0.6,0.05,0.15", cwd=tmp_path)
    xyz = [float(word) for word in done.stdout.split()]
    compiled = brdfc.compile(brdfc.load("ward"), {"incident": "40deg", "reflection": "10deg"})
    exact = brdfc.connect(compiled.mid, compiled.mvis).apply([0.1, 0.2, 0.6, 0.05, 0.15])
    assert xyz == pytest.approx(exact.tolist(), rel=1e-4)


def test_the_chart_holds_every_candidate_and_marks_the_choice(tmp_path: Path) -> None:
    done = run("chart", "ward", "-o", "ward.csv", "--effort", "60", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    rows = list(csv.DictReader((tmp_path / "ward.csv").open()))
    assert f"{len(rows)} points" in done.stdout
    assert [row["chosen"] for row in rows].count("yes") <= 1
    assert rows[0]["name"] == "as written"
    assert all("..." not in row["formula"] for row in rows)
    assert "<- chosen" in done.stdout


def test_the_other_layers(tmp_path: Path) -> None:
    layers = ["--layer", "encodings", "--layer", "storage", "--layer", "engines"]
    done = run("chart", "ward", "-o", "l.csv", *layers, *ANGLES, "--effort", "5", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    rows = list(csv.DictReader((tmp_path / "l.csv").open()))
    figures = {(row["layer"], row["name"]): float(row["de"]) for row in rows}
    assert figures["encodings", "curve:4096"] < figures["encodings", "curve:64"]
    assert figures["storage", "float32"] < figures["storage", "uint16"]
    assert ("engines", "interpreter") in figures


def test_tables_need_their_variables_fixed(tmp_path: Path) -> None:
    options = ["--layer", "encodings", "--effort", "5"]
    done = run("chart", "ward", "-o", "l.csv", *options, cwd=tmp_path)
    assert done.returncode == 1
    assert "--set incident=... --set reflection=..." in done.stderr


def test_export_writes_fpcore(tmp_path: Path) -> None:
    done = run("export", "lambert", "--fpcore", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("(FPCore ")
    assert ":pre" in done.stdout
