"""Coefficients of a model that come nearest to measurements.

The recipe: from many starts, spread over the coefficients that are not linear, the linear ones are
solved for, and all are refined by bounded least squares on a scale of seen differences; the best is
polished on the mean CIEDE2000 where colours are what counts. A simplex method alone, as in the
published workflow, ends in a poor minimum from a quarter of its starts and reports success; it is
here to compare with.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.fit.measurements import Kind, Measurements
from brdfc.fit.objectives import COLOUR, ColourDifferences, Differences, scale_named
from brdfc.fit.response import Response
from brdfc.source.errors import FitError, MissingExtraError

Array = NDArray[np.float64]

STARTS = 12
AGREED = 0.01
"""A start has come to the best one where its sum of squares is larger by this share at most."""
MOST_STEPS = 200
POLISH_STEPS, MOST_POLISHES, STILL = 3000, 3, 1e-3


class Method(Enum):
    """How the coefficients are searched for."""

    LEAST_SQUARES = "least-squares"
    SIMPLEX = "nelder-mead"


@dataclass(frozen=True)
class Found:
    """coefficients: (p,); before: the same before they were polished. loss: of the objective: the
    mean CIEDE2000, or the root of the mean square. converged: whether the method says that it has
    ended where it wanted to. agreed: of so many starts, how many came to this."""

    coefficients: Array
    before: Array
    loss: float
    converged: bool
    starts: int
    agreed: int


def search(
    response: Response,
    measured: Measurements,
    objective: str = COLOUR,
    factors: tuple[float, float, float] = (1.0, 1.0, 1.0),
    starts: int = STARTS,
    seed: int = 1,
    method: Method = Method.LEAST_SQUARES,
    begun: Array | None = None,
) -> Found:
    """The coefficients of least loss; objective: see objectives.SCALES. begun: coefficients to
    start from, in place of many starts.

    Raises FitError where there is less to go by than there are coefficients, ValueGivenError for an
    objective there is not, MissingExtraError where SciPy is not installed.
    """
    _require_scipy()
    scale = scale_named(objective)
    if objective == COLOUR and measured.kind is not Kind.XYZ:
        raise FitError(
            "colour differences need X, Y, Z",
            hint="give a light to spectra; of camera RGB take --objective cube-root",
        )
    differences = Differences(measured, scale)
    colours = ColourDifferences(measured, factors) if objective == COLOUR else None
    scaling = Scaling(response)
    if method is Method.SIMPLEX:
        return _simplex_alone(response, differences, colours, scaling, starts, seed)
    places = spread(response, starts, seed)
    if begun is not None:
        places = scaling.places(begun)[None]
    return _least_squares(response, differences, colours, scaling, places)


def _require_scipy() -> None:
    try:
        import scipy.optimize  # noqa: F401
    except ImportError:
        raise MissingExtraError("fitting needs SciPy", hint="pip install 'brdfc[fit]'") from None


class Scaling:
    """Coefficients on a scale of 0 to 1 each, by their logarithms where that is declared."""

    def __init__(self, response: Response) -> None:
        self.logarithmic = np.array([c.logarithmic for c in response.coefficients])
        low = np.array([c.low for c in response.coefficients])
        high = np.array([c.high for c in response.coefficients])
        self.low = np.where(self.logarithmic, np.log(np.where(self.logarithmic, low, 1.0)), low)
        top = np.where(self.logarithmic, np.log(np.where(self.logarithmic, high, 1.0)), high)
        self.size = top - self.low

    def values(self, x: Array) -> Array:
        """Coefficients for places (..., p) in 0..1."""
        plain = self.low + np.clip(x, 0, 1) * self.size
        grown = np.exp(np.where(self.logarithmic, plain, 0.0))
        return np.asarray(np.where(self.logarithmic, grown, plain))

    def places(self, values: Array) -> Array:
        plain = np.where(self.logarithmic, np.log(np.where(self.logarithmic, values, 1.0)), values)
        return np.asarray(np.clip((plain - self.low) / self.size, 0, 1))

    def slopes(self, values: Array) -> Array:
        """(..., p): the derivative of each coefficient by its place."""
        return np.asarray(self.size * np.where(self.logarithmic, values, 1.0))


def solved_linear(response: Response, differences: Differences, values: Array) -> Array:
    """Coefficients with the linear ones solved for within their ranges, in a metric that agrees
    with the scale near what was measured."""
    from scipy.optimize import lsq_linear

    linear = np.array([c.linear for c in response.coefficients])
    if not linear.any():
        return values
    start = np.where(linear, 0.0, values)
    offset, slopes = response.slopes(start)
    weight = differences.linear_weight()
    matrix = (weight[..., None] * slopes[..., linear]).reshape(-1, int(linear.sum()))
    target = (weight * (differences.given - offset)).ravel()
    bounds = [
        [getattr(c, end) for c in response.coefficients if c.linear] for end in ("low", "high")
    ]
    # Through its triangle: as many rows as there are coefficients are enough for the solution.
    triangle = np.linalg.qr(matrix)
    solution = lsq_linear(triangle.R, triangle.Q.T @ target, bounds, method="bvls")
    found = values.copy()
    found[linear] = solution.x
    return found


def _least_squares(
    response: Response,
    differences: Differences,
    colours: ColourDifferences | None,
    scaling: Scaling,
    places: Array,
) -> Found:
    from scipy.optimize import least_squares

    def residuals(x: Array) -> Array:
        return differences.residuals(response.values(scaling.values(x)))

    def slopes(x: Array) -> Array:
        values = scaling.values(x)
        found, by = response.slopes(values)
        return differences.by_slopes(found, by * scaling.slopes(values))

    ends = []
    for place in places:
        begun = solved_linear(response, differences, scaling.values(place))
        x = np.clip(scaling.places(begun), 1e-6, 1 - 1e-6)  # off the walls, which hold a step back
        ends.append(
            least_squares(
                residuals, x, slopes, bounds=(0.0, 1.0), max_nfev=MOST_STEPS, x_scale="jac"
            )
        )
    ends.sort(key=lambda end: float(end.cost))
    best = ends[0]
    agreed = sum(end.cost <= best.cost * (1 + AGREED) + 1e-15 for end in ends)
    values = scaling.values(best.x)
    if colours is None:
        count = max(1, int(differences.valid.sum()))
        root = float(np.sqrt(2 * best.cost / count))
        return Found(values, values, root, bool(best.success), len(places), agreed)
    loss = _of_colours(response, colours, scaling)
    polished = _simplex(loss, best.x)
    for _ in range(MOST_POLISHES):  # a simplex that has collapsed stops short
        again = _simplex(loss, polished.x)
        gained = float(polished.fun - again.fun)
        polished = again if gained > 0 else polished
        if gained < STILL * float(polished.fun) + 1e-9:
            break
    return Found(
        scaling.values(polished.x),
        values,
        float(polished.fun),
        bool(best.success and polished.success),
        len(places),
        agreed,
    )


def spread(response: Response, starts: int, seed: int) -> Array:
    """Places (starts, p) that fill the ranges evenly; linear coefficients in the middle.

    One start is enough where all coefficients are linear.
    """
    from scipy.stats import qmc

    linear = np.array([c.linear for c in response.coefficients])
    places = np.full((1 if linear.all() else starts, len(linear)), 0.5)
    if not linear.all():
        sampler = qmc.LatinHypercube(int((~linear).sum()), rng=seed)
        places[:, ~linear] = sampler.random(starts)
    return places


def _of_colours(
    response: Response, colours: ColourDifferences, scaling: Scaling
) -> Callable[[Array], float]:
    return lambda x: colours.mean(response.values(scaling.values(x)))


def _simplex(loss: Callable[[Array], float], x: Array, size: float = 0.02) -> Any:
    """Nelder and Mead's method from a place, with corners so far away."""
    from scipy.optimize import minimize

    corners = np.vstack(
        [x, *(x + np.where(x < 0.5, size, -size)[k] * np.eye(len(x))[k] for k in range(len(x)))]
    )
    return minimize(
        loss,
        x,
        method="Nelder-Mead",
        bounds=[(0.0, 1.0)] * len(x),
        options={
            "initial_simplex": corners,
            "maxfev": POLISH_STEPS,
            "xatol": 1e-4,
            "fatol": 1e-5,
            "adaptive": True,
        },
    )


def _simplex_alone(
    response: Response,
    differences: Differences,
    colours: ColourDifferences | None,
    scaling: Scaling,
    starts: int,
    seed: int,
) -> Found:
    """As in the published workflow, from places spread over all coefficients."""
    if colours is not None:
        loss = _of_colours(response, colours, scaling)
    else:
        count = max(1, int(differences.valid.sum()))

        def loss(x: Array) -> float:
            residuals = differences.residuals(response.values(scaling.values(x)))
            return float(np.sqrt(residuals @ residuals / count))

    random = np.random.default_rng(seed)
    places = random.random((starts, len(response.coefficients)))
    ends = sorted((_simplex(loss, x, 0.1) for x in places), key=lambda end: float(end.fun))
    best = ends[0]
    agreed = sum(end.fun <= best.fun * (1 + AGREED) for end in ends)
    values = scaling.values(best.x)
    return Found(values, values, float(best.fun), bool(best.success), starts, agreed)
