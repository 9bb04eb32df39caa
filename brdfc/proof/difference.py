"""The most that a change of a colour can be worth in CIEDE2000, over boxes.

CIEDE2000 is a quadratic form of the differences of lightness, chroma and hue, with weights that
depend on the colours (colour/difference.py). It is bounded from enclosures of the colour in CIELAB
and of its change there: the differences of chroma and of hue have together the length of the change
in the a*b* plane.
"""

from __future__ import annotations

import numpy as np

from brdfc.proof import intervals as on
from brdfc.proof.appearance import Seen
from brdfc.proof.intervals import (
    Array,
    Enclosure,
    add,
    div,
    enclosure,
    exactly,
    hull,
    meet,
    mul,
    sub,
)

ROUNDING = 1e-9
"""Of all that follows the enclosures in CIELAB, in CIEDE2000."""


def most_difference(colour: Seen) -> Array:
    """(boxes,) or (1,): no colour in a box differs by more from what it changes to. Infinite where
    nothing is known."""
    lightness, a, b, dl, da, db = (part.value for part in colour)
    with np.errstate(all="ignore"):
        found = _difference(lightness, a, b, dl, da, db)[..., 0]
    return np.where(np.isnan(found), np.inf, found)


def _scaled(factor: float, values: Enclosure) -> Enclosure:
    """By a positive number that loses nothing that ROUNDING does not cover."""
    return Enclosure(factor * values.low, factor * values.high)


def _length(a: Enclosure, b: Enclosure) -> Enclosure:
    """Of the vectors in a rectangle."""
    return on.sqrt(add(on.square(a), on.square(b)))


def _difference(
    lightness: Enclosure, a: Enclosure, b: Enclosure, dl: Enclosure, da: Enclosure, db: Enclosure
) -> Array:
    a2, b2 = add(a, da), add(b, db)
    # The a axis is stretched for both colours alike, by their mean chroma.
    mean = _scaled(0.5, add(_length(a, b), _length(a2, b2)))
    g = Enclosure(_stretch(mean.high), _stretch(mean.low))
    a, a2, da = mul(a, g), mul(a2, g), mul(da, g)
    both = add(_length(a, b), _length(a2, b2))
    apart = _length(da, db)
    along = div(add(mul(add(a, a2), da), mul(add(b, b2), db)), both)
    dc = meet(Enclosure(-apart.high, apart.high), along)

    chroma = _scaled(0.5, both)
    t, rotation = _of_hue(hull(a, a2), hull(b, b2), chroma)
    s_l = _lightness_weight(add(lightness, _scaled(0.5, dl)))
    s_c = 1 + 0.045 * chroma.low
    s_h = 1 + 0.015 * chroma.low * t
    x = dc.size
    y = np.sqrt(np.maximum(apart.high**2 - on.absolute(dc).low ** 2, 0.0))
    in_plane = (x / s_c) ** 2 + (y / s_h) ** 2 + rotation * x * y / (s_c * s_h)
    # x^2 + y^2 is at most apart^2, so the form is at most its larger eigenvalue times that.
    p, q = 1 / s_c**2, 1 / s_h**2
    largest = (p + q + np.hypot(p - q, rotation / (s_c * s_h))) / 2
    in_plane = np.minimum(in_plane, largest * apart.high**2)
    return np.asarray(np.sqrt((dl.size / s_l) ** 2 + in_plane) + ROUNDING)


def _stretch(chroma: Array) -> Array:
    """1 + G; falling."""
    ratio = (25.0 / np.maximum(chroma, 1e-9)) ** 7
    return np.asarray(1.5 - 0.5 / np.sqrt(1 + ratio))


def _lightness_weight(mean: Enclosure) -> Array:
    """The least S_L."""
    away = on.absolute(sub(mean, exactly(50.0))).low
    return np.asarray(1 + 0.015 * away**2 / np.sqrt(20 + away**2))


_DEGREE = np.pi / 180
_T = ((-0.17, 1, -30), (0.24, 2, 0), (0.32, 3, 6), (-0.20, 4, -63))
"""T is 1 and the sum of factor cos(times hue + offset), degrees."""


def _of_hue(a: Enclosure, b: Enclosure, chroma: Enclosure) -> tuple[Array, Array]:
    """The least T, and the largest |R_T|, of the mean hues that a rectangle allows."""
    hue = _hues(a, b)
    t = exactly(1.0)
    for factor, times, offset in _T:
        turned = add(_scaled(times, hue), exactly(offset * _DEGREE))
        t = add(t, mul(exactly(factor), on.cos(turned)))
    # The nearest to 275 degrees that the hue comes, however its turns are counted.
    centres = [exactly((275 + turn) * _DEGREE) for turn in (-360, 0)]
    away = np.minimum.reduce([on.absolute(sub(hue, c)).low for c in centres])
    angle = 60 * _DEGREE * np.exp(-((away / _DEGREE / 25) ** 2))
    most = 2 / np.sqrt(1 + (25.0 / np.maximum(chroma.high, 1e-9)) ** 7)
    return np.maximum(t.low, 0.0), np.asarray(most * np.sin(angle))


def _hues(a: Enclosure, b: Enclosure) -> Enclosure:
    """Angles of a rectangle's points, radians: within half a turn of its middle's where it does not
    hold the origin, else any."""
    middle = np.arctan2(b.middle, a.middle)
    corners = [np.arctan2(v, u) - middle for u in a for v in b]
    turned = [c - 2 * np.pi * np.round(c / (2 * np.pi)) for c in corners]
    low, high = np.minimum.reduce(turned), np.maximum.reduce(turned)
    holds = (a.low <= 0) & (a.high >= 0) & (b.low <= 0) & (b.high >= 0)
    unknown = holds | ~np.isfinite(middle + low + high)
    return enclosure(
        np.where(unknown, -np.pi, middle + low), np.where(unknown, np.pi, middle + high)
    )
