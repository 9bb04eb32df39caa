"""Our interpreter against the ICC's reference engine: bit for bit where there is one rounding.

Measured with iccdev 0.1.1 and followed by our engine:
- `sum` and `prod` add from the deepest value up; `cb` is (x x) x; a matrix row adds its terms from
  the left, its offset last for 3 or 4 channels in and out and first otherwise, and not at all where
  all offsets are 0 in those shapes;
- `min` and `max` of two values are `vmin` and `vmax`; of three and more, a NaN at the bottom stays;
- `mod` is 0 for divisors below 1e-12; `solv` finds no solution where |determinant| < 1e-8;
- `ctop`, `ptoc`, `tLab` and `tXYZ` are float32 but for the linear parts of the latter two; so are
  the differences that become a and b;
- a `sel` whose last body is empty is refused where it ends a block, as `portability` says.
Not followed: `rond` of an infinity is 10000 there; `eq` and `rnum` know one pattern of NaN only.
"""

import numpy as np
import pytest
from calc.calc_programs import EVERY, INPUTS, random_program
from engine_reference import dispatcher, encoded, judged, ulps

from brdfc.calc.disagreements import DISAGREEMENTS
from brdfc.calc.operators import OPERATORS
from brdfc.calc.portability import portability
from brdfc.calc.program import Matrix, Program
from brdfc.calc.text import assemble, disassemble
from brdfc.engine.interpreter import run
from brdfc.engine.kernels import ROOT_ABOVE
from brdfc.source.errors import LinkError

pytest.importorskip("iccdev")

SPECIAL = np.array(
    [
        *(0, -0.0, 1, -1, 0.5, -0.5, 0.49999997, 1.5, -1.5, 2.5, np.inf, -np.inf, np.nan, 1e-45),
        *(-1e-45, 1e-38, 3.4e38, -3.4e38, 2.0**31, -(2.0**31), 16777217, 1e-5, 1.00001, 3, -3, 7),
        *(0.7, 360, 8388609, 8388607.5, 0.008856, 0.0088565, 0.206, 100),
    ],
    dtype=np.float32,
)


def accepted(seeds, names, length=30):
    """The random programs that the reference does not refuse; without curves, which are powers."""
    kinds = ("matf", "clut", "calc")
    programs = [random_program(seed, names, kinds, length) for seed in seeds]
    return [p for p in programs if not any("rejected" in finding for finding in portability(p))]


# ---------------------------------------------------------------- operator by operator

TRANSCENDENTAL = ("pow", "gama", "atn2", "cbrt", "exp", "log", "ln", "sin", "cos", "tan", "asin",
                  "acos", "atan", "ctop", "ptoc")  # fmt: skip
THREE = Matrix(3, 3, (0.7, -1.1, 0.3, 0.0, 1.0, 0.0, 2.3, 0.1, -0.9), (0.1, 0.0, -3.0))
NO_OFFSETS = Matrix(3, 3, (0.7, -1.1, 0.3, 0.0, 1.0, 0.0, 2.3, 0.1, -0.9), (0.0, 0.0, 0.0))
FLAT = Matrix(2, 1, (0.7, -1.1), (0.3,))
WIDE = Matrix(3, 4, (0.7, -1.1, 0.3) * 4, (0.1, 0.2, 0.3, 0.4))
MATRICES = (THREE, NO_OFFSETS, FLAT, WIDE)


def single_operators():
    """A text for each operator that computes, of three channels in and out."""
    for name, operator in OPERATORS.items():
        effect = operator.effect
        if effect is None or operator.operand.name not in ("VECTOR", "FOLD"):
            continue
        kind = (effect(3, 0), operator.operand.name)
        if kind == ((3, 3), "VECTOR"):
            yield name, f"in[0,3] {name}[3] out[0,3]"
        elif kind == ((6, 3), "VECTOR"):
            yield name, f"in[0,3] in[1,2] in {name}[3] out[0,3]"
        elif kind == ((4, 3), "VECTOR"):
            yield name, f"in[0,3] in(1) {name}[3] out[0,3]"
        elif kind == ((3, 1), "FOLD"):
            both = f"in[0,3] {name}(3) in[0,3] in[0,3] 2 {name}(7)"
            yield name, f"{both} in[0,2] {name} out[0,3]"
        elif kind == ((6, 6), "VECTOR"):
            yield name, f"in[0,2] {name} in(2) out[0,3]"
        elif kind == ((9, 9), "VECTOR"):
            yield name, f"in[0,3] {name} out[0,3]"
    yield "solv", "in[0,3] in[0,3] flip(3) 1 2 0.3 in[0,3] sq[3] solv(3,3) pop out[0,3]"
    yield "solv", "in[0,3] in[0,3] flip(3) 1 2 0.3 in[0,3] sq[3] solv(3,3) 0 0 out[0,3]"
    yield "mtx", "in[0,3] mtx(0) out[0,3]"
    yield "mtx", "in[0,3] mtx(1) out[0,3]"
    yield "mtx", "in[0,2] mtx(2) in[1,2] mtx(2) 0 out[0,3]"
    yield "mtx", "in[0,3] mtx(3) pop out[0,3]"


