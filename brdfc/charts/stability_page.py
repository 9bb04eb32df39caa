"""A stability report as one page: the picture, what was counted, and a table by stratum."""

from __future__ import annotations

from html import escape
from itertools import groupby
from string import Template

from brdfc.charts.stability import Report
from brdfc.charts.stability_figure import rendered_map
from brdfc.judge.failure_strata import STRATA
from brdfc.judge.failures import Counted, Row, Worst, overall
from brdfc.judge.jumps import STEP
from brdfc.judge.measure import SEEN

_HEADINGS = (
    "program",
    "points",
    "worst error, ulp",
    "bits",
    "where",
    "worst CIEDE2000",
    "where",
    "NaN",
    "infinite",
    "negative",
    "discon&shy;tinuities",
)
_PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title: where float32 fails</title>
<style>
body { font: 15px/1.45 system-ui, sans-serif; color: #1a1a1a; max-width: 1250px; margin: 1.5em auto;
  padding: 0 1em; background: #fff }
figure { margin: 0 0 1.5em }
figure svg { width: 100%; height: auto }
.scroll { overflow-x: auto }
.scroll:focus-visible { outline: 2px solid #0072B2 }
table { border-collapse: collapse; width: 100%; margin-bottom: 1.5em }
th, td { text-align: right; padding: .3em .6em; border-bottom: 1px solid #ddd; vertical-align: top }
thead th { vertical-align: bottom }
th[scope=row] { text-align: left; font-weight: normal; white-space: nowrap }
td.where, th.where { text-align: left }
th[scope=rowgroup] { text-align: left; padding-top: 1em }
th[scope=rowgroup] span { font-weight: normal; color: #444 }
td { font-variant-numeric: tabular-nums }
td.where { font: 12px/1.4 ui-monospace, monospace; overflow-wrap: anywhere; min-width: 19em }
td.bad { color: #a33c00; font-weight: bold }
</style>
</head>
<body>
<main>
$picture
<ul>
$about
</ul>
<h2>All strata</h2>
<div class="scroll" tabindex="0" role="region" aria-label="All strata">
<table>
<thead><tr>$headings</tr></thead>
<tbody>
$whole
</tbody>
</table>
</div>
<h2>By stratum</h2>
<div class="scroll" tabindex="0" role="region" aria-label="By stratum">
<table>
<thead><tr>$headings</tr></thead>
$strata
</table>
</div>
<h2>How it was measured</h2>
<ul>
$method
</ul>
</main>
</body>
</html>
"""


def report_page(report: Report) -> bytes:
    """The page, in UTF-8. It needs nothing from outside."""
    names = [name for name, _ in report.methods]
    about = [f"<b>{escape(name)}</b>: {escape(what)}" for name, what in report.methods]
    about += [escape(report.note)] if report.note else []
    headings = "".join(
        f'<th scope="col"{" class=where" if i in (0, 4, 6) else ""}>{heading}</th>'
        for i, heading in enumerate(_HEADINGS)
    )
    whole = [_row(overall(report.rows, name)) for name in names]
    whole += [_counted(c) for c in report.counted]
    text = Template(_PAGE).substitute(
        title=escape(report.title),
        about=_items(about),
        picture=_picture(report),
        headings=headings,
        whole="\n".join(whole),
        strata="\n".join(
            _stratum(stratum, list(rows))
            for stratum, rows in groupby(report.rows, key=lambda row: row.stratum)
        ),
        method=_items(_METHOD),
    )
    return text.encode()


_METHOD = (
    f"An error counts, in units in the last place (ulp), where the exact value is at least "
    f"{SEEN:g} of the peak at the same coefficients; bits are log2(1 + ulp), of which a float32 "
    f"has 24. CIEDE2000 (white: D50) counts everywhere. The worst of each stratum are confirmed "
    f"with 40 digits.",
    "Programs run in float32, rounded after every operation, a division by zero as IEEE 754 has "
    "it. NaN and infinite results are counted and are no part of the worst errors; negative ones "
    "are counted where the exact value is not negative.",
    f"Discontinuities: lines, along one number each, on which two neighbouring floats were found "
    f"whose results differ by more than {STEP:.0%} of the value, where the exact formula does not: "
    f"its own jumps, as at its horizon, do not count.",
)


def _items(texts: tuple[str, ...] | list[str]) -> str:
    return "\n".join(f"<li>{text}</li>" for text in texts)


def _picture(report: Report) -> str:
    heading = f"{escape(report.title)}: where float32 fails</h1>"
    if report.map is None:
        return f"<h1>{heading}"
    svg = rendered_map(report.map, report.methods, report.title, "svg").decode()
    svg = svg[svg.index("<svg") :]
    known = [
        f"{name}, at worst {overall(report.rows, name).bits:.1f} bits" for name, _ in report.methods
    ]
    summary = f"{report.title}: worst error over the plane of the angles. {'; '.join(known)}."
    svg = svg.replace("<svg", f'<svg role="img" aria-label="{escape(summary)}"', 1)
    return f"<h1 hidden>{heading}\n<figure>\n{svg}</figure>"


def _stratum(stratum: str, rows: list[Row]) -> str:
    heading = f"{escape(stratum)} <span>– {escape(STRATA[stratum])}</span>"
    cells = "\n".join(_row(row) for row in rows)
    group = f'<tr><th scope="rowgroup" colspan="{len(_HEADINGS)}">{heading}</th></tr>'
    return f"<tbody>\n{group}\n{cells}\n</tbody>"


def _row(row: Row) -> str:
    cells = [
        f"<td>{row.points:,}</td>",
        f"<td>{_number(row.ulp.value)}</td>",
        f"<td>{row.bits:.1f}</td>",
        _where(row.ulp),
        f"<td>{_difference(row.de.value)}</td>",
        _where(row.de),
        *map(_count, (row.failures.nan, row.failures.infinite, row.failures.negative)),
        _jumps(row),
    ]
    return f'<tr><th scope="row">{escape(row.method)}</th>{"".join(cells)}</tr>'


def _counted(c: Counted) -> str:
    counts = "".join(map(_count, (c.failures.nan, c.failures.infinite, c.failures.negative)))
    return (
        f'<tr><th scope="row">{escape(c.method)}, counted</th><td>{c.points:,}</td>'
        f"{'<td></td>' * 5}{counts}<td></td></tr>"
    )


def _where(worst: Worst) -> str:
    return f'<td class="where">{escape(worst.at)}</td>'


def _count(count: int) -> str:
    return f'<td class="bad">{count:,}</td>' if count else "<td>0</td>"


def _jumps(row: Row) -> str:
    shown = f"{row.jumps} of {row.lines} lines"
    if not row.jumps:
        return f"<td>{shown}</td>"
    largest = f"largest {row.jump.value:.2g} of the value, at {row.jump.at}"
    return f'<td class="bad" title="{escape(largest)}">{shown}</td>'


def _difference(de: float) -> str:
    return f"{de:.2f}" if de >= 0.01 else f"{de:.1e}"


def _number(value: float) -> str:
    return f"{value:,.1f}" if value < 1e6 else f"{value:.1e}"
