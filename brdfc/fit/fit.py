"""A model fitted to measurements: searched, judged, and how sure that is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from brdfc.fit import checks
from brdfc.fit.fitting import STARTS, Found, Method, Scaling, search
from brdfc.fit.measurements import Kind, Measurements
from brdfc.fit.objectives import COLOUR, ColourDifferences, Differences, scale_named
from brdfc.fit.response import Response
from brdfc.fit.result import Estimate, Fit
from brdfc.fit.uncertainty import NORMAL, Losses, spread_of
from brdfc.lang.model import Model
from brdfc.source.errors import ValueGivenError
from brdfc.symbolic.formula import NO_WHITE

Array = NDArray[np.float64]

Factors = tuple[float, float, float]

KINK = 0.4
"""Share of the usual difference that the kink of a difference at 0 is rounded by, for its
curvature: less, and correlated noise is not seen; more, and all intervals are too wide."""
POOR = 10.0
"""A mean CIEDE2000 beyond which something else than the coefficients is wrong."""


def fit(
    model: Model,
    measured: Measurements,
    *,
    objective: str = COLOUR,
    factors: Factors = (1.0, 1.0, 1.0),
    fixed: Mapping[str, Sequence[float]] = {},
    ranges: Mapping[str, tuple[float, float]] = {},
    starts: int = STARTS,
    seed: int = 1,
    method: Method = Method.LEAST_SQUARES,
    bootstrap: int = 0,
) -> Fit:
    """The coefficients of a model in the full geometry that come nearest to measurements.

    fixed: quantities that are not fitted. ranges: of quantities, in place of what the model
    declares. factors: kL, kC, kH of CIEDE2000. bootstrap: how many times to fit anew to
    measurements drawn with replacement; the intervals are then of those.
    Raises FitError where there is too little to go by; see fitting.search for others.
    """
    response = response_to(in_ranges(model, ranges), measured, fixed)
    checks.refuse(measured, response)
    found = search(response, measured, objective, factors, starts, seed, method)
    scaling = Scaling(response)
    place = scaling.places(found.coefficients)
    losses = losses_of(response, measured, objective, factors)
    usual = KINK * float(np.median(losses(place)))
    spread = spread_of(
        losses,
        place,
        rounded=lambda x: np.hypot(losses(x), usual) if objective == COLOUR else losses(x),
        slopes=exact_slopes(response, measured, found.coefficients, scaling),
    )
    # Two objectives that should agree: by how much they do not is a bias of one of them, and adds
    # to the chance of the measurements as one independent error to another.
    apart = place - scaling.places(found.before)
    low = scaling.values(place - np.hypot(place - spread.low, apart))
    high = scaling.values(place + np.hypot(spread.high - place, apart))
    differences, by_incidence = _differences(response, measured, found)
    remarks = [*measured.remarks, *checks.before(measured), *checks.after(response, spread)]
    if differences is not None and differences[0] > POOR:
        remarks.append(
            f"a mean CIEDE2000 of {differences[0]:.3g} is no fit: check the unit, the angles and "
            "their signs (--unit, --angles, --mirror), or take another model"
        )
    if not found.converged:
        remarks.insert(0, "the search did not converge: do not use these coefficients")
    elif found.starts > 1 and found.agreed == 1:
        remarks.append(f"only one of {found.starts} starts came to this: try --starts with more")
    if bootstrap:
        low, high = _drawn(response, measured, objective, factors, found, bootstrap, seed)
    return Fit(
        model.name,
        measured.name,
        objective,
        method.value,
        found.loss,
        found.converged,
        found.starts,
        found.agreed,
        len(measured.directions),
        measured.white or NO_WHITE,
        measured.kind.value,
        tuple(
            Estimate(c.name, float(v), float(a), float(b))
            for c, v, a, b in zip(response.coefficients, found.coefficients, low, high, strict=True)
        ),
        differences,
        by_incidence,
        tuple(remarks),
        {name: tuple(values) for name, values in fixed.items()},
        tuple(tuple(map(float, row)) for row in spread.correlation),
        bootstrap,
    )


def response_to(
    model: Model,
    measured: Measurements,
    fixed: Mapping[str, Sequence[float]] = {},
) -> Response:
    """A model's reflectance where it was measured, under the white of the measurements; a model
    whose highlight adds the same to all components has none."""
    white = NO_WHITE if model.highlight == "equal" else measured.white or NO_WHITE
    return Response(model, measured.directions, fixed, white)


def in_ranges(model: Model, ranges: Mapping[str, tuple[float, float]]) -> Model:
    """A model whose quantities are declared for other ranges."""
    unknown = set(ranges) - {q.name for q in model.quantities}
    if unknown:
        raise ValueGivenError(f"'{model.name}' has no '{min(unknown)}'")

    quantities = []
    for q in model.quantities:
        if q.name in ranges:
            low, high = ranges[q.name]
            inside = tuple(min(max(v, low), high) for v in q.default)
            q = replace(q, low=low, high=high, default=inside)
        quantities.append(q)
    return replace(model, quantities=tuple(quantities))


def exact_slopes(
    response: Response, measured: Measurements, values: Array, scaling: Scaling
) -> Array:
    """(values, p): how what is seen changes with each place, by the formula's derivatives."""
    differences = Differences(measured, scale_named("cube-root"))
    found, slopes = response.slopes(values)
    return differences.by_slopes(found, slopes * scaling.slopes(values))


def losses_of(
    response: Response, measured: Measurements, objective: str, factors: Factors
) -> Losses:
    """What each measurement adds to the objective, at places in 0..1."""
    scaling = Scaling(response)
    if objective == COLOUR:
        colours = ColourDifferences(measured, factors)
        return lambda x: colours.each(response.values(scaling.values(x))) * colours.weights
    differences = Differences(measured, scale_named(objective))

    def losses(x: Array) -> Array:
        residuals = differences.residuals(response.values(scaling.values(x)))
        return np.asarray((residuals.reshape(response.count, -1) ** 2).sum(axis=1) / 2)

    return losses


def _differences(
    response: Response, measured: Measurements, found: Found
) -> tuple[tuple[float, float, float] | None, tuple[tuple[float, float, int], ...]]:
    """CIEDE2000, and by incidence."""
    if measured.kind is not Kind.XYZ:
        return None, ()
    colours = ColourDifferences(measured)
    each = colours.each(response.values(found.coefficients))
    incidence = np.degrees(measured.directions[colours.valid, 0]).round(2)
    rows = []
    for degrees in np.unique(incidence):
        here = each[incidence == degrees]
        rows.append((float(degrees), float(here.mean()), len(here)))
    whole = (float(each.mean()), float(np.quantile(each, 0.95)), float(each.max()))
    return whole, tuple(rows)


def _drawn(
    response: Response,
    measured: Measurements,
    objective: str,
    factors: Factors,
    found: Found,
    times: int,
    seed: int,
) -> tuple[Array, Array]:
    """Intervals of fits to measurements drawn with replacement, each counted as often as it is
    drawn; about the estimate, of the deviation that the fits show."""
    random = np.random.default_rng(seed)
    count = len(measured.directions)
    scaling = Scaling(response)
    places = []
    for _ in range(times):
        often = np.bincount(random.integers(0, count, count), minlength=count)
        drawn = replace(measured, weights=measured.weights * often)
        again = search(response, drawn, objective, factors, begun=found.coefficients)
        places.append(scaling.places(again.coefficients))
    deviation = np.std(places, axis=0, ddof=1)
    centre = scaling.places(found.coefficients)
    return (
        scaling.values(centre - NORMAL * deviation),
        scaling.values(centre + NORMAL * deviation),
    )
