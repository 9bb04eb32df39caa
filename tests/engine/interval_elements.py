"""What curve sets and lookup tables make of intervals.

Of one value they give what the engine computes; a formula of a curve is a composition of functions,
computed in float64 and rounded once, and CURVE_ULPS off at most. Of several values: a formula takes
its extremes at the ends and where it turns, or every float is tried; and samples joined by lines
are as steep as the steepest of them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import reduce

import numpy as np
from disputed import mark
from intervals import (
    INF,
    Floats,
    Interval,
    around,
    at,
    chosen,
    enclosing,
    everything,
    exact,
    has,
    hull,
    joined,
    place,
    propagating,
    widened,
)

from brdfc.calc.curves import (
    Curve,
    CurveSet,
    FormulaSegment,
    SampledCurve,
    SampledSegment,
    SegmentedCurve,
)
from brdfc.calc.tables import LookupTable
from brdfc.engine.interpreter import run

CURVE_ULPS = 1
HALF_UNIT = 2.0**-24
_QUOTIENTS, SHORT = (6, 7), 16
"""Formulas whose float32 steps do not grow together; so many floats are tried one by one."""


def bound_element(element: CurveSet | LookupTable, inputs: Sequence[Interval]) -> list[Interval]:
    """The outputs of an element, for what its inputs may be."""
    if isinstance(element, CurveSet):
        return [_curve(c, x) for c, x in zip(element.curves, inputs, strict=True)]
    return _table(element, inputs)


def values_of(element: CurveSet | LookupTable, inputs: Sequence[Floats]) -> list[Floats]:
    """What our engine gives for one value of each input."""
    results = run(element, np.stack(np.broadcast_arrays(*inputs), axis=-1), {})
    return list(np.moveaxis(results, -1, 0))


# ---------------------------------------------------------------- curves


def _curve(curve: Curve, x: Interval) -> Interval:
    rule = _sampled if isinstance(curve, SampledCurve) else _segmented
    found = propagating(lambda v: rule(curve, v))(x)
    odd = x.nan | ~(np.isfinite(x.low) & np.isfinite(x.high))
    return replace(found, disputed=found.disputed | x.disputed | mark("curv", odd))


def _value(curve: Curve, x: Floats) -> Floats:
    return values_of(CurveSet((curve,)), [x])[0]


def _lines(curve: Curve, x: Interval, points: Floats, first: float, last: float) -> Interval:
    """Samples at equal steps, joined by lines that go on where a curve is extended."""
    wide = points.astype(np.float64)
    slope = np.abs(np.diff(wide)).max() * (len(points) - 1) / (last - first)
    farthest = np.maximum(np.abs(x.low), np.abs(x.high)).astype(np.float64)
    size = np.abs(wide).max() + slope * (abs(first) + abs(last) + farthest)
    reach = slope * (x.high.astype(np.float64) - x.low) + 16 * HALF_UNIT * size
    value = _value(curve, x.low)
    found = around(value, np.where(x.single, 0.0, reach))
    return chosen(x.single | np.isfinite(value), found, everything(x))


def _sampled(curve: SampledCurve, x: Interval) -> Interval:
    return _lines(curve, x, curve.samples.values, curve.first, curve.last)


def _segmented(curve: SegmentedCurve, x: Interval) -> Interval:
    """The hull over all segments that a value may be in."""
    found = []
    starts = [-INF, *(np.nextafter(np.float32(b), INF) for b in curve.breaks)]
    ends = [*(np.float32(b) for b in curve.breaks), INF]
    for k, (start, end) in enumerate(zip(starts, ends, strict=True)):
        part = replace(x, low=np.clip(x.low, start, end), high=np.clip(x.high, start, end))
        segment = curve.segments[k]
        formula = isinstance(segment, FormulaSegment)
        values = _formula(segment, part) if formula else _after(curve, k, part)
        found.append((values, (x.low <= end) & (x.high >= start)))
    return joined(*found)


def _formula(segment: FormulaSegment, x: Interval) -> Interval:
    alone = SegmentedCurve((), (segment,))
    if segment.type in _QUOTIENTS:
        steps = np.arange(SHORT).reshape(-1, *(1,) * x.low.ndim)
        places = list(at(np.minimum(place(x.low) + steps, place(x.high))))
        lost = place(x.high) - place(x.low) >= SHORT
    else:
        turns = [np.nextafter(np.float32(t), to) for t in _turns(segment) for to in (-INF, t, INF)]
        places = [x.low, x.high, *(np.clip(t, x.low, x.high) for t in turns)]
        lost = np.zeros_like(x.nan)
    found = widened(enclosing(*(_value(alone, v) for v in places)), CURVE_ULPS)
    found = chosen(lost, everything(x, nan=True), found)
    pole = reduce(np.logical_or, [has(x, p) for p in _poles(segment)], lost & False)
    return replace(found, disputed=mark("curv", pole))


def _after(curve: SegmentedCurve, k: int, x: Interval) -> Interval:
    """A sampled segment: it starts where the one before it ends, which may be a formula's value."""
    segment, before = curve.segments[k], curve.segments[k - 1]
    assert isinstance(segment, SampledSegment)
    start, end = curve.breaks[k - 1], curve.breaks[k]
    if isinstance(before, FormulaSegment):
        at_start = _formula(before, exact(np.array([start])))
        firsts = [float(at_start.low[0]), float(at_start.high[0])]
    else:
        firsts = [float(before.samples.values[-1])]
    found = []
    for first in firsts:
        constant = FormulaSegment(0, (1.0, 0.0, first, 0.0))
        points = np.concatenate([[np.float32(first)], segment.samples.values])
        part = SegmentedCurve((start, end), (constant, segment, constant))
        found.append(_lines(part, x, points, start, end))
    return hull(found)


def _turns(segment: FormulaSegment) -> list[float]:
    """Where a formula may turn, or begin or end to be constant."""
    p = segment.parameters
    if segment.type == 0:
        return [-p[2] / p[1]] if p[1] else []
    if segment.type == 3:
        return [-p[3] / p[2]] if p[2] else []
    return [] if segment.type == 2 else [0.0]


def _poles(segment: FormulaSegment) -> list[float]:
    """Where the quotient of a formula has no value."""
    p = segment.parameters
    if segment.type == 6:
        return _bases(p[3], p[4], p[1])
    if segment.type == 7:
        return _bases(-1.0, p[4], p[1])
    return []


def _bases(constant: float, factor: float, exponent: float) -> list[float]:
    """Where factor x^exponent is a constant."""
    if factor == 0:
        return []
    value = constant / factor
    size = math.copysign(abs(value) ** (1 / exponent), value) if value else 0.0
    return [size, -size]


# ---------------------------------------------------------------- tables


def _table(table: LookupTable, inputs: Sequence[Interval]) -> list[Interval]:
    points = table.samples.values.reshape(*table.grid, table.outputs).astype(np.float64)
    single = reduce(np.logical_and, [x.single for x in inputs])
    rests = reduce(np.bitwise_or, [x.disputed for x in inputs])
    found = []
    for channel, value in enumerate(values_of(table, [x.low for x in inputs])):
        values = points[..., channel]
        # Weights, products and sums are rounded, and so are positions.
        reach = np.abs(values).max() * HALF_UNIT * (2**table.inputs + 8)
        for axis, x in enumerate(inputs):
            slope = np.abs(np.diff(values, axis=axis)).max() * (table.grid[axis] - 1)
            reach = reach + slope * (x.high.astype(np.float64) - x.low + 4 * HALF_UNIT)
        found.append(replace(around(value, np.where(single, 0.0, reach)), disputed=rests))
    return found
