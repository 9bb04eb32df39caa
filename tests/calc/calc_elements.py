"""Elements of every kind, for the tests of their bytes and of their values."""

import numpy as np

from brdfc.calc.appearance import AppearanceTransform
from brdfc.calc.calculator_curves import CalculatorCurve
from brdfc.calc.curves import (
    CurveSet,
    FormulaSegment,
    SampledCurve,
    SampledSegment,
    SegmentedCurve,
)
from brdfc.calc.program import Program
from brdfc.calc.samples import Samples, Storage
from brdfc.calc.tables import LookupTable
from brdfc.calc.text import assemble
from brdfc.calc.tints import TintArray

RANDOM = np.random.default_rng(0)


def single(value: float) -> float:
    return float(np.float32(value))


def formula(kind: int, *parameters: float) -> FormulaSegment:
    return FormulaSegment(kind, tuple(map(single, parameters)))


FORMULAS = {
    0: formula(0, 2.2, 0.9, 0.1, 0.05),
    1: formula(1, 1.3, 0.4, 2.0, 0.5, 0.1),
    2: formula(2, 0.5, 2.3, 0.9, -0.2, 0.3),
    3: formula(3, 2.4, 0.9, 1.1, -0.2, 0.01),
    4: formula(4, 0.8, 0.5, -0.3, 0.1, 1.7),
    5: formula(5, 1.2, 0.7, 0.1, 0.2, 0.9, 0.4),
    6: formula(6, 1.3, 0.9, 0.1, 1.5, 0.3, 0.8, 1.1),
    7: formula(7, 0.9, 1.1, 0.2, 0.8, 0.5, 0.9),
}
LINE = formula(0, 1, 2, 0, 0)

SAMPLED = {
    (storage, extend, count): SampledCurve(
        single(-0.3), single(0.9), Samples.of(RANDOM.uniform(0, 1, count), storage), extend
    )
    for storage in Storage
    for extend in (False, True)
    for count in (2, 3, 17, 1000)
}
SEGMENTED = {
    kind: SegmentedCurve(
        (single(0.1), single(0.4), single(0.8)),
        (
            first,
            SampledSegment(Samples.of(RANDOM.uniform(-1, 1, 5))),
            SampledSegment(Samples.of(RANDOM.uniform(-1, 1, 1))),
            LINE,
        ),
    )
    for kind, first in FORMULAS.items()
}
ALONE = {kind: SegmentedCurve((), (formula,)) for kind, formula in FORMULAS.items()}
SHARED = CurveSet((ALONE[0], SEGMENTED[3], ALONE[0]))


def table(inputs: int, storage: Storage, *, extended: bool = True, outputs: int = 3) -> LookupTable:
    grid = tuple(int(points) for points in RANDOM.integers(2, 6, inputs))
    values = RANDOM.uniform(0, 1, int(np.prod(grid)) * outputs)
    return LookupTable(inputs, outputs, grid, Samples.of(values, storage), extended)


TABLES = [
    *(table(inputs, storage) for inputs in range(1, 7) for storage in Storage),
    *(table(inputs, Storage.FLOAT32, extended=False) for inputs in range(1, 7)),
    LookupTable(7, 3, (2,) * 7, Samples.of(RANDOM.uniform(0, 1, 3 * 2**7))),
]
TINTS = [
    TintArray(outputs, Samples.of(RANDOM.uniform(0, 1, outputs * steps), storage))
    for storage in Storage
    for outputs, steps in ((1, 2), (1, 17), (3, 5), (3, 1000))
]
D65 = (single(95.05), 100.0, single(108.88))


def appearance(kind: str, *numbers: float) -> AppearanceTransform:
    x, y, z, *conditions = map(single, numbers)
    return AppearanceTransform(kind, (x, y, z), *conditions)


APPEARANCE = {kind: appearance(kind, *D65, 60, 20, 0.69, 1, 1) for kind in ("XtoJ", "JtoX")}


def calculated(
    text: str, size: int, first: float = 0.0, last: float = 1.0, *, extend: bool = False
) -> CalculatorCurve:
    calculator = Program(1, 1, assemble(f"{{ in {text} out }}"))
    return CalculatorCurve(size, single(first), single(last), calculator, extend)


CALCULATED = [
    *(calculated("sq", size, extend=extend) for size in (2, 3, 5, 400) for extend in (False, True)),
    calculated("exp", 33, -0.7, 1.3, extend=True),
    calculated("ln", 5, extend=True),  # the first sample is infinite
    calculated("env(inci) if { } else { pop 0.5 } mul cos", 64),
    calculated("pop 0.25", 7),
    calculated("7 mul sin", 100_000),  # 16384 samples are taken
]
CURVE_SETS = [
    *(CurveSet((curve,)) for curve in (*SAMPLED.values(), *SEGMENTED.values(), *ALONE.values())),
    SHARED,
    *(CurveSet((curve,)) for curve in CALCULATED),
]
