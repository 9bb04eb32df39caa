"""Colour appearance, X, Y, Z to J, a, b and back: CIECAM02 as the reference engine computes it.

That is CIECAM02 (CIE 159:2004) with two changes, so that every colour has a result. Adaptation
works on the cone responses of Hunt, Pointer and Estevez themselves, not on those of CAT02, and
negative responses are clipped. The compression has another exponent, and is a line up to 4/255 of
where the adapting luminance is. J is the lightness; a and b are the chroma C along its hue.

Computed in float64 and rounded once. The reference rounds in between, and one entry of its inverse
matrix has the wrong sign, which changes Y by 1.6e-5 of Z: that is not followed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.appearance import FORWARD, AppearanceTransform
from brdfc.engine.kernels import Values

Wide = NDArray[np.float64]
Three = Sequence[Wide]

CONES = ((0.38970, 0.68898, -0.07868), (-0.22981, 1.18340, 0.04641), (0.0, 0.0, 1.0))
"""X, Y, Z to the responses of the cones."""
_FROM_CONES = np.linalg.inv(CONES).tolist()
_EXPONENT, _CIE_EXPONENT, _LIFT = 0.3169, 0.42, 0.2307
_KNEE = 4 / 255
"""Where the line of the compression ends, in units of F_L."""
_LEAST = 1e-5
"""The lightness of black, and the chroma (t) of grey, in the way back."""
_CHROMA = 50000 / 13


@dataclass(frozen=True)
class Conditions:
    """What the equations need of the viewing conditions.

    gains: of each cone by adaptation, 0 where it sees nothing of the white. luminance, chroma,
    induction, background, exponent, white: F_L, (1.64 - 0.29^n)^0.73, N_c N_cb, N_bb, c z and A_w
    of CIE 159.
    """

    gains: tuple[float, ...]
    luminance: float
    chroma: float
    induction: float
    background: float
    exponent: float
    white: float


def conditions(transform: AppearanceTransform) -> Conditions | None:
    """None where colours have no appearance: a white without Y, no background, no light, c = 0."""
    adapting, (_, y, _) = np.float64(transform.luminance), transform.white
    k = np.power(1 / (5 * adapting + 1), 4)
    luminance = 0.2 * k * 5 * adapting + 0.1 * (1 - k) ** 2 * np.cbrt(5 * adapting)
    degree = transform.degree * (1 - np.exp(-(adapting + 42) / 92) / 3.6)
    n = np.float64(transform.background) / np.float64(y)
    background = 0.725 / np.power(n, 0.2)
    chroma = np.power(1.64 - np.power(0.29, n), 0.73)
    exponent = transform.impact * (1.48 + np.sqrt(n))
    cones = _times(CONES, [np.asarray(v, np.float64) for v in transform.white])
    gains = [degree * y / v + 1 - degree if v != 0 else 0.0 for v in cones]
    adapted = [gain * v for gain, v in zip(gains, cones, strict=True)]
    white = _achromatic(*(_compressed(v, luminance) for v in adapted)) * background
    induction = transform.induction * background
    numbers = [float(v) for v in (luminance, chroma, induction, background, exponent, white)]
    if not np.isfinite([*gains, *numbers]).all() or luminance <= 0 or white * exponent == 0:
        return None
    return Conditions(tuple(map(float, gains)), *numbers)


def apply_appearance(transform: AppearanceTransform, inputs: Sequence[Values]) -> list[Values]:
    """Three channels for three; 0 where the conditions give no colour an appearance."""
    found = conditions(transform)
    wide = [v.astype(np.float64) for v in np.broadcast_arrays(*inputs)]
    if found is None:
        results: Three = [np.zeros_like(v) for v in wide]
    elif transform.signature == FORWARD:
        results = _to_jab(found, wide)
    else:
        results = _to_xyz(found, wide)
    return [np.asarray(v).astype(np.float32) for v in results]


def _to_jab(at: Conditions, xyz: Three) -> Three:
    cones = _times(CONES, xyz)
    adapted = [gain * np.maximum(v, 0) for gain, v in zip(at.gains, cones, strict=True)]
    r, g, b = (_compressed(v, at.luminance) for v in adapted)
    red, yellow = r - 12 * g / 11 + b / 11, (r + g - 2 * b) / 9
    hue = np.arctan2(yellow, red)
    response = _achromatic(r, g, b) * at.background
    lightness = 100 * np.power(response / at.white, at.exponent)
    lightness = np.where(np.isfinite(response), lightness, 0.0)
    t = _CHROMA * at.induction * _eccentricity(hue) * np.hypot(red, yellow) / (r + g + 1.05 * b)
    chroma = np.power(t, 0.9) * np.sqrt(lightness / 100) * at.chroma
    return lightness, chroma * np.cos(hue), chroma * np.sin(hue)


def _to_xyz(at: Conditions, jab: Three) -> Three:
    """The equations of _to_jab solved for r, g, b: along a hue these are lines in the distance
    from grey, and so is what t divides by."""
    lightness, a, b = jab
    share = lightness / 100
    t = np.power(np.hypot(a, b) / (np.sqrt(share) * at.chroma), 1 / 0.9)
    response = at.white * np.power(share, 1 / at.exponent)
    grey = (response / at.background + 0.305) * 460 / 1403
    hue = np.arctan2(b, a)
    cosine, sine = np.cos(hue), np.sin(hue)
    per_t = _CHROMA * at.induction * _eccentricity(hue) / t
    distance = 3.05 * grey / (per_t + (671 * cosine + 6588 * sine) / 1403)
    distance = np.where(t < _LEAST, 0.0, distance)
    red, yellow = distance * cosine, distance * sine
    responses = (
        grey + (451 * red + 288 * yellow) / 1403,
        grey + (-891 * red - 261 * yellow) / 1403,
        grey + (-220 * red - 6300 * yellow) / 1403,
    )
    cones = []
    for gain, v in zip(at.gains, responses, strict=True):
        found = np.where(lightness < _LEAST, 0.1, np.where(v < 0, 0.0, v))
        cones.append(_expanded(found, at.luminance) / gain if gain else np.zeros_like(found))
    return _times(_FROM_CONES, cones)


def _times(matrix: Sequence[Sequence[float]], v: Three) -> list[Wide]:
    """Row by row, so that a value does not depend on how many there are."""
    return [row[0] * v[0] + row[1] * v[1] + row[2] * v[2] for row in matrix]


def _eccentricity(hue: Wide) -> Wide:
    return (np.cos(hue + 2) + 3.8) / 4


def _achromatic(r: Wide, g: Wide, b: Wide) -> Wide:
    return 2 * r + g + b / 20 - 0.305


def _saturating(x: Wide | float, exponent: float) -> Wide:
    power = np.power(x, exponent)
    return np.asarray(400 * power / (27.13 + power))


def _scale(luminance: float) -> tuple[Wide, Wide]:
    """The compression at F_L, by its own exponent and by that of CIE 159."""
    return _saturating(luminance, _EXPONENT), _saturating(luminance, _CIE_EXPONENT)


def _lifted(x: Wide | float, luminance: float) -> Wide:
    """Both curves meet at F_L; this one is that of CIE 159 to within some per cent."""
    own, cie = _scale(luminance)
    return np.asarray(((1 + _LIFT) * _saturating(x, _EXPONENT) / own - _LIFT) * cie)


def _compressed(response: Wide, luminance: float) -> Wide:
    x, knee = luminance * response / 100, _KNEE * luminance
    line = _lifted(knee, luminance) / knee * x
    size = np.abs(x)
    above = np.copysign(_lifted(size, luminance), x)
    return np.where(size <= knee, line, above) + 0.1


def _expanded(compressed: Wide, luminance: float) -> Wide:
    """The inverse of _compressed; what no response compresses to comes from 0."""
    y, knee = compressed - 0.1, _KNEE * luminance
    foot = _lifted(knee, luminance)
    own, cie = _scale(luminance)
    power = (np.abs(y) / cie + _LIFT) / (1 + _LIFT) * own
    base = np.where(power < 400, 27.13 * power / (400 - power), 0.0)
    above = np.copysign(np.power(base, 1 / _EXPONENT), y)
    x = np.where(np.abs(y) <= foot, y * (knee / foot), above)
    return 100 * x / luminance
