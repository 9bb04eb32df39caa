"""Models as points: what a pixel costs, and how far each is off where it was not fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure

from brdfc.charts.saved import BLUE, GREEN, GREY, VERMILION, saved


@dataclass(frozen=True)
class Point:
    """price: nanoseconds a pixel; inside, outside: CIEDE2000 of the fit, and held out."""

    name: str
    coefficients: int
    price: float
    inside: float
    outside: float
    chosen: bool


def rendered(points: Sequence[Point], tolerance: float | None, title: str, kind: str) -> bytes:
    """The picture as the bytes of a file of that kind ("svg" or "png")."""
    return saved(lambda: _figure(points, tolerance, title), kind)


def _figure(points: Sequence[Point], tolerance: float | None, title: str) -> Figure:
    figure = Figure(figsize=(9, 5.6), facecolor="white", layout="constrained")
    axes = figure.subplots()
    for point in points:
        colour = GREEN if point.chosen else BLUE
        axes.plot([point.price] * 2, [point.inside, point.outside], color=GREY, linewidth=1)
        axes.scatter(point.price, point.inside, s=14, color=GREY, zorder=3)
        axes.scatter(
            point.price, point.outside, s=70 if point.chosen else 36, color=colour, zorder=4
        )
        axes.annotate(
            f"{point.name} ({point.coefficients})",
            (point.price, point.outside),
            xytext=(6, 4),
            textcoords="offset points",
            fontsize=8.5,
            fontweight="bold" if point.chosen else "normal",
        )
    if tolerance is not None:
        axes.axhline(tolerance, color=VERMILION, linestyle=(0, (5, 3)), label="tolerance")
    axes.set_title(title)
    axes.set_xlabel("nanoseconds a pixel on the reference engine")
    axes.set_ylabel("mean CIEDE2000: held out (large), of the fit (small)")
    axes.set_xlim(left=0, right=max(p.price for p in points) * 1.25)
    axes.set_ylim(bottom=0, top=max(p.outside for p in points) * 1.12)
    axes.grid(alpha=0.3)
    return figure
