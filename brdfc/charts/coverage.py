"""Where a surface was measured: directions of reflection about the normal, a panel an incidence."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from numpy.typing import NDArray

from brdfc.charts.saved import VERMILION, saved

Array = NDArray[np.float64]

_ACROSS = 4
_PANEL = 2.7
"""Inches, either way."""


@dataclass(frozen=True, eq=False)
class Incidence:
    """incident: the zenith of the light; zeniths and azimuths of reflection, from the light's
    azimuth: (n,), all in degrees; values: (n,)."""

    incident: float
    title: str
    zeniths: Array
    azimuths: Array
    values: Array


def by_incidence(
    incident: Array, zeniths: Array, azimuths: Array, values: Array, most: int = 12
) -> list[Incidence]:
    """Directions (n,) in degrees in panels, so many at most: of one incidence each, or where there
    are more incidences, of equal parts of their range."""
    distinct = np.unique(np.round(incident, 2))
    edges = np.linspace(incident.min(), incident.max(), most + 1)
    part = np.clip(np.searchsorted(edges, incident, side="right") - 1, 0, most - 1)
    few = len(distinct) <= most
    if few:
        part = np.searchsorted(distinct, np.round(incident, 2))
    panels = []
    for which in np.unique(part):
        at = part == which
        middle = float(distinct[which] if few else (edges[which] + edges[which + 1]) / 2)
        title = f"{middle:g}°" if few else f"{edges[which]:.3g}°..{edges[which + 1]:.3g}°"
        panels.append(Incidence(middle, title, zeniths[at], azimuths[at], values[at]))
    return panels


def rendered_coverage(panels: Sequence[Incidence], title: str, kind: str) -> bytes:
    """The picture as the bytes of a file of that kind ("svg" or "png").

    The light comes from the left; its mirror direction, to the right, is marked by a cross. Colours
    are values, on a logarithmic scale.
    """

    def draw() -> Figure:
        across = min(len(panels), _ACROSS)
        down = math.ceil(len(panels) / across)
        figure = Figure(figsize=(across * _PANEL + 1.2, down * (_PANEL + 0.35) + 0.5))
        figure.suptitle(title, parse_math=False)
        positive = np.concatenate([p.values[p.values > 0] for p in panels])
        low, high = (positive.min(), positive.max()) if len(positive) else (1.0, 1.0)
        norm = LogNorm(low, max(high, low * 1.001))
        shape = {"projection": "polar"}
        grid = figure.subplots(down, across, squeeze=False, subplot_kw=shape)
        for axes, panel in zip(grid.flat, panels, strict=False):
            axes.set_title(panel.title, fontsize=10, parse_math=False)
            axes.set_theta_zero_location("W")
            axes.set_rlim(0, 90)
            axes.set_rticks([30, 60, 90], labels=[])
            axes.set_xticks(np.radians([0, 90, 180, 270]), labels=["light", "", "", ""])
            shown = np.maximum(panel.values, low)
            angle = np.radians(panel.azimuths)
            axes.scatter(angle, panel.zeniths, c=shown, s=7, norm=norm, linewidths=0)
            axes.plot([math.pi], [panel.incident], "x", color=VERMILION, markersize=7)
        for axes in grid.flat[len(panels) :]:
            axes.set_axis_off()
        figure.subplots_adjust(0.05, 0.03, 0.84, 1 - 0.85 / figure.get_figheight(), 0.25, 0.3)
        bar = figure.add_axes((0.89, 0.15, 0.018, 0.7))
        figure.colorbar(ScalarMappable(norm), cax=bar, label="1/sr")
        return figure

    return saved(draw, kind)
