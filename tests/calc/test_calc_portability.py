"""Warnings of what releases of the reference engine do differently: where they may, only there."""

import math
import time

import numpy as np
import pytest
from calc_programs import INPUTS, random_program

from brdfc.calc.curves import CurveSet, SampledCurve
from brdfc.calc.disagreements import DISAGREEMENTS
from brdfc.calc.disassembly import disassemble
from brdfc.calc.follow import Follower
from brdfc.calc.portability import portability
from brdfc.calc.program import If, Matrix, Op, Program, Select
from brdfc.calc.samples import Samples, Storage
from brdfc.calc.tables import LookupTable
from brdfc.calc.text import assemble
from brdfc.calc.verify import verify
from brdfc.engine.interpreter import run
from brdfc.symbolic.intervals import Interval

FLOATS = Storage.FLOAT32
TABLE = LookupTable(1, 1, (2,), Samples(FLOATS, np.array([0.5, 2.0], ">f4").tobytes()))
CURVES = CurveSet((SampledCurve(0.0, 1.0, Samples(FLOATS, np.array([1, 3], ">f4").tobytes())),))
MATRIX = Matrix(1, 1, (2.0,), (0.0,))
INNER = Program(1, 1, assemble("{ 1 in div out }"))
ELEMENTS = (TABLE, CURVES, MATRIX, INNER)


def found(text: str, inputs=None, variables=None) -> list[str]:
    made = Program(2, 1, assemble("{" + text + "}"), ELEMENTS)
    verify(made)
    return portability(made, "", inputs, variables)


# ---------------------------------------------------------------- whatever the values are


@pytest.mark.parametrize(
    ("text", "findings"),
    [
        ("in[0,2] add out", []),
        ("in scnt add out noop", ["op 1: 'scnt' is unknown", "op 4: 'noop' is unknown"]),
        ("in[0,2] vxor out", ["op 1: 'vxor' is unknown to older releases"]),
        ("1 out in if { } else { }", ["op 3: an empty 'else' at the end of a block fails"]),
        ("in if { in if { } else { } } 1 out", ["op 3: an empty 'else'"]),
        ("in if { } else { } 1 out", []),
        ("in if { } else { 1 out } 1 out", []),
        ("1 out 0 sel case { pi } case { }", ["op 3: an empty last case"]),
        ("1 out 0 sel case { pi } dflt { }", ["op 3: an empty last case"]),
        ("1 out 0 sel case { } dflt { pi }", []),
        ("1 out in if { 0 sel case { pi } dflt { } }", ["op 5: an empty last case"]),
        ("0 sel case { pi } dflt { } 1 out", []),
    ],
)
def test_what_stands_in_a_program(text, findings):
    lines = found(text)
    assert len(lines) == len(findings)
    assert all(line.startswith(start) for line, start in zip(lines, findings, strict=True))


# ---------------------------------------------------------------- by values

