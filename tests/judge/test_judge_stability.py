"""Where programs fail: planted faults are found, in their place, and sound programs are not blamed.

The golden table keeps the figures of the library's models from growing.
"""

from __future__ import annotations

import math
import re
from decimal import ROUND_CEILING, Decimal
from pathlib import Path

import numpy as np
import pytest
from stability_models import (
    ARC_COSINE,
    WARD,
    cancelling_ward,
    compiled,
    lambert,
    model,
    subjects,
    ward,
)

from brdfc.calc.program import Op, Program
from brdfc.codegen.select import VariableBinding
from brdfc.compiler import compile_model
from brdfc.engine.interpreter import run
from brdfc.judge import stability
from brdfc.judge.error_map import error_map
from brdfc.judge.failure_strata import STRATA, applicable, failure_points
from brdfc.judge.failures import Row, overall
from brdfc.judge.rival import as_written, pixels, subject
from brdfc.judge.stability import count_failures, judge_strata
from brdfc.lang.load import library, load
from brdfc.prepared import prepare, problem_of
from brdfc.source.errors import BrdfcError

GOLDEN = Path(__file__).parents[1] / "golden" / "stability.txt"
JUDGED, LINES, COUNTED = 6_000, 20, 50_000


def figures(of: str, rival, points: int = 6_000) -> dict[str, Row]:
    problem, both = subjects(of, rival)
    rows = judge_strata(problem, both, points)
    assert [row.stratum for row in rows[::2]] == applicable(problem.quantities)
    return {s.name: overall(rows, s.name) for s in both}


def angle(at: str, name: str) -> float:
    return float(re.search(rf"\b{name}=(\S+)deg", at)[1])


def number(at: str, name: str) -> float:
    return float(re.search(rf"\b{name}=(\S+)", at)[1])


# ------------------------------------------------------------ planted faults


def test_a_cancelling_form_is_far_off_near_the_peak_and_ours_is_not() -> None:
    found = figures("ward", cancelling_ward())
    bad, good = found["as written"], found["compiled"]
    assert bad.bits > 18
    assert bad.de.value > 0.1
    assert good.bits < 7
    assert good.de.value < 0.002
    off = math.radians(angle(bad.ulp.at, "incident") - angle(bad.ulp.at, "reflection")) / 2
    # Within ten roughnesses of the peak, and where the lobe is narrow.
    assert abs(off) < 10 * number(bad.ulp.at, "m") < 0.1


def test_the_place_that_is_named_has_the_error_that_is_named() -> None:
    problem, (_, rival) = subjects("ward", cancelling_ward())
    worst = overall(judge_strata(problem, [rival], 3_000), "as written").ulp
    rd = re.search(r"Rd=(\(.*?\)|\S+)", worst.at)[1].strip("()").split(", ")
    given = [float(v) for v in (rd * 3 if len(rd) == 1 else rd)]
    given += [number(worst.at, n) for n in ("ks", "m")]
    given += [math.radians(angle(worst.at, n)) for n in ("incident", "reflection")]
    point = np.array([given], np.float32)
    truth = stability._Exact(problem).precisely(point)[0]
    errors = np.abs(rival.values(point)[0] - truth) / np.spacing(truth.astype(np.float32))
    assert errors.max() == pytest.approx(worst.value, rel=1e-6)


@pytest.mark.parametrize(
    ("more", "what"),
    [
        ("*(radians(incident)/radians(incident))", "nan"),  # 0/0 on the normal
        ("*sqrt(1 - 1.000001*cos(incident))/sqrt(1 - 1.000001*cos(incident))", "nan"),
        ("+ 1e-9/radians(reflection)^2", "infinite"),
        ("- 1e-3", "negative"),
    ],
)
def test_planted_failures_are_counted_and_ours_has_none(more: str, what: str) -> None:
    problem, both = subjects("lambert", lambert(more))
    ours, planted = count_failures(problem, both, 20_000)
    assert getattr(planted.failures, what) > 20
    assert ours.failures == stability.Failures()
    rows = judge_strata(problem, both, 4_000)
    assert getattr(overall(rows, "as written").failures, what) > 5
    assert overall(rows, "compiled").failures == stability.Failures()


