"""Formulas as FPCore and back: the same function, the same ranges, and clear errors."""

from __future__ import annotations

import math
import random
from fractions import Fraction
from pathlib import Path

import pytest
from click.testing import CliRunner

from brdfc.cli.export_command import command
from brdfc.forms.fpcore import from_fpcore, scalars, to_fpcore
from brdfc.forms.fpcore_names import escape_name, unescape_name
from brdfc.lang.load import load, load_text
from brdfc.lang.model import Model
from brdfc.source.errors import ModelError
from brdfc.symbolic.evaluate import evaluate_precisely
from brdfc.symbolic.expression import (
    PI,
    Expression,
    component,
    const,
    make,
    quantity,
    vector,
)
from brdfc.symbolic.formula import formula
from brdfc.symbolic.intervals import INF, Interval, single

# Microfacet formulas in the manner of FPBench's graphics benchmarks, written from the formulas of
# the literature: sampled slopes of Beckmann and Trowbridge-Reitz, and Disney's GTR1.
BECKMANN = """
(FPCore (alphax alphay u0 cos2phi sin2phi)
  :name "Beckmann sample, tan2theta, alphax != alphay"
  :precision binary32
  :pre (and (<= 0.0001 alphax 1.0) (<= 0.0001 alphay 1.0)
            (<= 2.328306437e-10 u0 1.0) (<= 0.0 cos2phi 1.0) (<= 0.0 sin2phi))
  (/ (- (log (- 1.0 u0))) (+ (/ cos2phi (* alphax alphax)) (/ sin2phi (* alphay alphay)))))
"""
TROWBRIDGE_REITZ = """
(FPCore (u0 u1 alpha) ; the slope of a facet
  :name "Trowbridge-Reitz sample, near normal"
  :precision binary32
  :pre (and (<= 2.328306437e-10 u0 1) (and (>= u1 2.328306437e-10) (< u1 0.5)) (< 0 alpha 1))
  (let* ([r (sqrt (/ u0 (- 1 u0)))] [phi (* 6.28318530718 u1)])
    (! :precision binary32 (* alpha (* r (cos phi))))))
"""
GTR1 = """
(FPCore gtr1 (cosTheta alpha)
  :name "GTR1 distribution"
  :precision binary32
  :pre (and (<= 0 cosTheta 1) (<= 0.0001 alpha 1/2))
  (let ((a2 (* alpha alpha)))
    (/ (- a2 1) (* (* PI (log a2)) (+ 1 (* (* (- a2 1) cosTheta) cosTheta))))))
"""


def a_model(body: str, declarations: str = 'channel a : number in 0.25..2 = 1 "a"') -> Model:
    text = f'model trial "a trial"\n  cite "nobody"\n\n{declarations}\n\nradiance = {body}\n'
    found = load_text(text)
    assert isinstance(found, Model)
    return found


def agree(model: Model, text: str, points: int = 12) -> None:
    """The FPCores of a text have the values of a model's formula, and its ranges."""
    ready = formula(model, {})
    cores = from_fpcore(text)
    chance = random.Random(7)
    for _ in range(points):
        values, by_component = {}, {}
        for q in model.quantities:
            if q.name not in ready.domain:
                continue
            row = [chance.uniform(q.low, q.high) for _ in q.component_names]
            values[q.name] = row
            by_component |= {n: [v] for n, v in zip(q.component_names, row, strict=True)}
        expected = evaluate_precisely(ready.exact, values)
        found = [evaluate_precisely(core.expression, by_component)[0] for core in cores]
        if len(found) == 1:
            found *= len(expected)
        assert found == pytest.approx(expected, rel=1e-14, abs=0)
    for core in cores:
        for q in model.quantities:
            for name in q.component_names:
                if name in core.domain:
                    assert core.domain[name] == Interval(single(q.low), single(q.high))


@pytest.mark.parametrize("name", ["lambert", "ward", "ward_printed", "cook_torrance"])
def test_library_models_come_back_the_same(name: str) -> None:
    model = load(name)
    ready = formula(model, {})
    text = to_fpcore([ready.exact], name, ready.domain, model.quantities, model.citations)
    assert [core.name for core in from_fpcore(text)] == [f"{name}, {c}" for c in "XYZ"]
    assert {core.precision for core in from_fpcore(text)} == {"binary32"}
    agree(model, text)


