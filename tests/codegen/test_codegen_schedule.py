"""A scheduled program computes, bit for bit, what the graph says; it is never dearer than naive."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_expressions import (
    BINDINGS,
    INPUTS,
    A,
    B,
    C,
    V,
    naive_block,
    naive_program,
    naive_values,
    points,
    random_domain,
    random_expression,
    tree_size,
)

from brdfc.calc.price import nanoseconds
from brdfc.calc.program import Block, Op, Program, walk
from brdfc.calc.verify import verify
from brdfc.codegen.nodes import channels, data, needed_by_both, postorder, where
from brdfc.codegen.schedule import schedule
from brdfc.codegen.select import VariableBinding, select
from brdfc.compiler import compile_model
from brdfc.engine.interpreter import run
from brdfc.lang.load import load_text
from brdfc.lang.model import Model
from brdfc.source.errors import BrdfcError
from brdfc.symbolic.expression import ONE, ZERO, Expression, component, const, make, quantity
from brdfc.symbolic.expression import vector as side_by_side


def program(e: Expression) -> Program:
    return schedule(select(e, BINDINGS), INPUTS)


def operations(block: Block) -> list[Op]:
    return [i for i in walk(block) if isinstance(i, Op)]


def text(e: Expression) -> str:
    """The operators of a program without branches, in one line."""
    return " ".join(
        f"{o.value:g}" if o.name == "data" else o.name for o in operations(program(e).body)
    )


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.integers(0, 2**32))
def test_bit_for_bit_what_a_naive_program_computes(seed: int) -> None:
    random = Random(seed)
    e = random_expression(random)
    node = select(e, BINDINGS)
    if tree_size(node) > 2000:
        return
    scheduled = schedule(node, INPUTS)
    verify(scheduled)
    pixels = points(random, random_domain(random), 40)
    with np.errstate(all="ignore"):
        expected, found = naive_values(e, pixels), run(scheduled, pixels, {})
    # NaN of any sign is NaN; which one a processor makes depends on the order of the arguments.
    same = (expected.view(np.uint32) == found.view(np.uint32)) | (
        np.isnan(expected) & np.isnan(found)
    )
    assert same.all(), str(e)
    if tree_size(node) < 300:
        assert nanoseconds(scheduled.body) <= nanoseconds(naive_block(node)) + 1e-6, str(e)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.integers(0, 2**32))
def test_no_temporary_is_kept_in_vain(seed: int) -> None:
    e = random_expression(Random(seed), levels=5)
    body = operations(program(e).body)
    read = {t for o in body if o.name == "tget" for t in range(o.first, o.first + o.second)}
    saved = {t for o in body if o.name == "tsav" for t in range(o.first, o.first + o.second)}
    assert saved == read == set(range(len(saved)))


def test_the_same_graph_gives_the_same_program() -> None:
    for seed in range(30):
        e = random_expression(Random(seed))
        assert program(e) == program(e)


DETERMINISM = """
import hashlib, brdfc
from brdfc.compiler import compile_model
digest = hashlib.sha256()
for name in ("ward", "cook_torrance"):
    compiled = compile_model(brdfc.load(name), channels=["incident"])
    for profile in (compiled.mid, compiled.mvis):
        digest.update(profile.to_bytes())
