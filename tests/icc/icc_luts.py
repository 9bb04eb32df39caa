"""Generated lookup tables and curves for the tests: seeded random numbers in every layout."""

import math

import numpy as np

from brdfc.calc.samples import Samples, Storage
from brdfc.calc.tables import LookupTable
from brdfc.icc.curves import PARAMETERS, AnyCurve, Curve, ParametricCurve
from brdfc.icc.luts import StagedLut, TableLut

CURVES: tuple[AnyCurve, ...] = (
    Curve(),
    Curve(gamma=2.5),
    Curve(samples=Samples.of((0.0, 0.25, 1.0), Storage.UINT16)),
    *(
        ParametricCurve(kind, (2.5, 1.0, -0.25, 0.5, 0.125, -1 / 65536, 32767.0)[:count])
        for kind, count in PARAMETERS.items()
    ),
)


def random_samples(count: int, storage: Storage, seed: int = 0) -> Samples:
    return Samples.of(np.random.default_rng(seed).random(count), storage)


def table_lut(bits: int, inputs: int, outputs: int, points: int, entries: int = 256) -> TableLut:
    """An `mft1` or `mft2`."""
    storage = Storage.UINT8 if bits == 8 else Storage.UINT16
    table = random_samples(points**inputs * outputs, storage, 1)
    return TableLut(
        random_samples(inputs * entries, storage, 2),
        LookupTable(inputs, outputs, (points,) * inputs, table, extended=True),
        random_samples(outputs * entries, storage, 3),
        (1.0, 0.5, -0.25, 0.0, 1.0, 0.0, 0.0, 0.0, 1.5),
    )


def staged_lut(
    kind: str,
    device: int,
    stages: str = "AC3MB",
    storage: Storage = Storage.UINT16,
    grid: tuple[int, ...] = (2, 3, 4, 5),
) -> StagedLut:
    """An `mAB ` or `mBA `. stages: A, M, B curves, C the table, 3 the matrix."""
    inputs, outputs = (device, 3) if kind == "mAB " else (3, device)
    count = math.prod(grid[:inputs]) * outputs
    table = LookupTable(
        inputs, outputs, grid[:inputs], random_samples(count, storage), extended=True
    )
    return StagedLut(
        kind,  # type: ignore[arg-type]
        inputs,
        outputs,
        b_curves=CURVES[:3],
        matrix=(1.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -2.0, 0.125, 0.0, 0.5)
        if "3" in stages
        else None,
        m_curves=CURVES[3:6] if "M" in stages else None,
        clut=table if "C" in stages else None,
        a_curves=(CURVES * 2)[:device] if "A" in stages else None,
    )
