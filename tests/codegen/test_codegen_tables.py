"""Formulas as lookup tables and as curves: they converge, verify, and run in both engines."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

import brdfc
from brdfc.calc.binary import decode_element, encode_element
from brdfc.calc.price import nanoseconds
from brdfc.calc.program import Program
from brdfc.calc.text import disassemble
from brdfc.calc.verify import verify
from brdfc.cmm import reference
from brdfc.codegen.schedule import schedule
from brdfc.codegen.select import Binding, ChannelBinding, VariableBinding, select
from brdfc.codegen.tables import clut_program, curve_program
from brdfc.colour.difference import ciede2000
from brdfc.engine.interpreter import run
from brdfc.profiles.content import Content
from brdfc.profiles.multiplex import profile_pair
from brdfc.roles import assign_roles
from brdfc.source.errors import BrdfcError
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.expression import Expression, const, make, quantity, vector
from brdfc.symbolic.formula import Formula, formula
from brdfc.symbolic.intervals import Interval

ANGLES = {"incident": "40deg", "reflection": "10deg"}
X, Y = quantity("x", 1), quantity("y", 1)
DEAR = make("atan", make("tan", make("sin", make("exp", X))))
"""Dearer than a curve."""
SCALARS: dict[str, Binding] = {"x": ChannelBinding(0, 1), "y": ChannelBinding(1, 1)}


@cache
def model(name: str) -> tuple[Formula, dict[str, Binding]]:
    loaded = brdfc.load(name)
    roles = assign_roles(loaded, ANGLES, ())
    return formula(loaded, roles.constants), roles.bindings()


def plain(e: Expression, **domain: tuple[float, float]) -> Formula:
    """An expression of x and y as a formula, three times the same."""
    ranges = {name: Interval(*ends) for name, ends in domain.items()}
    exact = vector([e, e, e])
    return Formula(exact, ranges)


def pixels(f: Formula, bindings: dict[str, Binding], count: int) -> np.ndarray:
    random = np.random.default_rng(5)
    columns = []
    for name, binding in bindings.items():
        assert isinstance(binding, ChannelBinding)
        interval = f.domain[name]
        columns.append(random.uniform(interval.low, interval.high, (count, binding.width)))
    return np.concatenate(columns, axis=1).astype(np.float32)


def truth(f: Formula, bindings: dict[str, Binding], values: np.ndarray) -> np.ndarray:
    quantities = {
        name: values[:, b.start : b.start + b.width].astype(np.float64)
        for name, b in bindings.items()
        if isinstance(b, ChannelBinding)
    }
    return evaluate(f.exact, quantities)


def worst(f: Formula, bindings: dict[str, Binding], program: Program) -> float:
    """The largest CIEDE2000 of a program; it verifies and survives its own bytes besides."""
    verify(program)
    assert decode_element(encode_element(program), "x") == program
    values = pixels(f, bindings, 5000)
    return float(ciede2000(run(program, values, {}), truth(f, bindings, values)).max())


def calculator(f: Formula, bindings: dict[str, Binding]) -> Program:
    inputs = sum(b.width for b in bindings.values() if isinstance(b, ChannelBinding))
    return schedule(select(f.prepared, bindings), inputs)


@pytest.mark.parametrize("name", ["ward", "cook_torrance", "ward_printed"])
def test_curves_converge_and_are_quicker(name: str) -> None:
    f, bindings = model(name)
    programs = [
        curve_program(f.prepared, f.domain, bindings, points) for points in (64, 256, 1024, 4096)
    ]
    errors = [worst(f, bindings, program) for program in programs]
    # The error of a line between samples goes with the square of their distance, until rounding.
    for coarse, fine in pairwise(errors):
        assert fine < coarse / 8
    assert errors[-1] < 0.001
    by_rule = calculator(f, bindings)
    for program in programs:
        assert program.elements
        assert nanoseconds(program.body, program.elements) < nanoseconds(by_rule.body)


@pytest.mark.parametrize(("name", "grids"), [("ward", (5, 9, 17)), ("cook_torrance", (5, 9))])
def test_tables_converge(name: str, grids: tuple[int, ...]) -> None:
    f, bindings = model(name)
    errors = [
        worst(f, bindings, clut_program(f.prepared, f.domain, bindings, points)) for points in grids
    ]
    assert errors == sorted(errors, reverse=True)


def test_a_multilinear_formula_is_exact_in_the_coarsest_table() -> None:
    f = plain(make("add", make("mul", X, Y), const(1)), x=(-1.0, 3.0), y=(0.0, 0.5))
    assert worst(f, SCALARS, clut_program(f.prepared, f.domain, SCALARS, 2)) < 1e-3


def test_the_text_of_both() -> None:
    f, bindings = model("ward")
    table = disassemble(clut_program(f.prepared, f.domain, bindings, 2).body)
    assert " ".join(table.split()) == (
        "{ in[0,5] 0.00100000005 ssub 1.001001 smul 0 copy(1,4) vmax[5] 1 copy(1,4) vmin[5] clut "
        "out[0,3] }"
    )
    curves = " ".join(disassemble(curve_program(f.prepared, f.domain, bindings, 64).body).split())
    assert "in[3,2] 0.00100000005 vmax curv mul" in curves
    assert "exp" not in curves


def test_inputs_beyond_their_ranges_are_held() -> None:
    f, bindings = model("ward")
    inside = np.array([[0, 1, 0.5, 1, 0.001]], np.float32)
    beyond = np.array([[-5, 2, 0.5, np.inf, np.nan]], np.float32)
    program = clut_program(f.prepared, f.domain, bindings, 3)
    np.testing.assert_array_equal(run(program, beyond, {}), run(program, inside, {}))
    program = curve_program(f.prepared, f.domain, bindings, 64)
    for m in (-np.inf, -1.0, 0.0, np.nan):
        off, edge = np.array([[0.5] * 4 + [m]]), np.array([[0.5] * 4 + [0.001]])
        np.testing.assert_array_equal(run(program, off, {}), run(program, edge, {}))


def test_steps_follow_the_function() -> None:
    """x^(1/4) is steep at 0: equal steps in sqrt(x) are far better there than equal steps in x."""
    root = make("exp", make("div", make("sqrt", make("sqrt", X)), const(3)))
    f = plain(make("mul", make("sin", root), Y), x=(0.0, 1.0), y=(0.0, 1.0))
    program = curve_program(f.prepared, f.domain, SCALARS, 256)
    assert "sqrt curv" in " ".join(disassemble(program.body).split())
    smooth = plain(
        make("mul", make("sin", make("exp", X)), make("cos", Y)), x=(0.0, 1.0), y=(0.0, 1.0)
    )
    assert "sqrt" not in disassemble(
        curve_program(smooth.prepared, smooth.domain, SCALARS, 256).body
    )


def test_jumps_and_cheap_parts_stay_code() -> None:
    jump = make("where", make("lt", X, const(1)), DEAR, const(0))
    f = plain(make("mul", jump, Y), x=(0.0, 2.0), y=(0.0, 1.0))
    program = curve_program(f.prepared, f.domain, SCALARS, 1024)
    text = disassemble(program.body)
    assert len(program.elements) == 1
    assert "lt" in text
    assert "if" in text
    assert worst(f, SCALARS, program) < 0.01
    cheap = plain(make("mul", make("mul", X, X), Y), x=(0.0, 2.0), y=(0.0, 1.0))
    assert not curve_program(cheap.prepared, cheap.domain, SCALARS, 64).elements


def test_a_part_that_is_not_finite_everywhere_stays_code() -> None:
    """Under its condition the logarithm is safe; a curve over the whole range would not be."""
    log = make("exp", make("sin", make("ln", make("sub", X, const(1)))))
    e = make("where", make("gt", make("mul", X, Y), const(3)), log, const(0))
    f = plain(e, x=(1.5, 2.0), y=(0.0, 2.0))
    assert worst(f, SCALARS, curve_program(f.prepared, f.domain, SCALARS, 4096)) < 0.01
    hole = make("where", make("gt", X, Y), make("exp", make("ln", make("sub", X, const(1)))), Y)
    wide = {"x": Interval(0.0, 2.0), "y": Interval(1.0, 2.0)}
    assert not curve_program(hole, wide, SCALARS, 64).elements


def test_one_curve_used_twice_is_looked_up_once() -> None:
    twice = make("add", make("mul", DEAR, Y), make("div", DEAR, make("add", Y, const(2))))
    f = plain(twice, x=(0.0, 1.0), y=(0.0, 1.0))
    program = curve_program(f.prepared, f.domain, SCALARS, 256)
    assert len(program.elements) == 1
    assert disassemble(program.body).count("curv") == 1


@pytest.mark.parametrize("build", [clut_program, curve_program])
def test_variables_must_be_fixed(build) -> None:
    f = plain(make("mul", X, Y), x=(0.0, 1.0), y=(0.0, 1.0))
    bindings = {"x": SCALARS["x"], "y": VariableBinding("thti", 0.0)}
    with pytest.raises(BrdfcError, match=r"follow y, which each run may set\nhint: .* --set y="):
        build(f.prepared, f.domain, bindings, 16)


def test_refused_sizes() -> None:
    f, bindings = model("cook_torrance")
    with pytest.raises(BrdfcError, match="takes 276 MiB; 64 MiB is the most"):
        clut_program(f.prepared, f.domain, bindings, 17)
    for points in (1, 256):
        with pytest.raises(BrdfcError, match="2 to 255 points"):
            clut_program(f.prepared, f.domain, bindings, points)
    for points in (1, 65536):
        with pytest.raises(BrdfcError, match="2 to 65535 points"):
            curve_program(f.prepared, f.domain, bindings, points)


def test_a_table_of_what_is_not_finite_is_refused() -> None:
    e = vector([make("div", X, Y)] * 3)
    domain = {"x": Interval(0.0, 1.0), "y": Interval(0.0, 1.0)}
    with pytest.raises(BrdfcError, match="not finite at every point"):
        clut_program(e, domain, SCALARS, 3)


@pytest.mark.parametrize("name", ["ward", "cook_torrance"])
def test_the_reference_engine_agrees(tmp_path, name: str) -> None:
    pytest.importorskip("iccdev")
    f, bindings = model(name)
    values = pixels(f, bindings, 2000)
    for program in (
        clut_program(f.prepared, f.domain, bindings, 5),
        curve_program(f.prepared, f.domain, bindings, 256),
    ):
        names = [f"c{i}" for i in range(program.inputs)]
        pair = profile_pair(Content("T", program, tuple(names), (0.0,) * len(names)))
        mid, mvis = pair.save(tmp_path / "t_mvis.icc")
        assert reference.validate(mvis)[0] in ("OK", "warning")
        theirs = reference.apply(mid, mvis, values).xyz[0]
        np.testing.assert_allclose(theirs, run(program, values, {}), rtol=2e-6, atol=1e-9)