def test_single_operators(tmp_path):
    random = np.random.default_rng(2)
    x, y = np.meshgrid(SPECIAL, SPECIAL)
    pixels = np.concatenate(
        [
            np.column_stack([x.ravel(), y.ravel(), np.roll(x.ravel(), 7)]),
            random.normal(size=(2000, 3)) * 10 ** random.uniform(-3, 2, size=(2000, 1)),
            random.uniform(0, 1.2, size=(1000, 3)),
            random.normal(size=(1000, 3)) * 10 ** random.uniform(-40, 38, size=(1000, 3)),
        ]
    ).astype(np.float32)
    names, texts = zip(*single_operators(), strict=True)
    programs = [Program(3, 3, assemble("{" + text + "}"), MATRICES) for text in texts]
    found = judged(tmp_path, programs, pixels)[0]
    assert set(TRANSCENDENTAL) < set(names)
    for name, program, theirs in zip(names, programs, found, strict=True):
        ours = encoded(run(program, pixels, {}))
        if name == "rond":
            infinite = np.isinf(pixels)
            assert (theirs[infinite] == encoded(np.float32(10000))).all()
            ours, theirs = ours[~infinite], theirs[~infinite]
        if name == "tLab":
            # Their cube root is an ulp off now and then, and 500 (fx - fy) magnifies it.
            sound = ((pixels > -10) & (pixels < 1e6)).all(axis=1)
            roots = np.cbrt(np.abs(pixels[sound]).max(axis=1, keepdims=True)) + 80
            apart = np.abs(theirs[sound].astype(float) - ours[sound])
            assert (apart <= 1000 * 2.0**-23 * roots).all()
            ours, theirs = (v[(pixels < ROOT_ABOVE).all(axis=1)] for v in (ours, theirs))
        apart = ulps(ours, theirs)
        assert apart.max() <= (name in TRANSCENDENTAL), (name, pixels[apart.argmax() // 3])
        zero = (ours == 0) & (theirs == 0)
        assert (np.signbit(ours) == np.signbit(theirs))[zero].all(), name


# ---------------------------------------------------------------- whole programs

EXACT = tuple(
    name
    for name in EVERY
    if name not in (*TRANSCENDENTAL, "tLab", "tXYZ", "rond", "rnum", "eq", "neq")
)
"""Operators with one rounding, and none whose result depends on a NaN's bits or is wrong there."""
ENVIRONMENTS = ({}, {"thti": 0.75, "azi": -2.0, "a b": 1e-3, "x": 1e-5, "ä": 3.0, "12": 0.5})


def random_pixels(count):
    random = np.random.default_rng(8)
    pixels = random.normal(size=(count, INPUTS)) * 10 ** random.uniform(-2, 2, size=(count, 1))
    whole = random.integers(-1, 4, size=(count, INPUTS))
    return np.where(random.random((count, INPUTS)) < 0.5, pixels, whole).astype(np.float32)


def test_the_newest_release_does_what_the_table_of_disagreements_says(tmp_path):
    rows = [row for row in DISAGREEMENTS if row.result is not None]
    texts = ["{" + row.example + " copy(1,2) out[0,3] }" for row in rows]
    programs = [Program(3, 3, assemble(text)) for text in texts]
    found = judged(tmp_path, programs, np.zeros((1, 3), np.float32))[0]
    for row, theirs in zip(rows, found, strict=True):
        assert (theirs == encoded(np.float32(row.result))).all(), row.when


def test_random_programs_bit_for_bit(tmp_path):
    """400 programs: nested branches that do not balance, every stack move, calls, variables."""
    programs = accepted(range(500), EXACT)
    assert len(programs) > 400
    pixels = random_pixels(60)
    found = judged(tmp_path, programs, pixels, ENVIRONMENTS)
    for environment, results in zip(ENVIRONMENTS, found, strict=True):
        for program, theirs in zip(programs, results, strict=True):
            ours = encoded(run(program, pixels, environment))
            assert ulps(ours, theirs).max() == 0, disassemble(program.body)


def test_random_smooth_programs(tmp_path):
    """With transcendental operators: a difference of an ulp may grow, but not in most programs."""
    names = (*TRANSCENDENTAL, "add", "mul", "sub", "smul", "sum", "neg", "sq", "data", "env")
    programs = accepted(range(300), names)
    pixels = random_pixels(40)
    results = judged(tmp_path, programs, pixels)[0]
    apart = np.array(
        [
            ulps(encoded(run(program, pixels, {})), theirs)
            for program, theirs in zip(programs, results, strict=True)
        ]
    )
    assert (apart <= 1).mean() > 0.98


def test_the_dispatcher_itself(tmp_path):
    """Pixels that take 50 different branches at once."""
    programs = accepted(range(60), EXACT, length=8)
    pixels = random_pixels(20)
    found = judged(tmp_path, programs, pixels)[0]
    number = np.repeat(np.arange(len(programs)), len(pixels))
    every = np.column_stack([number, np.tile(pixels, (len(programs), 1))])
    ours = encoded(run(dispatcher(programs), every, {}))
    assert ulps(ours, found.reshape(-1, 3)).max() == 0


@pytest.mark.parametrize(
    "text",
    [
        "in[0,3] out[0,3] in sel case { pi } case { }",
        "in[0,3] out[0,3] in if { in sel case { pi } dflt { } } pi",
    ],
)
def test_what_the_reference_refuses(tmp_path, text):
    program = Program(3, 3, assemble("{" + text + "}"))
    assert any("an empty last case" in finding for finding in portability(program))
    with pytest.raises(LinkError):
        judged(tmp_path, [program], np.zeros((1, 3), np.float32))