@pytest.mark.parametrize(
    "body",
    [
        "sqrt(a) + a^0.5 - a^-3",
        "exp(-a)*ln(a)/log10(a + 1)",
        "degrees(asin(a/4) + acos(a/4)) + degrees(atan(a) - atan2(a, 2))",
        "min(a, 1, 1/a) + max(a, 0.5) + clamp(a, 0.3, 0.9)",
        "floor(a*3) + ceil(a*3) + trunc(-a*3) + round(a*3)",
        "sign(a - 1) + sign(a*a - 1) + abs(a - 1)",
        "a where a > 1 and not (a >= 1.5 or a == 1.25) else -a",
        "a where a < 1 or a <= 0.5 or a != 1 else 2",
        "sin(30deg)*a + cos(a*1rad)*tan(a*0.1rad) + pi",
        "cbrt(a - 1)*1.5e-30/7",
        "dot(normalize((a, 1, 2)), (1, a, 3))",
        "length(cross((a, 1, 2), (1, a, 3)))",
    ],
)
def test_every_operator_comes_back_the_same(body: str) -> None:
    model = a_model(body)
    ready = formula(model, {})
    agree(model, to_fpcore([ready.exact], "trial", ready.domain, model.quantities))


def test_shared_parts_are_named_once() -> None:
    x = quantity("x", 1)
    part = make("exp", make("mul", x, x))
    text = to_fpcore([make("add", part, make("sqrt", part))], "f", {"x": Interval(0, 1)}, ())
    assert "(let* ((t1 (exp (* x x))))\n    (+ t1 (sqrt t1)))" in text


def test_a_name_for_a_part_is_not_one_of_the_arguments() -> None:
    model = a_model("exp(t1)*exp(t1)", 'channel t1 : number in 0..1 = 0 "t"')
    ready = formula(model, {})
    text = to_fpcore([ready.exact], "f", ready.domain, model.quantities)
    assert "(let* ((t2 (exp t1)))" in text
    agree(model, text)


def test_equal_components_are_one_core() -> None:
    model = a_model("(a, a, a)")
    ready = formula(model, {})
    text = to_fpcore([ready.exact], "grey", ready.domain, model.quantities)
    assert [core.name for core in from_fpcore(text)] == ["grey"]


def test_a_constant_has_no_arguments_and_no_precondition() -> None:
    text = to_fpcore([make("div", const(1), PI)], "c", {}, ())
    assert text.startswith("(FPCore ()")
    assert ":pre " not in text
    assert evaluate_precisely(from_fpcore(text)[0].expression, {}) == (1 / math.pi,)


def test_words_of_fpcore_are_escaped() -> None:
    model = a_model(
        "E*PI + log", 'channel E : number in 0..1 = 0 "e"\nchannel PI : number in 0..1 = 0 "p"\n'
        'channel log : number in 0..1 = 0 "l"',
    )  # fmt: skip
    ready = formula(model, {})
    text = to_fpcore([ready.exact], "words", ready.domain, model.quantities)
    assert "(FPCore ($45. $50.I $6c.og)" in text
    assert from_fpcore(text)[0].arguments == ("E", "PI", "log")
    agree(model, text)


@pytest.mark.parametrize("name", ["m", "Rdx", "let", "α", "a b", "2nd", "x'", "(", "$", "if"])
def test_escaped_names_come_back(name: str) -> None:
    assert unescape_name(escape_name(name)) == name


def test_texts_are_plain_ascii_strings() -> None:
    text = to_fpcore([const(1)], 'a "b" \\', {}, (), ["Élan – é, 1990"])
    assert ':name "a \\"b\\" \\\\"' in text
    assert ':description "Elan - e, 1990"' in text
    assert text.isascii()
    assert from_fpcore(text)[0].name == 'a "b" \\'


@pytest.mark.parametrize(
    "value", ["1/3", "-2/7", "0.1", "1e-30", "123456789012345678901234567890", "1e400", "-1e-400"]
)
def test_numbers_come_back_exactly(value: str) -> None:
    text = to_fpcore([const(Fraction(value))], "n", {}, ())
    assert from_fpcore(text)[0].expression is const(Fraction(value))


def test_numbers_of_float32_come_back_exactly() -> None:
    for value in (2.0**-149, single(0.1), 3.4028234663852886e38):
        text = to_fpcore([const(Fraction(value))], "n", {}, ())
        assert from_fpcore(text)[0].expression is const(Fraction(value))


def test_scalars_have_no_vectors_in_them() -> None:
    v = quantity("v", 3)
    found = scalars(component_of_product(v))
    assert found == (make("mul", component(v, 1), const(2)),)


def component_of_product(v: Expression) -> Expression:
    return component(make("mul", v, vector([const(1), const(2), const(3)])), 1)


def test_beckmann() -> None:
    (core,) = from_fpcore(BECKMANN)
    assert core.arguments == ("alphax", "alphay", "u0", "cos2phi", "sin2phi")
    assert core.domain["alphax"] == Interval(0.0001, 1.0)
    assert core.domain["sin2phi"] == Interval(0.0, INF)
    point = {"alphax": [0.3], "alphay": [0.2], "u0": [0.7], "cos2phi": [0.4], "sin2phi": [0.6]}
    expected = -math.log(1 - 0.7) / (0.4 / 0.09 + 0.6 / 0.04)
    assert evaluate_precisely(core.expression, point)[0] == pytest.approx(expected, rel=1e-13)


