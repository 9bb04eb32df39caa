"""The worst error of programs in cells of the plane of the two angles, for a picture."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.judge.directions import directions
from brdfc.judge.failure_strata import applicable, failure_points
from brdfc.judge.measure import Judge, float64_suffices
from brdfc.judge.problem import Problem
from brdfc.judge.rival import Subject, pixels
from brdfc.judge.stability import point_errors
from brdfc.judge.strata import Points

POINTS, CELLS = 300_000, 90
"""Points of a map, and cells along a side of 180 degrees."""
SLOW_POINTS, SLOW_CELLS = 6_000, 30
"""The same where float64 is not good enough for the truth."""


@dataclass(frozen=True)
class Cells:
    """One program: bits, the worst error in each cell (reflection, incidence), NaN where no point
    lies; broken, where a result is NaN or infinite."""

    bits: NDArray[np.float64]
    broken: NDArray[np.bool_]


@dataclass(frozen=True)
class ErrorMap:
    """across, up: what the axes are, in words; their ends in degrees (left, right, bottom, top);
    points: how many there are; cells by the name of the program. up is "" where there is but one
    angle: the map is a single row then."""

    across: str
    up: str
    ends: tuple[float, float, float, float]
    points: int
    cells: Mapping[str, Cells]


def error_map(
    problem: Problem, subjects: Sequence[Subject], points: int = POINTS
) -> ErrorMap | None:
    """The map of programs at so many points of all strata, most of them uniform; None where the
    model has no angle. The same every time."""
    of = directions(problem.quantities)
    if not of.zeniths:
        return None
    at, side = _points(problem, points), CELLS
    if not float64_suffices(problem.exact, at):
        at, side = _points(problem, min(points, SLOW_POINTS)), SLOW_CELLS
    judge = Judge(problem, at)
    given = pixels(at, problem)
    x, y = _coordinates(at, problem)
    domain = problem.ranges.domain
    first = domain[of.zeniths[0]]
    ends = [math.degrees(first.low), math.degrees(first.high), 0.0, 1.0]
    if of.pair:
        second = domain[of.zeniths[1]]
        low = -second.high if of.full else second.low
        ends[2:] = [math.degrees(low), math.degrees(second.high)]
    columns, across = _cell(x, ends[0], ends[1], side)
    rows, up = _cell(y, ends[2], ends[3], side) if of.pair else (np.zeros(len(x), np.intp), 1)
    cells = {}
    for s in subjects:
        result = s.values(given)
        bits, _ = point_errors(judge, result)
        worst = np.full((up, across), -1.0)
        np.maximum.at(worst, (rows, columns), bits)
        broken = np.zeros((up, across), dtype=np.bool_)
        failed = ~np.isfinite(result).all(axis=-1)
        broken[rows[failed], columns[failed]] = True
        cells[s.name] = Cells(np.where(worst < 0, np.nan, worst), broken)
    words = f"{of.zeniths[1]}, degrees" if of.pair else ""
    words += ": negative on the light's side" if of.full else ""
    left, right, bottom, top = ends
    limits = (left, right, bottom, top)
    return ErrorMap(f"{of.zeniths[0]}, degrees", words, limits, at.count, cells)


def _points(problem: Problem, points: int) -> Points:
    """Two thirds anywhere, so that every cell has some; the rest where methods fail."""
    strata = applicable(problem.quantities)
    shares = dict.fromkeys(strata, points // 3 // len(strata))
    shares["uniform"] += points * 2 // 3
    return failure_points(problem.ranges.domain, problem.quantities, shares)


def _coordinates(at: Points, problem: Problem) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The angles of each point in degrees. Out of plane the second has a sign: positive in the half
    of directions that the mirror lies in, as in the plane."""
    of = directions(problem.quantities)
    angles = [np.degrees(at.values[n][:, 0].astype(np.float64)) for n in of.zeniths]
    if of.full:
        first, second = (at.values[n][:, 0].astype(np.float64) for n in of.azimuths)
        angles[1] = np.where(np.cos(second - first) > 0, -angles[1], angles[1])
    return angles[0], angles[-1]


def _cell(
    angle: NDArray[np.float64], low: float, high: float, side: int
) -> tuple[NDArray[np.intp], int]:
    """Which cell each angle lies in, and how many there are."""
    count = max(1, round(side * (high - low) / 180))
    place = np.floor((angle - low) / max(high - low, 1e-9) * count)
    return np.clip(place, 0, count - 1).astype(np.intp), count
