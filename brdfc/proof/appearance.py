"""The colours of a formula in CIELAB, and their change, as functions over boxes.

From y, u = x - y and v = y - z, relative to the white (opponent.py), with f of CIELAB:

    L* = 116 f(y) - 16,   a* = 500 (f(y + u) - f(y)),   b* = 200 (f(y) - f(y - v))

The change of a* where y and u change by dy and du is that of f(y + u) by du, and beyond it a double
difference of f, which is about u dy times the second derivative: nothing for greys.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from brdfc.colour.colorimetry import BRIGHTEST
from brdfc.proof import varying as of
from brdfc.proof.intervals import Array, Enclosure, enclosure, hull, meet, mul, sub
from brdfc.proof.varying import Varying

_LINEAR = 216 / 24389
"""Below it, f is a straight line."""


class Seen(NamedTuple):
    """A colour in CIELAB and its change, (boxes, 1) each."""

    lightness: Varying
    a: Varying
    b: Varying
    d_lightness: Varying
    d_a: Varying
    d_b: Varying


def seen(signals: Sequence[Varying], changes: Sequence[Varying]) -> Seen:
    """CIELAB of the signals of opponent.py, and how it changes with them."""
    with np.errstate(all="ignore"):
        (y, x, z, u, v), (dy, _, _, du, dv) = _dimmed(signals, changes)
        return Seen(
            _116 * _f(y) - of.number(16.0),
            _500 * _rise(y, u).met(_f(x) - _f(y)),
            -(_200 * _rise(y, -v).met(_f(z) - _f(y))),
            _116 * _rise(y, dy),
            _500 * (_rise(x + dy, du) + _double(y, x, u, dy)),
            -(_200 * (_rise(z + dy, -dv) + _double(y, z, -v, dy))),
        )


_116, _500, _200 = of.number(116.0), of.number(500.0), of.number(200.0)


def _dimmed(
    signals: Sequence[Varying], changes: Sequence[Varying]
) -> tuple[Sequence[Varying], Sequence[Varying]]:
    """What is more than BRIGHTEST times white is compared at that (Colorimetry.difference)."""
    tristimulus = signals[:3]
    if not any((p.value.size > BRIGHTEST).any() for p in tristimulus):
        return signals, changes
    y, x, z = map(of.absolute, tristimulus)
    most = of.larger(of.larger(x, y), z)
    limit = of.number(BRIGHTEST)
    factor = limit / of.larger(most, limit)
    within = Enclosure(np.full(most.low.shape, -BRIGHTEST), np.full(most.low.shape, BRIGHTEST))
    dimmed = [(p * factor).within(within) for p in tristimulus]
    return [*dimmed, *(p * factor for p in signals[3:])], [p * factor for p in changes]


def _f(t: Varying) -> Varying:
    return t.through(enclosure(_f_at(t.low), _f_at(t.high)), _slope(t.value))


def _f_at(t: Array) -> Array:
    return np.where(t > _LINEAR, np.cbrt(t), (t * 24389 / 27 + 16) / 116)


def _slope(t: Enclosure) -> Enclosure:
    """The derivative of f; falling."""
    return enclosure(_slope_at(t.high), _slope_at(t.low))


def _slope_at(t: Array) -> Array:
    root = np.cbrt(np.maximum(t, _LINEAR))
    return np.asarray(1 / (3 * root * root))


def _curvature(t: Enclosure) -> Enclosure:
    """The second derivative: 0 on the straight part, beyond it rising to 0 from below."""
    low, high = (-2 / 9 * np.maximum(end, _LINEAR) ** (-5 / 3) for end in t)
    return enclosure(np.where(t.high <= _LINEAR, 0.0, low), np.where(t.low <= _LINEAR, 0.0, high))


def _torsion(t: Enclosure) -> Enclosure:
    """The third derivative beyond the straight part, falling; where t reaches that, unknown."""
    high, low = (10 / 27 * np.maximum(end, _LINEAR) ** (-8 / 3) for end in t)
    beyond = t.low > _LINEAR
    return enclosure(np.where(beyond, low, -np.inf), np.where(beyond, high, np.inf))


def _rise(t: Varying, d: Varying) -> Varying:
    """f(t + d) - f(t): rising in d, and falling in t where d > 0, as f is concave."""
    if d is of.NONE:
        return d
    value = Enclosure(
        _risen(np.where(d.low >= 0, t.high, t.low), d.low),
        _risen(np.where(d.high >= 0, t.low, t.high), d.high),
    )
    moved = (t + d).value
    steeper = meet(
        mul(d.value, _curvature(hull(t.value, moved))), sub(_slope(moved), _slope(t.value))
    )
    slopes = of.summed(of.scaled(t.slopes, steeper), of.scaled(d.slopes, _slope(moved)))
    return Varying(value, slopes)


def _risen(t: Array, d: Array) -> Array:
    """f(t + d) - f(t) without cancellation; what it rounds is far below difference.ROUNDING."""
    moved = t + d
    p, q = np.cbrt(moved), np.cbrt(t)
    beyond = (t > _LINEAR) & (moved > _LINEAR)
    return np.where(beyond, d / (p * p + p * q + q * q), _f_at(moved) - _f_at(t))


def _double(y: Varying, x: Varying, u: Varying, d: Varying) -> Varying:
    """(f(x + d) - f(x)) - (f(y + d) - f(y)) with x = y + u: the difference of two rises, which is d
    times u times the second derivative somewhere between."""
    if d is of.NONE or u is of.NONE:
        return of.NONE
    x2, y2 = (x + d).value, (y + d).value
    curvature = _curvature(hull(x.value, y.value, x2, y2))
    # As f is concave, it only rises or only falls in each of x, y and d: its ends are at corners.
    corners = [_risen(p, r) - _risen(q, r) for p, q, r in product(x.value, y.value, d.value)]
    ends = enclosure(np.minimum.reduce(corners), np.maximum.reduce(corners))
    value = meet(ends, mul(mul(d.value, u.value), curvature))
    by_x, by_y = (
        meet(
            sub(_slope(moved), _slope(t.value)),
            mul(d.value, _curvature(hull(t.value, moved))),
        )
        for t, moved in ((x, x2), (y, y2))
    )
    by_d = meet(sub(_slope(x2), _slope(y2)), mul(u.value, curvature))
    # Along y, with u held, it changes by d u times the third derivative, or by both of the others.
    torsion = _torsion(hull(x.value, y.value, x2, y2))
    together = meet(mul(mul(d.value, u.value), torsion), sub(by_x, by_y))
    slopes = of.summed(of.scaled(y.slopes, together), of.scaled(u.slopes, by_x))
    return Varying(value, of.summed(slopes, of.scaled(d.slopes, by_d)))
