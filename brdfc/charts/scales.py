"""The axes of a chart: scales and ends, and lines that say what a figure means to a viewer."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.text import Text
from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator, StrMethodFormatter

from brdfc.charts.points import Point

LEAST_DE = 1e-6
"""A logarithmic axis has no 0: smaller differences are drawn here."""
MOST_BITS = 32.0
"""All the bits a float32 has: no bound says more."""
MEANINGS = (
    (1.0, "1: just seen, side by side"),
    (0.01, "0.01: far below what anyone can see"),
)
"""What a CIEDE2000 means to a viewer. 1 is about one just noticeable difference."""


def shown_value(point: Point, error: str) -> float:
    """Where a point's error is drawn, on the scale of its panel."""
    value = float(getattr(point, error))
    return max(value, LEAST_DE) if error == "de" else min(value, MOST_BITS)


def style_axes(axes: Axes, points: Sequence[Point], error: str) -> list[Text]:
    """Scales, ends, ticks and words; the texts that stand inside the axes."""
    _price_axis(axes, points)
    axes.grid(True, which="major", color="#e6e6e6", linewidth=0.7)
    axes.set_axisbelow(True)
    if error == "bits":
        _bits_axis(axes, points)
        return []
    return _de_axis(axes, points)


def _price_axis(axes: Axes, points: Sequence[Point]) -> None:
    prices = [p.price for p in points]
    low, high = min(prices), max(prices)
    axes.set_xscale("log")
    margin = max((high / low) ** 0.06, 1.05)
    axes.set_xlim(low / margin, high * margin**1.5)
    wide = high / low > 10
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)) if wide else MaxNLocator(7))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.set_xlabel("price: nanoseconds a pixel on the reference engine")


def _bits_axis(axes: Axes, points: Sequence[Point]) -> None:
    values = [shown_value(p, "bits") for p in points]
    values += [shown_value(p, "bound_bits") for p in points if p.bound_bits is not None]
    low, high = min(values), max(values)
    # Less than two bits from end to end would make much of differences that are none.
    margin = max(0.1 * (high - low), (2.0 - (high - low)) / 2)
    axes.set_ylim(max(low - margin, -0.5), high + margin)
    axes.yaxis.set_major_locator(MaxNLocator(8))
    axes.set_ylabel("worst error, log2(1 + units in the last place)")


def _de_axis(axes: Axes, points: Sequence[Point]) -> list[Text]:
    values = [shown_value(p, "de") for p in points]
    axes.set_yscale("log")
    axes.set_ylim(min(*values, 1e-2) / 3, max(*values, 1.0) * 4)
    axes.yaxis.set_major_locator(LogLocator())
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    least = f" ({LEAST_DE:g}: that or less)" if min(p.de for p in points) < LEAST_DE else ""
    axes.set_ylabel(f"worst CIEDE2000{least}")
    texts = []
    for value, meaning in MEANINGS:
        axes.axhline(value, color="#444444", linewidth=0.9, linestyle=(0, (5, 3)), zorder=1)
        texts.append(
            axes.annotate(
                meaning,
                (1.0, value),
                xycoords=("axes fraction", "data"),
                xytext=(-2, 2),
                textcoords="offset points",
                ha="right",
                va="bottom",
                fontsize=8,
                color="#444444",
            )
        )
    return list(texts)
