"""Curves, tables and tints: against NumPy written another way, and against the reference engine.

Measured with iccdev 0.1.1 and followed bit for bit: the order in which a table's corners are added;
the one product of a sampled curve that is rounded before the sum; the steps of each formula that
are rounded to float32; what formulas give where ICC.2 leaves them undefined; 1 or 0 from a sampled
curve for what is not finite; tables clamp their inputs there, NaN to 0 (older releases do not);
curves sampled from calculators see the variables of the run, are sampled 16384 times at most, and
give their first sample for what is not finite.

Not followed: tints of whole numbers, which are read from the wrong places there.
"""

import itertools
import math

import numpy as np
import pytest
from calc.calc_elements import (
    ALONE,
    CALCULATED,
    CURVE_SETS,
    FORMULAS,
    LINE,
    SAMPLED,
    SEGMENTED,
    TABLES,
    TINTS,
    calculated,
    formula,
)
from engine_reference import encoded, judged, ulps

from brdfc.calc.calculator_curves import CalculatorCurve
from brdfc.calc.curves import CurveSet, SegmentedCurve
from brdfc.calc.program import Op, Program
from brdfc.calc.samples import Samples, Storage
from brdfc.calc.tables import LookupTable
from brdfc.calc.text import assemble
from brdfc.calc.tints import TintArray
from brdfc.engine.interpreter import run

RANDOM = np.random.default_rng(4)


# ---------------------------------------------------------------- against formulas


def interpolated(table, point):
    """The n-linear interpolation at one point, as a sum over corners in float64."""
    values = table.samples.values.astype(float).reshape(*table.grid, table.outputs)
    position = [x * (n - 1) for x, n in zip(point, table.grid, strict=True)]
    cell = [min(int(p), n - 2) for p, n in zip(position, table.grid, strict=True)]
    total = np.zeros(table.outputs)
    for corner in itertools.product((0, 1), repeat=table.inputs):
        weight = math.prod(
            1 - abs(p - (c + k)) for p, c, k in zip(position, cell, corner, strict=True)
        )
        total += weight * values[tuple(np.add(cell, corner))]
    return total


@pytest.mark.parametrize("table", TABLES, ids=lambda t: f"{t.signature}{t.inputs}")
def test_tables(table):
    points = RANDOM.uniform(0, 1, (40, table.inputs)).astype(np.float32)
    points = np.concatenate([points, [[0] * table.inputs], [[1] * table.inputs]])
    expected = [interpolated(table, point) for point in points.astype(float)]
    np.testing.assert_allclose(run(table, points, {}), expected, atol=2e-6)


def test_tables_hold_their_inputs():
    table = LookupTable(2, 1, (3, 2), Samples.of([0, 1, 2, 3, 4, 5]))
    inside = [[0, 0], [1, 1], [0, 1], [0.5, 0.5]]
    beyond = [[-np.inf, np.nan], [np.inf, 2], [np.nan, 1e30], [0.5, 0.5]]
    np.testing.assert_array_equal(run(table, inside, {}), [[0], [5], [1], [2.5]])
    np.testing.assert_array_equal(run(table, beyond, {}), [[0], [5], [1], [2.5]])


@pytest.mark.parametrize("key", SAMPLED)
def test_sampled_curves(key):
    _, extend, _ = key
    curve = SAMPLED[key]
    values = curve.samples.values.astype(float)
    grid = np.linspace(curve.first, curve.last, len(values))
    x = np.concatenate([RANDOM.uniform(-1, 2, 500).astype(np.float32), grid.astype(np.float32)])
    expected = np.interp(x.astype(float), grid, values)
    if extend:
        low = values[0] + (x - grid[0]) * (values[1] - values[0]) / (grid[1] - grid[0])
        high = values[-1] + (x - grid[-1]) * (values[-1] - values[-2]) / (grid[-1] - grid[-2])
        expected = np.where(x < grid[0], low, np.where(x > grid[-1], high, expected))
    found = run(CurveSet((curve,)), x[:, None], {})[:, 0]
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-6 * len(x))


PLAIN = {
    0: lambda x, g, a, b, c: (a * x + b) ** g + c,
    1: lambda x, g, a, b, c, d: a * np.log10(b * x**g + c) + d,
    2: lambda x, a, b, c, d, e: a * b ** (c * x + d) + e,
    3: lambda x, g, a, b, c, d: a * max(b * x + c, 0) ** g + d,
    4: lambda x, g, a, b, c, d: a * np.log(d * x**g - b) + c,
    5: lambda x, g, a, b, c, d, e: e * np.exp((d * x**g - c) / a) + b,
    6: lambda x, w, g, a, b, c, d, e: d * (max(e * x**g - a, 0) / (b - c * x**g)) ** w,
    7: lambda x, w, g, a, b, c, d: d * ((a + b * x**g) / (1 + c * x**g)) ** w,
}


