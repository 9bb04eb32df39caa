"""Programs without jumps give what the interpreter gives, to the last bit."""

from __future__ import annotations

from pathlib import Path
from random import Random

import numpy as np
import pytest

from brdfc.calc.program import Op, Program
from brdfc.calc.text import assemble
from brdfc.calc.verify import verify
from brdfc.codegen.schedule import schedule
from brdfc.codegen.select import ChannelBinding, select
from brdfc.engine import blocks, interpreter
from brdfc.engine.kernels import BINARY, UNARY
from brdfc.engine.straight import Crooked, straighten
from brdfc.symbolic.expression import Expression, component, const, make, quantity, vector

GOLDEN = sorted((Path(__file__).parents[1] / "golden").glob("*.calc"))
SPECIAL = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    1e-40,
    3e38,
    -3e38,
    np.inf,
    -np.inf,
    np.nan,
    2.0**31,
    0.49999997,
]


def same(a: np.ndarray, b: np.ndarray) -> bool:
    bits = a.view(np.int32) == b.view(np.int32)
    return bool((bits | (np.isnan(a) & np.isnan(b))).all())


def pixels(random: np.random.Generator, count: int, channels: int) -> np.ndarray:
    usual = random.uniform(-1.5, 1.5, (count, channels))
    special = random.choice(SPECIAL, (count, channels))
    return np.where(random.random(usual.shape) < 0.15, special, usual).astype(np.float32)


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


@pytest.mark.parametrize("path", GOLDEN, ids=lambda p: p.stem)
def test_every_golden_program(path: Path) -> None:
    """With variables defined and not, the same for all pixels and another for each."""
    text = path.read_text()
    program = Program(channels_of(text), 3, assemble(text))
    random = np.random.default_rng(3)
    values = pixels(random, 5000, program.inputs)
    names = sorted(verify(program).variables)
    runs: list[dict[str, object]] = [{}, dict.fromkeys(names, 0.4), dict.fromkeys(names, 1.58)]
    runs.append({name: random.uniform(-1.6, 1.6, 5000).astype(np.float32) for name in names})
    for run in runs:
        assert same(blocks.run(program, values, run), interpreter.run(program, values, run))


@pytest.mark.parametrize("name", [*UNARY, *BINARY])
def test_every_operator_on_special_values(name: str) -> None:
    grid = np.array(np.meshgrid(SPECIAL, SPECIAL), np.float32).reshape(2, -1).T.copy()
    arguments = 1 if name in UNARY else 2
    program = Program(2, 1, (Op("in", 0, arguments), Op(name, 1), Op("out", 0, 1)))
    assert same(blocks.run(program, grid, {}), interpreter.run(program, grid, {}))
    for constant in SPECIAL:  # one of the arguments is the same for all pixels
        body = (Op("data", value=float(np.float32(constant))), Op("in", 0, 1), Op(name, 1))
        if arguments == 2:
            program = Program(2, 1, (*body, Op("out", 0, 1)))
            assert same(blocks.run(program, grid, {}), interpreter.run(program, grid, {}))


@pytest.mark.parametrize("seed", range(40))
def test_random_programs(seed: int) -> None:
    random = Random(seed)
    leaves = [quantity(n, 1) for n in "abc"] + [component(quantity("v", 3), i) for i in range(3)]

    def grown(levels: int) -> Expression:
        if levels == 0 or random.random() < 0.1:
            return random.choice([*leaves, const(random.choice([0, 1, 2, -1]))])
        kind = random.random()
        if kind < 0.55:
            operator = random.choice(["add", "sub", "mul", "div", "min", "max", "atan2"])
            return make(operator, grown(levels - 1), grown(levels - 1))
        if kind < 0.85:
            operator = random.choice(["neg", "sqrt", "exp", "sin", "cos", "tan", "abs", "floor"])
            return make(operator, grown(levels - 1))
        relation = random.choice(["lt", "le", "gt", "ge", "eq", "ne"])
        condition = make(relation, grown(levels - 1), grown(levels - 1))
        return make("where", condition, grown(levels - 1), grown(levels - 1))

    result = vector([grown(5) for _ in range(3)])
    bindings = {n: ChannelBinding(i, 1) for i, n in enumerate("abc")} | {"v": ChannelBinding(3, 3)}
    program = schedule(select(result, bindings), 6)
    values = pixels(np.random.default_rng(seed), 3000, 6)
    assert same(blocks.run(program, values, {}), interpreter.run(program, values, {}))


def test_what_depends_on_no_pixel_is_computed_before() -> None:
    text = "{ env(inci) if { } else { pop 0 } cos in[0,1] mul out[0,1] }"
    program = Program(1, 1, assemble(text))
    straight = straighten(program, {"inci": np.asarray(0.5, np.float32)})
    assert [step.name for step in straight.steps] == ["mul"]


def test_what_has_no_straight_form_is_left_to_the_interpreter() -> None:
    text = "{ in[0,1] sel case { 1 } case { 2 } dflt { 3 } out[0,1] }"
    program = Program(1, 1, assemble(text))
    with pytest.raises(Crooked):
        straighten(program, {})
    values = np.array([[0.0], [1.0], [7.0]], np.float32)
    assert blocks.run(program, values, {}).ravel().tolist() == [1.0, 2.0, 3.0]


def test_shapes_and_no_pixels() -> None:
    program = Program(2, 1, assemble("{ in[0,2] add out[0,1] }"))
    assert blocks.run(program, np.ones((3, 4, 2)), {}).shape == (3, 4, 1)
    assert blocks.run(program, np.ones((0, 2)), {}).shape == (0, 1)
