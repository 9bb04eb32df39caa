"""Stability reports as files: the same bytes twice, all kinds, every figure, clear errors."""

from __future__ import annotations

import csv
import sys
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from brdfc.charts.stability import Report, draw_report
from brdfc.charts.stability_table import COLUMNS
from brdfc.judge.error_map import Cells, ErrorMap
from brdfc.judge.failure_strata import STRATA
from brdfc.judge.failures import Counted, Failures, Row, Worst
from brdfc.source.errors import BrdfcError, MissingExtraError

TITLE = 'Ward <b>&amp; "friends"</b>: $x$ and $price'
PLACE = "incident=30.1234567deg reflection=30.5deg Rd=(0.1, 0.25, 1) m=0.001"
KINDS = ["html", "csv", "svg", "png"]


def report(methods: tuple[str, ...] = ("compiled", "as written"), **changed: object) -> Report:
    random = np.random.default_rng(3)
    rows = [
        Row(
            stratum,
            method,
            1666,
            Worst(2.5 ** (i + 9 * number) + 1 / 3, PLACE),
            Worst(1e-4 * 3.0**i, PLACE),
            Failures(i * number, 0, 2 * i * number),
            60,
            i * number,
            Worst(0.1 * i, PLACE if i else ""),
        )
        for i, stratum in enumerate(STRATA)
        for number, method in enumerate(methods)
    ]
    bits = random.uniform(0, 24, (6, 4))
    bits[0, 0] = np.nan
    cells = {m: Cells(bits, bits > 20) for m in methods}
    plane = ErrorMap("incident, degrees", "reflection, degrees", (-90, 90, -90, 90), 300, cells)
    made = Report(
        TITLE,
        tuple((m, f"{m} <i>by us</i>") for m in methods),
        "",
        rows,
        [Counted(m, 10**6, Failures(1, 23, 456)) for m in methods],
        plane,
    )
    return replace(made, **changed)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("methods", [("compiled",), ("compiled", "as written")])
def test_the_same_report_gives_the_same_bytes(
    tmp_path: Path, kind: str, methods: tuple[str, ...]
) -> None:
    for name in "ab":
        draw_report(report(methods), tmp_path / f"{name}.{kind}")
    assert (tmp_path / f"a.{kind}").read_bytes() == (tmp_path / f"b.{kind}").read_bytes()
    assert sorted(p.name for p in tmp_path.iterdir()) == [f"a.{kind}", f"b.{kind}"]


def test_pictures_are_what_their_names_say(tmp_path: Path) -> None:
    draw_report(report(), tmp_path / "a.svg")
    draw_report(report(), tmp_path / "a.png")
    assert ElementTree.parse(tmp_path / "a.svg").getroot().tag.endswith("svg")
    assert b"<dc:date>" not in (tmp_path / "a.svg").read_bytes()
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_a_row_of_cells_and_a_range_of_no_width_can_be_drawn(tmp_path: Path) -> None:
    cells = {m: Cells(np.zeros((1, 9)), np.zeros((1, 9), bool)) for m in ("compiled", "as written")}
    strip = ErrorMap("incident, degrees", "", (-90, 90, 0, 1), 300, cells)
    draw_report(report(map=strip), tmp_path / "a.png")
    flat = ErrorMap("incident, degrees", "reflection, degrees", (-90, 90, 40, 40.5), 3, cells)
    draw_report(report(map=flat, title="a title " * 60), tmp_path / "a.svg")


def test_the_table_holds_every_figure(tmp_path: Path) -> None:
    made = report()
    draw_report(made, tmp_path / "a.csv")
    with (tmp_path / "a.csv").open(newline="") as stream:
        read = list(csv.DictReader(stream))
    assert tuple(read[0]) == COLUMNS
    for row, cells in zip(made.rows, read[: len(made.rows)], strict=True):
        assert (cells["stratum"], cells["method"]) == (row.stratum, row.method)
        assert float(cells["worst_ulp"]) == row.ulp.value
        assert float(cells["worst_bits"]) == row.bits
        assert float(cells["worst_de"]) == row.de.value
        assert cells["worst_ulp_at"] == cells["worst_de_at"] == PLACE
        counts = [int(cells[n]) for n in ("points", "nan", "infinite", "negative", "lines")]
        f = row.failures
        assert counts == [row.points, f.nan, f.infinite, f.negative, row.lines]
        assert int(cells["discontinuities"]) == row.jumps
        assert float(cells["largest_jump"]) == row.jump.value
    for cells in read[len(made.rows) :]:
        assert cells["stratum"] == "all strata"
        assert [cells[n] for n in ("points", "nan", "negative")] == ["1000000", "1", "456"]
        assert cells["worst_ulp"] == cells["lines"] == ""


class _Page(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.text = ""
        self.links: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in ("meta", "link", "br"):
            self.open.append(tag)
        self.links += [v or "" for n, v in attrs if n in ("src", "href", "xlink:href")]

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.links += [v or "" for n, v in attrs if n in ("src", "href", "xlink:href")]

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


@pytest.mark.parametrize("with_picture", [True, False])
def test_the_page_is_whole_and_takes_nothing_from_outside(
    tmp_path: Path, with_picture: bool
) -> None:
    made = report() if with_picture else report(map=None)
    draw_report(replace(made, note="a note <u>"), tmp_path / "a.html")
    page = _Page()
    page.feed((tmp_path / "a.html").read_text(encoding="utf-8"))
    assert page.open == []
    assert all(link.startswith(("#", "data:image/png;")) for link in page.links)
    assert bool(page.links) == with_picture
    for shown in (TITLE, "as written <i>by us</i>", "a note <u>", PLACE, *STRATA, "1,000,000"):
        assert shown in page.text


def test_other_kinds_and_pictures_of_nothing_are_refused(tmp_path: Path) -> None:
    with pytest.raises(BrdfcError, match=r"'\.pdf' is no kind of chart"):
        draw_report(report(), tmp_path / "a.pdf")
    with pytest.raises(BrdfcError, match="no angle") as refused:
        draw_report(report(map=None), tmp_path / "a.png")
    assert ".csv" in str(refused.value.hint)
    assert list(tmp_path.iterdir()) == []


def test_without_matplotlib_the_table_can_still_be_had(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    draw_report(report(), tmp_path / "a.csv")
    with pytest.raises(MissingExtraError, match="matplotlib"):
        draw_report(report(), tmp_path / "a.html")