WARNED = [
    ("1 in div out", "op 2: 'div': the divisor may be 0 (any number or NaN)"),
    ("1 in abs div out", "op 3: 'div': the divisor may be 0 (0..inf or NaN)"),
    ("1 2 in sdiv[2] pop out", "op 3: 'sdiv': the divisor may be 0"),
    ("1 2 3 4 5 in[1,1] in(0) 4 div[4] pop(3) out", "op 8: 'div': the divisor may be 0"),
    ("1 0 in vmax div out", "op 4: 'div': the divisor may be 0"),  # x vmax: NaN stays
    ("1 in 0 gt div out", "op 4: 'div': the divisor may be 0 (0..1)"),
    ("1 1e-30 sq div out", "op 3: 'div': the divisor may be 0 (0)"),
    ("in if { 0 } else { 1 } tput 1 tget div out", "op 8: 'div': the divisor may be 0 (0..1)"),
    ("in 0 tput if { 1 tput } 1 tget div out", "op 8: 'div': the divisor may be 0 (0..1)"),
    ("1 in 0 vmax sel case { 0 } dflt { 2 } div out", "op 9: 'div': the divisor may be 0 (0..2)"),
    ("in 0 lt if { 1 } else { 1 in div } out", "op 8: 'div': the divisor may be 0"),
    ("1 env(x) pop div out", "op 3: 'div': the divisor may be 0"),
    ("1 env(x) if { } else { pop 0 } div out", "op 6: 'div': the divisor may be 0"),
    ("1 in mtx(2) div out", "op 3: 'div': the divisor may be 0"),
    ("in 7 mod out", "op 2: 'mod': an operand may be infinite or NaN"),
    ("7 in mod out", "op 2: 'mod': the divisor may be 0, or below 1e-12"),
    ("1e10 1.5 mod out", "op 2: 'mod': the quotient may reach 2^31"),
    ("1e9 2 mod out", None),
    ("1 0.1 mod out", "op 2: 'mod': the quotient may be rounded to a whole number"),
    ("0.09 0.1 mod out", None),
    ("in trnc out", "op 1: 'trnc': the value may reach 2^31 or be NaN"),
    ("in rond out", "op 1: 'rond': the value may reach 2^31 or be NaN"),
    ("in -1e9 vmax 1e9 vmin rond out", None),
    ("1e9 in vmin -1e9 vmax rond out", None),  # max comes last and takes NaN away
    ("in -1e9 vmax 3e9 vmin rond out", "op 5: 'rond': the value may reach 2^31"),
    ("in rnum out", "op 1: 'rnum': the value may be NaN"),
    ("in cos sq 0 1 vmax rnum out pop", None),
    ("in[0,2] eq out", "op 1: 'eq': both values may be NaN"),
    ("in[0,2] neq out", "op 1: 'neq': both values may be NaN"),
    ("in 1 eq out", None),
    ("in sel case { 1 } dflt { 2 } out", "op 1: 'sel': the selector may be NaN"),
    ("in 0 vmax sel case { 1 } dflt { 2 } out", None),
    ("1 0 0 1 1 2 solv(2,2) pop(2) out", "op 6: 'solv': the system is not 3 x 3"),
    ("1 0 0 0 1 0 0 0 in 1 2 3 solv(3,3) pop(3) out", "op 12: 'solv': the determinant may be"),
    ("1 0 0 0 2 0 0 0 1 in copy(1,2) solv(3,3) pop(3) out", None),
    ("in clut(0) out", "op 1: 'clut': an input may be outside 0..1 or NaN"),
    ("in elem(0) out", "op 1: 'clut': an input may be outside 0..1 or NaN"),
    ("in 0 vmax 1 vmin clut(0) out", None),
    ("1 in 0 vmax 1 vmin clut(0) div out", None),  # the table gives 0.5 at least
    ("in curv(1) out", "op 1: 'curv': an input of a sampled curve may be infinite or NaN"),
    ("in 0 vmax 1 vmin curv(1) out", None),
    ("in calc(3) out", "sub-element 3, op 2: 'div': the divisor may be 0"),
    ("in sq 1 vmax calc(3) out", None),
]


@pytest.mark.parametrize(("text", "finding"), WARNED)
def test_by_values(text, finding):
    lines = found(text)
    if finding is None:
        assert lines == []
    else:
        assert [line[: len(finding)] for line in lines] == [finding]


@pytest.mark.parametrize(
    "text",
    [
        "1 in sq 1e-20 vmax div out",
        "1 in 1e-30 vmax div out",  # also of NaN
        "1 in exp 1 add div out",
        "1 in 9 vmin -9 vmax cos div out",  # no float32 has a cosine of 0
        "1 in sign 2 add div out",
        "1 in not 2 add div out",
        "in 0 gt if { 1 in div } else { 0 } out",
        "in 0 le if { 0 } else { in 0 ge if { 1 in 1 add div } else { 0 } } out",
        "in 0 gt not if { 0 } else { 1 in div } out",
        "in[0,2] tsav[0,2] vmin 0 gt if { 1 tget[0,2] pop div } else { 0 } out",
        "in[0,2] vmin ceil if { 1 in[1,1] div } else { 0 } out",
        "in 0 gt in[1,1] 0 lt and if { 1 in[1,1] div } else { 0 } out",
        "in 0 gt in[1,1] 0 lt vand if { 1 in div } else { 0 } out",
        "in 0 le in[1,1] 0 le or if { 0 } else { 1 in[1,1] 2 vmax div } out",
        "in abs 0.5 gt if { 1 in div } else { 0 } out",
        "in neg -1 lt if { 1 in div } else { 0 } out",
        "in 1.4 vmin -1.4 vmax tsav cos 0 gt if { 1 tget cos div } else { 0 } out",
        "1 env(x) if { } else { pop 2 } div out",
        "1 in if { 1 } else { 2 } div out",
        "1 in 0 vmax sel case { 1 } case { 3 } dflt { 2 } div out",
        "0 if { 1 0 div } else { 2 } out",  # never reached
        "1 sel case { 1 0 div } case { 2 } dflt { 3 } out",
        "0 tput 1 tput 1 tget div out",
        "1 2 in if { pop 3 } div out",
    ],
)
def test_proven(text):
    variables = {"x": Interval(0.5, 3.0)}
    assert found(text, [Interval(-10.0, 10.0, undefined=True)] * 2, variables) == []


def test_what_is_given_of_channels_and_variables():
    text = "1 in div 1 env(x) pop in[1,1] add div add out"
    assert len(found(text)) == 2
    inputs = [Interval(0.1, 1.0), Interval(1.0, 2.0)]
    assert found(text, inputs, {"x": Interval(0.0, 1.0)}) == []
    assert len(found(text, inputs, {"x": Interval(-1.5, 1.0)})) == 1


