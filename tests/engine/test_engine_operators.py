"""Every operator against what the fact sheet and plain arithmetic expect of it."""

import math

import numpy as np
import pytest
from calc.calc_elements import APPEARANCE

from brdfc.calc.curves import CurveSet, SampledCurve
from brdfc.calc.operators import OPERATORS, Operand
from brdfc.calc.program import Matrix, Op, OpaqueElement, Program
from brdfc.calc.samples import Samples
from brdfc.calc.tables import LookupTable
from brdfc.calc.text import assemble
from brdfc.calc.tints import TintArray
from brdfc.calc.verify import verify
from brdfc.engine import interpreter
from brdfc.engine.elements import Setting
from brdfc.engine.interpreter import run
from brdfc.engine.kernels import BINARY, FOLDED, GROUPED, SCALED, UNARY
from brdfc.engine.tables import Interpolation
from brdfc.source.errors import ProgramError

INF, NAN = math.inf, math.nan


def calculate(text: str, *values: float, environment=None, elements=()) -> list[float]:
    """What a text leaves on the stack for these inputs; everything there goes to the outputs."""
    body = assemble("{" + text + "}")
    pushed = Program(
        len(values), 0, (Op("in", 0, len(values)), *body) if values else body, elements
    )
    depth = depth_after(pushed)
    program = Program(pushed.inputs, depth, (*pushed.body, Op("out", 0, depth)), elements)
    pixels = np.array([values], dtype=np.float32)
    result = run(program, pixels, environment or {})
    # Constants take another way through the interpreter than arrays: both must agree.
    blocks = run(program, np.repeat(pixels, 3, axis=0), environment or {})
    np.testing.assert_array_equal(blocks, np.repeat(result, 3, axis=0))
    assert result.dtype == np.float32
    return [float(v) for v in result[0]]


def depth_after(program: Program) -> int:
    for depth in range(100):
        try:
            verify(
                Program(program.inputs, 0, (*program.body, Op("pop", depth + 1)), program.elements)
            )
        except ProgramError:
            return depth
    raise AssertionError


def same(found: float, expected: float) -> bool:
    if math.isnan(expected):
        return math.isnan(found)
    wanted = float(np.float32(expected))
    return found == wanted and math.copysign(1, found) == math.copysign(1, wanted)


def test_every_operator_of_the_table_is_known_and_no_other():
    kernels = [*UNARY, *BINARY, *SCALED, *FOLDED, *GROUPED]
    assert len(kernels) == len(set(kernels))
    assert set(kernels) <= set(OPERATORS)
    matrix = Matrix(1, 1, (1.0,), (0.0,))
    calls = {
        "calc": Program(1, 1, assemble("{ in out }")),
        "curv": CurveSet((SampledCurve(0.0, 1.0, Samples.of([0, 1])),)),
        "clut": LookupTable(1, 1, (2,), Samples.of([0, 1])),
        "tint": TintArray(1, Samples.of([0, 1])),
        "tJab": APPEARANCE["XtoJ"],
        "fJab": APPEARANCE["JtoX"],
    }
    for name, operator in OPERATORS.items():
        elements = (calls.get(name, matrix),)
        first = {"out": 0, "in": 0, "tget": 0}.get(name, 3 if name in ("solv", "tran") else 2)
        first = 0 if operator.operand in (Operand.SPAN, Operand.ELEMENT) else first
        second = {"solv": 3, "tran": 3}.get(name, 1)
        body = [Op("in", 0, 1), Op("copy", 1, 20), Op("tput", 0, 1), Op(name, first, second)]
        run(Program(1, 1, (*body, Op("out", 0, 1)), elements), [[0.5]], {})
    # A kernel without a row, or a name without a branch, ends in the interpreter's last `else`.
    setting = Setting({}, BINARY, Interpolation.LINEAR)
    with pytest.raises(AssertionError):
        interpreter._other(Op("unheard"), interpreter._Machine(Program(0, 0, ()), setting, []))


