"""The chart as one page to explore: the picture, what is under the pointer, and a table.

The page needs no network and reads well without its script: the pointer shows a mark's formula and
figures (SVG titles), the table has all. The script adds the arrow keys and a larger readout.
"""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from string import Template

from brdfc.charts.figure import mark_id, rendered
from brdfc.charts.points import AS_WRITTEN, Point, front
from brdfc.charts.template import PAGE

_HEADINGS = (
    "name",
    "price, ns a pixel",
    "worst bits",
    "mean bits",
    "proven bound, bits",
    "worst CIEDE2000",
    "operators",
    "best in",
    "formula and the rules that led to it",
)
_SHORT = 70


def page(points: Sequence[Point], title: str, notes: Sequence[str] = ()) -> bytes:
    """The page, in UTF-8. notes: a table of lines below the chart."""
    best = {error: front(points, error) for error in ("bits", "de")}
    text = Template(PAGE).substitute(
        title=escape(title),
        picture=_picture(points, title, best),
        headings="".join(f'<th scope="col">{heading}</th>' for heading in _HEADINGS),
        rows="\n".join(_row(point, best) for point in sorted(points, key=lambda p: p.price)),
        notes=_notes(notes),
    )
    return text.encode()


def _notes(notes: Sequence[str]) -> str:
    rows = "\n".join(f"<tr><td>{escape(note)}</td></tr>" for note in notes)
    return f"<table>\n<tbody>\n{rows}\n</tbody>\n</table>" if notes else ""


def _picture(points: Sequence[Point], title: str, best: dict[str, tuple[Point, ...]]) -> str:
    """The SVG, its marks made readable and reachable by the keyboard."""
    svg = rendered(points, title, "svg").decode()
    svg = svg[svg.index("<svg") :]  # the declaration and the document type have no place in a page
    summary = f"{title}. Two panels: price against worst bits, price against worst CIEDE2000."
    svg = svg.replace("<svg", f'<svg role="group" aria-label="{escape(summary)}"', 1)
    for error, on_front in best.items():
        for index, point in enumerate(points):
            known = escape(_about(point))
            # One stop of the Tab key for each point that has a name; arrow keys reach the others.
            named = point in on_front or point.chosen or point.name == AS_WRITTEN
            mark = (
                f'<g id="{mark_id(error, index)}" class="mark" role="img" aria-label="{known}" '
                f'data-panel="{error}" data-price="{point.price!r}" '
                f'tabindex="{0 if named else -1}"><title>{known}</title>'
            )
            svg = svg.replace(f'<g id="{mark_id(error, index)}">', mark, 1)
    return svg


def _about(point: Point) -> str:
    """A point in words."""
    marks = ", chosen" if point.chosen else ""
    bound = "" if point.bound_bits is None else f", proven below {point.bound_bits:.2f}"
    steps = f"\nby: {'; '.join(point.steps)}" if point.steps else ""
    return (
        f"{point.name}{marks}\n{point.price:.0f} ns a pixel, {point.operators} operators\n"
        f"worst {point.bits:.2f} bits (mean {point.mean_bits:.2f}{bound}), "
        f"worst CIEDE2000 {point.de:.1e}\n{point.formula}{steps}"
    )


def _row(point: Point, best: dict[str, tuple[Point, ...]]) -> str:
    words = {"bits": "bits", "de": "CIEDE2000"}
    fronts = " and ".join(words[error] for error, those in best.items() if point in those)
    cells = (
        f"{point.price:.1f}",
        f"{point.bits:.2f}",
        f"{point.mean_bits:.2f}",
        "" if point.bound_bits is None else f"{point.bound_bits:.2f}",
        f"{point.de:.1e}",
        f"{point.operators}",
        fronts,
    )
    kind = ' class="chosen"' if point.chosen else ' class="front"' if fronts else ""
    name = escape(point.name) + (" (chosen)" if point.chosen else "")
    figures = "".join(f"<td>{cell}</td>" for cell in cells)
    return f'<tr{kind}><th scope="row">{name}</th>{figures}<td>{_formula(point)}</td></tr>'


def _formula(point: Point) -> str:
    """The formula, folded up where it is long, with its steps."""
    whole = f"<code>{escape(point.formula)}</code>"
    steps = "".join(f"<li>{escape(step)}</li>" for step in point.steps)
    more = f"<ol>{steps}</ol>" if steps else ""
    if len(point.formula) <= _SHORT and not more:
        return whole
    start = point.formula[:_SHORT] + (" …" if len(point.formula) > _SHORT else "")
    return f"<details><summary><code>{escape(start)}</code></summary>{whole}{more}</details>"
