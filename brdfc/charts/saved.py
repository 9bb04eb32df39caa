"""Figures of matplotlib as bytes that depend on nothing but the figure, and colours for them.

matplotlib is an optional package, so this module, and what uses it, is imported only where a
picture is drawn. Its objects are used directly: pyplot would take half a second more, and keep
state between pictures.
"""

from __future__ import annotations

import io
from collections.abc import Callable

import matplotlib
from matplotlib.figure import Figure

# Okabe and Ito's colours: people who do not see all hues tell them apart.
BLACK, BLUE, VERMILION, GREEN = "#000000", "#0072B2", "#D55E00", "#009E73"
PURPLE, ORANGE, SKY, GREY = "#CC79A7", "#E69F00", "#56B4E9", "#8a8a8a"
SERIES = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK)
"""The colours of curves, in turn; the eighth begins anew, with another dash."""
DASHES = ("-", "--", ":", "-.")
SHAPES = "o^vsDPX"
"""Shapes of marks, which differ where colours may not be seen to."""

PIXELS = 160
"""An inch, in PNG."""
_NO_DATE = {
    "svg": {"Date": None, "Creator": None, "Format": None, "Type": None},
    "png": {"Software": None},
}


def saved(
    draw: Callable[[], Figure], kind: str, font_size: float = 9.5, *, frame: bool = True
) -> bytes:
    """A figure as the bytes of a file of that kind ("svg" or "png").

    draw: makes the figure, once whatever the user has set up for other pictures is out of the way.
    frame: draw the axes' upper and right sides.
    """
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rc("font", size=font_size)
        # Without a salt the names inside an SVG are random; paths look the same without the font.
        matplotlib.rc("svg", hashsalt="brdfc", fonttype="path")
        matplotlib.rc("axes.spines", top=frame, right=frame)
        picture = io.BytesIO()
        draw().savefig(picture, format=kind, dpi=PIXELS, metadata=_NO_DATE[kind])
        return picture.getvalue()
