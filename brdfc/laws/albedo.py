"""Directional albedo: the part of the light from one direction that is reflected in all.

a(l) = integral of f cos(tr) over the hemisphere, over two charts that share it out (charts.py).
Each chart is cut into cells, a Gauss rule in each; a cell is cut in four where it and its parts
differ, until what is uncertain is below the tolerance. Their moments are compared too, not the
integrals alone: two wrong integrals may agree by chance, and whoever searches for the largest
albedo finds just these. Many albedos are computed side by side, cells of all in one array.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.laws.charts import (
    PARTS,
    PARTS_TO_AXES,
    mirror,
    retro,
    share_of_mirror,
    within_turn,
)
from brdfc.laws.reflectance import (
    INCIDENT,
    INCIDENT_AZIMUTH,
    REFLECTION,
    REFLECTION_AZIMUTH,
    Array,
    Reflectance,
    Values,
)

TOLERANCE = 1e-4
MIRROR, RETRO = 0, 1
_ACROSS = 4
"""Cells of a chart at first in the radius; in the turn there is one for each smooth part."""
_NODES = 4
_CAUTION = 2
"""What two levels differ by is nearly always more than the finer one's error; half of it, more."""
_MOST_CELLS, _MOST_LEVELS = 20_000, 24
_SIDE_BY_SIDE, _AT_ONCE = 64, 1 << 15
"""Albedos refined together, and points evaluated together: what fits a cache is faster."""


@dataclass(frozen=True)
class Albedos:
    """One of each a point. value: of the component that reflects most; error: what refinement
    leaves uncertain; converged: whether that is within the tolerance."""

    value: Array
    error: Array
    converged: NDArray[np.bool_]


@dataclass(frozen=True)
class _Cells:
    """Rectangles of charts. corner: the least (u, w); size: in u and w; chart: MIRROR or RETRO;
    owner: the albedo they are part of."""

    corner: Array
    size: Array
    chart: NDArray[np.int64]
    owner: NDArray[np.int64]

    def quarters(self) -> _Cells:
        """Every cell in four, the parts of one after another."""
        half = self.size / 2
        offsets = np.array([(0, 0), (1, 0), (0, 1), (1, 1)])
        corner = self.corner[:, None] + offsets * half[:, None]
        owner, chart = np.repeat(self.owner, 4), np.repeat(self.chart, 4)
        return _Cells(corner.reshape(-1, 2), np.repeat(half, 4, axis=0), chart, owner)

    def only(self, which: NDArray[np.bool_] | NDArray[np.intp]) -> _Cells:
        return _Cells(self.corner[which], self.size[which], self.chart[which], self.owner[which])


def albedos(reflectance: Reflectance, values: Values, tolerance: float = TOLERANCE) -> Albedos:
    """Albedos to a tolerance, absolute below 1 and relative above.

    values: (points, components) for the parameters and the incident direction. The value is NaN
    where the formula gives none somewhere in the hemisphere.
    """
    parts = []
    for start in range(0, len(values[INCIDENT]), _SIDE_BY_SIDE):
        some = {name: v[start : start + _SIDE_BY_SIDE] for name, v in values.items()}
        parts.append(_refined(reflectance, some, tolerance))
    value, error, converged = (np.concatenate(column) for column in zip(*parts, strict=True))
    return Albedos(value, error, converged)