def test_without_the_horizon_cut_results_below_it_are_blamed() -> None:
    problem, both = subjects("lambert", model("cos(incident)*Rd/pi"))
    ours, uncut = count_failures(problem, both, 20_000)
    assert ours.failures.negative == 0
    assert uncut.failures.negative > 100


def test_a_negative_value_of_the_formula_itself_is_no_failure() -> None:
    dark = model("cos(incident)*Rd/pi - 0.1")
    made = compile_model(dark)
    problem = problem_of(made.roles, made.formula)
    (counted,) = count_failures(problem, [subject("compiled", made.program, problem)], 5_000)
    assert counted.failures.negative == 0


def test_a_planted_jump_is_found_where_it_is() -> None:
    jump = figures("lambert", lambert(" + (0.05 where incident > 20deg else 0)"))["as written"]
    assert jump.jumps >= 5
    assert angle(jump.jump.at, "incident") == pytest.approx(20, abs=1e-4)


def test_smooth_programs_have_no_jumps_nor_have_cuts_at_the_horizon() -> None:
    found = figures("ward", ward())
    assert [row.jumps for row in found.values()] == [0, 0]
    assert found["compiled"].lines > 500


def test_a_jump_of_the_formula_itself_is_none_of_the_program() -> None:
    stepped = lambert(" + (0.05 where incident > 20deg else 0)")
    made = compile_model(stepped)
    problem = problem_of(made.roles, made.formula)
    rows = judge_strata(problem, [subject("compiled", made.program, problem)], 4_000)
    assert overall(rows, "compiled").jumps == 0


def test_a_wrong_constant_is_no_jump_and_no_failure() -> None:
    wrong = figures("lambert", lambert("*1.5"))["as written"]
    assert wrong.bits > 20
    assert wrong.de.value > 5
    assert wrong.jumps == 0
    assert wrong.failures == stability.Failures()


# ------------------------------------------------------------ truth and programs


def test_where_float64_loses_the_digits_the_truth_has_more() -> None:
    """1 - cos of small angles keeps eight digits in float64 where it is divided by 1e-9."""
    steep = model("Rd/pi*exp(-(1 - cos(incident - reflection))/1e-9)")
    stable = model("Rd/pi*exp(-2*sin((incident - reflection)/2)^2/1e-9)")
    problem = problem_of(*prepare(steep, {}, ()))
    program = as_written(stable, problem, {})
    rows = judge_strata(problem, [subject("stable", program, problem)], 6_000)
    mirror = next(row for row in rows if row.stratum == "mirror")
    assert mirror.points <= stability.SLOW_JUDGED
    assert mirror.bits < 8


@pytest.mark.parametrize("name", ["ward", "full"])
def test_a_subject_gives_what_the_program_gives_with_its_variables(name: str) -> None:
    made, problem = compiled(name)
    shares = dict.fromkeys(STRATA, 4)
    given = pixels(failure_points(problem.ranges.domain, problem.quantities, shares), problem)
    found = subject("compiled", made.program, problem).values(given)
    signatures = [b.signature for b in problem.bindings.values() if isinstance(b, VariableBinding)]
    for pixel, result in zip(given, found, strict=True):
        variables = dict(zip(signatures, map(float, pixel[problem.inputs :]), strict=True))
        expected = run(made.program, pixel[None, : problem.inputs], variables)[0]
        assert (result.view(np.uint32) == expected.view(np.uint32)).all()


def test_division_by_zero_is_as_the_engine_or_as_the_processor_has_it() -> None:
    body = (Op("in", 0, 2), Op("div", 1), Op("out", 0, 1))
    program = Program(2, 1, body)
    given = np.array([[1, 0], [0, 0], [6, 3]], np.float32)
    assert run(program, given, {})[:, 0].tolist() == [0, 0, 2]
    ieee = run(program, given, {}, ieee=True)[:, 0]
    assert np.isposinf(ieee[0])
    assert np.isnan(ieee[1])
    assert ieee[2] == 2


def test_a_rival_of_other_quantities_is_refused_with_its_differences() -> None:
    _, problem = compiled("lambert")
    with pytest.raises(BrdfcError, match=r"only one of the models has ks, m"):
        as_written(ward(), problem, {})


def test_the_same_figures_every_time() -> None:
    problem, both = subjects("ward", cancelling_ward())
    assert judge_strata(problem, both, 1_500, 5) == judge_strata(problem, both, 1_500, 5)
    assert count_failures(problem, both, 3_000) == count_failures(problem, both, 3_000)


