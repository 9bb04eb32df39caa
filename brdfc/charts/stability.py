"""A report of where programs fail, as a file of the kind its name says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from brdfc.charts.draw import chart_kind
from brdfc.files import write_whole
from brdfc.judge.error_map import ErrorMap
from brdfc.judge.failures import Counted, Row
from brdfc.source.errors import BrdfcError


@dataclass(frozen=True)
class Report:
    """What there is to show. title: of the model; methods: each program's name and what it is;
    note: said besides, or ""."""

    title: str
    methods: tuple[tuple[str, str], ...]
    note: str
    rows: Sequence[Row]
    counted: Sequence[Counted]
    map: ErrorMap | None


def draw_report(report: Report, path: str | Path) -> None:
    """Write a report, whole or not at all: a page (.html), a picture (.svg, .png) or the table
    alone (.csv).

    The same report gives the same bytes. Raises BrdfcError for another suffix, or where a picture
    is asked for and the model has no angle to draw it over; MissingExtraError where matplotlib is
    not installed (the table does without).
    """
    kind = chart_kind(path)
    if kind == ".csv":
        from brdfc.charts.stability_table import csv_rows

        data = csv_rows(report)
    elif kind == ".html":
        from brdfc.charts.stability_page import report_page

        data = report_page(report)
    else:
        from brdfc.charts.stability_figure import rendered_map

        if report.map is None:
            message = "there is no angle to draw a picture over"
            raise BrdfcError(message, where=str(path), hint="write a .csv or .html file")
        data = rendered_map(report.map, report.methods, report.title, kind[1:])
    write_whole(path, data)
