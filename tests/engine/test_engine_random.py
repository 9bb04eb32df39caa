"""Random programs, each against the reference engine within a bound that is computed for it.

The bound is the interval of what any engine may give whose functions are within one unit in the
last place. `pytest tests/engine/test_engine_random.py --programs 20000 -rP` draws so many programs
and prints what became of them.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path
from random import Random

import numpy as np
import pytest
from calc.calc_programs import EVERY, INPUTS, programs, random_program
from calc.random_elements import curve_set, lookup_table
from followed import Bounds, Engine, Nearby, Wrong
from hypothesis import HealthCheck, Phase, given, seed, settings
from interval_elements import bound_element
from interval_functions import FIXED
from interval_rules import RULES, bound
from intervals import Interval, at, enclosing, place
from judging import Tally, judge
from special_pixels import special_pixels

from brdfc.calc.binary import encode_element
from brdfc.calc.curves import CurveSet
from brdfc.calc.portability import portability
from brdfc.calc.program import Element, Program
from brdfc.calc.text import disassemble
from brdfc.engine.curves import apply_curves
from brdfc.engine.kernels import BINARY, FOLDED, INNER, UNARY, compute
from brdfc.engine.tables import apply_table

FUNCTIONS = (*(name for name in FIXED if name not in INNER), "gama", "ctop", "ptoc", "tLab", "tXYZ")
NAMES = (*EVERY, *FUNCTIONS, *FUNCTIONS)
"""Functions are drawn three times as often."""
SHORT, BATCH, PIXELS = 300, 200, 25
Batch = tuple[np.ndarray, dict[str, float]]
ENVIRONMENTS = ({}, {"thti": 0.75, "azi": -2.0, "a b": 1e-3, "x": 1e-5, "ä": 3.0, "12": 0.5})


def accepted(program: Program) -> bool:
    """Whether the reference does not refuse it; see calc/portability.py."""
    return not any("rejected" in finding for finding in portability(program))


def drawn(number: int, count: int, test: Callable[[Program], None], *phases: Phase) -> None:
    """So many programs of a batch, the same again at every call, to a test."""
    strategy = programs(NAMES, length=30).filter(accepted)
    draw = settings(
        max_examples=count,
        phases=[Phase.generate, *phases],
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )

    @seed(number)
    @draw
    @given(strategy)
    def every(program: Program) -> None:
        test(program)

    every()


def of_batch(number: int) -> Batch:
    """Pixels and variables of a batch."""
    pixels = special_pixels(np.random.default_rng(number), PIXELS, INPUTS, share=0.04)
    return pixels, ENVIRONMENTS[number % 2]


def smallest(
    number: int, count: int, program: Program, fails: Callable[[Program], bool]
) -> Program:
    """The smallest program that still fails, from one of a batch that does."""
    failing: list[Program] = []

    def test(candidate: Program) -> None:
        if not failing and candidate != program:
            return  # of those that the batch draws before it
        if fails(candidate):
            failing.append(candidate)
            pytest.fail("it fails still")

    with contextlib.suppress(BaseException):
        drawn(number, count, test, Phase.shrink)
    return min(failing, key=lambda candidate: len(encode_element(candidate)), default=program)


# ---------------------------------------------------------------- against the reference engine


def test_random_programs(tmp_path: Path, request: pytest.FixtureRequest) -> None:
    pytest.importorskip("iccdev")
    count = max(SHORT, request.config.getoption("--programs"))
    tally = Tally()
    for number in range(-(-count // BATCH)):
        batch: list[Program] = []
        size = min(BATCH, count - number * BATCH)
        drawn(number, size, batch.append)
        pixels, variables = of_batch(number)
        before = len(tally.failures)
        judge(tmp_path, batch, pixels, variables, tally)
        for failure in tally.failures[before:][:1]:

            def fails(program: Program, where: Batch = (pixels, variables)) -> bool:
                alone = Tally()
                judge(tmp_path, [program], *where, alone)
                return bool(alone.failures)

            found = smallest(number, size, failure.program, fails)
            judge(tmp_path, [found], pixels, variables, tally)
    print(tally.report())
    assert not tally.failures, tally.report()
    assert tally.left_out < 0.06 * tally.values
    assert tally.unbounded < 0.01 * tally.values


# ---------------------------------------------------------------- the bound itself


def outside(program: Program, results: list[np.ndarray], pixels: np.ndarray) -> bool:
    """Whether any result of an engine lies outside the bound."""
    found = Bounds.run(program, pixels, {})
    inside = [b.contains(r) | (b.disputed != 0) for b, r in zip(found, results, strict=True)]
    return not all(i.all() for i in inside)


def test_engines_a_float_off_lie_inside() -> None:
    """Whose functions give the nearest float or one beside it."""
    changed = 0
    for number in range(60):
        program = random_program(number, NAMES)
        pixels, _ = of_batch(number)
        near, exact = Nearby.run(program, pixels, {}), Engine.run(program, pixels, {})
        assert not outside(program, near, pixels), number
        assert not outside(program, exact, pixels), number
        changed += any((a != b).any() for a, b in zip(near, exact, strict=True))
    assert changed > 20


@pytest.mark.parametrize("operator", ["sin", "add"])
def test_wrong_engines_lie_outside(operator: str) -> None:
    """A sine that is a millionth off, a sum that is a float off: seen in most of the programs whose
    results it changes."""
    changed = seen = 0
    names = (operator, operator, "mul", "sub", "cos", "vmin", "env", "sq", "exp")
    for number in range(100):
        program = random_program(number, names)
        pixels, _ = of_batch(number)
        wrong = Wrong.run(program, pixels, {}, operator=operator)
        right = Engine.run(program, pixels, {})
        if any((a != b).any() for a, b in zip(wrong, right, strict=True)):
            changed += 1
            seen += outside(program, wrong, pixels)
    assert changed > 20
    assert seen > 0.8 * changed, f"{seen} of {changed}"


def intervals_and_points(random: np.random.Generator, count: int) -> tuple[Interval, np.ndarray]:
    """Intervals, short and long, and a value in each, NaN where that may be."""
    start = special_pixels(random, count, 1, share=0.3)[:, 0]
    floats = random.choice([0, 1, 5, 1000, 10**7], count)
    ends = at(place(start) + floats), at(place(start) - random.choice([0, 3], count))
    found = enclosing(*(np.where(np.isnan(start), np.float32(1), e) for e in ends))
    nan = np.isnan(start) | (random.random(count) < 0.1)
    inside = at(random.integers(place(found.low), place(found.high), endpoint=True))
    value = np.where(nan & (random.random(count) < 0.5), np.float32(np.nan), inside)
    return Interval(found.low, found.high, nan), value


@pytest.mark.parametrize("name", sorted(RULES))
def test_what_is_between_stays_between(name: str) -> None:
    """An operation of values out of intervals, in what is bound for the intervals."""
    random = np.random.default_rng(7)
    arguments = next(n for n in (1, 2, 3) if _takes(name, n))
    for _ in range(20):
        pairs = [intervals_and_points(random, 500) for _ in range(arguments)]
        with np.errstate(all="ignore"):
            found = bound(name, *(interval for interval, _ in pairs))
            values = [value for _, value in pairs]
            result = np.asarray(compute(name, *values))
            wrong = ~found.contains(result) & (found.disputed == 0)
        assert not wrong.any(), [v[wrong][0] for v in values]


def _takes(name: str, count: int) -> bool:
    """Whether an operation takes so many arguments; folds take three."""
    if name in FOLDED:
        return count == 3
    if name in UNARY or name in BINARY:
        return count == (1 if name in UNARY else 2)
    return count == {"choose": 3, "lab fx": 2, "lab fz": 2}.get(name, 1)


@pytest.mark.parametrize("draw", [curve_set, lookup_table])
def test_what_is_between_stays_between_in_elements(draw: Callable[..., Element]) -> None:
    random = np.random.default_rng(7)
    for number in range(150):
        element = draw(Random(number).choice)
        pairs = [intervals_and_points(random, 100) for _ in range(element.inputs)]
        if draw is lookup_table:  # programs clamp its inputs
            pairs = [(clamped(x), np.clip(np.nan_to_num(v), 0, 1)) for x, v in pairs]
        with np.errstate(all="ignore"):
            found = bound_element(element, [interval for interval, _ in pairs])
            results = engine_of(element)([value for _, value in pairs])
            for interval, result in zip(found, results, strict=True):
                wrong = ~interval.contains(result) & (interval.disputed == 0)
                assert not wrong.any(), (number, element)


def clamped(x: Interval) -> Interval:
    low, high = (np.clip(v, np.float32(0), np.float32(1)) for v in (x.low, x.high))
    return Interval(np.where(x.nan, np.float32(0), low), high, np.zeros_like(x.nan))


def engine_of(element: Element) -> Callable[[list[np.ndarray]], list[np.ndarray]]:
    apply = apply_curves if isinstance(element, CurveSet) else apply_table
    return lambda values: apply(element, values)


def test_what_fails_is_shown_small() -> None:
    """From a program of some length to the one operator that is at fault."""

    def fails(program: Program) -> bool:
        return "tan" in disassemble(program.body).split()

    batch: list[Program] = []
    drawn(3, 60, batch.append)
    program = max(filter(fails, batch), key=lambda p: len(encode_element(p)))
    found = smallest(3, 60, program, fails)
    assert fails(found)
    assert len(found.body) <= 6 < len(program.body)
