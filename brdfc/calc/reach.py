"""What elements that are no calculators can give, whatever they are given."""

from __future__ import annotations

from brdfc.calc.bounds import UNKNOWN, either
from brdfc.calc.curves import Curve, CurveSet, SampledCurve
from brdfc.calc.program import Element
from brdfc.calc.samples import Samples
from brdfc.calc.tables import LookupTable
from brdfc.symbolic.bounds import TRUTH
from brdfc.symbolic.intervals import Interval


def reach(element: Element) -> list[Interval]:
    """An interval for each of its outputs."""
    if isinstance(element, LookupTable):
        return [_of_samples(element.samples)] * element.outputs
    if isinstance(element, CurveSet):
        return [_of_curve(curve) for curve in element.curves]
    return [UNKNOWN] * element.outputs


def _of_curve(curve: Curve) -> Interval:
    """What is not finite may become 0 or 1, whatever the curve."""
    if isinstance(curve, SampledCurve) and not curve.extend:
        return either(_of_samples(curve.samples), TRUTH)
    return UNKNOWN


_WEIGHTS = 1e-4
"""Relative: what the weights of 2^16 corners may add up to beyond 1, each rounded."""


def _of_samples(samples: Samples) -> Interval:
    """Between samples lies what lies between their values, but for rounding."""
    low, high = float(samples.values.min()), float(samples.values.max())
    slack = _WEIGHTS * max(abs(low), abs(high))
    return Interval(
        low * (1 - _WEIGHTS) if low >= 0 else low - slack,
        high * (1 - _WEIGHTS) if high <= 0 else high + slack,
    )
