"""The functions of machine code against high precision, in units of the last place."""

from __future__ import annotations

from collections.abc import Callable

import mpmath
import numpy as np
import pytest

from brdfc.calc.program import Op, Program
from brdfc.engine import interpreter, native, runs
from brdfc.engine.choice import Engine

pytestmark = pytest.mark.skipif(not native.available(), reason="llvmlite is not installed")

ONE: dict[str, tuple[Callable[..., object], float]] = {
    # The function, and the size of its usual arguments.
    "exp": (mpmath.exp, 20),
    "ln": (mpmath.log, 10),
    "log": (mpmath.log10, 10),
    "sin": (mpmath.sin, 10),
    "cos": (mpmath.cos, 10),
    "tan": (mpmath.tan, 10),
    "asin": (mpmath.asin, 1),
    "acos": (mpmath.acos, 1),
    "atan": (mpmath.atan, 5),
    "cbrt": (lambda x: mpmath.sign(x) * mpmath.cbrt(abs(x)), 10),
}
TWO: dict[str, Callable[..., object]] = {
    "pow": mpmath.power,
    "atn2": lambda x, y: mpmath.atan2(y, x),
}
CORRECTLY_ROUNDED = 0.5
MARGIN = 1e-4
"""Results are computed in float64 and rounded once: half a unit, and what float64 is off."""


def compiled(name: str, *columns: np.ndarray) -> np.ndarray:
    count = len(columns)
    program = Program(count, 1, (Op("in", 0, count), Op(name, 1), Op("out", 0, 1)))
    return runs.run((program,), count, np.stack(columns, 1), {}, engine=Engine.COMPILED)[:, 0]


def any_floats(random: np.random.Generator, count: int) -> np.ndarray:
    """Finite values of every exponent and sign."""
    found = random.integers(0, 2**32, 2 * count, dtype=np.uint64).astype(np.uint32)
    values = found.view(np.float32)
    return values[np.isfinite(values)][:count]


def worst(
    name: str, found: np.ndarray, exact: Callable[..., object], *columns: np.ndarray
) -> float:
    """Units in the last place of the exact result, at most; checks what has no number."""
    most = 0.0
    with mpmath.workdps(40):
        for i, got in enumerate(found.astype(float)):
            arguments = [mpmath.mpf(float(c[i])) for c in columns]
            try:
                value = exact(*arguments)
            except (ValueError, ZeroDivisionError):
                continue
            if not isinstance(value, mpmath.mpf) or not mpmath.isfinite(value):
                continue  # a complex number; special values have their own test
            if abs(value) > 3.4028235e38:
                assert np.isinf(got) or abs(got) > 3.4e38, (name, arguments)
                continue
            size = max(float(abs(value)), 1e-37)
            unit = float(np.spacing(np.float32(size))) if size > 1.2e-38 else 2.0**-149
            unit = 2.0**-149 if abs(value) < 1.2e-38 else unit
            most = max(most, float(abs(value - got)) / unit)
    return most


@pytest.mark.parametrize("name", ONE)
def test_functions_of_one_argument(name: str) -> None:
    exact, size = ONE[name]
    random = np.random.default_rng(5)
    usual = random.uniform(-size, size, 1500).astype(np.float32)
    near_one = (1 + random.uniform(-1e-3, 1e-3, 300)).astype(np.float32)
    turns = (np.pi / 2 * random.integers(-3000, 3000, 300)).astype(np.float32)
    values = np.concatenate([usual, near_one, turns, any_floats(random, 1500)])
    assert worst(name, compiled(name, values), exact, values) < CORRECTLY_ROUNDED + MARGIN


@pytest.mark.parametrize("name", TWO)
def test_functions_of_two_arguments(name: str) -> None:
    random = np.random.default_rng(6)
    x = np.concatenate([random.uniform(0, 5, 1500), random.uniform(-5, 5, 500)])
    y = np.concatenate([random.uniform(-20, 20, 1500), random.integers(-9, 9, 500)])
    x, y = (np.concatenate([v.astype(np.float32), any_floats(random, 1000)]) for v in (x, y))
    assert worst(name, compiled(name, x, y), TWO[name], x, y) < CORRECTLY_ROUNDED + MARGIN


@pytest.mark.parametrize("name", [*ONE, *TWO])
def test_a_million_values_are_the_interpreters(name: str) -> None:
    """But for ties of rounding, and never by more than one unit."""
    random = np.random.default_rng(7)
    columns = [any_floats(random, 1_000_000) for _ in range(2 if name in TWO else 1)]
    count = len(columns)
    program = Program(count, 1, (Op("in", 0, count), Op(name, 1), Op("out", 0, 1)))
    expected = interpreter.run(program, np.stack(columns, 1), {})[:, 0]
    found = compiled(name, *columns)
    assert (np.isnan(found) == np.isnan(expected)).all()
    other = (found != expected) & ~np.isnan(found)
    assert other.sum() <= 10
    apart = found[other].view(np.int32).astype(np.int64) - expected[other].view(np.int32)
    assert (np.abs(apart) <= 1).all()


def test_the_hardest_angles() -> None:
    """The float32 nearest to a multiple of pi/2, and the largest one."""
    values = np.array([16367173 * 2.0**72, 3.4028235e38, 2.0**20, 1048576.1, 1.0e30], np.float32)
    values = np.concatenate([values, -values])
    for name in ("sin", "cos", "tan"):
        exact = ONE[name][0]
        assert worst(name, compiled(name, values), exact, values) < CORRECTLY_ROUNDED + MARGIN
