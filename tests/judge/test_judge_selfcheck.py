"""The self-check notices what is wrong with a program, says where, and passes what is right."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import pytest

from brdfc import load
from brdfc.calc.program import Block, If, Instruction, Op, Program
from brdfc.compiled import Compiled
from brdfc.compiler import compile_model
from brdfc.engine import kernels
from brdfc.judge.samples import sample
from brdfc.judge.selfcheck import LIMIT, self_check
from brdfc.lang.load import load_text
from brdfc.lang.model import Model
from brdfc.roles import assign_roles
from brdfc.source.errors import ProgramError, SelfCheckError
from brdfc.symbolic.evaluate import evaluate_precisely
from brdfc.symbolic.precise import PreciseEvaluation
from brdfc.symbolic.ranges import domain

HEAD = """model t "T"
channel Rd : XYZ in 0..1 = 0.5
channel x : number in {low}..{high}
env p : angle in -90deg..90deg = 0deg as angp
radiance = """


def model(formula: str, low: float = 0, high: float = 1) -> Model:
    made = load_text(HEAD.format(low=low, high=high) + formula + "\n", "t.brdf")
    assert isinstance(made, Model)
    return made


def compiled(formula: str, low: float = 0, high: float = 1) -> Compiled:
    return compile_model(model(formula, low, high))


@pytest.fixture(scope="module")
def ward() -> Compiled:
    return compile_model(load("ward"))


def check(c: Compiled, program: Program) -> None:
    samples = sample(c.formula.domain, c.roles.channels, c.roles.variables)
    self_check(program, c.formula.exact, c.roles.bindings(), samples)


def changed(block: Block, change: Callable[[Op], Op]) -> Block:
    """A block with a change made to every operator."""
    result: list[Instruction] = []
    for instruction in block:
        if isinstance(instruction, If):
            otherwise = instruction.otherwise
            instruction = If(
                changed(instruction.then, change),
                None if otherwise is None else changed(otherwise, change),
            )
        elif isinstance(instruction, Op):
            instruction = change(instruction)
        result.append(instruction)
    return tuple(result)


def constants(block: Block) -> list[float]:
    found: list[float] = []

    def note(op: Op) -> Op:
        if op.name == "data" and op.value:
            found.append(op.value)
        return op

    changed(block, note)
    return found


def broken(c: Compiled, change: Callable[[Op], Op]) -> Program:
    program = Program(c.program.inputs, c.program.outputs, changed(c.program.body, change))
    assert program != c.program
    return program


def test_the_right_program_passes(ward: Compiled) -> None:
    check(ward, ward.program)
    assert ward.verdict.worst < LIMIT / 5


def scaled(op: Op, value: float) -> Op:
    """A constant of that value made greater by one in ten thousand."""
    is_it = op.name == "data" and op.value == value
    return Op("data", value=float(np.float32(value * 1.0001))) if is_it else op


@pytest.mark.parametrize("name", ["ward", "lambert", "ward_printed", "cook_torrance"])
def test_every_constant_that_is_off_by_one_in_ten_thousand_is_noticed(name: str) -> None:
    c = compile_model(load(name), effort=1)
    for value in set(constants(c.program.body)):
        # The default of an angle that the run always gives is never read.
        if value == pytest.approx(np.pi / 4):
            continue
        program = broken(c, lambda op, v=value: scaled(op, v))
        with pytest.raises(SelfCheckError, match="differs from the model by"):
            check(c, program)


def test_a_wrong_sign_is_noticed(ward: Compiled) -> None:
    with pytest.raises(SelfCheckError):
        check(ward, broken(ward, lambda op: Op("neg", op.first) if op.name == "exp" else op))
    c = compiled("Rd*abs(x) where x > 0.5 else Rd*(-x + 1)", -1, 1)
    minus = broken(c, lambda op: Op("add", op.first) if op.name == "sub" else op)
    with pytest.raises(SelfCheckError):
        check(c, minus)


@pytest.mark.parametrize(("old", "new"), [("ceil", "flor"), ("ceil", "neg"), ("vmin", "vmax")])
def test_a_wrong_condition_is_noticed(ward: Compiled, old: str, new: str) -> None:
    program = broken(ward, lambda op: Op(new, op.first) if op.name == old else op)
    with pytest.raises(SelfCheckError):
        check(ward, program)


def test_temporaries_exchanged_are_noticed(ward: Compiled) -> None:
    reads = sorted({o.first for o in _ops(ward.program.body) if o.name == "tget"})
    first, second = reads[0], reads[-1]
    exchange = {first: second, second: first}

    def change(op: Op) -> Op:
        return Op("tget", exchange.get(op.first, op.first), op.second) if op.name == "tget" else op

    with pytest.raises((SelfCheckError, ProgramError)):
        check(ward, broken(ward, change))


def _ops(block: Block) -> list[Op]:
    found: list[Op] = []

    def note(op: Op) -> Op:
        found.append(op)
        return op

    changed(block, note)
    return found


def test_a_guard_that_is_gone_is_noticed() -> None:
    c = compiled("Rd*sqrt(x)", -1, 1)
    assert c.guards
    keep_left = broken(c, lambda op: Op("vmin", op.first) if op.name == "vmax" else op)
    with pytest.raises(SelfCheckError, match="the program gives"):
        check(c, keep_left)


def test_a_division_by_zero_is_noticed_where_engines_give_infinity(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    c = compiled("Rd/x")
    gone = broken(c, lambda op: Op("data", value=0.0) if 0 < abs(op.value) < 1e-20 else op)
    monkeypatch.setitem(kernels.BINARY, "div", np.divide)
    with pytest.raises(SelfCheckError, match=r"the program gives \[.*(nan|inf).*\] where .*x=0"):
        check(c, gone)


# ------------------------------------------------------------ angles fixed at compile time


@pytest.mark.parametrize("name", ["ward", "lambert", "cook_torrance"])
def test_light_along_the_surface_gives_exactly_nothing(name: str) -> None:
    c = compile_model(load(name), {"incident": "90deg"})
    assert (evaluate_precisely(c.formula.prepared, {}) == np.zeros(3)).all()
    assert [o.name for o in _ops(c.program.body)] == ["data", "data", "data", "out"]


# ------------------------------------------------------------ cancellation

SECANT = """model secant "Ward with 1/cos^2 - 1 for tan^2"
channel Rd : XYZ in 0..1 = 0.5
channel ks : number in 0..1 = 0.05
channel m : roughness in {low}..1 = 0.5
env incident : angle in -90deg..90deg = 45deg as inci
env reflection : angle in -90deg..90deg = 0deg as refl
let delta = (incident - reflection)/2
radiance = cos(incident)*(Rd/pi
    + ks/sqrt(cos(incident)*cos(reflection))*exp(-(1/cos(delta)^2 - 1)/m^2)/(4*pi*m^2))
  where cos(incident) > 0 and cos(reflection) > 0 else 0
