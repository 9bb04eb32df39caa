"""Random sub-elements of every kind that calculators call: matrices, curve sets, lookup tables.

All is drawn through a function from a list to one of its members (calc_programs.py); simple members
stand first, so that what fails shrinks towards them.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from brdfc.calc.curves import (
    CurveSet,
    FormulaSegment,
    SampledCurve,
    SampledSegment,
    Segment,
    SegmentedCurve,
)
from brdfc.calc.program import Matrix
from brdfc.calc.samples import Samples, Storage
from brdfc.calc.tables import LookupTable

Choose = Callable[[Sequence[Any]], Any]


def singles(*values: float) -> tuple[float, ...]:
    """Numbers that float32 holds."""
    return tuple(float(np.float32(value)) for value in values)


TAME = singles(1, 0, 0.5, 2, -1, 0.25, -0.5, 3, 0.1, -0.3, 1.5, 1 / 3, 0.7, -2, 10)
"""Constants that keep results within what can be told apart."""
UNIT = singles(0, 1, 0.5, 0.25, 0.9, 0.1, 0.7)
POWER = singles(1, 2, 0.5, 2.2, 1 / 2.4, 3)
POSITIVE = singles(1, 0.5, 2, 0.1, 0.9, 1.3)
NEGATIVE = singles(-1, -0.3, -2)

FORMULAS: dict[int, tuple[tuple[float, ...], ...]] = {
    0: (POWER, TAME, TAME, TAME),
    1: (POWER, TAME, POSITIVE, TAME, TAME),
    2: (TAME, POSITIVE, TAME, TAME, TAME),
    3: (POWER, TAME, TAME, TAME, TAME),
    4: (POWER, TAME, TAME, TAME, POSITIVE),
    5: (POWER, (*POSITIVE, *NEGATIVE), TAME, TAME, TAME, TAME),
    6: (POWER, POWER, TAME, POSITIVE, NEGATIVE, TAME, TAME),
    7: (POWER, POWER, TAME, TAME, POSITIVE, TAME),
}
"""What each parameter of a formula segment is drawn from, by the segment's type."""
BREAKS = (singles(0), singles(0.5), singles(-0.3, 0.6), singles(0.1, 0.4, 0.8))


def matrix(choose: Choose) -> Matrix:
    inputs, outputs = choose(range(1, 5)), choose(range(1, 5))
    values = _several(choose, TAME, inputs * outputs)
    offsets = _several(choose, TAME, outputs) if choose((False, True)) else (0.0,) * outputs
    return Matrix(inputs, outputs, values, offsets)


def lookup_table(choose: Choose) -> LookupTable:
    inputs, outputs = choose(range(1, 5)), choose(range(1, 4))
    grid = tuple(choose(range(2, 5)) for _ in range(inputs))
    storage = choose(tuple(Storage))
    extended = storage is not Storage.FLOAT32 or choose((False, True))
    return LookupTable(
        inputs, outputs, grid, _samples(choose, storage, math.prod(grid) * outputs), extended
    )


def curve_set(choose: Choose) -> CurveSet:
    kinds = (_segmented, _sampled)
    return CurveSet(tuple(choose(kinds)(choose) for _ in range(choose(range(1, 4)))))


def _sampled(choose: Choose) -> SampledCurve:
    first, last = choose((singles(0, 1), singles(-0.3, 0.9), singles(-2, 2)))
    samples = _samples(choose, choose(tuple(Storage)), choose(range(2, 7)))
    return SampledCurve(first, last, samples, choose((False, True)))


def _segmented(choose: Choose) -> SegmentedCurve:
    breaks = choose(((), *BREAKS))
    inner: list[Segment] = []
    for _ in breaks[1:]:
        sampled = choose((True, False))
        inner.append(_sampled_segment(choose) if sampled else _formula(choose))
    last = [_formula(choose)] if breaks else []
    return SegmentedCurve(breaks, (_formula(choose), *inner, *last))


def _formula(choose: Choose) -> FormulaSegment:
    kind = choose(tuple(FORMULAS))
    return FormulaSegment(kind, tuple(choose(options) for options in FORMULAS[kind]))


def _sampled_segment(choose: Choose) -> SampledSegment:
    return SampledSegment(_samples(choose, Storage.FLOAT32, choose(range(1, 5))))


def _samples(choose: Choose, storage: Storage, count: int) -> Samples:
    values = TAME if storage in (Storage.FLOAT32, Storage.FLOAT16) else UNIT
    return Samples.of(_several(choose, values, count), storage)


def _several(choose: Choose, options: Sequence[float], count: int) -> tuple[float, ...]:
    """Some drawn values, one after the other and again from the first: few draws fill a table."""
    drawn = [choose(options) for _ in range(min(count, 5))]
    return tuple(drawn[i % len(drawn)] for i in range(count))


ELEMENTS: dict[str, Callable[[Choose], Any]] = {
    "matf": matrix,
    "cvst": curve_set,
    "clut": lookup_table,
}
"""By kind; calculators draw their own calculators (calc_programs.py)."""
