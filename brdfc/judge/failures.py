"""The figures of a program in a stratum: worst errors, and results that are no colour."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

EVERYWHERE = "all strata"
"""The stratum of points that are only counted: as many of each."""


@dataclass(frozen=True)
class Failures:
    """How many results are NaN, infinite, or below 0 where the formula is not."""

    nan: int = 0
    infinite: int = 0
    negative: int = 0

    def __add__(self, other: Failures) -> Failures:
        return Failures(
            self.nan + other.nan, self.infinite + other.infinite, self.negative + other.negative
        )


@dataclass(frozen=True)
class Worst:
    """A worst figure, and where it is, in words; "" where it is 0."""

    value: float
    at: str


@dataclass(frozen=True)
class Row:
    """A program in a stratum.

    points: compared with the truth. ulp: worst error in units in the last place, where a value is
    large enough to be seen beside the peak; de: worst CIEDE2000 (white: D50), both of results that
    are finite. jumps: how many of lines end in a jump that the formula does not have; jump: the
    largest, as a share of the value.
    """

    stratum: str
    method: str
    points: int
    ulp: Worst
    de: Worst
    failures: Failures
    lines: int
    jumps: int
    jump: Worst

    @property
    def bits(self) -> float:
        """log2(1 + units in the last place)."""
        return math.log2(1 + self.ulp.value)


@dataclass(frozen=True)
class Counted:
    """Failures of a program at many points of all strata, none of them compared with the truth."""

    method: str
    points: int
    failures: Failures


def overall(rows: Iterable[Row], method: str) -> Row:
    """The worst of all strata and the sum of their counts, for one program."""
    own = [row for row in rows if row.method == method]
    return Row(
        EVERYWHERE,
        method,
        sum(row.points for row in own),
        max((row.ulp for row in own), key=lambda w: w.value),
        max((row.de for row in own), key=lambda w: w.value),
        sum((row.failures for row in own), Failures()),
        sum(row.lines for row in own),
        sum(row.jumps for row in own),
        max((row.jump for row in own), key=lambda w: w.value),
    )


def failures(
    result: NDArray[np.float32], below: NDArray[np.bool_], truth: NDArray[np.float64]
) -> Failures:
    """Failures among results (points, components). below: the points with a component below 0;
    truth: the formula's values at those."""
    nan = np.isnan(result).any(axis=-1)
    infinite = np.isinf(result).any(axis=-1) & ~nan
    negative = (result[below] < 0) & ~(truth < 0)
    wrong = negative.any(axis=-1) & np.isfinite(result[below]).all(axis=-1)
    return Failures(int(nan.sum()), int(infinite.sum()), int(wrong.sum()))
