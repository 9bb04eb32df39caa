"""The figures of a stability report as comma-separated values."""

from __future__ import annotations

import csv
import io

from brdfc.charts.stability import Report
from brdfc.judge.failures import EVERYWHERE, Failures, Row

COLUMNS = (
    "stratum",
    "method",
    "points",
    "worst_ulp",
    "worst_bits",
    "worst_ulp_at",
    "worst_de",
    "worst_de_at",
    "nan",
    "infinite",
    "negative",
    "lines",
    "discontinuities",
    "largest_jump",
    "largest_jump_at",
)


def csv_rows(report: Report) -> bytes:
    """A row for each stratum and program; the last ones, of all strata, are points that were only
    counted, and have no errors."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in report.rows:
        writer.writerow(_cells(row))
    for c in report.counted:
        empty = [""] * 5
        writer.writerow(
            [EVERYWHERE, c.method, c.points, *empty, *_counts(c.failures), "", "", "", ""]
        )
    return text.getvalue().encode()


def _cells(row: Row) -> list[object]:
    errors = [row.ulp.value, row.bits, row.ulp.at, row.de.value, row.de.at]
    jumps = [row.lines, row.jumps, row.jump.value, row.jump.at]
    return [row.stratum, row.method, row.points, *errors, *_counts(row.failures), *jumps]


def _counts(failures: Failures) -> list[int]:
    return [failures.nan, failures.infinite, failures.negative]
