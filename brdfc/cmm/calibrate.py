"""The table of prices, fitted to what the reference engine takes on this machine.

A price counts in a program as often as `work` says, so times are linear in prices, and prices are
the least squares of what programs take: each operator alone tells them all apart, and formulas
bring in that an operator waits for the one before. Other formulas judge the table.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.operators import OPERATORS
from brdfc.calc.price import work
from brdfc.calc.prices import CONTROL, Price, Prices
from brdfc.calc.program import Block
from brdfc.cmm.clock import Clock
from brdfc.cmm.probes import ELEMENTS, EMPTY, Probe, formulas, probes

_Array = NDArray[np.float64]
_Key = tuple[str, str]
_Work = Counter[_Key]

LEARNT, JUDGED = 200, 60
"""Formulas the prices are fitted to, and formulas that judge them."""
QUICK = 70
_AROUND: _Key = ("around", "first")
"""What all programs that are timed together take beside their operators."""
_PROBE = 0.5
"""What a probe counts against a formula."""
_USUAL = 0.03
"""A relative error from which a program counts the less, the more it is off."""
ALIKE = (
    ("pi", "+INF", "-INF", "NaN"),
    ("rotl", "rotr"),
    ("add", "sub", "mul"),
    ("sadd", "ssub", "smul"),
    ("sum", "prod"),
    ("neg", "sq", "cb"),
    ("min", "max"),
    ("vmin", "vmax"),
    ("and", "or"),
    ("vand", "vor", "vxor"),
    ("lt", "le", "ge", "gt"),
    ("eq", "neq"),
    ("flor", "ceil"),
    ("sin", "cos"),
    ("asin", "acos"),
)
"""Operators that the engine computes in the same way have one price: choices between them should
not hang on what the clock could not tell apart."""
_NO_PROBES = {"elem": "mtx", "tint": "curv", "tJab": "tLab", "fJab": "tXYZ"}
"""Calls of elements that are not made here, and what they may cost."""
_SAME = _NO_PROBES | {name: group[0] for group in ALIKE for name in group[1:]}
"""The operator whose price an operator has, if not one of its own."""


@dataclass(frozen=True)
class Calibration:
    """A table; the formulas that judge it, and what they took beside what is common to all."""

    table: Prices
    judges: tuple[Block, ...]
    measured: _Array

    @property
    def errors(self) -> _Array:
        """Relative errors of the table's predictions."""
        return np.abs(predicted(self.table, self.judges) / self.measured - 1)

    def errors_of(self, other: Prices) -> _Array:
        """The same of another table, multiplied by what fits best: only its ratios count."""
        ratios = predicted(other, self.judges) / self.measured
        errors: _Array = np.abs(ratios / np.median(ratios) - 1)
        return errors

    def ratios_to(self, other: Prices) -> dict[str, float]:
        """Each operator's time here over that of another table, 1 at the median."""
        apart = {
            name: (self.table.dispatch + price.first)
            / (other.dispatch + other.operators[name].first)
            for name, price in self.table.operators.items()
        }
        middle = float(np.median(list(apart.values())))
        return {name: ratio / middle for name, ratio in apart.items()}


def calibrate(clock: Clock, quick: bool = False) -> Calibration:
    """Time all probes and formulas, and fit the table."""
    single = probes()
    learnt, judges = formulas(1, QUICK if quick else LEARNT), formulas(2, JUDGED)
    pairs = [block for probe in single for block in (probe.few, probe.many)]
    times = clock.together([*pairs, *learnt, *judges])
    of_pairs, of_learnt, of_judges = np.split(times, [len(pairs), len(pairs) + len(learnt)])
    costs = fit(single, of_pairs[1::2] - of_pairs[::2], learnt, of_learnt)
    around = costs.pop(_AROUND)
    pixel = clock.alone(EMPTY) - _total(costs, EMPTY)
    return Calibration(_table(costs, pixel), judges, of_judges - around)


def predicted(table: Prices, blocks: Sequence[Block]) -> _Array:
    """What programs cost by a table, the fixed cost of a pixel left out."""
    costs = {}
    for name, price in table.operators.items():
        costs[name, "first"], costs[name, "more"] = table.dispatch + price.first, price.more
    return np.array([_total(costs, block) for block in blocks])


def _total(costs: dict[_Key, float], block: Block) -> float:
    return sum(count * costs.get(key, 0.0) for key, count in work(block, ELEMENTS).items())


def _work(block: Block) -> _Work:
    """How often each price counts, those of operators that are alike as one."""
    found: _Work = Counter()
    for (name, part), count in work(block, ELEMENTS).items():
        found[_SAME.get(name, name), part] += count
    return found


def fit(
    single: Sequence[Probe], apart: _Array, learnt: Sequence[Block], times: _Array
) -> dict[_Key, float]:
    """Prices, dispatch included, and the time around all formulas.

    apart: what a probe's longer program takes more. times: of formulas.
    """
    rows: list[_Work] = []
    for probe in single:
        row = _work(probe.many)
        row.subtract(_work(probe.few))
        rows.append(row)
    rows += [_work(block) + Counter([_AROUND]) for block in learnt]
    keys = sorted({key for row in rows for key, count in row.items() if count})
    matrix = np.array([[row[key] for key in keys] for row in rows], dtype=float)
    times = np.concatenate([apart, times])
    # An interrupted clock may say that more work takes no time; such a row tells nothing.
    sane = np.maximum(times, 1.0)
    weights = np.where(times > 0, 1.0, 0.0) / sane
    weights[: len(single)] *= _PROBE
    trust = np.ones(len(times))
    for _ in range(8):
        found = _least_squares(matrix * (weights * trust)[:, None], times * weights * trust)
        off = np.abs(matrix @ found - times) / sane
        trust = 1 / np.sqrt(np.maximum(1.0, off / _USUAL))
    return dict(zip(keys, found.tolist(), strict=True))


def _least_squares(matrix: _Array, times: _Array) -> _Array:
    """Least squares where nothing costs less than nothing."""
    free = np.ones(matrix.shape[1], dtype=bool)
    while True:
        found: _Array = np.zeros(matrix.shape[1])
        found[free] = np.linalg.lstsq(matrix[:, free], times, rcond=None)[0]
        if found.min() >= 0:
            return found
        free[found.argmin()] = False


def _table(costs: dict[_Key, float], pixel: float) -> Prices:
    """Prices beyond a dispatch, which is what the cheapest operator costs."""
    dispatch = min(cost for (_, part), cost in costs.items() if part == "first")
    operators = {}
    for name in (*CONTROL, *OPERATORS):
        as_if = _SAME.get(name, name)
        first, more = (costs.get((as_if, part), 0.0) for part in ("first", "more"))
        operators[name] = Price(max(first - dispatch, 0.0), more)
    return Prices(max(pixel, 0.0), dispatch, operators)
