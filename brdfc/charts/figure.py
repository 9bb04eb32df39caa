"""The picture: price against worst bits, and price against worst CIEDE2000, with matplotlib."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from brdfc.charts.naming import name_points
from brdfc.charts.points import AS_WRITTEN, Point, front
from brdfc.charts.saved import BLUE, GREEN, GREY, PURPLE, SHAPES, VERMILION, saved
from brdfc.charts.scales import shown_value, style_axes

_PANELS = (
    ("bits", "Accuracy in float32: worst error, in bits"),
    ("de", "Accuracy to the eye: worst colour difference"),
)


def rendered(points: Sequence[Point], title: str, kind: str, notes: Sequence[str] = ()) -> bytes:
    """The picture as the bytes of a file of that kind ("svg" or "png"). notes: lines below it."""
    return saved(lambda: _figure(points, title, notes), kind, 9.0, frame=False)


def mark_id(error: str, index: int) -> str:
    """The name of a point's mark in the SVG, by panel and place in the list of points."""
    return f"{error}-{index}"


def _figure(points: Sequence[Point], title: str, notes: Sequence[str]) -> Figure:
    below = [line for note in notes for line in textwrap.wrap(note, 160, subsequent_indent="    ")]
    height = 6.0 + 0.17 * len(below)
    figure = Figure(figsize=(11.5, height), facecolor="white")
    lines = textwrap.wrap(title, 100, max_lines=2, placeholder=" …") or [""]
    top = 1 - (0.14 + 0.04 * len(lines)) * 6.0 / height
    bottom = (0.18 * 6.0 + 0.17 * len(below)) / height
    figure.subplots_adjust(left=0.06, right=0.985, top=top, bottom=bottom, wspace=0.17)
    figure.text(
        0.06,
        1 - 0.15 / height,
        "\n".join(lines),
        va="top",
        fontsize=13,
        fontweight="bold",
        parse_math=False,
    )
    if below:
        figure.text(
            0.06, 0.12 / height, "\n".join(below), va="bottom", fontsize=8, parse_math=False
        )
    count = f"{len(points)} candidate{'s' if len(points) > 1 else ''}. "
    better = "Cheaper is to the left, more accurate is down."
    under = 1 - (0.03 + 0.045 * len(lines)) * 6.0 / height
    figure.text(0.06, under, count + better, va="top", color="#444444")
    for column, (error, heading) in enumerate(_PANELS, start=1):
        axes = figure.add_subplot(1, 2, column)
        axes.set_title(heading, loc="left", fontsize=10)
        _panel(axes, points, error)
    figure.legend(
        handles=_legend(points),
        loc="lower center",
        bbox_to_anchor=(0.5, 0.17 * len(below) / height),
        ncols=8,
        frameon=False,
        handletextpad=0.4,
    )
    return figure


def _panel(axes: Axes, points: Sequence[Point], error: str) -> None:
    best = front(points, error)
    lettering = style_axes(axes, points, error)
    shapes = _shapes(points)
    if error == "bits":
        _bounds(axes, points, best)
    # By price: the marks of a page are reached by the keyboard in the order they are drawn.
    for index, point in sorted(enumerate(points), key=lambda pair: pair[1].price):
        on_front = point in best
        axes.plot(
            [point.price],
            [shown_value(point, error)],
            shapes[point.layer],
            gid=mark_id(error, index),
            color=BLUE if on_front else GREY,
            alpha=1.0 if on_front else 0.55,
            markersize=6.5 if on_front else 5.0,
            markeredgewidth=0.0,
            zorder=4 if on_front else 3,
        )
    for point in points:
        if point.name == AS_WRITTEN:
            _ring(axes, point, error, "s", VERMILION, 11)
        if point.chosen:
            _ring(axes, point, error, "D", GREEN, 12.5)
    corners = _steps(best, error, axes.get_xlim()[1])
    axes.plot(*zip(*corners, strict=True), "-", color=BLUE, linewidth=1.3, zorder=2)
    name_points(axes, points, best, error, corners, lettering)


def _ring(axes: Axes, point: Point, error: str, shape: str, colour: str, size: float) -> None:
    where = ([point.price], [shown_value(point, error)])
    axes.plot(*where, shape, color=colour, fillstyle="none", markersize=size, mew=1.8, zorder=5)


def _bounds(axes: Axes, points: Sequence[Point], best: Sequence[Point]) -> None:
    """Proven bounds: hollow triangles, tied to those points that have a name."""
    for point in points:
        if point.bound_bits is None:
            continue
        named = point in best or point.chosen or point.name == AS_WRITTEN
        bound = shown_value(point, "bound_bits")
        alpha = 1.0 if named else 0.5
        where = ([point.price], [bound])
        axes.plot(*where, "v", color=PURPLE, alpha=alpha, fillstyle="none", ms=5, zorder=3)
        if named:
            ends = [point.bits, bound]
            axes.plot([point.price] * 2, ends, ":", color=PURPLE, linewidth=1.0, zorder=1)


def _steps(best: Sequence[Point], error: str, right: float) -> list[tuple[float, float]]:
    """The corners of the front: what can be had for a price, up to the right edge."""
    corners = []
    for point, following in zip(best, [*best[1:], None], strict=True):
        value = shown_value(point, error)
        corners.append((point.price, value))
        corners.append((following.price if following else right, value))
    return corners


def _shapes(points: Sequence[Point]) -> dict[str, str]:
    layers = dict.fromkeys(point.layer for point in points)
    return {layer: SHAPES[i % len(SHAPES)] for i, layer in enumerate(layers)}


def _legend(points: Sequence[Point]) -> list[Line2D]:
    def entry(label: str, shape: str, colour: str, size: float, **more: str) -> Line2D:
        return Line2D([], [], marker=shape, color=colour, ms=size, label=label, **more)  # type: ignore[arg-type]

    shapes = _shapes(points)
    plain = "o" if len(shapes) == 1 else "."
    entries = [
        entry("front: nothing is both cheaper and more accurate", plain, BLUE, 6.5),
        entry("candidate", plain, GREY, 5, linestyle="none"),
        entry(AS_WRITTEN, "s", VERMILION, 9, linestyle="none", fillstyle="none"),
        entry("chosen", "D", GREEN, 9, linestyle="none", fillstyle="none"),
    ]
    if any(point.bound_bits is not None for point in points):
        entries.append(entry("proven bound", "v", PURPLE, 5, linestyle=":", fillstyle="none"))
    if len(shapes) > 1:
        entries += [entry(n, s, "#444444", 6, linestyle="none") for n, s in shapes.items()]
    return entries
