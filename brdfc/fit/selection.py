"""The smallest model that measurements support: not the one that fits them best.

On thousands of dense measurements the differences are the model's, not noise, and an information
criterion nearly always takes the larger model. What counts is what a model says of an incidence
that it was not fitted to: cross-validation by incidence, with the rule of one standard error (T.
Hastie, R. Tibshirani, J. Friedman, The Elements of Statistical Learning, 2nd ed., 7.10). It is held
on the cube root's scale, which sees a highlight that a mean CIEDE2000 of mostly dull directions
does not. The criterion (G. Schwarz, Annals of Statistics 6(2), 1978) stands beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.fit.fit import fit, in_ranges, response_to
from brdfc.fit.fitting import search
from brdfc.fit.measurements import Kind, Measurements
from brdfc.fit.objectives import SCALES, ColourDifferences, Differences
from brdfc.fit.result import Fit
from brdfc.lang.model import Model
from brdfc.source.errors import FitError, ValueGivenError

Array = NDArray[np.float64]
Groups = Sequence[NDArray[np.bool_]]

MODELS = (
    *("lambert", "minnaert", "oren_nayar", "ward", "ward_gmd", "blinn_phong"),
    *("ashikhmin_shirley", "cook_torrance", "ggx", "abc_microfacet", "cook_torrance_2"),
)
"""Of the library: those that measurements of one isotropic material can be asked about."""
LEAST = 1e-4
"""On the cube root's scale: less cannot be seen, nor measured."""
FOLDS = 10
"""Groups of incidences, at most."""
SCALE = SCALES["cube-root"]


@dataclass(frozen=True)
class Candidate:
    """A model fitted. cost: nanoseconds a pixel by the price table. inside: the mean CIEDE2000 of
    the fit; outside: the same of incidences that were held out. seen: the root mean square on the
    cube root's scale, held out, the mean of the groups; error: its standard error. criterion:
    Schwarz's."""

    fit: Fit
    cost: float
    inside: float
    outside: float
    seen: float
    error: float
    criterion: float

    @property
    def name(self) -> str:
        return self.fit.model

    @property
    def parameters(self) -> int:
        return len(self.fit.estimates)


@dataclass(frozen=True)
class Selection:
    """candidates: best held out first. chosen: the smallest that the measurements support, or whose
    difference keeps to the tolerance; None where none does. left_out: models that cannot be fitted
    to so little, and why."""

    candidates: tuple[Candidate, ...]
    chosen: Candidate | None
    tolerance: float | None
    left_out: Mapping[str, str]

    @property
    def nearest(self) -> Candidate:
        """That of the least difference, held out."""
        return min(self.candidates, key=lambda c: c.outside)


def select(
    measured: Measurements,
    models: Sequence[Model],
    cost: Callable[[str], float],
    tolerance: float | None = None,
    ranges: Mapping[str, tuple[float, float]] = {},
    progress: Callable[[str], None] = lambda name: None,
) -> Selection:
    """Fit models in the full geometry, and choose among them.

    cost: nanoseconds a pixel of a model by its name. tolerance: a mean CIEDE2000, held out, that is
    good enough. ranges: of quantities, of the models that have them. Raises FitError for what is no
    X, Y, Z, or measured at fewer than three incidences.
    """
    if measured.kind is not Kind.XYZ:
        raise FitError("models are chosen by colour differences", hint="give a light to spectra")
    groups = folds(measured)
    unknown = [n for n in ranges if all(model.quantity(n) is None for model in models)]
    if unknown:
        raise ValueGivenError(f"no model here has a quantity '{unknown[0]}'")
    found, left_out = [], {}
    for model in models:
        progress(model.name)
        here = {n: r for n, r in ranges.items() if model.quantity(n) is not None}
        try:
            found.append(_candidate(measured, in_ranges(model, here), cost(model.name), groups))
        except FitError as error:
            left_out[model.name] = error.message
    if not found:
        raise FitError(f"no model can be fitted: {next(iter(left_out.values()))}")
    found.sort(key=lambda c: c.seen)
    return Selection(tuple(found), chosen(found, tolerance), tolerance, left_out)


def chosen(candidates: Sequence[Candidate], tolerance: float | None) -> Candidate | None:
    """The one with the fewest coefficients, then the cheapest, of those within one standard error
    of the best; of those that keep to a tolerance where one is given."""
    sound = [c for c in candidates if c.fit.converged]
    if not sound:
        return None
    best = min(sound, key=lambda c: c.seen)
    if tolerance is None:
        enough = [c for c in sound if c.seen <= best.seen + best.error + LEAST]
    else:
        enough = [c for c in sound if c.outside <= tolerance]
    return min(enough, key=lambda c: (c.parameters, c.cost), default=None)


def folds(measured: Measurements) -> Groups:
    """Which measurements each group of incidences holds out; FitError for fewer than three."""
    incidence = np.degrees(measured.directions[:, 0]).round(1)
    distinct = np.unique(incidence)
    if len(distinct) < 3:
        raise FitError(
            f"{len(distinct)} incidences; to hold one out, three are needed at least",
            where=measured.name,
        )
    parts = np.array_split(distinct, min(FOLDS, len(distinct)))
    return [np.isin(incidence, part) for part in parts]


def _candidate(measured: Measurements, model: Model, cost: float, groups: Groups) -> Candidate:
    whole = fit(model, measured)
    response = response_to(model, measured)
    near = search(response, measured, "cube-root").coefficients
    seen, each = [], []
    for group in groups:
        rest, held = measured.selected(~group), measured.selected(group)
        elsewhere, there = response_to(model, rest), response_to(model, held)
        found = search(elsewhere, rest, "cube-root", begun=near)
        seen.append(_root_mean_square(Differences(held, SCALE), there.values(found.coefficients)))
        polished = search(elsewhere, rest, begun=found.coefficients).coefficients
        each.append(ColourDifferences(held).each(there.values(polished)))
    whole_scale = Differences(measured, SCALE)
    count = max(1, int(whole_scale.valid.sum()))
    square = max(_root_mean_square(whole_scale, response.values(near)) ** 2, 1e-300)
    assert whole.difference is not None
    return Candidate(
        whole,
        cost,
        whole.difference[0],
        float(np.concatenate(each).mean()),
        float(np.mean(seen)),
        float(np.std(seen, ddof=1) / np.sqrt(len(seen))),
        float(count * np.log(square) + len(near) * np.log(count)),
    )


def _root_mean_square(differences: Differences, values: Array) -> float:
    """Of what counts."""
    residuals = differences.residuals(values)
    return float(np.sqrt(residuals @ residuals / max(1, int(differences.valid.sum()))))
