"""Where programs fail: their worst errors by stratum of the domain, and what they cannot compute.

Errors are measured against the model's exact formula in high precision, at some thousand points of
every stratum; values that are no colour at all are counted at as many points as one has time for.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.judge.failure_strata import STRATA, applicable, failure_points
from brdfc.judge.failures import Counted, Failures, Row, Worst, failures
from brdfc.judge.jumps import Jumps, jumps
from brdfc.judge.measure import FALSE_ZERO, Judge, float64_suffices
from brdfc.judge.problem import Problem
from brdfc.judge.rival import Subject, pixels
from brdfc.judge.strata import Points
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.precise import PreciseEvaluation

JUDGED, COUNTED = 20_000, 1_000_000
"""Points whose error is measured, and points where failures are counted, by default."""
SLOW_JUDGED = 200
"""Points of a stratum at most where float64 is not good enough for the truth."""
LINES = 60
"""Lines of a stratum along which jumps are searched for."""
CHUNK = 1 << 17
"""Points counted at a time: memory stays bounded."""


def judge_strata(
    problem: Problem, subjects: Sequence[Subject], points: int = JUDGED, lines: int = LINES
) -> list[Row]:
    """A row for each stratum and program, strata in their order; the same every time."""
    strata = applicable(problem.quantities)
    share = max(1, points // len(strata))
    rows = []
    for stratum in strata:
        at = _stratum_points(problem, stratum, share)
        quick = float64_suffices(problem.exact, at)
        if at.count > SLOW_JUDGED and not quick:
            at = _stratum_points(problem, stratum, SLOW_JUDGED)
        judge = Judge(problem, at, quick)
        given = pixels(at, problem)
        starts, ends, floor = _lines(judge, given, lines)
        exact = _Exact(problem)
        for s in subjects:
            found = jumps(s.values, exact.quickly, exact.precisely, starts, ends, floor)
            rows.append(_row(problem, judge, s, stratum, given, found))
    return rows


def count_failures(
    problem: Problem, subjects: Sequence[Subject], points: int = COUNTED
) -> list[Counted]:
    """Failures at so many points of all strata, a chunk of them at a time."""
    counts = [Failures() for _ in subjects]
    exact = _Exact(problem)
    for at in _chunks(problem, points):
        given = pixels(at, problem)
        for number, s in enumerate(subjects):
            result = s.values(given)
            below = np.asarray((result < 0).any(axis=-1))
            counts[number] += failures(result, below, exact.quickly(given[below]))
    return [Counted(s.name, points, c) for s, c in zip(subjects, counts, strict=True)]


def place(problem: Problem, point: NDArray[np.float32]) -> str:
    """A point in words, angles first and in degrees: `incident=30deg reflection=30.1deg m=0.1`."""
    angles, others, start = [], [], 0
    for q in problem.quantities:
        values = [float(v) for v in point[start : start + q.type.value.width]]
        start += len(values)
        if q.type.is_angle:
            angles.append(f"{q.name}={math.degrees(values[0]):.9g}deg")
        else:
            same = len(set(values)) == 1
            text = ", ".join(f"{v:.9g}" for v in (values[:1] if same else values))
            others.append(f"{q.name}={text}" if same else f"{q.name}=({text})")
    return " ".join(angles + others)


def _row(
    problem: Problem,
    judge: Judge,
    subject: Subject,
    stratum: str,
    given: NDArray[np.float32],
    found: Jumps,
) -> Row:
    result = subject.values(given)
    bits, de = _confirmed(judge, result)
    below = np.asarray((result < 0).any(axis=-1))
    sizes = np.where(found.found, found.size, 0.0)
    return Row(
        stratum,
        subject.name,
        len(given),
        _worst(problem, given, np.exp2(bits) - 1),
        _worst(problem, given, de),
        failures(result, below, judge.truth[below]),
        len(found.found),
        int(found.found.sum()),
        _worst(problem, found.at, sizes),
    )


def _worst(problem: Problem, given: NDArray[np.float32], errors: NDArray[np.float64]) -> Worst:
    index = int(errors.argmax()) if len(errors) else -1
    if index < 0 or not errors[index] > 0:
        return Worst(0.0, "")
    return Worst(float(errors[index]), place(problem, given[index]))


def point_errors(
    judge: Judge, result: NDArray[np.float32]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(points,) in bits and in CIEDE2000; 0 where a result is not finite, which is counted."""
    finite = np.asarray(np.isfinite(result).all(axis=-1))
    bits, de = judge.errors_of(np.where(finite[:, None], result, 0.0).astype(np.float64))
    return np.where(finite, bits.max(axis=-1), 0.0), np.where(finite, de, 0.0)


def _confirmed(
    judge: Judge, result: NDArray[np.float32]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The errors of points, those of the worst by the truth in high precision."""
    confirmed: set[int] = set()
    while True:
        bits, de = point_errors(judge, result)
        worst = {int(bits.argmax()), int(de.argmax())} - confirmed
        if judge.quick and worst:
            for index in worst:
                judge.confirm(index)
            confirmed |= worst
        else:
            return bits, de


def _stratum_points(problem: Problem, stratum: str, count: int) -> Points:
    shares = dict.fromkeys(applicable(problem.quantities), 0) | {stratum: count}
    seed = 1 + list(STRATA).index(stratum)
    return failure_points(problem.ranges.domain, problem.quantities, shares, seed)


def _chunks(problem: Problem, points: int) -> Iterator[Points]:
    strata = applicable(problem.quantities)
    for seed, start in enumerate(range(0, points, CHUNK), start=1):
        count = min(CHUNK, points - start)
        shares = {s: (count + i) // len(strata) for i, s in enumerate(strata)}
        yield failure_points(problem.ranges.domain, problem.quantities, shares, seed)


def _lines(
    judge: Judge, given: NDArray[np.float32], lines: int
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float64]]:
    """Lines between points that differ in one channel: each channel in turn, its other end taken
    from another point of the stratum."""
    count, channels = given.shape
    which = np.linspace(0, count - 1, min(lines, count)).astype(int)
    starts = given[which]
    ends = starts.copy()
    channel = np.arange(len(which)) % channels
    ends[np.arange(len(which)), channel] = given[(which + 1) % count, channel]
    return starts, ends, np.maximum(judge.seen[which], FALSE_ZERO)


@dataclass(frozen=True)
class _Exact:
    """The exact formula at rows of pixels."""

    problem: Problem

    def columns(self, rows: NDArray[np.float32]) -> Mapping[str, NDArray[np.float64]]:
        found, start = {}, 0
        for q in self.problem.quantities:
            width = q.type.value.width
            found[q.name] = rows[:, start : start + width].astype(np.float64)
            start += width
        return found

    def quickly(self, rows: NDArray[np.float32]) -> NDArray[np.float64]:
        return evaluate(self.problem.exact, self.columns(rows))

    def precisely(self, rows: NDArray[np.float32]) -> NDArray[np.float64]:
        columns = {name: values.tolist() for name, values in self.columns(rows).items()}
        precise = PreciseEvaluation(self.problem.exact)
        values = [precise({n: c[i] for n, c in columns.items()}) for i in range(len(rows))]
        return np.array(values).reshape(len(rows), self.problem.exact.width)