def test_called_calculators():
    """With what they are given; one that is called twice has the findings of both calls."""
    outer = Program(1, 1, assemble("{ 2 calc(0) in calc(0) add out }"), (INNER, INNER))
    assert portability(outer, "M2B0, element 0, ") == [
        "M2B0, element 0, sub-element 0, op 2: 'div': the divisor may be 0 (any number or NaN); "
        "older releases give an infinity or NaN, newer ones 0"
    ]
    assert portability(outer, "", [Interval(1.0, 2.0)]) == []


# ---------------------------------------------------------------- against the interpreter


@pytest.mark.parametrize("row", [row for row in DISAGREEMENTS if row.example], ids=lambda r: r.when)
def test_the_table_says_what_the_engine_does(row):
    made = Program(1, 1, assemble("{" + row.example + " out }"))
    assert run(made, [[0.0]], {})[0, 0] == np.float32(row.result)
    (finding,) = portability(made)
    assert row.when in finding
    assert row.older in finding


def test_intervals_hold_what_programs_compute():
    """Random programs, random pixels: every output lies in its interval, and a program without a
    finding gives the same where x/0 is left to the processor."""
    random = np.random.default_rng(0)
    pixels = random.uniform(-1, 1, (300, INPUTS))
    pixels[100:200] = np.round(2 * pixels[100:200]) / 2
    pixels[200:] *= 10.0 ** random.uniform(-20, 0, (100, INPUTS))
    pixels = pixels.astype(np.float32)
    clean = 0
    for seed in range(150):
        made = random_program(seed)
        follower = Follower({"thti": Interval(0.0, 1.0)})
        intervals = follower.follow(made, [Interval(-1.0, 1.0)] * INPUTS)
        for environment in ({}, {"thti": 0.5, "x": 3.0}):
            values = run(made, pixels, environment)
            for interval, of in zip(intervals, values.T.astype(float), strict=True):
                numbers = of[~np.isnan(of)]
                assert interval.undefined or len(numbers) == len(of), (seed, interval)
                inside = (interval.low <= numbers) & (numbers <= interval.high)
                assert (inside & (abs(numbers) >= interval.gap)).all(), disassemble(made.body)
            if not any(follower.findings.values()):
                clean += 1
                ieee = run(made, pixels, environment, ieee=True)
                assert np.array_equal(ieee, values, equal_nan=True), disassemble(made.body)
    assert clean > 100


# ---------------------------------------------------------------- long and hostile programs

IN, OUT = Op("in", 0, 1), Op("out", 0, 1)


def doubling(levels: int) -> Program:
    """Calls itself, so to say, 2^levels times."""
    made = Program(1, 1, assemble("{ 1 in div out }"))
    for _ in range(levels):
        made = Program(1, 1, assemble("{ in calc(0) calc(1) out }"), (made, made))
    return made


HOSTILE = {
    "calls": doubling(18),
    "a deep stack, and branches that do not balance": Program(
        1, 1,
        (IN, Op("copy", 1, 1500), *((IN, If((IN, If((Op("pop", 1),))))) * 1400), IN, OUT),
    ),
    "a case for every operation": Program(
        1, 1,
        (IN, Op("tput", 7, 1), IN, Select(tuple((IN, Op("tput", i, 1)) for i in range(15000))), IN,
         OUT),
    ),
    "wide vectors": Program(1, 1, (IN, Op("copy", 1, 30000), *[Op("sin", 30000)] * 150, OUT)),
    "conditions on conditions": Program(
        1, 1, (IN, *[Op("not", 1)] * 40000, If((IN, OUT)), IN, OUT)
    ),
}  # fmt: skip


@pytest.mark.parametrize("made", HOSTILE.values(), ids=list(HOSTILE))
def test_time_is_in_proportion(made):
    verify(made)
    started = time.process_time()
    portability(made)
    assert time.process_time() - started < 5  # under 0.7 s where nothing else runs


def test_beyond_what_is_followed_nothing_is_taken_for_granted():
    wide = (IN, Op("copy", 1, 30000), *[Op("sin", 30000)] * 5, Op("pop", 30000))
    made = Program(1, 1, (*wide, *assemble("{ 1 2 div out }")))
    (finding,) = portability(made)
    assert "'div': the divisor may be 0" in finding
    assert math.isinf(Follower({}).follow(made, None)[0].high)


def test_calculators_that_call_each_other_are_not_followed_for_long(function_calls):
    """Fifteen that each call the next one twice: 2^15 times the last, from a few hundred bytes."""
    program = Program(1, 1, assemble("{ in sin cos sq out }"))
    for _ in range(15):
        program = Program(1, 1, assemble("{ in calc(0) calc(0) out }"), (program,))
    verify(program)
    assert function_calls(lambda: Follower({}).follow(program, None)) < 500_000
