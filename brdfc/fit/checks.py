"""What in measurements makes a fit say less than it seems to; told before and after it.

Each check is a row of a table: what it looks at, and the words for what it finds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from brdfc.fit.measurements import Kind, Measurements
from brdfc.fit.response import Response
from brdfc.fit.uncertainty import TIED, Spread
from brdfc.source.errors import FitError

Array = NDArray[np.float64]

SHARED = 0.01
"""Share of the measurements that have one and the same value, when that is no chance."""
FEWEST_SHARED = 4


def refuse(measured: Measurements, response: Response) -> None:
    """FitError where there is less to go by than there are coefficients."""
    usable = (measured.values >= 0) & (measured.weights > 0)[:, None]
    if measured.kind is Kind.XYZ:
        usable &= usable.all(axis=1, keepdims=True)  # a colour is whole, or none
    if not usable.any():
        raise FitError(
            "no measurement has a value that counts: all are missing, negative or of no weight",
            where=measured.name,
        )
    if (measured.directions[:, :2] >= np.pi / 2 - 1e-6).any(axis=1).all():
        raise FitError("all measurements are at 90 degrees or beyond", where=measured.name)
    geometries = len(np.unique(measured.directions[usable.any(axis=1)].round(6), axis=0))
    least = least_geometries(response)
    if geometries < least or usable.sum() < len(response.coefficients):
        raise FitError(
            f"{geometries} geometries and {int(usable.sum())} values for "
            f"{len(response.coefficients)} coefficients of '{response.model.name}'; "
            f"{least} geometries are needed at least",
            where=measured.name,
            hint="take a model with fewer, or fix some: --set NAME=VALUE",
        )


def least_geometries(response: Response) -> int:
    """How many geometries a model's coefficients need: colours of one quantity are found from
    components of one."""
    shaped = sum(not c.linear for c in response.coefficients)
    return shaped + len({c.quantity for c in response.coefficients if c.linear})


def before(measured: Measurements) -> Iterator[str]:
    """What the measurements themselves show."""
    for check in _BEFORE:
        yield from check(measured)


def _one_incidence(measured: Measurements) -> Iterator[str]:
    incidences = np.unique(measured.directions[:, 0].round(3))
    if len(incidences) == 1:
        yield (
            f"all measurements are at one incidence, {np.degrees(incidences[0]):.1f} degrees: how "
            "the highlight changes with it is the model's word alone"
        )


def _no_highlight(measured: Measurements) -> Iterator[str]:
    away = _half_angles(measured.directions)
    if away.min() > np.radians(10):
        yield (
            f"none is within {np.degrees(away.min()):.0f} degrees of the mirror direction: what "
            "is said of a highlight is a guess"
        )


def _saturated(measured: Measurements) -> Iterator[str]:
    top = np.nanmax(measured.values, axis=0)
    count = int((measured.values == top).any(axis=1).sum())
    if _many(count, measured):
        yield f"{count} measurements share the greatest value: peaks look saturated; mask them"


def _floor(measured: Measurements) -> Iterator[str]:
    low = np.nanmin(measured.values, axis=0)
    count = int((measured.values == low).any(axis=1).sum())
    if _many(count, measured) and not (np.nanmax(measured.values, axis=0) == low).all():
        yield f"{count} measurements share the least value: the instrument's floor; leave them out"


def _many(count: int, measured: Measurements) -> bool:
    return count >= max(FEWEST_SHARED, SHARED * len(measured.values))


def _negative(measured: Measurements) -> Iterator[str]:
    count = int((measured.values < 0).any(axis=1).sum())
    if count:
        yield f"{count} measurements have negative values, and are left out"


def _missing(measured: Measurements) -> Iterator[str]:
    gone = np.isnan(measured.values)
    columns = np.flatnonzero(gone.all(axis=0))
    if len(columns):
        named = ", ".join(measured.components[c] for c in columns)
        yield f"no values for {named}"
    elif gone.any():
        yield f"{int(gone.any(axis=1).sum())} measurements miss some of their values"


_BEFORE: tuple[Callable[[Measurements], Iterator[str]], ...] = (
    _one_incidence,
    _no_highlight,
    _saturated,
    _floor,
    _negative,
    _missing,
)


def _half_angles(directions: Array) -> Array:
    """Between half vectors and the normal."""
    incident, reflection, azimuth, other = directions.T
    turn = azimuth - other
    x = np.sin(incident) + np.sin(reflection) * np.cos(turn)
    y = np.sin(reflection) * np.sin(turn)
    return np.asarray(np.arctan2(np.hypot(x, y), np.cos(incident) + np.cos(reflection)))


def after(response: Response, spread: Spread) -> Iterator[str]:
    """What cannot be known of the coefficients."""
    names = [c.name for c in response.coefficients]
    for c, end in zip(response.coefficients, spread.at_end, strict=True):
        if end:
            word, value = ("least", c.low) if end < 0 else ("greatest", c.high)
            yield f"{c.name} is at the {word} value that the model declares, {value:g}"
    for place in np.flatnonzero(spread.undetermined):
        yield f"{names[place]} is not determined by these measurements"
    for i, j in np.argwhere(np.triu(np.abs(spread.correlation) > TIED, 1)):
        one_colour = response.coefficients[i].quantity == response.coefficients[j].quantity
        if not (one_colour or spread.undetermined[i] or spread.undetermined[j]):
            yield (
                f"{names[i]} and {names[j]} cannot be told apart (correlation "
                f"{spread.correlation[i, j]:.2f}): only together do they mean something"
            )