@pytest.mark.parametrize(("name", "kind"), [("tint", "tint"), ("elem", "emtx"), ("elem", "bACS")])
def test_elements_that_are_only_carried(name, kind):
    """Numbers of a type that is not run, spectra, and a marker that changes how many channels."""
    program = Program(
        1, 2, assemble(f"{{ in {name} out[0,2] }}"), (OpaqueElement(kind, 1, 2, b""),)
    )
    with pytest.raises(ProgramError, match=f"elements of kind '{kind}' cannot be run"):
        run(program, [[1.0]], {})


BINARY_CASES = {
    "add": [(1, 2, 3), (0.1, 0.2, np.float32(0.1) + np.float32(0.2)), (INF, -INF, NAN)],
    "sub": [(1, 2, -1), (0, 0, 0.0), (-0.0, 0, -0.0)],
    "mul": [(3, -0.0, -0.0), (INF, 0, NAN), (3e38, 10, INF), (1e-45, 0.4, 0.0)],
    # x/0 differs between releases; ours follows the newest.
    "div": [(1, 3, np.float32(1) / np.float32(3)), (1, 0, 0), (0, 0, 0), (-1, -0.0, 0),
            (INF, 0, 0)],
    "mod": [(7, -3, 1), (-7, 3, -1), (-5.5, 2, -1.5), (5, 0, 0), (INF, 2, 0), (1, INF, 0)],
    "pow": [(2, 10, 1024), (0, 0, 1), (0, -1, INF), (-2, 3, -8), (-8, 1 / 3, NAN), (NAN, 0, 1),
            (-INF, 0.5, INF), (-0.0, 0.5, 0), (-INF, 2, INF), (-INF, -1, -0.0)],
    "atn2": [(1, 2, 1.1071488), (0, 0, 0), (-1, 0, math.pi), (-1, -0.0, -math.pi),
             (0, -1, -1.5707964)],
    "lt": [(1, 2, 1), (2, 2, 0), (NAN, 1, 0), (1, NAN, 0), (-0.0, 0, 0)],
    "le": [(1, 2, 1), (2, 2, 1), (NAN, 1, 0), (3, 2, 0), (0, -0.0, 1)],
    "gt": [(1, 2, 0), (2, 1, 1), (NAN, 1, 0), (1, NAN, 0)],
    "ge": [(2, 2, 1), (1, 2, 0), (NAN, NAN, 0), (INF, 1, 1)],
    "eq": [(0, -0.0, 1), (1, 1, 1), (1, 2, 0), (NAN, NAN, 1), (NAN, 1, 0), (INF, INF, 1)],
    "neq": [(0, -0.0, 0), (1, 2, 1), (NAN, NAN, 0), (NAN, 1, 1)],
    "near": [(0, 1e-5, 1), (0, 1.1e-5, 0), (1, 1.00001, 0), (1, 1.000009, 1), (NAN, NAN, 0),
             (INF, INF, 0)],
    "vmin": [(1, 2, 1), (NAN, 5, 5), (5, NAN, NAN), (-0.0, 0, 0.0), (0, -0.0, -0.0)],
    "vmax": [(1, 2, 2), (NAN, 5, 5), (5, NAN, NAN), (-0.0, 0, 0.0), (0, -0.0, -0.0)],
    "vand": [(1, 1, 1), (0.5, 7, 1), (0.4999, 1, 0), (NAN, 1, 0), (-3, 1, 0)],
    "vor": [(0, 0, 0), (0, 0.5, 1), (NAN, 0, 0), (NAN, 1, 1)],
    "vxor": [(1, 1, 0), (1, 0, 1), (NAN, 1, 1), (0, 0, 0)],
}  # fmt: skip

