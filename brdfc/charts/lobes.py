"""Polar lobes: the distance from the middle is what a surface sends into a direction.

The normal is up, the light comes from the left where its angle is positive, and the mirror
direction is to the right.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc
from matplotlib.ticker import MaxNLocator

from brdfc.charts.curves import (
    Array,
    Panel,
    Styles,
    cube_root_values,
    draw_curve,
    grid,
    legend,
    sheet,
    styles,
)
from brdfc.charts.saved import saved

_DECADES = 3.0
"""That a logarithmic scale goes down from the greatest value."""
_LINE, _TEXT = "#d8d8d8", "#444444"


def rendered_lobes(
    panels: Sequence[Panel],
    title: str,
    values: str,
    kind: str,
    *,
    scale: str = "linear",
    note: str = "",
) -> bytes:
    """Lobes as the bytes of a file of that kind ("svg" or "png"); see rendered_curves."""

    def draw() -> Figure:
        figure, top, bottom = sheet(panels, title, note, 4.6, 2.6)
        for place, panel in enumerate(panels, start=1):
            axes = figure.add_subplot(*grid(len(panels)), place)
            _lobes(axes, panel, styles(panels), scale, values)
        legend(figure, panels)
        figure.subplots_adjust(0.04, bottom, 0.96, top, wspace=0.12, hspace=0.2)
        return figure

    return saved(draw, kind)


def _lobes(axes: Axes, panel: Panel, of: Styles, scale: str, values: str) -> None:
    most = max(float(c.values.max()) for c in panel.curves)
    radius, ticks = _radius(most if most > 0 else 1.0, scale)
    axes.set_title(panel.title, fontsize=10, parse_math=False)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_xlim(-1.3, 1.3)
    axes.set_ylim(-0.28, 1.2)
    for tick in ticks:
        r = float(radius(np.array([tick]))[0])
        axes.add_patch(Arc((0, 0), 2 * r, 2 * r, theta1=0, theta2=180, color=_LINE, linewidth=0.8))
        axes.text(-r, -0.03, f"{tick:g}", ha="center", va="top", fontsize=8, color=_TEXT)
    for degrees in range(-90, 91, 30):
        x, y = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
        axes.plot([0, 1.05 * x], [0, 1.05 * y], "-", color=_LINE, linewidth=0.8, zorder=1)
        axes.text(1.14 * x, 1.12 * y, f"{degrees}°", ha="center", va="center", fontsize=8)
    axes.plot([-1.05, 1.05], [0, 0], "-", color="black", linewidth=1.0, zorder=1)
    axes.text(0, -0.16, values, ha="center", va="top", color=_TEXT)
    for curve in panel.curves:
        angle, out = np.radians(curve.angles), radius(curve.values)
        draw_curve(axes, curve, out * np.sin(angle), out * np.cos(angle), of[curve.label])
    if panel.incident is not None:
        tilt = -math.radians(panel.incident)
        outer, inner = 1.03, 0.06
        ends = [(k * math.sin(tilt), k * math.cos(tilt)) for k in (outer, inner)]
        arrow = {"arrowstyle": "->", "color": _TEXT, "linewidth": 1.2}
        axes.annotate("", xy=ends[1], xytext=ends[0], arrowprops=arrow)


def _radius(most: float, scale: str) -> tuple[Callable[[Array], Array], list[float]]:
    """Where values lie between the middle, 0, and the rim, 1; and values to mark."""
    if scale == "cbrt":
        return (lambda v: np.cbrt(np.maximum(v, 0) / most)), cube_root_values(most, 5)
    if scale == "log":
        least = most * 10**-_DECADES
        top = math.floor(math.log10(most))
        ticks = [10.0 ** (top - i) for i in range(int(_DECADES))]
        return (lambda v: np.log10(np.maximum(v, least) / least) / _DECADES), [
            t for t in ticks if t > 1.5 * least
        ]
    return (lambda v: np.maximum(v, 0) / most), [
        float(t) for t in MaxNLocator(3).tick_values(0, most) if 0 < t <= most * 1.0001
    ]
