"""A chart of price against error, as a file of the kind its name says."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from brdfc.charts.points import Point
from brdfc.charts.table import csv_table
from brdfc.files import write_whole
from brdfc.source.errors import BrdfcError, MissingExtraError


def draw(points: Sequence[Point], path: str | Path, title: str, notes: Sequence[str] = ()) -> None:
    """Chart price against worst bits and worst CIEDE2000, whole or not at all.

    path: its suffix says what is written: a picture (.svg, .png), a page to explore (.html) or a
    table (.csv). notes: lines below the chart, a table of their own in a page; a .csv has none. The
    same points give the same bytes. Raises BrdfcError for another suffix or for no points,
    MissingExtraError where matplotlib is not installed (the table does without).
    """
    kind = chart_kind(path)
    if not points:
        raise BrdfcError("there is nothing to chart: no form was measured", where=str(path))
    _refuse_twins(points)
    write_whole(path, _KINDS[kind](points, title, notes))


def chart_kind(path: str | Path) -> str:
    """The suffix of a chart's name, once it is sure that such a chart can be drawn; BrdfcError
    where it cannot. Commands ask before they search."""
    kind = Path(path).suffix.lower()
    if kind not in _KINDS:
        what = f"'{kind}' is" if kind else "a name without a suffix is"
        offered = ", ".join(_KINDS)
        raise BrdfcError(f"{what} no kind of chart", where=str(path), hint=f"there is {offered}")
    if kind != ".csv":
        _need_matplotlib()
    return kind


def _refuse_twins(points: Sequence[Point]) -> None:
    seen = set()
    for point in points:
        if (point.layer, point.name) in seen:
            where = f"{point.layer}, {point.name}"
            raise BrdfcError("two points of a chart have the same name", where=where)
        seen.add((point.layer, point.name))


def _svg(points: Sequence[Point], title: str, notes: Sequence[str]) -> bytes:
    from brdfc.charts.figure import rendered

    return rendered(points, title, "svg", notes)


def _png(points: Sequence[Point], title: str, notes: Sequence[str]) -> bytes:
    from brdfc.charts.figure import rendered

    return rendered(points, title, "png", notes)


def _html(points: Sequence[Point], title: str, notes: Sequence[str]) -> bytes:
    from brdfc.charts.page import page

    return page(points, title, notes)


def _csv(points: Sequence[Point], _title: str, _notes: Sequence[str]) -> bytes:
    return csv_table(points)


_KINDS: dict[str, Callable[[Sequence[Point], str, Sequence[str]], bytes]] = {
    ".svg": _svg,
    ".png": _png,
    ".html": _html,
    ".csv": _csv,
}


def _need_matplotlib() -> None:
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        message = "drawing a chart needs matplotlib, which is not installed"
        hint = "pip install 'brdfc[plot]'; a chart named .csv needs nothing"
        raise MissingExtraError(message, hint=hint) from None