UNARY_CASES = {
    "neg": [(0, -0.0), (-0.0, 0.0), (3, -3), (NAN, NAN)],
    "sq": [(-3, 9), (1e30, INF), (NAN, NAN)],
    "sqrt": [(9, 3), (-1, NAN), (-0.0, -0.0), (INF, INF), (2, np.sqrt(np.float32(2)))],
    "cb": [(-2, -8), (1e-20, 0)],
    "cbrt": [(-8, -2), (27, 3), (-0.0, -0.0)],
    "sign": [(3, 1), (-0.1, -1), (0, 0), (-0.0, 0), (NAN, 0), (-INF, -1)],
    "abs": [(-3, 3), (-0.0, -0.0), (NAN, NAN), (-INF, INF)],
    "flor": [(1.5, 1), (-1.5, -2), (-0.0, -0.0), (INF, INF), (NAN, NAN), (3e38, 3e38)],
    "ceil": [(1.5, 2), (-1.5, -1), (-0.5, -0.0), (-INF, -INF)],
    "trnc": [(1.9, 1), (-1.9, -1), (-0.5, 0.0), (-0.0, 0.0), (3e9, 2.0**31), (-INF, -(2.0**31)),
             (NAN, 0)],
    "rond": [(0.5, 1), (-0.5, -1), (1.5, 2), (2.5, 3), (-2.5, -3), (0.49999997, 0), (-0.4, 0.0),
             (3e9, 2.0**31), (-3e9, -(2.0**31)), (INF, 2.0**31), (NAN, 0), (8388609, 8388609)],
    "exp": [(0, 1), (1, math.e), (100, INF), (-200, 0), (-INF, 0)],
    "log": [(1000, 3), (0, -INF), (-1, NAN)],
    "ln": [(math.e, np.log(float(np.float32(math.e)))), (0, -INF), (-1, NAN)],
    "sin": [(0, 0), (-0.0, -0.0), (1, math.sin(1)), (INF, NAN),
            (1e20, math.sin(float(np.float32(1e20))))],
    "cos": [(0, 1), (1, math.cos(1)), (-INF, NAN)],
    "tan": [(1, math.tan(1)), (math.pi / 2, math.tan(float(np.float32(math.pi / 2))))],
    "asin": [(1, math.pi / 2), (0.3, math.asin(float(np.float32(0.3)))), (1.1, NAN)],
    "acos": [(1, 0), (-1, math.pi), (-1.1, NAN)],
    "atan": [(1, math.pi / 4), (INF, math.pi / 2), (-0.0, -0.0)],
    "rnum": [(1, 1), (INF, 0), (-INF, 0), (NAN, 0), (3e38, 1)],
    "not": [(0.5, 0), (0.4999, 1), (-2.5, 1), (NAN, 1), (1, 0)],
}  # fmt: skip


def test_the_cases_are_complete():
    assert set(BINARY_CASES) == set(BINARY)
    assert set(UNARY_CASES) == set(UNARY)


@pytest.mark.parametrize(
    ("name", "x", "y", "expected"), [(n, *c) for n, cases in BINARY_CASES.items() for c in cases]
)
def test_binary(name, x, y, expected):
    (found,) = calculate(name, x, y)
    assert same(found, expected)
    if name in SCALED.values():
        scaled = next(s for s, n in SCALED.items() if n == name)
        assert same(calculate(scaled, x, y)[0], expected)


@pytest.mark.parametrize(
    ("name", "x", "expected"), [(n, *c) for n, cases in UNARY_CASES.items() for c in cases]
)
def test_unary(name, x, expected):
    assert same(calculate(name, x)[0], expected)