def test_trowbridge_reitz() -> None:
    (core,) = from_fpcore(TROWBRIDGE_REITZ)
    assert core.name == "Trowbridge-Reitz sample, near normal"
    assert core.domain["u1"] == Interval(2.328306437e-10, 0.5)
    found = evaluate_precisely(core.expression, {"u0": [0.3], "u1": [0.1], "alpha": [0.5]})[0]
    expected = 0.5 * math.sqrt(0.3 / 0.7) * math.cos(0.1 * 6.28318530718)
    assert found == pytest.approx(expected, rel=1e-13)


def test_gtr1() -> None:
    (core,) = from_fpcore(GTR1)
    assert core.domain == {"cosTheta": Interval(0.0, 1.0), "alpha": Interval(0.0001, 0.5)}
    found = evaluate_precisely(core.expression, {"cosTheta": [0.9], "alpha": [0.25]})[0]
    a2 = 0.0625
    expected = (a2 - 1) / (math.pi * math.log(a2) * (1 + (a2 - 1) * 0.81))
    assert found == pytest.approx(expected, rel=1e-13)


def test_microfacet_benchmarks_come_back_the_same() -> None:
    for core in from_fpcore(BECKMANN + TROWBRIDGE_REITZ + GTR1):
        (again,) = from_fpcore(to_fpcore([core.expression], core.name, core.domain, ()))
        point = {name: [0.37] for name in core.arguments}
        assert again.name == core.name
        values = [evaluate_precisely(c.expression, point) for c in (core, again)]
        assert values[0] == values[1]


def test_let_binds_at_once_and_let_star_in_a_row() -> None:
    at_once, in_a_row = (
        from_fpcore(f"(FPCore (x) ({let} ((x 2) (y x)) (+ x y)))")[0].expression
        for let in ("let", "let*")
    )
    assert evaluate_precisely(at_once, {"x": [10.0]}) == (12.0,)
    assert evaluate_precisely(in_a_row, {"x": [10.0]}) == (4.0,)


def test_operators_that_are_written_out() -> None:
    text = "(+ (fma x x x) (+ (expm1 x) (+ (log1p x) (+ (hypot x 2) (fdim x 0x1.8p0)))))"
    (core,) = from_fpcore(f"(FPCore (x) {text})")
    expected = 6 + math.expm1(2) + math.log1p(2) + math.hypot(2, 2) + 0.5
    assert evaluate_precisely(core.expression, {"x": [2.0]})[0] == pytest.approx(expected)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("(FPCore (x) (+ x y))", "nothing here is called 'y'"),
        ("(FPCore (x) (gamma x))", "'gamma' is no operator"),
        ("(FPCore (x) (while (< x 1) ((x 0 (+ x 1))) x))", "'while' is no operator"),
        ("(FPCore (x) (sqrt x x))", "'sqrt' takes 1 argument"),
        ("(FPCore (x) (+ x 1)", "never closed"),
        ("(FPCore (x) x))", "closes none"),
        ('(FPCore (x) :name "a x)', "does not end"),
        ("(FPCore (x))", "has no formula"),
        ("(FPCore x)", "no list of arguments"),
        ("(FPCore (x) :name)", "expected a property and its value|nothing here is called"),
        ("(FPCore (x) ())", "expected an operator"),
        ("(FPCore (x) (if x 1))", "'if' takes"),
        ("(FPCore (x) (let ((y)) y))", "expected \\(name value\\)"),
        ("hello", "expected \\(FPCore"),
        ("(FPCore (x) " + "(sqrt " * 1000 + "x" + ")" * 1001, "deep"),
        ("(FPCore (x) (and " + "(< x 1) " * 1000 + "))", "deep"),
        ("(FPCore (x) " + "9" * 5000 + ")", "more than 1,000 letters"),
    ],
)
def test_what_cannot_be_read_is_an_error_with_its_place(text: str, message: str) -> None:
    with pytest.raises(ModelError, match=message) as caught:
        from_fpcore(text, "trial.fpcore")
    assert str(caught.value).startswith("trial.fpcore:1:")


def test_the_command_prints_or_writes(tmp_path: Path) -> None:
    run = CliRunner()
    printed = run.invoke(command, ["ward", "--fpcore", "--set", "incident=40deg"])
    assert printed.exit_code == 0
    assert ":cite (ward-1992)" in printed.output
    assert "incident" not in printed.output
    file = tmp_path / "ward.fpcore"
    written = run.invoke(command, ["ward", "--fpcore", "--set", "incident=40deg", "-o", str(file)])
    assert written.exit_code == 0
    assert file.read_text() == printed.output


def test_the_command_wants_a_format() -> None:
    refused = CliRunner().invoke(command, ["ward"])
    assert refused.exit_code == 2
    assert "--fpcore" in refused.output
