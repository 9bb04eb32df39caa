"""CIEDE2000 in NumPy, for the compiler's own path, where importing colour-science would cost more
than the whole compilation. Tested against colour-science."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

D50 = (0.9642, 1.0, 0.8249)
"""The white of the ICC profile connection space (ICC.1:2022, 7.2.16)."""


def lab(xyz: ArrayLike, white: ArrayLike = D50) -> NDArray[np.float64]:
    """CIELAB of XYZ (..., 3), Y = 1 for white (CIE 15:2004, eq. 8.3-8.8)."""
    ratio = np.asarray(xyz, dtype=np.float64) / np.asarray(white, dtype=np.float64)
    linear = (ratio * 24389 / 27 + 16) / 116
    fx, fy, fz = np.moveaxis(np.where(ratio > 216 / 24389, np.cbrt(ratio), linear), -1, 0)
    return np.stack([116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)], axis=-1)


def ciede2000(first: ArrayLike, second: ArrayLike, white: ArrayLike = D50) -> NDArray[np.float64]:
    """Colour difference of XYZ (..., 3) and XYZ (..., 3) under a white; unit factors kL = kC = kH.

    G. Sharma, W. Wu, E. N. Dalal, The CIEDE2000 color-difference formula: implementation notes,
    Color Research and Application 30(1), 2005.
    """
    return ciede2000_of_lab(lab(first, white), lab(second, white))


def ciede2000_of_lab(
    first: ArrayLike, second: ArrayLike, factors: tuple[float, float, float] = (1.0, 1.0, 1.0)
) -> NDArray[np.float64]:
    """As ciede2000, of CIELAB (..., 3), with factors kL, kC, kH."""
    l1, a1, b1 = np.moveaxis(np.asarray(first, dtype=np.float64), -1, 0)
    l2, a2, b2 = np.moveaxis(np.asarray(second, dtype=np.float64), -1, 0)
    mean_chroma = (np.hypot(a1, b1) + np.hypot(a2, b2)) / 2
    g = 0.5 * (1 - np.sqrt(mean_chroma**7 / (mean_chroma**7 + 25.0**7)))
    a1, a2 = a1 * (1 + g), a2 * (1 + g)
    c1, c2 = np.hypot(a1, b1), np.hypot(a2, b2)
    h1, h2 = (np.degrees(np.arctan2(b, a)) % 360 for a, b in ((a1, b1), (a2, b2)))

    grey = c1 * c2 == 0
    turn = h2 - h1
    turn = np.where(turn > 180, turn - 360, np.where(turn < -180, turn + 360, turn))
    turn = np.where(grey, 0.0, turn)
    d_hue = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(turn) / 2)
    lightness, chroma = (l1 + l2) / 2, (c1 + c2) / 2
    apart = np.abs(h1 - h2) > 180
    hue = np.where(grey, h1 + h2, np.where(apart, (h1 + h2 + 360) / 2 % 360, (h1 + h2) / 2))

    t = (
        1
        - 0.17 * np.cos(np.radians(hue - 30))
        + 0.24 * np.cos(np.radians(2 * hue))
        + 0.32 * np.cos(np.radians(3 * hue + 6))
        - 0.20 * np.cos(np.radians(4 * hue - 63))
    )
    s_l = 1 + 0.015 * (lightness - 50) ** 2 / np.sqrt(20 + (lightness - 50) ** 2)
    s_c = 1 + 0.045 * chroma
    s_h = 1 + 0.015 * chroma * t
    rotation = -2 * np.sqrt(chroma**7 / (chroma**7 + 25.0**7))
    rotation *= np.sin(np.radians(60 * np.exp(-(((hue - 275) / 25) ** 2))))
    k_l, k_c, k_h = factors
    lightness_term = (l2 - l1) / (k_l * s_l)
    chroma_term, hue_term = (c2 - c1) / (k_c * s_c), d_hue / (k_h * s_h)
    squared = lightness_term**2 + chroma_term**2 + hue_term**2 + rotation * chroma_term * hue_term
    return np.asarray(np.sqrt(np.maximum(squared, 0.0)))
