"""What a search found, and its rivals, as points of a chart: a layer for each question.

forms       which equivalent form of the formula?
encodings   a calculator, or tables?
storage     what does it cost to keep the coefficients in fewer bits?
engines     how long does a pixel take, measured here?
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.price import operations, price
from brdfc.calc.program import Program
from brdfc.charts.points import AS_WRITTEN, Point
from brdfc.compiled import Compiled
from brdfc.encodings import Encoding, encoded
from brdfc.engine.interpreter import run
from brdfc.judge.bound import error_bound
from brdfc.judge.explore import Explored
from brdfc.judge.measure import Judge, Measured
from brdfc.judge.problem import Problem
from brdfc.judge.strata import MANY, points
from brdfc.lang.model import Model
from brdfc.prepared import prepare, problem_of
from brdfc.roles import Roles, Value
from brdfc.source.errors import BrdfcError, ValueGivenError
from brdfc.symbolic.expression import Expression
from brdfc.symbolic.formula import Formula
from brdfc.symbolic.guards import guarded
from brdfc.symbolic.ranges import Ranges
from brdfc.symbolic.spelling import spelled

TABLES = (
    *(Encoding("clut", n) for n in (3, 5, 9, 17)),
    *(Encoding("curve", n) for n in (32, 64, 256, 1024, 4096)),
)
"""The rivals of the calculator that a chart of encodings shows."""


def form_points(explored: Explored, ranges: Ranges) -> list[Point]:
    """A point for every form that was measured and does not fail, with the bound on its error
    that interval arithmetic proves over the whole domain, where it proves one."""
    return [
        _point(
            "forms",
            AS_WRITTEN if number == 0 else f"form {number}",
            candidate.measured,
            candidate.price,
            operations(candidate.program) if candidate.program else 0,
            candidate.form.expression,
            tuple(step.rule for step in candidate.form.steps),
            chosen=candidate is explored.chosen,
            bound_bits=error_bound(candidate.form.expression, Ranges(ranges.domain)),
        )
        for number, candidate in enumerate(explored.candidates)
        if candidate.works
    ]


def _point(
    layer: str,
    name: str,
    measured: Measured,
    price: float,
    operators: int,
    expression: Expression,
    steps: tuple[str, ...],
    *,
    chosen: bool = False,
    bound_bits: float | None = None,
) -> Point:
    return Point(
        layer=layer,
        name=name,
        price=price,
        bits=measured.bits,
        mean_bits=measured.mean_bits,
        de=measured.de,
        operators=operators,
        formula=spelled(expression),
        steps=steps,
        bound_bits=bound_bits,
        chosen=chosen,
    )


@dataclass(frozen=True)
class Rivals:
    """The chosen form of a model against its rivals, all measured at the same points."""

    roles: Roles
    formula: Formula
    problem: Problem
    judge: Judge
    expression: Expression

    def encodings(self) -> list[Point]:
        """As a calculator, and with tables; tables that would be too large are left out. Every
        variable must be fixed (ValueGivenError)."""
        if self.roles.variables:
            names = " ".join(f"--set {q.name}=..." for q in self.roles.variables)
            raise ValueGivenError("tables need every variable fixed", hint=f"add {names}")
        found = []
        for how in (Encoding(), *TABLES):
            try:
                program = self._program(how)
            except BrdfcError:
                continue
            measured = self.judge.measure_program(program, self.judge.graphs.channels)
            if measured is not None:
                cost, count = price(program), operations(program)
                name = str(how)
                found.append(
                    _point("encodings", name, measured, cost, count, self.expression, (name,))
                )
        return found

    def storage(self) -> list[Point]:
        """With the coefficients kept in fewer bits: integers span the declared ranges."""
        program = self._program(Encoding())
        found = []
        for name, stored in self._stored():
            measured = self.judge.measure_program(program, stored)
            if measured is not None:
                cost, count = price(program), operations(program)
                found.append(
                    _point("storage", name, measured, cost, count, self.expression, (name,))
                )
        return found

    def _program(self, how: Encoding) -> Program:
        safe, _ = guarded(self.expression, self.problem.ranges)
        return encoded(how, self.problem, safe)

    def _stored(self) -> list[tuple[str, NDArray[np.float32]]]:
        """The channels as a file of some sample type gives them back."""
        exact = self.judge.graphs.channels
        ends = [
            (self.formula.domain[q.name].low, self.formula.domain[q.name].high)
            for q in self.roles.channels
            for _ in q.component_names
        ]
        low, span = np.array([a for a, _ in ends]), np.array([b - a for a, b in ends])
        unit = np.divide(exact - low, span, out=np.zeros(exact.shape), where=span > 0)
        whole = {
            f"uint{bits}": low + span * np.round(unit * (2**bits - 1)) / (2**bits - 1)
            for bits in (16, 8)
        }
        half = np.clip(exact.astype(np.float16), low, low + span)
        return [
            ("float32", exact),
            ("float16", half.astype(np.float32)),
            *((name, values.astype(np.float32)) for name, values in whole.items()),
        ]


def rivals(
    model: Model, set: Mapping[str, Value], channels: Iterable[str], explored: Explored
) -> Rivals:
    """The chosen form of a search with what is needed to measure its rivals."""
    roles, ready = prepare(model, set, channels)
    problem = problem_of(roles, ready)
    many = points(problem.ranges.domain, problem.quantities, MANY)
    judge = Judge(problem, many)
    return Rivals(roles, ready, problem, judge, explored.chosen.form.expression)


def engine_points(compiled: Compiled, explored: Explored, pixels: int = 100_000) -> list[Point]:
    """Our interpreter, and the reference engine where it is installed: the least measured time of
    five passes over the same pixels."""
    from tempfile import TemporaryDirectory

    from brdfc.cmm import reference

    random = np.random.Generator(np.random.PCG64(1))
    low = [compiled.formula.domain[q.name] for q in compiled.roles.channels]
    columns = [
        random.uniform(i.low, i.high, (pixels, q.type.value.width))
        for i, q in zip(low, compiled.roles.channels, strict=True)
    ]
    image = np.concatenate(columns, axis=1).astype(np.float32)
    seconds = {"interpreter": min(_timed(compiled.program, image) for _ in range(5))}
    if reference.available():
        with TemporaryDirectory() as folder:
            mid, mvis = compiled.save(f"{folder}/timed_mvis.icc")
            judged = reference.apply(mid, mvis, image, repeat=5)
            seconds["reference engine"] = float(judged.seconds[0])
    chosen = explored.chosen
    count = operations(compiled.program)
    return [
        _point(
            "engines",
            name,
            chosen.measured,
            1e9 * taken / pixels,
            count,
            chosen.form.expression,
            (name,),
        )
        for name, taken in seconds.items()
    ]


def _timed(program: Program, image: NDArray[np.float32]) -> float:
    start = time.perf_counter()
    run(program, image, {})
    return time.perf_counter() - start