@pytest.mark.parametrize(
    ("text", "values", "expected"),
    [
        # Folds run from the deepest value up and round after every term.
        ("sum(3)", (1e8, 1, -1e8), [0.0]),
        ("sum(3)", (1e8, -1e8, 1), [1.0]),
        ("prod(3)", (1e30, 1e30, 1e-30), [INF]),
        ("min(3)", (2, 1, 3), [1]),
        ("max", (2, 1), [2]),
        ("min(3)", (NAN, 1, 3), [NAN]),
        ("min(3)", (2, NAN, 1), [1]),
        ("max(3)", (NAN, 1, 3), [NAN]),
        # Two values are compared as vmin and vmax compare them.
        ("min", (NAN, 1), [1]),
        ("min", (1, NAN), [NAN]),
        ("max", (NAN, 1), [1]),
        ("and(3)", (1, NAN, 1), [1]),
        ("and(3)", (1, 0.4, 1), [0]),
        ("or(3)", (0, NAN, 0), [0]),
        ("or(3)", (0, 0.5, 0), [1]),
        # Vectors: block X, then block Y.
        ("sub[3]", (1, 2, 3, 10, 20, 30), [-9, -18, -27]),
        ("div[2]", (1, 2, 4, 0), [0.25, 0]),
        ("smul[3]", (1, 2, 3, 10), [10, 20, 30]),
        ("ssub[2]", (1, 2, 10), [-9, -8]),
        ("gama[2]", (2, 3, 2), [4, 9]),
        ("sdiv[2]", (2, 3, 0), [0, 0]),
        ("neg[2]", (7, 2, 3), [7, -2, -3]),
        # Moves, the top on the right.
        ("copy(2,2)", (1, 2), [1, 2, 1, 2, 1, 2]),
        ("copy", (1, 2), [1, 2, 2]),
        ("rotl(4,1)", (1, 2, 3, 4), [2, 3, 4, 1]),
        ("rotr(4,1)", (1, 2, 3, 4), [4, 1, 2, 3]),
        ("rotl(3,7)", (0, 1, 2, 3), [0, 2, 3, 1]),
        ("rotr(3,7)", (0, 1, 2, 3), [0, 3, 1, 2]),
        ("posd(2,2)", (1, 2, 3), [1, 2, 3, 2, 2]),
        ("posd", (1, 2), [1, 2, 2]),
        ("flip(3)", (0, 1, 2, 3), [0, 3, 2, 1]),
        ("pop(2)", (1, 2, 3), [1]),
        ("tran(2,3)", (1, 2, 3, 4, 5, 6), [1, 4, 2, 5, 3, 6]),
        ("tran(1,3)", (1, 2, 3), [1, 2, 3]),
        ("noop scnt", (5, 6), [5, 6, 2]),
        ("pi +INF -INF NaN 1.5", (), [math.pi, INF, -INF, NAN, 1.5]),
        # Temporaries and channels: the deepest goes to the lowest.
        ("tput[4,3] tget(5) tget[4,2]", (1, 2, 3), [2, 1, 2]),
        ("tsav[0,2] tget[0,2]", (1, 2), [1, 2, 1, 2]),
        ("in(1)", (7, 8), [7, 8, 8]),
        # Variables: value, then whether it is defined.
        ("env(thti) env(none)", (), [0.5, 1, 0, 0]),
        ("env(true) env(ndef)", (), [1, 1, 0, 0]),
        ("env(x)", (), [NAN, 1]),
        ("env(none) if { } else { pop 7 }", (), [7]),
        # Coordinates and colour.
        ("ctop", (0, -2), [2, 270]),
        ("ctop", (-1, 0), [1, 180]),
        ("ctop[2]", (3, 0, 4, 1), [5, 1, 53.1301003, 90]),
        ("ptoc", (1, 90), [-4.37113883e-08, 1]),
        ("tLab", (0, 0, 0), [-5.96046448e-08, 0, 0]),
        ("tLab", (1, 1, 1), [100, 0, 0]),
        ("tXYZ", (100, 0, 0), [1, 1, 1]),
        ("tXYZ rotr(3) pop(2)", (5, 10, 10), [0.0]),
        # solv: three equations, else zeros and 0.
        ("solv(3,3)", (2, 0, 0, 0, 4, 0, 0, 0, 8, 1, 1, 1), [0.5, 0.25, 0.125, 1]),
        ("solv(3,3)", (0, 1, 0, 1, 0, 0, 0, 0, 1, 5, 6, 7), [6, 5, 7, 1]),
        ("solv(3,3)", (1, 2, 3, 2, 4, 6, 1, 1, 1, 1, 1, 1), [0, 0, 0, 0]),
        ("solv(2,2)", (1, 0, 0, 1, 5, 6), [0, 0, 0]),
        ("solv(3,2)", (1, 0, 0, 1, 1, 1, 5, 6, 7), [0, 0, 0]),
    ],
)
def test_others(text, values, expected):
    found = calculate(text, *values, environment={"thti": 0.5, "x": NAN, "true": 9, "ndef": 9})
    assert len(found) == len(expected)
    assert all(same(f, e) for f, e in zip(found, expected, strict=True)), found