def test_counting_takes_chunks_and_counts_every_point(monkeypatch: pytest.MonkeyPatch) -> None:
    problem, both = subjects(
        "ward", model(WARD.format(t2="tan(acos(h.z))^2"), ARC_COSINE, lobe=True)
    )
    monkeypatch.setattr(stability, "CHUNK", 700)
    sizes = [at.count for at in stability._chunks(problem, 2_000)]
    assert sizes == [700, 700, 600]
    counted = count_failures(problem, both, 2_000)
    assert [c.points for c in counted] == [2_000, 2_000]
    assert counted[1].failures.nan > 100  # the root of a negative product of cosines


# ------------------------------------------------------------ the map


def test_the_map_shows_the_error_on_the_mirrors_diagonal() -> None:
    problem, both = subjects(
        "ward", model(WARD.format(t2="tan(acos(h.z))^2"), ARC_COSINE, lobe=True)
    )
    found = error_map(problem, both, 30_000)
    ours, written = found.cells["compiled"], found.cells["as written"]
    assert found.ends == pytest.approx((-90, 90, -90, 90))
    diagonal = np.diagonal(written.bits)
    assert np.nanmedian(diagonal) > 12
    assert np.nanmedian(written.bits) < 6
    assert np.nanmax(ours.bits) < 7
    assert not ours.broken.any()
    assert written.broken[0].any()  # the horizon


def test_out_of_plane_the_mirrors_side_is_the_positive_one() -> None:
    made, problem = compiled("full")
    found = error_map(problem, [subject("compiled", made.program, problem)], 20_000)
    assert found.ends == pytest.approx((0, 90, -90, 90))
    assert found.cells["compiled"].bits.shape == (90, 45)
    assert "light's side" in found.up


# ------------------------------------------------------------ the library's figures


def line(case: str) -> str:
    """A model's figures, rounded up: a small change of a sample is none of these."""
    name, geometry = case.split("/")
    made = compile_model(load(name, geometry))
    problem = problem_of(made.roles, made.formula)
    ours = [subject(name, made.program, problem)]
    row = overall(judge_strata(problem, ours, JUDGED, LINES), name)
    (counted,) = count_failures(problem, ours, COUNTED)
    total = row.failures + counted.failures
    bits = math.ceil(2 * row.bits) / 2
    # One digit, rounded up.
    de = Decimal(f"{row.de.value:.12f}").normalize()
    de = de.quantize(Decimal(1).scaleb(de.adjusted()), ROUND_CEILING)
    return (
        f"{case:<35} {bits:4.1f} bits  {float(de):.0e} CIEDE2000  {total.nan} NaN  "
        f"{total.infinite} infinite  {total.negative} negative  {row.jumps} jumps\n"
    )


def kept_lines() -> dict[str, str]:
    text = GOLDEN.read_text(encoding="utf-8") if GOLDEN.exists() else ""
    return {one.split()[0]: one for one in text.splitlines(keepends=True)}


CASES = [
    f"{name}/{geometry}"
    for name, entry in library().items()
    if entry.kind == "model"
    for geometry in ("plane", "full")
]


@pytest.mark.parametrize("case", CASES)
def test_no_figure_of_a_library_model_grows(case: str, request: pytest.FixtureRequest) -> None:
    now, kept = line(case), kept_lines()
    if request.config.getoption("--update-golden"):
        lines = {known: one for known, one in kept.items() if known in CASES} | {case: now}
        GOLDEN.write_text("".join(lines[n] for n in sorted(lines)), encoding="utf-8")
        return
    assert case in kept, f"{GOLDEN.name} does not keep {case} yet: make golden"
    pattern = r"(\S+) (?:bits|CIEDE2000|NaN|infinite|negative|jumps)"
    grown = zip(re.findall(pattern, now), re.findall(pattern, kept[case]), strict=True)
    worse = [f"{a} > {b}" for a, b in grown if float(a) > float(b)]
    assert not worse, f"{case} has become less stable ({', '.join(worse)}):\n{kept[case]}{now}"


def test_the_table_keeps_the_library_and_nothing_else(request: pytest.FixtureRequest) -> None:
    if request.config.getoption("--update-golden"):
        pytest.skip("golden files are being written, not compared")
    assert sorted(kept_lines()) == sorted(CASES)