@pytest.mark.parametrize("kind", PLAIN)
def test_formulas(kind):
    x = RANDOM.uniform(0, 2, 100).astype(np.float32)
    expected = [PLAIN[kind](float(v), *FORMULAS[kind].parameters) for v in x]
    found = run(CurveSet((ALONE[kind],)), x[:, None], {})[:, 0]
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6)


def test_segments_meet():
    """A segment holds up to its break; a sampled one starts at its neighbour's end."""
    curve = SEGMENTED[2]
    breaks = np.array(curve.breaks, dtype=np.float32)
    exact = [
        PLAIN[2](curve.breaks[0], *FORMULAS[2].parameters),
        curve.segments[1].samples.values[-1],
        curve.segments[2].samples.values[-1],
    ]
    after = np.nextafter(breaks, np.float32(2))
    found = run(CurveSet((curve,)), np.concatenate([breaks, after])[:, None], {})[:, 0]
    np.testing.assert_allclose(found[:3], exact, rtol=1e-6)
    np.testing.assert_allclose(found[3:5], exact[:2], rtol=1e-4)
    assert found[5] == 2 * after[2]  # the last segment, a line, need not meet


def test_in_a_program():
    """Constants take another way through the interpreter than arrays."""
    table = LookupTable(2, 1, (2, 2), Samples.of([0, 1, 2, 3], Storage.FLOAT16), extended=True)
    curves = CurveSet((SEGMENTED[0], ALONE[3]))
    body = assemble("{ 0.25 in curv(1) clut(0) 0.25 0.5 curv(1) clut(0) out[0,2] }")
    program = Program(1, 2, body, (table, curves))
    result = run(program, [[0.5], [0.5]], {})
    np.testing.assert_array_equal(result[:, 0], result[:, 1])


@pytest.mark.parametrize("tint", TINTS, ids=lambda t: f"{t.samples.storage.name}{t.outputs}")
def test_tints(tint):
    """Integers, too, stand for 0 to 1 at equal steps."""
    steps = tint.samples.values.astype(float).reshape(-1, tint.outputs)
    x = np.concatenate([RANDOM.uniform(-0.5, 1.5, 300), [0, 1, np.inf, -np.inf]])
    at = np.linspace(0, 1, len(steps))
    expected = np.column_stack([np.interp(x.astype(np.float32), at, c) for c in steps.T])
    np.testing.assert_allclose(run(tint, x[:, None], {}), expected, atol=1e-7 * len(steps))


def test_a_tint_of_nothing_is_its_first_step():
    tint = TintArray(2, Samples.of([0.25, 0.5, 0.75, 1]))
    assert run(tint, [[np.nan], [-0.0]], {}).tolist() == [[0.25, 0.5]] * 2


@pytest.mark.parametrize("curve", CALCULATED, ids=lambda c: str(c.size))
def test_calculator_curves(curve):
    """As a sampled curve of the calculator's values, but for what is not finite."""
    at = np.linspace(curve.first, curve.last, curve.points)[:, None]
    values = run(curve.calculator, at, {})[:, 0]
    x = RANDOM.uniform(-2, 3, 300).astype(np.float32)
    inside = x[(x > curve.first) & (x < curve.last)]
    found = run(CurveSet((curve,)), inside[:, None], {})[:, 0]
    finite = np.isfinite(found)
    expected = np.interp(inside.astype(float), at[:, 0], values)
    np.testing.assert_allclose(found[finite], expected[finite], rtol=1e-4, atol=1e-5)
    for few in (x[:1], x):  # as many samples are taken as there are values for, or all
        again = run(CurveSet((curve,)), np.resize(few, 20_000)[:, None], {})[: len(few), 0]
        np.testing.assert_array_equal(run(CurveSet((curve,)), few[:, None], {})[:, 0], again)


@pytest.mark.parametrize("size", [3, 6, 7, 900])
def test_a_calculator_curve_of_a_variable_for_each_pixel(size):
    curves = CurveSet((calculated("env(inci) pop mul cos", size, extend=True),))
    x, gains = RANDOM.uniform(-1, 2, (2, 50)).astype(np.float32)
    found = run(curves, x[:, None], {"inci": gains})
    for i in range(50):
        np.testing.assert_array_equal(found[i], run(curves, [[x[i]]], {"inci": gains[i]})[0])
    constant = Program(1, 1, assemble("{ 0.3 curv out }"), (curves,))
    found = run(constant, x[:, None], {"inci": gains})
    np.testing.assert_array_equal(found[7], run(constant, [[0]], {"inci": gains[7]})[0])


