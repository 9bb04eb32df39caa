"""Curves over an angle: what a surface sends into each direction."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import (
    LogLocator,
    MultipleLocator,
    NullFormatter,
    StrMethodFormatter,
)
from numpy.typing import NDArray

from brdfc.charts.saved import DASHES, SERIES, SHAPES, saved

Array = NDArray[np.float64]
Styles = dict[str, tuple[str, str, str]]

SCALES = ("linear", "log", "cbrt")
"""Scales of values; the cube root shows a highlight and what is beside it."""
_MOST_ACROSS = 3
"""Panels side by side."""


@dataclass(frozen=True)
class Curve:
    """angles: degrees; values: as many. measured: single points, not a line."""

    label: str
    angles: Array
    values: Array
    measured: bool = False


@dataclass(frozen=True)
class Panel:
    """Curves that belong together; incident: the light's angle in degrees, where it is one."""

    title: str
    curves: Sequence[Curve]
    incident: float | None = None


def rendered_curves(
    panels: Sequence[Panel],
    title: str,
    values: str,
    kind: str,
    *,
    scale: str = "linear",
    reverse: bool = False,
    note: str = "",
) -> bytes:
    """Curves over the reflection angle, as the bytes of a file of that kind ("svg" or "png").

    values: what the ordinate is. scale: of SCALES. reverse: angles fall from left to right. note:
    under the title.
    """

    def draw() -> Figure:
        figure, top, bottom = sheet(panels, title, note, 4.6, 3.5)
        for place, panel in enumerate(panels, start=1):
            axes = figure.add_subplot(*grid(len(panels)), place)
            _curves(axes, panel, styles(panels), scale)
            axes.set_ylabel(values)
            axes.set_xlabel("reflection angle [deg]")
            if reverse:
                axes.invert_xaxis()
        legend(figure, panels)
        wide = figure.get_figwidth()
        ends = (0.85 / wide, bottom, 1 - 0.2 / wide, top)
        figure.subplots_adjust(*ends, wspace=0.3, hspace=0.45)
        return figure

    return saved(draw, kind, frame=False)


# ---------------------------------------------------------------- one sheet


def grid(count: int) -> tuple[int, int]:
    across = min(count, _MOST_ACROSS)
    return math.ceil(count / across), across


def sheet(
    panels: Sequence[Panel], title: str, note: str, width: float, height: float
) -> tuple[Figure, float, float]:
    """A figure with its title and note, and where the panels end above and below."""
    down, across = grid(len(panels))
    wide = max(width * across, 6.0)
    lines = textwrap.wrap(title, int(10.5 * wide), max_lines=2, placeholder=" …")
    small = textwrap.wrap(note, int(14 * wide))
    labels = {c.label for p in panels for c in p.curves}
    above = 0.25 + 0.24 * len(lines) + 0.18 * len(small) + 0.3
    figure = Figure(figsize=(wide, wide), facecolor="white")
    below = 0.75 + 0.2 * math.ceil(len(labels) / _columns(figure, labels))
    tall = above + height * down + below
    figure.set_figheight(tall)
    y = 1 - 0.1 / tall
    for line in lines:
        figure.text(0.02, y, line, va="top", fontsize=12, fontweight="bold", parse_math=False)
        y -= 0.24 / tall
    for line in small:
        figure.text(0.02, y, line, va="top", color="#444444", parse_math=False)
        y -= 0.18 / tall
    return figure, 1 - above / tall, below / tall


def styles(panels: Sequence[Panel]) -> Styles:
    """Colour, dash and shape of every label, the same in all panels."""
    labels = dict.fromkeys(curve.label for panel in panels for curve in panel.curves)
    return {
        label: (
            SERIES[i % len(SERIES)],
            DASHES[(i // len(SERIES) + i) % len(DASHES)],
            SHAPES[i % len(SHAPES)],
        )
        for i, label in enumerate(labels)
    }


def draw_curve(axes: Axes, curve: Curve, x: Array, y: Array, style: tuple[str, str, str]) -> None:
    """One curve, or its points, at places of the axes."""
    colour, dash, shape = style
    if curve.measured:
        axes.plot(x, y, shape, color=colour, markersize=4, fillstyle="none", label=curve.label)
    else:
        axes.plot(x, y, dash, color=colour, linewidth=1.6, label=curve.label)


def _curves(axes: Axes, panel: Panel, of: Styles, scale: str) -> None:
    axes.set_title(panel.title, loc="left", fontsize=10, parse_math=False)
    axes.grid(True, color="#e6e6e6", linewidth=0.7)
    axes.set_axisbelow(True)
    for curve in panel.curves:
        y = np.cbrt(curve.values) if scale == "cbrt" else curve.values
        draw_curve(axes, curve, curve.angles, y, of[curve.label])
    low = min(float(c.angles.min()) for c in panel.curves)
    high = max(float(c.angles.max()) for c in panel.curves)
    axes.set_xlim(low, high)
    if high - low > 60:
        axes.xaxis.set_major_locator(MultipleLocator(20 if high - low > 100 else 10))
    if scale == "log":
        _log_ticks(axes)
    elif scale == "cbrt":
        _cube_root_ticks(axes)
    elif min(float(c.values.min()) for c in panel.curves) >= 0:
        axes.set_ylim(bottom=0)


def _log_ticks(axes: Axes) -> None:
    """Ticks as plain numbers, some within a decade where there are few decades."""
    axes.set_yscale("log")
    low, high = axes.get_ylim()
    few = high / low < 200
    axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if few else (1,)))
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())


def _cube_root_ticks(axes: Axes) -> None:
    """Ticks at values, which stand at their cube roots."""
    most = axes.get_ylim()[1] ** 3
    axes.set_ylim(bottom=0)
    ticks = [0.0, *cube_root_values(most, 12)]
    axes.set_yticks(np.cbrt(ticks), labels=[f"{v:g}" for v in ticks])


def cube_root_values(most: float, count: int) -> list[float]:
    """Round values up to the greatest, at most about so many, that do not crowd at their cube
    roots."""
    step = 10.0 ** math.floor(math.log10(most))
    chosen: list[float] = []
    # From the greatest down, as long as they do not crowd.
    for value in (step * f * d for d in (1, 0.1, 0.01, 0.001) for f in (5, 2, 1)):
        room = np.cbrt(most) / count
        if value <= most and (not chosen or np.cbrt(chosen[-1]) - np.cbrt(value) > room):
            chosen.append(value)
    return [v for v in reversed(chosen) if np.cbrt(v) > room]


def legend(figure: Figure, panels: Sequence[Panel]) -> None:
    found: dict[str, Any] = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
    if len(found) > 1 or any(c.label for p in panels for c in p.curves):
        figure.legend(
            list(found.values()),
            list(found),
            loc="lower center",
            ncols=_columns(figure, found),
            frameon=False,
        )


def _columns(figure: Figure, labels: Iterable[str]) -> int:
    """As many columns as the longest label leaves room for."""
    longest = max(len(label) for label in labels)
    return max(1, min(3, int(figure.get_figwidth() / (0.075 * longest + 0.75))))
