"""Models as rows of a chart: what a pixel costs, and how far each is off, beside each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, StrMethodFormatter

from brdfc.charts.saved import BLUE, GREEN, GREY, VERMILION, saved
from brdfc.charts.scales import LEAST_DE

_ROW, _AROUND = 0.24, 1.9
"""Inches of a row, and around the rows."""


@dataclass(frozen=True)
class Row:
    """price: nanoseconds a pixel; difference: CIEDE2000 at worst; good: within the tolerance;
    chosen: the cheapest of those; note: stands after the name."""

    name: str
    price: float
    difference: float
    good: bool
    chosen: bool
    note: str = ""


def rendered(rows: Sequence[Row], tolerance: float, title: str, kind: str) -> bytes:
    """The picture as the bytes of a file of that kind ("svg" or "png")."""
    return saved(lambda: _figure(rows, tolerance, title), kind, 9.0)


def _figure(rows: Sequence[Row], tolerance: float, title: str) -> Figure:
    height = _ROW * len(rows) + _AROUND
    figure = Figure(figsize=(10.5, height), facecolor="white")
    figure.subplots_adjust(
        left=0.27, right=0.98, top=1 - 0.95 / height, bottom=0.75 / height, wspace=0.06
    )
    figure.text(0.02, 1 - 0.2 / height, title, va="top", fontsize=12, fontweight="bold")
    figure.text(
        0.02,
        1 - 0.5 / height,
        "Blue: within the tolerance. Green: the cheapest of those. Grey: farther off.",
        va="top",
        color="#444444",
    )
    price, off = figure.subplots(1, 2, sharey=True, width_ratios=(1, 1.25))
    places = range(len(rows))
    colours = [GREEN if r.chosen else BLUE if r.good else GREY for r in rows]
    price.barh(places, [r.price for r in rows], color=colours, height=0.68)
    for place, row in zip(places, rows, strict=True):
        price.annotate(
            f"{row.price:.0f}",
            (row.price, place),
            xytext=(3, 0),
            textcoords="offset points",
            va="center",
            fontsize=8,
        )
    price.set_yticks(places, [r.name + (f" ({r.note})" if r.note else "") for r in rows])
    price.set_ylim(len(rows) - 0.4, -0.6)
    price.set_xlim(0, max(r.price for r in rows) * 1.12)
    price.set_xlabel("nanoseconds a pixel on the reference engine")
    off.set_xscale("log")
    shown = [max(r.difference, LEAST_DE) for r in rows]
    off.scatter(shown, places, color=colours, s=34, zorder=3)
    off.set_xlim(min(*shown, tolerance) / 3, max(*shown, tolerance) * 3)
    off.axvline(tolerance, color=VERMILION, linewidth=1.1, linestyle=(0, (5, 3)))
    off.annotate(
        f"tolerance {tolerance:g}",
        (tolerance, 1.0),
        xycoords=("data", "axes fraction"),
        xytext=(0, 3),
        textcoords="offset points",
        ha="center",
        color=VERMILION,
        fontsize=8,
    )
    off.xaxis.set_major_locator(LogLocator(numticks=12))
    off.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    off.set_xlabel("CIEDE2000 from the richest model, at worst")
    off.grid(True, axis="both", color="#e6e6e6", linewidth=0.7)
    off.tick_params(left=False)
    off.set_axisbelow(True)
    return figure
