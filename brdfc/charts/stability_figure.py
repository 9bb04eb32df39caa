"""The picture of a stability report: worst error over the plane of the two angles.

Programs stand side by side in one scale of colours.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patches import Patch

from brdfc.charts.saved import VERMILION, saved
from brdfc.judge.error_map import ErrorMap
from brdfc.judge.measure import SEEN

ALL_BITS = 24
"""Bits of a float32's digits: an error of so many leaves none of them right."""
NOWHERE = "#ececec"


def rendered_map(
    errors: ErrorMap, methods: Sequence[tuple[str, str]], title: str, kind: str
) -> bytes:
    """The picture as the bytes of a file of that kind ("svg" or "png")."""
    return saved(lambda: _figure(errors, methods, title), kind)


_LEFT, _RIGHT, _BOTTOM = 0.65, 1.5, 0.95
_PANEL, _GAP, _BAR = 4.3, 0.6, 0.16
"""Inches: margins, a panel's side, what lies between panels, the width of the scale."""


def _figure(errors: ErrorMap, methods: Sequence[tuple[str, str]], title: str) -> Figure:
    width = _LEFT + len(methods) * (_PANEL + _GAP) - _GAP / 2 + _BAR + _RIGHT
    headings = textwrap.wrap(f"{title}: where float32 fails", int(10 * width), max_lines=2)
    lines = textwrap.wrap(_caption(errors), int(13.5 * width))
    panel = _PANEL if errors.up else 1.2
    height = _BOTTOM + panel + 0.6 + 0.27 * len(headings) + 0.2 * len(lines)
    figure = Figure(figsize=(width, height), facecolor="white")
    y = height - 0.12
    for line in headings:
        figure.text(
            _LEFT / width,
            y / height,
            line,
            va="top",
            fontsize=13,
            fontweight="bold",
            parse_math=False,
        )
        y -= 0.27
    for line in lines:
        figure.text(_LEFT / width, y / height, line, va="top", color="#444444")
        y -= 0.2

    def axes_at(left: float, wide: float) -> Axes:
        return figure.add_axes((left / width, _BOTTOM / height, wide / width, panel / height))

    left = _LEFT
    for number, (name, _) in enumerate(methods):
        axes = axes_at(left, _PANEL)
        worst = np.nanmax(errors.cells[name].bits)
        axes.set_title(f"{name}: at worst {worst:.1f} bits", loc="left", fontsize=10.5)
        image = _panel(axes, errors, name)
        if number == 0:
            axes.set_ylabel(errors.up)
        left += _PANEL + _GAP
    _scale(figure, image, axes_at(left - _GAP / 2, _BAR), tall=bool(errors.up))
    _legend(figure, errors, _LEFT / width)
    return figure


def _caption(errors: ErrorMap) -> str:
    return (
        f"Colour: worst error in a cell, of {errors.points:,} points over the whole ranges of all "
        f"coefficients; counted where a value is at least {SEEN:g} of the peak."
    )


def _panel(axes: Axes, errors: ErrorMap, name: str) -> AxesImage:
    cells = errors.cells[name]
    colours = matplotlib.colormaps["viridis"].with_extremes(bad=NOWHERE)
    left, right, bottom, top = errors.ends
    extent = (left, right, bottom, top)
    options = {"origin": "lower", "extent": extent, "interpolation": "nearest", "aspect": "auto"}
    image = axes.imshow(cells.bits, cmap=colours, vmin=0, vmax=ALL_BITS, **options)  # type: ignore[arg-type]
    if cells.broken.any():
        shown = np.where(cells.broken, 1.0, np.nan)
        axes.imshow(shown, cmap=ListedColormap([VERMILION]), **options)  # type: ignore[arg-type]
    axes.set_xlabel(errors.across)
    axes.set_xticks(_ticks(left, right))
    axes.set_yticks(_ticks(bottom, top) if errors.up else [])
    return image


def _ticks(low: float, high: float) -> list[float]:
    """Whole steps that people know angles by."""
    step = next((s for s in (5, 15, 30, 45) if (high - low) / s <= 7), 90)
    first = math.ceil(low / step - 1e-6) * step
    return [float(t) for t in np.arange(first, high + 1e-6 * step, step)]


def _scale(figure: Figure, image: ScalarMappable, axes: Axes, tall: bool) -> None:
    bar = figure.colorbar(image, cax=axes)
    ticks = range(0, ALL_BITS + 1, 4 if tall else 12)
    words = {0: "0: exact", ALL_BITS: f"{ALL_BITS}: no digit"}
    bar.set_ticks(list(ticks), labels=[words.get(t, str(t)) for t in ticks])
    bar.set_label("error in bits,\nlog2(1 + units in the last place)" if tall else "bits")


def _legend(figure: Figure, errors: ErrorMap, left: float) -> None:
    entries = []
    if any(cells.broken.any() for cells in errors.cells.values()):
        entries.append(Patch(facecolor=VERMILION, label="some result is NaN or infinite"))
    if any(np.isnan(cells.bits).any() for cells in errors.cells.values()):
        entries.append(Patch(facecolor=NOWHERE, label="no point"))
    if entries:
        place = (left - 0.01, 0.0)
        figure.legend(
            handles=entries, loc="lower left", bbox_to_anchor=place, ncols=2, frameon=False
        )
