"""How far a law that can be seen at single points is broken at a point: quickly, and precisely."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from brdfc.laws.claims import RAISED, Claim, Point
from brdfc.laws.reflectance import Array, Reflectance, Values, reversed_path, reversed_point

NOTHING = 1e-30
"""Values below this (1/sr) are no reflectance; what they differ by does not count."""
ROUNDING = 1e-12
"""A relative difference that both sides' angles, rounded to float64, may make."""
BOTH_WAYS = 1e-9
"""A relative difference of both ways that rounding in the model's own constants may make."""


@dataclass(frozen=True)
class Measure:
    """How far a law is broken at a point.

    quick: in float64 on arrays, larger where worse. figure: the law's own figure, in high
    precision; NaN where the formula has no value that the law could be about. breaks: whether a
    figure breaks the law. falling: whether smaller figures are worse.
    """

    quick: Callable[[Values], Array]
    figure: Callable[[Point], float]
    breaks: Callable[[float], bool]
    falling: bool = False


def measure(reflectance: Reflectance, claim: Claim, quantity: str = "") -> Measure:
    """The measure of a law other than energy; quantity: the one that increasing is about."""
    match claim.name:
        case "reciprocal":
            return _reciprocal(reflectance)
        case "positive":
            return _positive(reflectance)
        case "bounded":
            return _bounded(reflectance, claim.bound)
        case "increasing":
            return _increasing(reflectance, quantity)
    raise ValueError(f"'{claim.name}' is not seen at single points")


def _reciprocal(reflectance: Reflectance) -> Measure:
    def quick(values: Values) -> Array:
        return _relative(reflectance(values), reflectance(reversed_path(values)))

    def figure(point: Point) -> float:
        there, back = reflectance.precise(point), reflectance.precise(reversed_point(point))
        return float(_relative(np.array(there), np.array(back), undefined=math.nan))

    return Measure(quick, figure, lambda found: not found <= BOTH_WAYS)


def _positive(reflectance: Reflectance) -> Measure:
    def quick(values: Values) -> Array:
        least = reflectance.radiance(values).min(axis=-1)
        return np.where(np.isfinite(least), -least, np.inf)  # no value is worst: looked at closely

    def figure(point: Point) -> float:
        least = min(reflectance.precise_radiance(point), key=_defined_last)
        return -math.inf if math.isnan(least) else least

    return Measure(quick, figure, lambda found: not found >= -NOTHING, falling=True)


def _bounded(reflectance: Reflectance, bound: float | None) -> Measure:
    assert bound is not None
    limit = bound + ROUNDING * abs(bound)

    def figure(point: Point) -> float:
        return float(np.max(reflectance.precise(point)))

    return Measure(
        lambda values: reflectance(values).max(axis=-1), figure, lambda f: not f <= limit
    )


def _increasing(reflectance: Reflectance, quantity: str) -> Measure:
    raised = quantity + RAISED

    def quick(values: Values) -> Array:
        before = reflectance.radiance(values)
        after = reflectance.radiance({**values, quantity: values[raised]})
        return _fall(before, after)

    def figure(point: Point) -> float:
        before = np.array(reflectance.precise_radiance(point))
        after = reflectance.precise_radiance({**point, quantity: point[raised]})
        return float(_fall(before, np.array(after)))

    return Measure(quick, figure, lambda found: not found <= ROUNDING)


def _defined_last(value: float) -> float:
    return -math.inf if math.isnan(value) else value


def _relative(a: Array, b: Array, undefined: float = 0.0) -> Array:
    """The largest relative difference of a component (...,), 0 where both are nothing."""
    with np.errstate(all="ignore"):
        larger = np.maximum(np.abs(a), np.abs(b))
        difference = np.where(larger > NOTHING, np.abs(a - b) / larger, 0.0)
    known = np.isfinite(a) & np.isfinite(b)
    return np.asarray(np.where(known, difference, undefined).max(axis=-1))


def _fall(before: Array, after: Array) -> Array:
    """The largest fall of a component, in parts of what it was; 0 where none falls."""
    with np.errstate(all="ignore"):
        fall = np.where(np.abs(before) > NOTHING, (before - after) / np.abs(before), 0.0)
    return np.asarray(np.maximum(fall, 0.0).max(axis=-1))
