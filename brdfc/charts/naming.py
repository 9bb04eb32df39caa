"""The names in a panel: of the front, the formula as written and the chosen form."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from matplotlib.text import Text

from brdfc.charts.labels import Box, place
from brdfc.charts.points import AS_WRITTEN, Point
from brdfc.charts.scales import shown_value

LONGEST = 28
"""Letters of a name in the picture; the page and the table have it whole."""
_EVERY = 6.0
"""How densely the front's line counts as something not to cover, in points."""


FEW = 14
"""Up to so many points, every one is named."""


def name_points(
    axes: Axes,
    points: Sequence[Point],
    best: Sequence[Point],
    error: str,
    corners: Sequence[tuple[float, float]],
    lettering: Sequence[Text],
) -> None:
    """Write the names, in this order of importance: chosen, as written, the rest of the front.

    corners: of the front's line, in data units. lettering: texts already in the panel. Where a
    panel is so full that a name finds no place, it is left out rather than put over another.
    """
    named = [p for p in points if p.chosen or p.name == AS_WRITTEN]
    named.sort(key=lambda p: not p.chosen)
    named += [p for p in (points if len(points) <= FEW else best) if p not in named]
    figure = axes.get_figure(root=True)
    assert figure is not None
    unit = 72 / figure.dpi  # pixels to points, in which texts are placed

    def box(text: Text) -> Box:
        extent = text.get_window_extent()
        return Box(extent.x0 * unit, extent.y0 * unit, extent.x1 * unit, extent.y1 * unit)

    def spot(x: float, y: float) -> tuple[float, float]:
        px, py = axes.transData.transform((x, y))
        return float(px) * unit, float(py) * unit

    texts = [axes.text(0, 0, _name(p), fontsize=8, parse_math=False) for p in named]
    boxes = [box(text) for text in texts]
    anchors = [spot(p.price, shown_value(p, error)) for p in named]
    marks = [spot(p.price, shown_value(p, error)) for p in points]
    if error == "bits":
        proven = [p for p in points if p.bound_bits is not None]
        marks += [spot(p.price, shown_value(p, "bound_bits")) for p in proven]
    marks += _along([spot(*corner) for corner in corners])
    # What is named must stay in sight: its mark is as good as taken, with the ring around it.
    taken = [box(t) for t in lettering]
    for point, (x, y) in zip(named, anchors, strict=True):
        r = 8.5 if point.chosen or point.name == AS_WRITTEN else 4.0
        taken.append(Box(x - r, y - r, x + r, y + r))
    frame = axes.get_window_extent()
    inside = Box(frame.x0 * unit, frame.y0 * unit, frame.x1 * unit, frame.y1 * unit)
    sizes = [(b.right - b.left, b.top - b.bottom) for b in boxes]
    places = place(anchors, sizes, marks, taken, inside)
    for text, point, anchor, placed in zip(texts, named, anchors, places, strict=True):
        text.remove()
        if placed is None:
            continue
        where = (point.price, shown_value(point, error))
        away = (placed.x - anchor[0], placed.y - anchor[1])
        _write(axes, _name(point), where, away, placed.far)


def _write(
    axes: Axes, name: str, where: tuple[float, float], away: tuple[float, float], far: bool
) -> None:
    """A name on a light ground, over all lines; a line of its own leads to it from afar."""
    if far:
        line = {"arrowstyle": "-", "color": "#444444", "linewidth": 0.6, "shrinkB": 4}
        axes.annotate("", where, xytext=away, textcoords="offset points", arrowprops=line, zorder=6)
    axes.annotate(
        name,
        where,
        xytext=away,
        textcoords="offset points",
        ha="center",
        va="center",
        fontsize=8,
        parse_math=False,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5} if far else None,
        path_effects=[withStroke(linewidth=2.2, foreground="white")],
        zorder=7,
    )


def _name(point: Point) -> str:
    short = point.name if len(point.name) <= LONGEST else point.name[: LONGEST - 1] + "…"
    return f"{short}, chosen" if point.chosen else short


def _along(corners: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Places along a line, close together."""
    found: list[tuple[float, float]] = []
    for (x0, y0), (x1, y1) in pairwise(corners):
        count = int(max(abs(x1 - x0), abs(y1 - y0)) / _EVERY) + 1
        found += [(x0 + (x1 - x0) * t, y0 + (y1 - y0) * t) for t in np.linspace(0, 1, count)]
    return found
