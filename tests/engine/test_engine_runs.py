"""The usual way to run chains gives what the interpreter gives, by every engine.

NumPy's results are the interpreter's to the last bit. Those of machine code may differ by one unit
in the last place of a function, once in a million; hardly a program shows it.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from calc.calc_elements import APPEARANCE, SAMPLED, SEGMENTED, TABLES, TINTS, calculated
from calc.calc_programs import INPUTS, random_program
from special_pixels import SPECIAL, special_pixels

from brdfc.calc.curves import CurveSet
from brdfc.calc.program import Element, Op, OpaqueElement, Program
from brdfc.calc.samples import Storage
from brdfc.calc.text import assemble
from brdfc.calc.verify import verify
from brdfc.engine import choice, interpreter, jobs, native, runs, trace
from brdfc.engine.choice import Engine
from brdfc.engine.kernels import BINARY, UNARY
from brdfc.engine.straight import straighten
from brdfc.engine.tables import Interpolation
from brdfc.engine.trace import Crooked, Route
from brdfc.engine.written import ELEMENT
from brdfc.source.errors import BrdfcError, ProgramError, ValueGivenError

GOLDEN = sorted((Path(__file__).parents[1] / "golden").glob("*.calc"))
COMPILED = pytest.param(
    Engine.COMPILED,
    marks=pytest.mark.skipif(not native.available(), reason="llvmlite is not installed"),
)
ENGINES = pytest.mark.parametrize("engine", [Engine.BLOCKS, COMPILED])


def different(a: np.ndarray, b: np.ndarray) -> int:
    """How many values differ in a bit; every NaN equals every NaN."""
    assert a.shape == b.shape
    bits = a.view(np.int32) == b.view(np.int32)
    return int((~(bits | (np.isnan(a) & np.isnan(b)))).sum())


def run(program: Element, pixels: object, environment: object, engine: Engine) -> np.ndarray:
    return runs.run((program,), program.inputs, pixels, environment, engine=engine)


def channels_of(program_text: str) -> int:
    """How many channels a program reads at most."""
    body = assemble(program_text)

    def highest(block) -> int:  # type: ignore[no-untyped-def]
        found = 0
        for step in block:
            if isinstance(step, Op):
                found = max(found, step.first + step.second if step.name == "in" else 0)
            else:
                found = max([found, *(highest(b) for b in step.bodies)])
        return found

    return highest(body)


@ENGINES
@pytest.mark.parametrize("path", GOLDEN, ids=lambda p: p.stem)
def test_every_golden_program(path: Path, engine: Engine) -> None:
    """With variables defined and not, the same for all pixels and another for each."""
    text = path.read_text()
    program = Program(channels_of(text), 3, assemble(text))
    random = np.random.default_rng(3)
    pixels = special_pixels(random, 5000, program.inputs)
    names = sorted(verify(program).variables)
    given: list[dict[str, object]] = [{}, dict.fromkeys(names, 0.4), dict.fromkeys(names, 1.58)]
    given.append({name: random.uniform(-1.6, 1.6, 5000).astype(np.float32) for name in names})
    for variables in given:
        found = run(program, pixels, variables, engine)
        assert not different(found, interpreter.run(program, pixels, variables))


@ENGINES
@pytest.mark.parametrize("name", [*UNARY, *BINARY])
def test_every_operator_on_special_values(name: str, engine: Engine) -> None:
    grid = np.array(np.meshgrid(SPECIAL, SPECIAL), np.float32).reshape(2, -1).T.copy()
    arguments = 1 if name in UNARY else 2
    program = Program(2, 1, (Op("in", 0, arguments), Op(name, 1), Op("out", 0, 1)))
    assert not different(run(program, grid, {}, engine), interpreter.run(program, grid, {}))
    if arguments == 1:
        return
    for constant in SPECIAL[:6]:  # one of the arguments is the same for all pixels
        body = (Op("data", value=float(np.float32(constant))), Op("in", 0, 1), Op(name, 1))
        program = Program(2, 1, (*body, Op("out", 0, 1)))
        assert not different(run(program, grid, {}, engine), interpreter.run(program, grid, {}))


@ENGINES
def test_random_programs(engine: Engine, request: pytest.FixtureRequest) -> None:
    """`pytest tests/engine/test_engine_runs.py -k random --programs 20000` takes ten minutes; it
    last found 0 values of NumPy's and 0 of machine code's 30,000,000 that differ."""
    others = values = 0
    for seed in range(request.config.getoption("--programs")):
        program = random_program(seed, kinds=("matf", "calc"))
        random = np.random.default_rng(seed)
        pixels = special_pixels(random, 500, INPUTS)
        angles = random.uniform(-2, 2, 500).astype(np.float32)
        given = [{}, {"thti": 0.7, "azi": -0.3}, {"thti": angles}][seed % 3]
        expected = interpreter.run(program, pixels, given)
        count = different(run(program, pixels, given, engine), expected)
        assert count == 0 or engine is Engine.COMPILED, f"seed {seed}"
        others, values = others + count, values + expected.size
    print(f"{engine.value}: {others:,} of {values:,} values differ")
    assert others <= 1e-6 * values


def test_what_depends_on_no_pixel_is_computed_before() -> None:
    text = "{ env(inci) if { } else { pop 0 } cos in[0,1] mul out[0,1] }"
    program = Program(1, 1, assemble(text))
    straight = straighten((program,), 1, {"inci": np.asarray(0.5, np.float32)})
    assert [step.name for step in straight.steps] == ["mul"]


EVERY_ELEMENT = Program(
    4,
    3,
    assemble(
        "{ in[0,3] curv(0) clut(1) in(3) tint(2) add[3] tJab(3) in(3) if { 3 smul[3] } "
        "else { fJab(4) } 0.25 0.5 1 tJab(3) mul[3] in(3) tint(2) add[3] elem(5) "
        "in[0,3] clut(1) pop(2) sadd[3] out[0,3] }"
    ),
    (
        CurveSet((SAMPLED[Storage.UINT8, True, 17], SEGMENTED[3], calculated("env(inci) mul", 40))),
        TABLES[8],
        TINTS[2],
        APPEARANCE["XtoJ"],
        APPEARANCE["JtoX"],
        OpaqueElement("bACS", 3, 3, b"bACS" + bytes(4)),
    ),
)


@ENGINES
@pytest.mark.parametrize("interpolation", Interpolation)
def test_elements_are_steps(engine: Engine, interpolation: Interpolation) -> None:
    """Those whose arguments are the same for all pixels, too, and results that nothing reads."""
    pixels = special_pixels(np.random.default_rng(1), 3000, 4)
    given = {"inci": np.float32(0.75)}
    straight = straighten((EVERY_ELEMENT,), 4, {"inci": np.asarray(0.75, np.float32)})
    names = [step.name for step in straight.steps]
    assert names.count(ELEMENT) == 8  # three curves; the tint once; not Jab of the constants
    assert not choice.can_be_compiled(straight)
    found = runs.run((EVERY_ELEMENT,), 4, pixels, given, engine=engine, interpolation=interpolation)
    expected = interpreter.run(EVERY_ELEMENT, pixels, given, interpolation=interpolation)
    assert not different(found, expected)


@ENGINES
def test_what_has_no_straight_form_is_left_to_the_interpreter(engine: Engine) -> None:
    """A curve of a variable that is another one for every pixel."""
    curves = CurveSet((calculated("env(inci) pop mul", 5),))
    program = Program(1, 1, assemble("{ in curv sq out }"), (curves,))
    values = np.array([[0.0], [0.75], [7.0]], np.float32)
    gains = np.array([0.5, 2.0, -1.0], np.float32)
    for element in (curves, program):
        straighten((element,), 1, {"inci": gains[0], "refl": gains})
        with pytest.raises(Crooked):
            straighten((element,), 1, {"inci": gains})
        found = run(element, values, {"inci": gains}, engine)
        assert not different(found, interpreter.run(element, values, {"inci": gains}))


def test_too_many_steps_have_no_straight_form(monkeypatch: pytest.MonkeyPatch) -> None:
    """Both sides of every one of many nested conditions."""
    monkeypatch.setattr(trace, "MOST_FOLLOWED", 1000)
    text = "in[0,1] sq"
    for _ in range(9):
        text = f"in[0,1] if {{ {text} 1 add }} else {{ {text} 2 mul }}"
    program = Program(1, 1, assemble(f"{{ {text} out[0,1] }}"))
    with pytest.raises(Crooked):
        straighten((program,), 1, {})
    assert run(program, [[0.25]], {}, Engine.AUTO) == 0.25**2 * 2**9


POLAR = Program(3, 4, assemble("{ in[0,2] ctop[1] in[2,1] copy[1,1] exp out[0,4] }"))


def layouts(values: np.ndarray) -> dict[str, np.ndarray]:
    """The same values (rows, columns, samples) of several strides."""
    rows, columns, samples = values.shape
    wide = np.zeros((rows, columns, samples + 2), np.float32)
    wide[..., 1 : samples + 1] = values
    odd = np.frombuffer(b"x" + values.tobytes(), np.uint8)[1:].view(np.float32)
    planes = np.ascontiguousarray(np.moveaxis(values, -1, 0))
    return {
        "interleaved": np.ascontiguousarray(values),
        "planes": np.moveaxis(planes, 0, -1),
        "some of the samples": wide[..., 1 : samples + 1],
        "upside down": np.ascontiguousarray(values[::-1])[::-1],
        "across": np.ascontiguousarray(values.swapaxes(0, 1)).swapaxes(0, 1),
        "not aligned": odd.reshape(values.shape),
        "another byte order": values.astype(">f4"),
    }


@ENGINES
@pytest.mark.parametrize("size", [(1, 1), (3, 5), (17, 64), (33, 1111)], ids=str)
def test_every_layout_and_size(
    size: tuple[int, int], engine: Engine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(runs, "SHARE", 4096)
    monkeypatch.setattr(jobs, "PIECE", 1000)
    pixels = special_pixels(np.random.default_rng(1), size[0] * size[1], 3).reshape(*size, 3)
    expected = interpreter.run(POLAR, pixels, {})
    for name, given in layouts(pixels).items():
        assert not different(run(POLAR, given, {}, engine), expected), name


@ENGINES
def test_results_where_they_are_wanted(engine: Engine) -> None:
    pixels = special_pixels(np.random.default_rng(1), 1000, 3)
    expected = interpreter.run(POLAR, pixels, {})
    for given in layouts(np.zeros((50, 20, 4), np.float32)).values():
        if given.dtype.isnative and given.flags.writeable:
            runs.sweep((POLAR,), 3, pixels.reshape(50, 20, 3), [{}], [given], engine=engine)
            assert not different(np.ascontiguousarray(given).reshape(-1, 4), expected)


@ENGINES
def test_several_runs_in_one_pass(engine: Engine, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jobs, "PIECE", 300)
    monkeypatch.setattr(native, "_kept", {})
    text = "{ env(inci) pop[1] in[0,1] mul cos in[1,1] add out[0,1] }"
    program = Program(2, 1, assemble(text))
    pixels = special_pixels(np.random.default_rng(1), 1001, 2)
    varied = np.linspace(0, 1, 1001, dtype=np.float32)
    given = [{"inci": 0.1}, {}, {"inci": varied}, {"inci": 0.2}]
    results = [np.empty((1001, 1), np.float32) for _ in given]
    runs.sweep((program,), 2, pixels, given, results, engine=engine)
    for variables, result in zip(given, results, strict=True):
        assert not different(result, interpreter.run(program, pixels, variables))
    # Three of them are of one shape, and so are all other angles.
    run(program, pixels, {"inci": 0.3}, engine)
    assert len(native._kept) == (2 if engine is Engine.COMPILED else 0)


@ENGINES
def test_routes_and_no_elements(engine: Engine) -> None:
    pixels = special_pixels(np.random.default_rng(1), 100, 3)
    chain = (POLAR, Route((3, None, 0), (0.0, 0.25, 0.0)))
    found = runs.run(chain, 3, pixels, {}, engine=engine)
    expected = interpreter.run(POLAR, pixels, {})
    assert not different(np.ascontiguousarray(found[:, ::2]), expected[:, [3, 0]])
    assert (found[:, 1] == 0.25).all()
    assert not different(runs.run((), 3, pixels, {}, engine=engine), pixels)
    assert runs.run(chain, 3, np.ones((4, 0, 3)), {}, engine=engine).shape == (4, 0, 3)
    with pytest.raises(ProgramError, match="3 channels are needed"):
        runs.run(chain, 3, np.ones((4, 2)), {}, engine=engine)
    for wrong in ((POLAR, POLAR), (POLAR, Route((4,), (0.0,)))):
        with pytest.raises(ProgramError, match="is given 4"):
            runs.run(wrong, 3, pixels, {}, engine=engine)
    # Chains without elements are many, and of as many channels as they are given.
    for channels in (5, 3, 40):
        values = special_pixels(np.random.default_rng(2), 50, channels)
        assert not different(runs.run((), channels, values, {}, engine=engine), values)


@ENGINES
def test_no_channels_and_no_outputs(engine: Engine) -> None:
    constant = Program(0, 2, assemble("{ 1 2 out[0,2] }"))
    assert runs.run((constant,), 0, np.empty((5, 0)), {}, engine=engine).tolist() == [[1, 2]] * 5
    assert runs.run((Route((), ()),), 3, np.ones((5, 3)), {}, engine=engine).shape == (5, 0)


@ENGINES
def test_results_that_cannot_take_the_values(engine: Engine) -> None:
    pixels = np.ones((64, 3), np.float32)
    fixed = np.frombuffer(bytes(64 * 16), np.float32).reshape(64, 4)
    wrong = [np.empty((10, 4), np.float32), np.empty((64, 3), np.float32), fixed]
    wrong += [np.empty((64, 4), kind) for kind in (np.float16, np.int32, ">f4")]
    for result in wrong:
        with pytest.raises(ValueError, match="results are float32 arrays"):
            runs.sweep((POLAR,), 3, pixels, [{}], [result], engine=engine)
    with pytest.raises(ValueError, match="2 runs, and 1 results"):
        runs.sweep((POLAR,), 3, pixels, [{}] * 2, [np.empty((64, 4), np.float32)], engine=engine)


@ENGINES
def test_results_over_the_pixels(engine: Engine) -> None:
    """The values are those of the pixels as they were."""
    whole = special_pixels(np.random.default_rng(1), 2000, 3).ravel()
    pixels, result = whole[:3000].reshape(-1, 3), whole[3:3003].reshape(-1, 3)
    program = Program(3, 3, assemble("{ in[0,3] sq[3] out[0,3] }"))
    expected = interpreter.run(program, pixels.copy(), {})
    runs.sweep((program,), 3, pixels, [{}, {}], [result, result], engine=engine)
    assert not different(np.ascontiguousarray(result), expected)


def test_both_sides_of_many_branches_are_not_followed_for_ever() -> None:
    """Calculators that call each other twice, without an operation in them."""
    program = Program(1, 1, assemble("{ in out }"))
    for _ in range(28):
        text = "{ in in if { calc(0) } else { calc(0) } out }"
        program = Program(1, 1, assemble(text), (program,))
    with pytest.raises(Crooked):
        straighten((program,), 1, {})


@ENGINES
def test_a_selection_of_many_cases(engine: Engine) -> None:
    cases = " ".join(f"case {{ {k} }}" for k in range(900))
    program = Program(1, 1, assemble(f"{{ in sel {cases} dflt {{ -1 }} out }}"))
    pixels = np.array([[0], [7.4], [899], [900], [-3], [np.nan]], np.float32)
    assert not different(run(program, pixels, {}, engine), interpreter.run(program, pixels, {}))


@pytest.mark.skipif(not native.available(), reason="llvmlite is not installed")
def test_what_is_too_much_to_compile_is_left_to_numpy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(native, "_kept", {})
    program = Program(1, 1, assemble("{ in " + "exp neg " * 700 + "out }"))
    pixels = special_pixels(np.random.default_rng(1), 100, 1)
    found = run(program, pixels, {}, Engine.COMPILED)
    assert not different(found, interpreter.run(program, pixels, {}))
    assert not native._kept


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
def test_threads_after_a_fork() -> None:
    """The other process has none of the threads of this one."""
    code = (
        "import os, numpy as np; from brdfc.engine import runs;"
        "from brdfc.calc.program import Program; from brdfc.calc.text import assemble;"
        "chain = (Program(1, 1, assemble('{ in sq out }')),);"
        "go = lambda: runs.run(chain, 1, np.ones((1 << 18, 1)), {}, threads=2);"
        "go(); child = os.fork();"
        "go() if child == 0 else None;"
        "os._exit(0) if child == 0 else os.waitpid(child, 0)"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def test_the_engine_that_is_done_sooner() -> None:
    straight = straighten((POLAR,), 3, {})
    assert 10_000 * choice.saved(straight) < choice.making(straight)
    assert 100_000_000 * choice.saved(straight) > choice.making(straight)


def test_without_llvmlite_all_works_but_what_asks_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(native, "available", lambda: False)
    monkeypatch.setattr(choice, "making", lambda _: -1.0)
    pixels = special_pixels(np.random.default_rng(1), 100, 3)
    expected = interpreter.run(POLAR, pixels, {})
    assert not different(run(POLAR, pixels, {}, Engine.AUTO), expected)
    with pytest.raises(BrdfcError, match="llvmlite, which is not installed") as caught:
        run(POLAR, pixels, {}, Engine.COMPILED)
    assert "pip install 'brdfc[jit]'" in str(caught.value)


def test_engines_by_name() -> None:
    assert choice.engine_named("blocks") is Engine.BLOCKS
    with pytest.raises(ValueGivenError, match="no engine 'compilde'"):
        choice.engine_named("compilde")


@pytest.mark.skipif(not native.available(), reason="llvmlite is not installed")
def test_codes_that_are_dropped_leave_the_others_working(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(native, "KEPT", 2)
    pixels = np.array([[0.5]], np.float32)
    for _ in range(2):
        for count in range(6):
            program = Program(1, 1, assemble("{ in " + "sq " * count + "out }"))
            assert run(program, pixels, {}, Engine.COMPILED) == 0.5 ** (2**count)