def test_solve_against_numpy():
    random = np.random.default_rng(4)
    systems = random.normal(size=(500, 12)).astype(np.float32)
    program = Program(12, 4, assemble("{ in[0,12] solv(3,3) out[0,4] }"))
    found = run(program, systems, {})
    a, b = systems[:, :9].reshape(-1, 3, 3).astype(float), systems[:, 9:].astype(float)
    good = np.linalg.cond(a) < 50
    assert (found[good, 3] == 1).all()
    np.testing.assert_allclose(
        found[good, :3], np.linalg.solve(a, b[..., None])[good, :, 0], atol=2e-4
    )


def test_lab_against_the_standard():
    """CIE 15: L* = 116 (Y/Yn)^(1/3) - 16, and back."""
    random = np.random.default_rng(5)
    xyz = random.uniform(0.01, 1.2, size=(500, 3)).astype(np.float32)
    lab = run(Program(3, 3, assemble("{ in[0,3] tLab out[0,3] }")), xyz, {})
    f = np.cbrt(xyz.astype(float))
    expected = np.stack(
        [116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], axis=1
    )
    np.testing.assert_allclose(lab, expected, atol=1e-4)
    back = run(Program(3, 3, assemble("{ in[0,3] tXYZ out[0,3] }")), lab, {})
    np.testing.assert_allclose(back, xyz, rtol=2e-6)


def test_matrix():
    """y = M x + c, a row an output."""
    matrix = Matrix(2, 3, (1, 2, 3, 4, 5, 6), (10, 20, 30))
    assert calculate("mtx", 1, 100, elements=(matrix,)) == [211, 423, 635]
    assert run(matrix, [[1, 100]], {}).tolist() == [[211, 423, 635]]
    square = Matrix(3, 3, (1, 0, 0, 0, 1, 0, 0, 0, 1), (0, 0, 0))
    assert math.copysign(1, run(square, [[-0.0, -0.0, -0.0]], {})[0, 0]) == -1
    assert run(Matrix(0, 2, (), (3, 4)), np.empty((2, 0)), {}).tolist() == [[3, 4], [3, 4]]


def test_selector_rounding():
    """Half away from zero; what is no case goes to the default, or nowhere."""
    program = Program(
        1, 1, assemble("{ in sel case { 10 } case { 11 } case { 12 } dflt { -1 } out }")
    )
    given = [-0.4, -0.5, -0.6, 0, 0.49, 0.5, 1.4, 1.5, 2.49, 2.5, 3e9, INF, -INF, NAN]
    expected = [10, -1, -1, 10, 10, 11, 11, 12, 12, -1, -1, -1, -1, 10]
    assert run(program, np.array(given)[:, None], {})[:, 0].tolist() == expected
    for value, wanted in zip(given, expected, strict=True):
        assert run(program, [[value]], {}).tolist() == [[wanted]]
    without = Program(1, 1, assemble("{ 5 in sel case { pop 10 } case { 11 } out }"))
    assert run(without, [[0], [1], [2]], {})[:, 0].tolist() == [10, 11, 5]


def test_conditions():
    """True from one half on; NaN is false."""
    program = Program(1, 1, assemble("{ in if { 1 } else { 2 } out }"))
    given = [0.5, 0.4999999, 1, -1, NAN, INF, 0]
    assert run(program, np.array(given)[:, None], {})[:, 0].tolist() == [1, 2, 1, 2, 2, 1, 2]
