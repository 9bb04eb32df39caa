"""Sweeps and bodies to files: pictures, and on request the numbers behind them."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from brdfc.charts.draw import chart_kind
from brdfc.colour.picture import srgb
from brdfc.files import write_whole
from brdfc.pictures.bodies import Lit
from brdfc.pictures.sweep import QUANTITIES, Sweep, sweep_rows
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import BrdfcError, ValueGivenError

RULE = "what sRGB cannot show is clipped, component by component"


def picture_kind(path: str | Path) -> str:
    """ "svg" or "png", once it is sure that such a picture can be drawn; BrdfcError otherwise."""
    kind = Path(path).suffix.lower()
    if kind not in (".svg", ".png"):
        message = f"'{kind}' is no kind of picture" if kind else "a picture's name has a suffix"
        raise BrdfcError(message, where=str(path), hint="there is .svg and .png")
    return chart_kind(path)[1:]


def scale(text: str) -> str:
    """A name of charts.curves.SCALES; ValueGivenError for another."""
    from brdfc.charts.curves import SCALES

    if text not in SCALES:
        hint = did_you_mean(text, SCALES) or ", ".join(SCALES)
        raise ValueGivenError(f"there is no scale '{text}'", hint=hint)
    return text


def draw_sweeps(
    sweeps: Sequence[Sweep],
    path: str | Path,
    quantity: str,
    title: str,
    *,
    lobes: bool = False,
    scale: str = "linear",
    reverse: bool = False,
    note: str = "",
) -> None:
    """Curves over the reflection angle, or lobes, whole or not at all; quantity: of
    sweep.QUANTITIES."""
    from brdfc.charts.curves import Curve, Panel, rendered_curves
    from brdfc.charts.lobes import rendered_lobes

    kind = picture_kind(path)
    if scale != "linear" and not max(float(s.values(quantity).max()) for s in sweeps) > 0:
        raise ValueGivenError(f"no {QUANTITIES[quantity]} is above 0: a {scale} scale shows none")
    incidents = list(dict.fromkeys(s.incident for s in sweeps))
    labels = dict.fromkeys(s.label for s in sweeps)
    whites = dict.fromkeys(s.adapt for s in sweeps)
    # One thing that is turned fits into one panel; more would be a thicket.
    together = not lobes and len(labels) * len(whites) == 1

    def label(s: Sweep) -> str:
        parts = [s.label] if len(labels) > 1 else []
        parts += [f"light at {s.incident:g} deg"] if together else []
        parts += [f"adapted to {s.adapt}"] if s.adapt else []
        return ", ".join(parts) or s.label

    def curve(s: Sweep) -> Curve:
        return Curve(label(s), s.reflection, s.values(quantity), s.measured)

    if together:
        panels = [Panel("", [curve(s) for s in sweeps])]
    else:
        panels = [
            Panel(f"light at {i:g} deg", [curve(s) for s in sweeps if s.incident == i], i)
            for i in incidents
        ]
    name = QUANTITIES[quantity]
    if lobes:
        data = rendered_lobes(panels, title, name, kind, scale=scale, note=note)
    else:
        data = rendered_curves(panels, title, name, kind, scale=scale, reverse=reverse, note=note)
    write_whole(path, data)


def draw_strips(sweeps: Sequence[Sweep], path: str | Path, title: str, note: str = "") -> int:
    """Strips of sRGB patches, a group a label and a row an incidence; the sweeps are under D50.
    Returns how many patches sRGB cannot show."""
    from brdfc.charts.patches import Strip, Strips, rendered_strips

    kind = picture_kind(path)
    groups = []
    clipped = total = 0
    for label in dict.fromkeys(s.label for s in sweeps):
        own = [s for s in sweeps if s.label == label]
        rows = []
        for s in own:
            colours, outside = srgb(s.xyz)
            clipped, total = clipped + int(outside.sum()), total + len(colours)
            rows.append(Strip(f"{s.incident:g} deg", colours, outside))
        groups.append(Strips(label, own[0].reflection, rows))
    said = f"{clipped} of {total} patches are outside sRGB (marked): {RULE}."
    write_whole(path, rendered_strips(groups, title, " ".join((note, said)).strip(), kind))
    return clipped


def draw_bodies(
    bodies: Sequence[tuple[str, Lit]], path: str | Path, title: str, note: str = ""
) -> int:
    """Lit bodies side by side, by label; their colours are under D50. Returns how many pixels sRGB
    cannot show."""
    from brdfc.charts.patches import Body, rendered_bodies

    kind = picture_kind(path)
    drawn = []
    clipped = total = 0
    for label, one in bodies:
        picture = np.full((*one.inside.shape, 3), 0x55, np.uint8)
        colours, outside = srgb(one.xyz)
        picture[one.inside] = colours
        clipped, total = clipped + int(outside.sum()), total + len(colours)
        drawn.append(Body(label, _smooth(picture)))
    said = f"{clipped:,} of {total:,} pixels are outside sRGB: {RULE}."
    write_whole(path, rendered_bodies(drawn, title, " ".join((note, said)).strip(), kind))
    return clipped


def _smooth(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Half the size, each pixel the mean of four, so that edges are not stairs."""
    half = [n // 2 for n in picture.shape[:2]]
    blocks = picture.reshape(half[0], 2, half[1], 2, 3).astype(np.float64)
    mean: NDArray[np.uint8] = np.round(blocks.mean(axis=(1, 3))).astype(np.uint8)
    return mean


def write_sweeps(sweeps: Sequence[Sweep], path: str | Path) -> None:
    """The numbers of sweeps as CSV, whole or not at all."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(sweep_rows(sweeps))
    write_whole(path, text.getvalue().encode())


def write_bodies(bodies: Sequence[tuple[str, Lit]], path: str | Path) -> None:
    """X, Y, Z of lit bodies by place, in radii from the middle, as CSV, whole or not at all."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["source", "x", "y", "X", "Y", "Z"])
    for label, one in bodies:
        for row in np.hstack([one.places, one.xyz]).tolist():
            table.writerow([label, *(f"{v:.9g}" for v in row)])
    write_whole(path, text.getvalue().encode())