print(digest.hexdigest())
"""


def test_bytes_do_not_depend_on_the_order_of_hashes() -> None:
    digests = {
        subprocess.run(
            [sys.executable, "-c", DETERMINISM],
            env={"PYTHONHASHSEED": seed, "PYTHONPATH": ":".join(p for p in sys.path if p)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("1", "2")
    }
    assert len(digests) == 1


# ------------------------------------------------------------ choosing operators


def test_a_square_takes_one_operator() -> None:
    assert text(make("mul", A, A)) == "in sq out"
    assert text(make("pow", A, const(3))) == "in cb out"
    assert text(make("pow", A, const(4))) == "in sq sq out"
    assert text(make("pow", A, const(-2))) == "1 in sq div out"


def test_any_other_power_takes_the_power_operator() -> None:
    assert text(make("pow", A, B)) == "in pow out"
    assert text(make("pow", A, const(100))) == "in 100 pow out"
    assert text(make("pow", V, B)) == "in in gama out"


def test_chains_fold() -> None:
    assert text(make("add", make("add", A, B), C)) == "in sum out"
    assert text(make("mul", make("mul", A, B), C)) == "in prod out"


def test_vectors_with_scalars() -> None:
    assert text(make("mul", V, A)) == "in in smul out"
    assert text(make("mul", A, V)) == "in in smul out"
    assert text(make("add", A, V)) == "in in sadd out"
    assert text(make("sub", A, V)) == "in neg in sadd out"
    assert text(make("sub", V, A)) == "in in ssub out"
    assert text(make("div", V, A)) == "in in sdiv out"
    assert text(make("div", A, V)) == "in copy in div out"


def test_the_ordinate_of_an_arc_tangent_stands_on_top() -> None:
    pixel = np.array([[1, -1, 0, 0, 0, 0]], np.float32)
    value = run(program(make("atan2", A, B)), pixel, {})
    assert value[0, 0] == np.float32(np.arctan2(1, -1))


def test_components_of_channels_are_channels() -> None:
    assert text(component(V, 1)) == "in out"
    assert text(side_by_side([component(V, 2), A, component(V, 0)])) == "in in in out"


def test_components_of_a_computed_vector() -> None:
    pixel = np.array([[2, 0, 0, 3, 4, 5]], np.float32)
    assert run(program(component(make("mul", V, A), 2)), pixel, {})[0, 0] == 10


def test_a_variable_has_a_default() -> None:
    for default in (0.0, 0.25):
        node = select(quantity("q", 1), {"q": VariableBinding("quan", default)})
        made = schedule(node, 1)
        pixel = np.zeros((1, 1), np.float32)
        assert run(made, pixel, {})[0, 0] == np.float32(default)
        assert run(made, pixel, {"quan": 0.5})[0, 0] == 0.5


@pytest.mark.parametrize("value", [10**39, -(10**39), 10**400])
def test_a_constant_too_large_for_float32_is_refused(value: int) -> None:
    with pytest.raises(BrdfcError, match="does not fit a 32-bit float") as caught:
        select(make("mul", A, const(value)), BINDINGS)
    assert caught.value.hint


# ------------------------------------------------------------ order and temporaries


def test_what_is_used_twice_is_computed_once() -> None:
    sine = make("sin", A)
    e = make("div", make("add", sine, ONE), make("exp", sine))
    assert text(e).count("sin") == 1


def test_what_both_branches_need_is_computed_before_them_if_it_is_large() -> None:
    x = channels(0, 1)
    large = select(make("sin", make("cos", A)), BINDINGS)
    choice = where(x, large, large)
    assert needed_by_both(postorder(choice), least=1)[choice] == (large,)
    assert needed_by_both(postorder(choice), least=9)[choice] == ()
    assert needed_by_both(postorder(where(x, data(1), large)), least=1) == {
        where(x, data(1), large): ()
    }


def naive_time(e: Expression) -> float:
    return nanoseconds(naive_program(e).body)


def test_a_branch_may_use_what_was_kept_before_it() -> None:
    sine = make("sin", A)
    e = make("add", sine, make("where", make("gt", B, ZERO), sine, make("cos", sine)))
    assert text(e).count("sin") == 1
    assert nanoseconds(program(e).body) < naive_time(e)


# ------------------------------------------------------------ size

HEAD = """model t "T"
channel x : number in -1..1 = 0.5
channel m : number in 0.1..1 = 0.5
channel Rd : XYZ in 0..1 = 0.5
env p : angle in -90deg..90deg = 0deg as angp
"""


def compile_lines(lines: str) -> None:
    model = load_text(HEAD + lines, "t.brdf")
    assert isinstance(model, Model)
    compile_model(model, cache=False)


LARGE = {
    "a chain of doublings": "let x0 = x/2\n"
    + "".join(f"let x{i + 1} = x{i}*x{i} - x{i}/2\n" for i in range(25))
    + "radiance = Rd*(x25 + 1)\n",
    "a chain of vectors": "let x0 = Rd\n"
    + "".join(f"let x{i + 1} = x{i}*x{i} - x{i}\n" for i in range(25))
    + "radiance = (x25.x + 1, x25.y + 1, x25.z + 1)\n",
    "a chain of conditions": "let x0 = x\n"
    + "".join(f"let x{i + 1} = x{i}*m where x{i} > {i}/30 else x{i} + {i}/50\n" for i in range(12))
    + "radiance = Rd*(x12 + 2)\n",
    "a long sum": "radiance = Rd*("
    + " + ".join(f"cos(x*{i}*1rad + p)*exp(-x^2/(m^2 + {i}))" for i in range(1, 25))
    + " + 30)\n",
    "roots within roots": "radiance = Rd*" + "sqrt(1 + " * 45 + "x^2" + ")" * 45 + "\n",
}


@pytest.mark.parametrize("name", LARGE)
def test_large_formulas_compile_in_little_time(
    name: str, function_calls: Callable[[Callable[[], object]], int]
) -> None:
    """Three million calls are about a second."""
    assert function_calls(lambda: compile_lines(LARGE[name])) < 10_000_000


def test_a_formula_that_grows_beyond_all_bounds_is_refused() -> None:
    lines = "let f0(y) = y + 1\n"
    lines += "".join(f"let f{i + 1}(y) = f{i}(f{i}(y))\n" for i in range(30))
    with pytest.raises(BrdfcError):
        compile_lines(lines + "radiance = Rd*f30(x)\n")
