"""Generated profiles of devices: displays of tone curves and a matrix, printers of tables, gray."""

from __future__ import annotations

import numpy as np

from brdfc.calc.curves import CurveSet, FormulaSegment, SegmentedCurve
from brdfc.calc.program import Matrix
from brdfc.calc.samples import Samples, Storage
from brdfc.calc.tables import LookupTable
from brdfc.icc.curves import Curve, ParametricCurve
from brdfc.icc.header import Header
from brdfc.icc.luts import StagedLut, TableLut
from brdfc.icc.profile import Profile
from brdfc.icc.types import LocalizedText, Pipeline, XYZArray

SRGB = ParametricCurve(3, (2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045))
GAMMA = Curve(gamma=2.19921875)
TABLE = Curve(samples=Samples.of(np.linspace(0, 1, 1024) ** 2.4, Storage.UINT16))
COLUMNS = [(0.43604, 0.22249, 0.01392), (0.38512, 0.71690, 0.09706), (0.14305, 0.06061, 0.71391)]
VERSIONS = {2: 0x02400000, 4: 0x04200000, 5: 0x05000000}


def profile(kind: str, space: bytes, pcs: bytes, version: int, /, **tags: object) -> Profile:
    """A profile of a class with what every profile has."""
    common = {
        "desc": LocalizedText.english(f"generated {kind}"),
        "cprt": LocalizedText.english("No copyright is claimed."),
        "wtpt": XYZArray(((0.9, 0.93, 0.75),)),
    }
    header = Header(kind, colour_space=space, pcs=pcs, version=VERSIONS[version])
    # Read back: fixed-point numbers are what a file holds of them.
    return Profile.from_bytes(Profile(header, {**common, **tags}).to_bytes())


def display(curve: Curve | ParametricCurve, version: int = 4) -> Profile:
    colorants = {n: XYZArray((c,)) for n, c in zip(("rXYZ", "gXYZ", "bXYZ"), COLUMNS, strict=True)}
    curves = dict.fromkeys(("rTRC", "gTRC", "bTRC"), curve)
    return profile("mntr", b"RGB ", b"XYZ ", version, **colorants, **curves)


def gray(pcs: bytes = b"XYZ ") -> Profile:
    return profile("mntr", b"GRAY", pcs, 4, kTRC=GAMMA)


def _grid(channels: int, points: int) -> np.ndarray:
    axes = np.meshgrid(*[np.linspace(0, 1, points)] * channels, indexing="ij")
    return np.stack(axes, axis=-1).reshape(-1, channels)


def _inked(cmyk: np.ndarray) -> np.ndarray:
    """CIELAB of inks, encoded 0..1 smoothly: no model of anything."""
    c, m, y, k = np.moveaxis(cmyk, -1, 0)
    light = (1 - 0.5 * c) * (1 - 0.6 * m) * (1 - 0.1 * y) * (1 - 0.9 * k)
    a = 0.5 + (0.25 * m - 0.2 * c) * (1 - k)
    b = 0.5 + (0.3 * y - 0.25 * c) * (1 - k)
    return np.stack([light, a, b], axis=-1)


def _separated(lab: np.ndarray) -> np.ndarray:
    """Some inks for CIELAB, encoded 0..1."""
    light, a, b = np.moveaxis(lab, -1, 0)
    inks = [1 - light + (0.5 - a), 1 - light + (a - 0.5), 1 - light + (b - 0.5), (1 - light) ** 3]
    return np.clip(np.stack(inks, axis=-1), 0, 1)


def _curves(channels: int, storage: Storage, power: float) -> Samples:
    return Samples.of(np.tile(np.linspace(0, 1, 256) ** power, channels), storage)


def _table(inputs: int, outputs: int, points: int, values: np.ndarray, storage: Storage):
    samples = Samples.of(values, storage)
    return LookupTable(inputs, outputs, (points,) * inputs, samples, extended=True)


def printer(storage: Storage = Storage.UINT16, version: int = 2) -> Profile:
    """CMYK of `mft1` or `mft2`, both ways, all intents that differ by their curves."""
    tags = {}
    for number, power in enumerate((1.0, 1.1, 0.9)):
        there = _table(4, 3, 5, _inked(_grid(4, 5)), storage)
        back = _table(3, 4, 9, _separated(_grid(3, 9)), storage)
        curves = [_curves(n, storage, power) for n in (4, 3, 3, 4)]
        tags[f"A2B{number}"] = TableLut(curves[0], there, curves[1])
        tags[f"B2A{number}"] = TableLut(curves[2], back, curves[3])
    return profile("prtr", b"CMYK", b"Lab ", version, **tags)


def staged(pcs: bytes = b"Lab ") -> Profile:
    """RGB of `mAB ` and `mBA ` with every stage."""
    matrix = (0.9, 0.05, 0.05, 0.02, 0.95, 0.03, 0.01, 0.04, 0.95, 0.01, 0.0, 0.02)
    points = _grid(3, 6)
    mixed = 0.1 + 0.8 * points**1.2 * (1 - 0.5 * np.roll(points, 1, axis=-1))
    there = _table(3, 3, 6, mixed, Storage.UINT16)
    back = _table(3, 3, 6, 0.1 + 0.8 * _grid(3, 6) ** 0.9, Storage.UINT8)
    a, m, b = (SRGB,) * 3, (GAMMA, TABLE, Curve()), (ParametricCurve(0, (1.1,)),) * 3
    onward = StagedLut("mAB ", 3, 3, b, matrix, m, there, a)
    inward = StagedLut("mBA ", 3, 3, b, matrix, m, back, a)
    return profile("prtr", b"RGB ", pcs, 4, A2B0=onward, A2B1=onward, B2A0=inward, B2A1=inward)


def pipelined(pcs: bytes = b"XYZ ") -> Profile:
    """RGB of processing elements, as version 5 has them."""
    curve = SegmentedCurve((), (FormulaSegment(0, (2.2, 1.0, 0.0, 0.0)),))
    back = SegmentedCurve((), (FormulaSegment(0, (1 / 2.2, 1.0, 0.0, 0.0)),))
    scale = 100.0 if pcs == b"Lab " else 1.0
    columns = np.array(COLUMNS).T * scale
    there = Matrix(3, 3, tuple(np.float32(columns).ravel().tolist()), (0.0,) * 3)
    inverse = Matrix(3, 3, tuple(np.float32(np.linalg.inv(columns)).ravel().tolist()), (0.0,) * 3)
    return profile(
        "spac",
        b"RGB ",
        pcs,
        5,
        A2B1=Pipeline(3, 3, (CurveSet((curve,) * 3), there)),
        B2A1=Pipeline(3, 3, (inverse, CurveSet((back,) * 3))),
        A2B3=Pipeline(3, 3, (CurveSet((curve,) * 3), there)),
    )
