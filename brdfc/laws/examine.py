"""A law held against a model: the worst point of its whole domain that a search finds."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from brdfc.laws.albedo import TOLERANCE, albedos
from brdfc.laws.claims import Claim, LawResult, Point
from brdfc.laws.directed import Directed, View
from brdfc.laws.measures import Measure, measure
from brdfc.laws.reflectance import (
    ANGLES,
    INCIDENT,
    REFLECTION,
    Array,
    Reflectance,
    Values,
)
from brdfc.laws.search import Effort, search
from brdfc.laws.space import Space

GRAZING_ALBEDO = math.radians(0.01)
"""How near to the right angle the incidence of an albedo comes, in radians."""

_POINTS = Effort(seeds=40_000, swept=10_000, starts=24, tries=24, rounds=24, kept=16)
_ALBEDOS = Effort(seeds=250, swept=400, starts=8, tries=8, rounds=5, kept=16)
_FINER = Effort(seeds=0, swept=0, starts=3, tries=10, rounds=10, kept=3)
_ROUGHLY, _NEARLY = 2e-2, 1e-3
"""Tolerances of albedos while searching; the worst are computed again to TOLERANCE."""


def examine(reflectance: Reflectance, claim: Claim) -> LawResult:
    """The worst that a search finds of a law; the same every time.

    Raises ValueError for a law it does not know.
    """
    if claim.name == "energy":
        return _energy(reflectance, claim)
    quantities = claim.quantities if claim.name == "increasing" else ("",)
    found = [_at_points(reflectance, claim, quantity) for quantity in quantities]
    worst = max(found, key=lambda result: (not result.holds, result.worst))
    return replace(worst, points=sum(result.points for result in found))


def _at_points(reflectance: Reflectance, claim: Claim, quantity: str) -> LawResult:
    seen = measure(reflectance, claim, quantity)
    both_ways = claim.name == "reciprocal"

    def badness(values: Values) -> Array:
        bad = seen.quick(values)
        return np.where(_reversible(reflectance, values), bad, -np.inf) if both_ways else bad

    figures: list[tuple[float, Point]] = []
    tried = 0
    for view in View:
        space = Directed(reflectance, view, claim.condition, quantity)
        worst, count = search(badness, space, _POINTS)
        tried += count
        figures += _figures(seen, space.values(worst))
    if not figures:
        return LawResult(claim, True, False, math.nan, {}, tried, ())
    worst_figure, at = (min if seen.falling else max)(figures, key=lambda found: found[0])
    keep = {*reflectance.directions, *((INCIDENT, REFLECTION) if both_ways else ())}
    shown = {name: value for name, value in at.items() if name not in ANGLES or name in keep}
    holds = not seen.breaks(worst_figure)
    return LawResult(claim, holds, True, worst_figure, shown, tried, reflectance.angular)


def _figures(seen: Measure, values: Values) -> Iterable[tuple[float, Point]]:
    """The figures of points where they have one, with the points."""
    for i in range(len(values[INCIDENT])):
        at = _point(values, i)
        figure = seen.figure(at)
        if not math.isnan(figure):
            yield figure, at


def _reversible(reflectance: Reflectance, values: Values) -> NDArray[np.bool_]:
    """Where the zeniths may be exchanged within their declared ranges (points,)."""
    low = max(reflectance.limits[name][0] for name in (INCIDENT, REFLECTION))
    high = min(reflectance.limits[name][1] for name in (INCIDENT, REFLECTION))
    zeniths = np.concatenate([values[INCIDENT], values[REFLECTION]], axis=-1)
    return np.asarray(((zeniths >= low) & (zeniths <= high)).all(axis=-1))


def _energy(reflectance: Reflectance, claim: Claim) -> LawResult:
    assert claim.bound is not None
    space = Space(reflectance, GRAZING_ALBEDO, condition=claim.condition)
    valued = True

    def roughly(values: Values) -> Array:
        nonlocal valued
        found = albedos(reflectance, values, _ROUGHLY).value
        valued &= bool(np.isfinite(found).all())
        return found

    def nearly(values: Values) -> Array:
        return albedos(reflectance, values, _NEARLY).value

    worst, tried = search(roughly, space, _ALBEDOS)
    finer, more = search(nearly, space, _FINER, starts=worst)
    candidates = np.concatenate([finer, worst[: _FINER.starts]])
    values = space.values(candidates)
    found = albedos(reflectance, values)
    if not len(candidates) or np.isnan(found.value).all():
        return LawResult(claim, True, False, math.nan, {}, tried + more, ())
    i = int(np.nanargmax(found.value))
    figure, allowed = float(found.value[i]), claim.bound + TOLERANCE
    certain = bool(found.converged[i]) or abs(figure - allowed) > found.error[i]
    absent = set(ANGLES) - set(reflectance.directions)
    at = {name: v for name, v in _point(values, i).items() if name not in absent}
    holds = figure <= allowed
    settled = certain and (valued or not holds)
    return LawResult(claim, holds, settled, figure, at, tried + more, reflectance.angular)


def _point(values: Mapping[str, Array], index: int) -> dict[str, tuple[float, ...]]:
    """One point of many."""
    return {name: tuple(float(c) for c in v[index]) for name, v in values.items()}
