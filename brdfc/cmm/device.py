"""Transforms of tables and tone curves (`mft1`, `mft2`, `mAB `, `mBA `, matrix, TRC) as elements.

The engine runs them as it runs any element, in float32. A connection space is left as real numbers
(X, Y, Z with Y = 1; L, a, b); device values are 0 to 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from brdfc.calc.curves import CurveSet, SampledCurve
from brdfc.calc.program import Element, Matrix
from brdfc.calc.samples import Samples
from brdfc.cmm.tones import inverse_tone, tone
from brdfc.icc.curves import AnyCurve, Curve, ParametricCurve
from brdfc.icc.luts import IDENTITY, StagedLut, TableLut
from brdfc.icc.profile import Profile
from brdfc.icc.types import XYZArray
from brdfc.profiles.conditions import matrix_element, profile_white
from brdfc.source.errors import LinkError

Lut = TableLut | StagedLut

_XYZ_UNIT = 32768 / 65535
"""What 1 is in encoded X, Y, Z (u1Fixed15)."""
_LAB_STEPS = {True: (652.8 / 65535, 256 / 65535), False: (1 / 100, 1 / 255)}
"""What one of L, and one of a or b, is in encoded CIELAB. In `mft2` the upper byte of the 16 bits
is the whole number (ICC.1:2022, 10.10), elsewhere 65535 stands for 100 and for 127."""


def lut_elements(
    tag: Lut, space: bytes, takes_colours: bool, gives_colours: bool
) -> tuple[Element, ...]:
    """A lookup table's stages. space: the connection space; takes_colours, gives_colours: which
    sides are in it."""
    legacy = isinstance(tag, TableLut) and tag.bits == 16
    before = (encoding(space, legacy),) if takes_colours else ()
    after = (decoding(space, legacy),) if gives_colours else ()
    if isinstance(tag, StagedLut):
        inner = _staged(tag)
    else:
        inner = _tabled(tag, takes_colours and space == b"XYZ ")
    return (*before, *inner, *after)


def encoding(space: bytes, legacy: bool = False) -> Matrix:
    """From real numbers of a connection space to 0..1."""
    if space == b"XYZ ":
        return matrix_element(np.eye(3) * _XYZ_UNIT)
    lightness, step = _LAB_STEPS[legacy]
    element = matrix_element(np.diag([lightness, step, step]))
    return Matrix(3, 3, element.values, (0.0, 128 * step, 128 * step))


def decoding(space: bytes, legacy: bool = False) -> Matrix:
    """The inverse of encoding."""
    if space == b"XYZ ":
        return matrix_element(np.eye(3) / _XYZ_UNIT)
    lightness, step = _LAB_STEPS[legacy]
    element = matrix_element(np.diag([1 / lightness, 1 / step, 1 / step]))
    return Matrix(3, 3, element.values, (0.0, -128.0, -128.0))


def _tabled(tag: TableLut, with_matrix: bool) -> tuple[Element, ...]:
    matrix: tuple[Element, ...] = ()
    if with_matrix and tag.matrix != IDENTITY:
        matrix = (Matrix(3, 3, tag.matrix, (0.0, 0.0, 0.0)),)
    curves = (_sampled(tag.input_curves, tag.inputs), _sampled(tag.output_curves, tag.outputs))
    return (*matrix, curves[0], tag.table, curves[1])


def _sampled(samples: Samples, channels: int) -> CurveSet:
    """Samples of several channels, one after the other, as curves."""
    size = len(samples.data) // channels
    parts = (samples.data[k * size : (k + 1) * size] for k in range(channels))
    return CurveSet(tuple(SampledCurve(0.0, 1.0, Samples(samples.storage, p)) for p in parts))


def _staged(tag: StagedLut) -> tuple[Element, ...]:
    """Only the stages that there are; `mAB ` ends with the B curves, `mBA ` begins with them."""
    matrix = None if tag.matrix is None else Matrix(3, 3, tag.matrix[:9], tag.matrix[9:])
    curves = [_curves(c) for c in (tag.b_curves, tag.m_curves, tag.a_curves)]
    stages: list[Element | None] = [curves[0], matrix, curves[1], tag.clut, curves[2]]
    ordered = stages if tag.kind == "mBA " else stages[::-1]
    return tuple(stage for stage in ordered if stage is not None)


def _curves(curves: Sequence[AnyCurve] | None) -> CurveSet | None:
    return None if curves is None else CurveSet(tuple(map(tone, curves)))


# --- matrix and tone curves -----------------------------------------------------------------------


@dataclass(frozen=True)
class Shaper:
    """name: "matrix" or "gray". channels: of the device."""

    name: str
    channels: int
    elements: tuple[Element, ...]


_WORST = 1e6
"""The condition of a matrix whose inverse float32 makes nothing of; of a display it is under 10."""
_COLUMNS, _TONES = ("rXYZ", "gXYZ", "bXYZ"), ("rTRC", "gTRC", "bTRC")


def matrix_shaper(profile: Profile, inverse: bool) -> Shaper | None:
    """The transform of a profile's tone curves, with the matrix of its colorants, or of its gray
    curve; None where it has neither. inverse: from the connection space.

    Raises LinkError where they cannot be inverted.
    """
    space = profile.header.device_space
    if space == b"RGB " and profile.header.pcs == b"XYZ ":
        return _matrix(profile, inverse)
    return _gray(profile, inverse) if space == b"GRAY" else None


def _matrix(profile: Profile, inverse: bool) -> Shaper | None:
    columns = [profile.tags.get(name) for name in _COLUMNS]
    tones = _tones(profile, _TONES)
    colorants = [c.values[0] for c in columns if isinstance(c, XYZArray) and len(c.values)]
    if tones is None or len(colorants) != 3:
        return None
    matrix = np.array(colorants, dtype=np.float64).T
    if not inverse:
        return Shaper("matrix", 3, (CurveSet(tuple(map(tone, tones))), matrix_element(matrix)))
    if not np.linalg.cond(matrix) < _WORST:
        raise LinkError("the profile's colorants lie in a plane: no matrix leads back")
    back = np.asarray(np.linalg.inv(matrix), dtype=np.float64)
    return Shaper("matrix", 3, (matrix_element(back), CurveSet(tuple(map(inverse_tone, tones)))))


def _gray(profile: Profile, inverse: bool) -> Shaper | None:
    tones = _tones(profile, ("kTRC",))
    if tones is None:
        return None
    is_lab = profile.header.pcs == b"Lab "
    white = (100.0, 0.0, 0.0) if is_lab else profile_white(profile)
    if not inverse:
        curve = CurveSet((tone(tones[0]),))
        return Shaper("gray", 1, (curve, matrix_element(np.array([white], np.float64).T)))
    lightness = np.array([[0.01, 0.0, 0.0] if is_lab else [0.0, 1.0, 0.0]])
    return Shaper("gray", 1, (matrix_element(lightness), CurveSet((inverse_tone(tones[0]),))))


def _tones(profile: Profile, names: Sequence[str]) -> list[AnyCurve] | None:
    found = [profile.tags.get(name) for name in names]
    curves = [c for c in found if isinstance(c, Curve | ParametricCurve)]
    return curves if len(curves) == len(names) else None
