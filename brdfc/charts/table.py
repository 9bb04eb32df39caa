"""The candidates of a chart as comma-separated values."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import fields

from brdfc.charts.points import Point, front

STEPS_APART = " | "
"""Stands between the names of rules, which have commas in them."""


def csv_table(points: Sequence[Point]) -> bytes:
    """A row a point, in the order given; figures as they are, to the last digit.

    The columns are the fields of Point, then whether it is on each front. An empty bound is none.
    """
    names = [field.name for field in fields(Point)]
    on_front = [set(front(points, error)) for error in ("bits", "de")]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*names, "front_bits", "front_de"])
    for point in points:
        row = [_cell(getattr(point, name)) for name in names]
        writer.writerow([*row, *(_cell(point in those) for those in on_front)])
    return text.getvalue().encode()


def _cell(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        return STEPS_APART.join(value)
    return "" if value is None else str(value)