"""


def test_cancellation_is_refused_where_the_lobe_is_narrow() -> None:
    narrow = load_text(SECANT.format(low=0.001), "secant.brdf")
    assert isinstance(narrow, Model)
    with pytest.raises(SelfCheckError) as caught:
        compile_model(narrow, effort=1)  # as it is written
    message = str(caught.value)
    assert "limit 0.01" in message
    found = re.search(r"by ([0-9.e-]+) CIEDE2000 .* where incident=.* m=0.00[12]", message)
    assert found, message
    assert float(found[1]) > 0.05
    assert "tan(x)^2" in message


@pytest.mark.parametrize("low", [0.2, 0.5])
def test_the_same_is_accepted_where_the_lobe_is_wide(low: float) -> None:
    wide = load_text(SECANT.format(low=low), "secant.brdf")
    assert isinstance(wide, Model)
    assert compile_model(wide).verdict.worst < LIMIT / 5


# ------------------------------------------------------------ the edges of the domain


def test_a_jump_at_an_end_that_float32_does_not_have_is_forgiven() -> None:
    """The float32 nearest to 0.7 is less than 0.7."""
    compiled("Rd where x >= 0.7 else 0*Rd", 0.7, 1)


def test_a_formula_without_any_value_is_refused() -> None:
    with pytest.raises(SelfCheckError, match="no finite value at any"):
        compiled("Rd*sqrt(-1 - x)")


def test_overflow_inside_the_domain_is_refused() -> None:
    with pytest.raises(SelfCheckError):
        compiled("Rd*exp(100*x)")


def test_points_without_a_value_are_counted() -> None:
    verdict = compiled("Rd*sqrt(x)", -1, 1).verdict
    assert 0 < verdict.undefined < verdict.points


# ------------------------------------------------------------ samples


def test_samples_reach_what_matters() -> None:
    c = load("ward")
    roles = assign_roles(c, {}, ())
    bounds = domain(c.quantities)
    samples = sample(bounds, roles.channels, roles.variables)
    runs = [(r["incident"], r["reflection"]) for r in samples.runs]
    ends = bounds["incident"]
    assert {(ends.low, ends.low), (ends.low, ends.high), (ends.high, ends.high)} <= set(runs)
    assert (ends.high, ends.low) in runs
    for q in roles.channels:
        values = np.concatenate([p[q.name] for p in samples.pixels])
        low, high = np.float32(bounds[q.name].low), np.float32(bounds[q.name].high)
        assert (values.min(axis=0) == low).all()
        assert (values.max(axis=0) == high).all()
    assert sum(np.pi / 2 - 1e-3 < max(map(abs, r)) < np.pi / 2 for r in runs) >= 4
    narrow = 0
    for (ti, tr), pixels in zip(runs, samples.pixels, strict=True):
        slope = abs(np.tan((ti - tr) / 2)) / pixels["m"][:, 0]
        narrow += int(((slope < 2) & (slope > 0.1) & (pixels["m"][:, 0] < 0.003)).sum())
    assert narrow >= 5
    assert 300 <= sum(len(p["m"]) for p in samples.pixels) <= 500


def test_samples_are_the_same_every_time_and_inside_the_domain() -> None:
    c = load("ward")
    roles = assign_roles(c, {}, ["incident"])
    bounds = domain(c.quantities)
    first, second = (sample(bounds, roles.channels, roles.variables) for _ in range(2))
    for a, b in zip(first.pixels, second.pixels, strict=True):
        for name, values in a.items():
            assert (values == b[name]).all()
            assert (values >= np.float32(bounds[name].low)).all()
            assert (values <= np.float32(bounds[name].high)).all()
    assert first.runs == second.runs


def test_the_check_is_quick(ward: Compiled, monkeypatch: pytest.MonkeyPatch) -> None:
    """High precision, which takes nearly all of its time, is asked for once a point."""
    asked = 0
    value = PreciseEvaluation.__call__

    def counted(self: PreciseEvaluation, values: Mapping[str, Sequence[float]]) -> object:
        nonlocal asked
        asked += 1
        return value(self, values)

    monkeypatch.setattr(PreciseEvaluation, "__call__", counted)
    check(ward, ward.program)
    assert asked == ward.verdict.points <= 500


def test_the_search_finds_the_form_that_does_not_cancel() -> None:
    narrow = load_text(SECANT.format(low=0.001), "secant.brdf")
    assert isinstance(narrow, Model)
    compiled = compile_model(narrow)
    assert compiled.form is not None
    assert "secant, turned" in [step.rule for step in compiled.form.derivation]
    assert compiled.verdict.worst < 1e-3