def _refined(
    reflectance: Reflectance, values: Values, tolerance: float
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Values, errors, and whether they are within the tolerance."""
    count = len(values[INCIDENT])

    def by_owner(cells: _Cells, amounts: Array) -> Array:
        total = np.zeros((count, *amounts.shape[1:]))
        np.add.at(total, cells.owner, amounts)
        return total

    cells = _mesh(count, PARTS if reflectance.isotropic else PARTS_TO_AXES)
    whole = _integrals(reflectance, values, cells)
    settled = np.zeros((count, reflectance.width))
    settled_error, value, error = np.zeros(count), np.zeros(count), np.zeros(count)
    for _ in range(_MOST_LEVELS):
        quarters = cells.quarters()
        parts = _integrals(reflectance, values, quarters)
        four = parts.reshape(-1, 4, *parts.shape[1:])
        together = np.einsum("qnm,cqmw->cnw", _TOGETHER, four)
        difference = np.abs(together - whole).max(axis=(1, 2))
        value = (settled + by_owner(quarters, parts[:, 0])).max(axis=-1)
        error = settled_error + by_owner(cells, difference)
        number = by_owner(cells, np.ones(len(difference)))
        allowed = tolerance * np.maximum(1, np.abs(value)) / _CAUTION
        done = (error <= allowed) | ~np.isfinite(value) | (number > _MOST_CELLS)
        # Half of what is allowed is shared out among the cells: those beyond it are cut again.
        share = (allowed - settled_error) / 2 / np.maximum(number, 1)
        again = ~done[cells.owner] & (difference > share[cells.owner])
        if not again.any():
            break
        settled += by_owner(cells.only(~again), together[~again, 0])
        settled_error += by_owner(cells.only(~again), difference[~again])
        which = np.repeat(again, 4)
        cells, whole = quarters.only(which), parts[which]
    converged = error <= tolerance * np.maximum(1, np.abs(value)) / _CAUTION
    return value, error, converged


def _mesh(count: int, around: int) -> _Cells:
    """The cells that so many albedos begin with; around: parts of the turn of the mirror chart."""
    parts = [_grid(count, MIRROR, around), _grid(count, RETRO, PARTS)]
    return _Cells(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _grid(
    count: int, chart: int, around: int
) -> tuple[Array, Array, NDArray[np.int64], NDArray[np.int64]]:
    """The fields of equal cells of one chart."""
    axes = (np.arange(count), np.arange(_ACROSS), np.arange(around))
    owner, u, w = (a.ravel() for a in np.meshgrid(*axes, indexing="ij"))
    size = np.full((owner.size, 2), (1 / _ACROSS, 1 / around))
    return np.stack([u, w], axis=-1) * size, size, np.full(owner.size, chart), owner


def _rule() -> tuple[Array, Array]:
    """Nodes (nodes,) of a Gauss rule on 0..1, and the weights of pairs of them for the moments 1,
    x, y and xy (nodes * nodes, 4), with x and y from -1 to 1 in the cell."""
    x, weight = np.polynomial.legendre.leggauss(_NODES)
    first, second = (a.ravel() for a in np.meshgrid(x, x, indexing="ij"))
    moments = np.stack([np.ones(len(first)), first, second, first * second], axis=-1)
    return (x + 1) / 2, moments * np.outer(weight / 2, weight / 2).reshape(-1, 1)


def _together() -> Array:
    """The moments of a cell by those of its quarters (quarters, moments, moments): what is x in a
    quarter to the left is (x - 1)/2 in the cell."""
    return np.array(
        [
            [
                [1, 0, 0, 0],
                [left / 2, 1 / 2, 0, 0],
                [down / 2, 0, 1 / 2, 0],
                [left * down / 4, down / 4, left / 4, 1 / 4],
            ]
            for left, down in ((-1, -1), (1, -1), (-1, 1), (1, 1))
        ]
    )


(_NODE, _WEIGHT), _TOGETHER = _rule(), _together()


def _integrals(reflectance: Reflectance, values: Values, cells: _Cells) -> Array:
    """The moments of the integrand in every cell (cells, 4, width), the integral first."""
    result = np.zeros((cells.owner.size, 4, reflectance.width))
    step = _AT_ONCE // len(_WEIGHT)
    for which in (MIRROR, RETRO):
        (mine,) = np.nonzero(cells.chart == which)
        for start in range(0, len(mine), step):
            some = cells.only(mine[start : start + step])
            own = {name: v[some.owner, None] for name, v in values.items()}
            density = _density(reflectance, own, which, some)
            area = some.size.prod(axis=-1)[:, None, None]
            result[mine[start : start + step]] = np.matmul(_WEIGHT.T, density) * area
    return result


def _density(reflectance: Reflectance, values: Values, which: int, cells: _Cells) -> Array:
    """f cos(tr) with the solid angle (cells, nodes, width), at the nodes of cells of one chart.

    values: (cells, 1, components).
    """
    u, w = (cells.corner[:, i, None] + _NODE * cells.size[:, i, None] for i in range(2))
    incident = values[INCIDENT][..., None, 0]
    turned = values[INCIDENT_AZIMUTH][..., None, 0]
    if which == RETRO:
        at = retro(incident, u[:, :, None], w[:, None, :])
    else:
        tangent = None if reflectance.isotropic else -turned
        at = mirror(incident, u[:, :, None], w[:, None, :], tangent)
    share = share_of_mirror(incident, at)
    weight = at.solid_angle * at.z * (share if which == MIRROR else 1 - share)
    shape = (len(u), -1, 1)
    azimuth = within_turn(turned + at.azimuth)
    directions = {
        REFLECTION: at.zenith.reshape(shape),
        REFLECTION_AZIMUTH: azimuth.reshape(shape),
    }
    f = reflectance({**values, **directions})
    with np.errstate(all="ignore"):
        return np.asarray(f * weight.reshape(shape))
