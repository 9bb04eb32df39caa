"""Pictures of colours: strips of patches over the reflection angle, and lit bodies."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from brdfc.charts.saved import PIXELS, saved

Picture = NDArray[np.uint8]
Mask = NDArray[np.bool_]

GROUND = "#777777"
"""Around colours: a middle grey, so that neither light nor dark ones are set off."""


@dataclass(frozen=True)
class Strip:
    """A row of patches: colours (patches, 3), sRGB; clipped: those that sRGB cannot show."""

    label: str
    colours: Picture
    clipped: Mask


@dataclass(frozen=True)
class Strips:
    """Rows of patches over the same angles, in degrees."""

    title: str
    angles: NDArray[np.float64]
    rows: Sequence[Strip]


def rendered_strips(groups: Sequence[Strips], title: str, note: str, kind: str) -> bytes:
    """Strips of patches, as the bytes of a file of that kind ("svg" or "png").

    A patch that sRGB cannot show has a small triangle in its corner. note: under the title.
    """

    def draw() -> Figure:
        rows = sum(len(group.rows) for group in groups)
        body = 0.42 * rows + 0.75 * len(groups)
        figure, tall, y = _sheet(9.5, body, title, note)
        for group in groups:
            height = 0.42 * len(group.rows)
            y -= 0.3 + height
            axes = figure.add_axes((0.13, y / tall, 0.84, height / tall))
            _strips(axes, group)
            y -= 0.45
        return figure

    return saved(draw, kind)


@dataclass(frozen=True)
class Body:
    """A lit body: picture (rows, columns, 3), sRGB."""

    title: str
    picture: Picture


def rendered_bodies(bodies: Sequence[Body], title: str, note: str, kind: str) -> bytes:
    """Lit bodies side by side, as the bytes of a file of that kind ("svg" or "png")."""

    def draw() -> Figure:
        across = min(len(bodies), 4)
        down = -(-len(bodies) // across)
        side = max(b.picture.shape[0] for b in bodies) / PIXELS  # a pixel for a pixel
        width = max(across * (side + 0.15) + 0.3, 5.0)
        figure, tall, top = _sheet(width, down * (side + 0.35) + 0.1, title, note)
        for i, body in enumerate(bodies):
            row, column = divmod(i, across)
            left = 0.2 + column * (side + 0.15)
            bottom = top - (row + 1) * (side + 0.35)
            axes = figure.add_axes((left / width, bottom / tall, side / width, side / tall))
            axes.imshow(body.picture, interpolation="nearest")
            axes.set_title(body.title, loc="left", fontsize=10, parse_math=False)
            axes.set_axis_off()
        return figure

    return saved(draw, kind)


def _sheet(width: float, body: float, title: str, note: str) -> tuple[Figure, float, float]:
    """A figure with its title and note, its height, and where they end, in inches from below."""
    lines = textwrap.wrap(title, int(10.5 * width), max_lines=2, placeholder=" …")
    small = textwrap.wrap(note, int(13.5 * width))
    tall = 0.2 + 0.24 * len(lines) + 0.18 * len(small) + body
    figure = Figure(figsize=(width, tall), facecolor="white")
    y = tall - 0.1
    for line in lines:
        figure.text(
            0.2 / width, y / tall, line, va="top", fontsize=12, fontweight="bold", parse_math=False
        )
        y -= 0.24
    for line in small:
        figure.text(0.2 / width, y / tall, line, va="top", color="#444444", parse_math=False)
        y -= 0.18
    return figure, tall, y


def _strips(axes: Axes, group: Strips) -> None:
    angles = group.angles
    step = float(angles[1] - angles[0]) if len(angles) > 1 else 5.0
    left, right = float(angles[0]) - step / 2, float(angles[-1]) + step / 2
    count = len(group.rows)
    axes.set_facecolor(GROUND)
    for index, row in enumerate(group.rows):
        extent = (left, right, index + 0.92, index + 0.08)
        axes.imshow(row.colours[None], extent=extent, aspect="auto", interpolation="nearest")
        for angle in angles[row.clipped]:
            # Black on white, so that it is seen on any colour.
            corner = (float(angle) + 0.34 * step, index + 0.8)
            axes.plot(*corner, "^", color="white", markersize=4.5, markeredgecolor="black", mew=0.6)
    axes.set_xlim(left, right)
    axes.set_ylim(count, 0)
    axes.set_yticks(np.arange(count) + 0.5, labels=[row.label for row in group.rows])
    axes.tick_params(axis="y", length=0)
    axes.set_xticks([a for a in angles if round(a) % 20 == 0])
    axes.set_xlabel("reflection angle [deg]", labelpad=2)
    axes.set_title(group.title, loc="left", fontsize=10, parse_math=False)