@pytest.mark.parametrize("differing", [False, True])
def test_curves_in_calculators_in_curves_take_what_was_counted(differing):
    """Eighteen levels of two samples each: near the limit of what a pixel may take."""
    curves = CurveSet((calculated("env(inci) pop add", 2),))
    for _ in range(17):
        program = Program(1, 1, assemble("{ in curv out }"), (curves,))
        curves = CurveSet((CalculatorCurve(2, 0.0, 1.0, program),))
    given = {"inci": [0.25, 0.5] if differing else 0.25}
    assert run(curves, [[0.0], [0.5]], given).tolist()[0] == [0.25]


# ---------------------------------------------------------------- against the reference engine

DEGENERATE = [
    *(formula(0, g, 1, 0, 0) for g in (-1, -0.5, 0, 0.5, 1, 2)),
    *(formula(0, 1, 0.7, b, c) for b in (0, 0.3) for c in (0, 0.1)),
    *(formula(1, *p) for p in ((1, 1, 1, 0, 0), (2, 1, 1, -0.5, 0.3))),
    *(formula(2, 1, b, 1, 0, 0) for b in (-2, 0)),
    *(formula(3, g, 1, 1, 0, 0) for g in (-1, 0, 1)),
    *(formula(4, *p) for p in ((1, 1, 0, 0, 1), (2, 1, 0.5, 0.3, 1), (1, 0.7, 0.1, 0.3, 1.3))),
    *(formula(5, *p) for p in ((1, 0, 0.1, 0.2, 0.3, 0.4), (1, 0.7, 0.1, 0.2, 0.3, 0.4))),
    *(formula(6, w, 1, 0.1, 0.7, -0.3, 0.9, 1.1) for w in (-0.5, 0.5, 2)),
    *(formula(7, w, 1, 0.1, 0.7, 0.3, 0.9) for w in (-0.5, 0.5, 2)),
    *(formula(6, w, g, a, 1, 1, 1, 1) for w in (-1, 0.5, 1) for g in (1, 2) for a in (0, -1)),
    *(formula(7, w, g, 1, 1, -1, 1) for w in (-1, 0.5, 1) for g in (1, 2)),
]
SPECIAL = np.array(
    [0, -0.0, 1, -1, 0.5, 2, -2, 0.25, 3, np.inf, -np.inf, np.nan, 1e30, -1e30, 0.1, -0.3, 0.9],
    dtype=np.float32,
)
INPUTS = 7


def padded(element):
    """A program of 7 inputs that calls an element and gives three outputs."""
    name = {"cvst": "curv", "tint": "tint"}.get(element.signature, "clut")
    code = [Op("in", 0, element.inputs), Op(name, 0)]
    code += [Op("in", 0, 1)] * (3 - element.outputs)
    return Program(INPUTS, 3, (*code, Op("out", 0, 3)), (element,))


def test_like_the_reference_engine(tmp_path):
    pytest.importorskip("iccdev")
    elements = [
        *CURVE_SETS,
        *TABLES,
        *(tint for tint in TINTS if tint.samples.storage.one == 1),
        *(CurveSet((SegmentedCurve((), (segment,)),)) for segment in DEGENERATE),
        CurveSet((SegmentedCurve((0.5,), (DEGENERATE[0], LINE)),)),
    ]
    pixels = np.concatenate(
        [
            np.column_stack([np.roll(SPECIAL, i) for i in range(INPUTS)]),
            RANDOM.uniform(0, 1, (300, INPUTS)),
            RANDOM.normal(size=(200, INPUTS)),
        ]
    ).astype(np.float32)
    programs = [padded(element) for element in elements]
    found = judged(tmp_path, programs, pixels)[0]
    for element, program, theirs in zip(elements, programs, found, strict=True):
        ours = encoded(run(program, pixels, {}))
        # A power is an ulp off in one C library or the other.
        assert ulps(ours, theirs).max() <= (isinstance(element, CurveSet)), element


def test_calculator_curves_see_variables_like_the_reference_engine(tmp_path):
    pytest.importorskip("iccdev")
    curve = calculated("env(inci) pop mul cos", 9, -1, 1, extend=True)
    program, pixels = padded(CurveSet((curve,))), RANDOM.uniform(-2, 2, (100, INPUTS))
    given = [{"inci": 2.0}, {"inci": -0.5}, {}]
    theirs = judged(tmp_path, [program], pixels, given)[:, 0]
    for environment, found in zip(given, theirs, strict=True):
        assert ulps(encoded(run(program, pixels, environment)), found).max() <= 1
