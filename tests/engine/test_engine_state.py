"""What the interpreter does with arrays of pixels: branches, calls, blocks and shapes."""

import tracemalloc

import numpy as np
import pytest
from calc.calc_programs import INPUTS, programs
from hypothesis import given, settings

from brdfc.calc.program import Matrix, Op, Program
from brdfc.calc.text import assemble
from brdfc.engine import interpreter
from brdfc.engine.interpreter import BLOCK, run
from brdfc.source.errors import ProgramError

RANDOM = np.random.default_rng(11)
ENVIRONMENT = {"thti": 0.75, "azi": -2.0, "a b": 1e-3}


@settings(max_examples=100, deadline=None)
@given(programs())
def test_pixels_do_not_see_each_other(program):
    """Together, where they take different branches, and one by one: the same bits."""
    pixels = RANDOM.choice(np.array([0, 0.4, 0.5, 1, 1.5, 2, -1, 3e8, np.nan]), size=(9, INPUTS))
    together = run(program, pixels, ENVIRONMENT)
    alone = np.concatenate([run(program, pixel[None], ENVIRONMENT) for pixel in pixels])
    np.testing.assert_array_equal(together.view(np.uint32), alone.view(np.uint32))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("in if { 10 } else { 20 } out", [20, 10, 10]),
        ("5 in if { 1 2 3 } else { 4 } add out", [9, 5, 5]),
        ("7 8 in if { pop } out", [8, 7, 7]),
        ("in sel case { 10 } case { 11 0 0 pop(2) } dflt { 12 } out", [10, 11, 12]),
        ("in sel case { 1 2 } case { 3 } dflt { 4 5 6 } out", [2, 3, 6]),
        ("3 tput in if { in tput } tget out", [3, 1, 2]),
        ("9 out in if { in 2 ge if { 1 out } }", [9, 9, 1]),
        ("in if { in 1 sub if { 1 } else { 2 } } else { 3 } out", [3, 2, 1]),
        ("in if { } else { pop 7 }".replace("pop ", "") + " in out", [0, 1, 2]),
        ("env(thti) if { } else { pop 7 } out", [0.75, 0.75, 0.75]),
        ("in if { 1 tput 5 tput(1) tget(1) } else { 2 tput 6 } tget add out", [8, 6, 6]),
    ],
)
def test_branches(text, expected):
    program = Program(1, 1, assemble("{" + text + "}"))
    assert run(program, [[0], [1], [2]], ENVIRONMENT)[:, 0].tolist() == expected
    for value, wanted in enumerate(expected):
        assert run(program, [[value]], ENVIRONMENT).tolist() == [[wanted]]


def test_calls():
    """A calculator has its own stack and temporaries, and the variables of the run."""
    matrix = Matrix(2, 1, (10.0, 1.0), (0.5,))
    innermost = Program(1, 1, assemble("{ in env(thti) pop mul tput tget out }"))
    inner = Program(2, 2, assemble("{ in[0,2] mtx(0) tput in calc(1) tget out[0,2] }"),
                    (matrix, innermost))  # fmt: skip
    outer = Program(
        2,
        3,
        assemble("{ 100 tput in[0,2] calc 1 if { in[0,2] calc pop pop } tget out[0,3] }"),
        (inner,),
    )
    assert run(outer, [[1, 2], [3, 4]], ENVIRONMENT).tolist() == [
        [0.75, 12.5, 100],
        [2.25, 34.5, 100],
    ]


def test_shapes():
    """Any leading axes, none, no pixels, a view with steps, integers, other float types."""
    program = Program(3, 2, assemble("{ in[0,2] in(2) smul[2] out[0,2] }"))
    image = RANDOM.random((5, 7, 3)).astype(np.float32)
    result = run(program, image, {})
    assert result.shape == (5, 7, 2)
    assert result.dtype == np.float32
    np.testing.assert_array_equal(result[..., 0], image[..., 0] * image[..., 2])
    assert run(program, image[2, 3], {}).shape == (2,)
    np.testing.assert_array_equal(run(program, image[2, 3], {}), result[2, 3])
    assert run(program, np.empty((0, 3)), {}).shape == (0, 2)
    assert run(program, np.empty((4, 0, 3)), {}).shape == (4, 0, 2)
    np.testing.assert_array_equal(run(program, image[::2, ::-3], {}), result[::2, ::-3])
    planar = np.moveaxis(np.ascontiguousarray(np.moveaxis(image, -1, 0)), 0, -1)
    np.testing.assert_array_equal(run(program, planar, {}), result)
    assert run(program, [1, 2, 3], {}).tolist() == [3, 6]
    before = image.copy()
    run(Program(3, 3, assemble("{ in[0,3] neg[3] out[0,3] }")), image, {})
    np.testing.assert_array_equal(image, before)
    assert run(Program(0, 1, assemble("{ 5 out }")), np.empty((4, 0)), {}).tolist() == [[5]] * 4
    assert run(Program(1, 0, ()), np.empty((4, 1)), {}).shape == (4, 0)


@pytest.mark.parametrize(
    ("pixels", "shape"),
    [([[1, 2]], "(1, 2)"), (5.0, "()"), ([], "(0,)"), (np.ones((3, 1)), "(3, 1)")],
)
def test_wrong_channels(pixels, shape):
    with pytest.raises(ProgramError) as caught:
        run(Program(3, 1, assemble("{ in out }")), pixels, {})
    assert str(caught.value) == f"3 channels are needed, the array is {shape}"


def test_only_verified_programs_run():
    with pytest.raises(ProgramError, match="op 1: 'add' needs 2 values"):
        run(Program(1, 1, assemble("{ in add out }")), [[1.0]], {})


def test_more_pixels_than_a_block():
    """Branches, constants and calls give the same at any size and in any block."""
    program = Program(1, 1, assemble("{ in 0.5 sub sin in if { 1 add } else { pi mul } out }"))
    pixels = RANDOM.random((BLOCK + 77, 1)).astype(np.float32)
    whole = run(program, pixels, {})
    np.testing.assert_array_equal(whole[-100:], run(program, pixels[-100:], {}))
    np.testing.assert_array_equal(whole[:100], run(program, pixels[:100], {}))


def test_a_program_that_holds_much_gets_fewer_pixels_at_a_time(monkeypatch):
    """40,000 values a pixel would be 5 GB for a block of the usual size."""
    monkeypatch.setattr(interpreter, "HELD", 1 << 20)
    program = Program(1, 1, assemble("{ in copy(1,39999) sq[20000] sq[20000] sum(40000) out }"))
    pixels = RANDOM.random((100, 1))
    tracemalloc.start()
    result = run(program, pixels, {})
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 64_000_000
    np.testing.assert_array_equal(result[:3], run(program, pixels[:3], {}))


def test_a_matrix_runs_alone():
    matrix = Matrix(1, 2, (2.0, 3.0), (0.0, 1.0))
    assert run(matrix, [[[1], [2]]], {}).tolist() == [[[2, 4], [4, 7]]]


def test_constants_fill_the_result():
    program = Program(1, 3, (Op("data", value=0.25), Op("copy", 1, 2), Op("out", 0, 3)))
    assert (run(program, np.zeros((4, 1)), {}) == 0.25).all()
