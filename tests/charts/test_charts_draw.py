"""Charts as files: the same bytes twice, all formats, nothing from outside, clear errors."""

from __future__ import annotations

import csv
import random
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest

from brdfc.charts.draw import draw
from brdfc.charts.points import AS_WRITTEN, Point, front
from brdfc.charts.table import STEPS_APART
from brdfc.source.errors import BrdfcError, MissingExtraError

TITLE = 'Ward <b>&amp; "friends"</b>: $x$ and $price'


def points(count: int) -> list[Point]:
    chance = random.Random(count)
    made = []
    for i in range(count):
        bits = chance.choice([6.0, 12.0, 19.0]) + chance.random()
        made.append(
            Point(
                layer="forms",
                name=f"form {i}" if i else AS_WRITTEN,
                price=chance.uniform(110, 250),
                bits=bits,
                mean_bits=bits / 4,
                de=10 ** (-6 + bits / 4),
                operators=chance.randrange(20, 60),
                formula="(x < 1 & y > '2')" * chance.randrange(1, 6),
                steps=("reciprocal once, back", "half angle")[: i % 3],
                bound_bits=bits + 2 if i % 4 == 0 else None,
                chosen=i == count // 2,
            )
        )
    return made


@pytest.mark.parametrize("kind", ["svg", "png", "html", "csv"])
@pytest.mark.parametrize("count", [1, 3, 60])
def test_the_same_points_give_the_same_bytes(tmp_path: Path, kind: str, count: int) -> None:
    first, second = tmp_path / f"a.{kind}", tmp_path / f"b.{kind}"
    draw(points(count), first, TITLE)
    draw(points(count), second, TITLE)
    assert first.read_bytes() == second.read_bytes()
    assert sorted(p.name for p in tmp_path.iterdir()) == [f"a.{kind}", f"b.{kind}"]


def test_pictures_are_what_their_names_say(tmp_path: Path) -> None:
    draw(points(5), tmp_path / "a.svg", TITLE)
    draw(points(5), tmp_path / "a.PNG", TITLE)
    assert ElementTree.parse(tmp_path / "a.svg").getroot().tag.endswith("svg")
    assert (tmp_path / "a.PNG").read_bytes().startswith(b"\x89PNG")
    assert b"<dc:date>" not in (tmp_path / "a.svg").read_bytes()


def test_extreme_figures_can_be_drawn(tmp_path: Path) -> None:
    extremes = [
        Point("forms", AS_WRITTEN, 1e-3, 0.0, 0.0, 0.0, 0, "0", (), 0.0, False),
        Point("engines", "slow", 1e7, 32.0, 31.0, 99.0, 10**6, "x" * 10**5, (), 500.0, True),
        Point("forms", "a name " * 40, 5.0, 1e-9, 0.0, 1e-12, 1, "$\\frac", ("a",), None, False),
    ]
    draw(extremes, tmp_path / "a.svg", "a title " * 60)
    draw(extremes, tmp_path / "a.html", "")


def test_equal_points_can_be_drawn(tmp_path: Path) -> None:
    equal = [Point("forms", f"f{i}", 9.0, 5.0, 1.0, 1e-3, 9, "x", (), None, False) for i in "abc"]
    draw(equal, tmp_path / "a.svg", TITLE)


def test_the_table_holds_every_figure(tmp_path: Path) -> None:
    made = points(30)
    draw(made, tmp_path / "a.csv", TITLE)
    with (tmp_path / "a.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    read = [
        Point(
            layer=row["layer"],
            name=row["name"],
            price=float(row["price"]),
            bits=float(row["bits"]),
            mean_bits=float(row["mean_bits"]),
            de=float(row["de"]),
            operators=int(row["operators"]),
            formula=row["formula"],
            steps=tuple(row["steps"].split(STEPS_APART)) if row["steps"] else (),
            bound_bits=float(row["bound_bits"]) if row["bound_bits"] else None,
            chosen=row["chosen"] == "yes",
        )
        for row in rows
    ]
    assert read == made
    for error in ("bits", "de"):
        on_front = {row["name"] for row in rows if row[f"front_{error}"] == "yes"}
        assert on_front == {p.name for p in front(made, error)}


class Page(HTMLParser):
    """What tests need of a page: its tags with their attributes, and its text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.words = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        self.words += data


@pytest.fixture
def page(tmp_path: Path) -> str:
    draw(points(12), tmp_path / "a.html", TITLE)
    return (tmp_path / "a.html").read_text(encoding="utf-8")


def test_the_page_needs_nothing_from_outside(page: str) -> None:
    for tag, attributes in Page(page).tags:
        assert tag not in ("link", "iframe", "object", "embed", "img", "base")
        assert "src" not in attributes
        for key, value in attributes.items():
            if key in ("href", "xlink:href"):
                assert value is not None
                assert value.startswith("#")
    assert not re.findall(r"url\((?!#)|@import|fetch\(|XMLHttpRequest|import\(", page)
    # What is left are the names of SVG's namespaces, which nothing fetches.
    outside = set(re.findall(r"https?://[^\"' ]*", page))
    assert outside == {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"}


def test_the_page_shows_texts_as_they_are(page: str) -> None:
    assert "<b>" not in page
    assert "(x < 1" not in page
    read = Page(page)
    assert TITLE in read.words
    assert "(x < 1 & y > '2')" in read.words


def test_every_mark_says_what_it_is_without_a_script(page: str) -> None:
    marks = re.findall(r'<g id="(\w+)-(\d+)" class="mark"[^>]*tabindex="(-?\d)"><title>', page)
    assert len(marks) == 24
    assert {panel for panel, _, _ in marks} == {"bits", "de"}
    reachable = {(panel, int(index)) for panel, index, stop in marks if stop == "0"}
    assert {("bits", 0), ("de", 0), ("bits", 6), ("de", 6)} <= reachable
    made = points(12)
    assert all(("de", made.index(p)) in reachable for p in front(made, "de"))


@pytest.mark.parametrize("name", ["a.pdf", "a", "a.svg.gz"])
def test_other_kinds_are_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(BrdfcError, match=r"no kind of chart\nhint: there is \.svg, \.png, \.html"):
        draw(points(3), tmp_path / name, TITLE)
    assert not list(tmp_path.iterdir())


def test_no_points_are_refused(tmp_path: Path) -> None:
    with pytest.raises(BrdfcError, match="nothing to chart"):
        draw([], tmp_path / "a.svg", TITLE)


def test_two_points_of_one_name_are_refused(tmp_path: Path) -> None:
    with pytest.raises(BrdfcError, match="forms, as written: two points"):
        draw([*points(3), *points(3)], tmp_path / "a.csv", TITLE)


@pytest.mark.parametrize("kind", ["svg", "png", "html"])
def test_without_matplotlib_the_extra_is_named(
    tmp_path: Path, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'brdfc\[plot\]'"):
        draw(points(3), tmp_path / f"a.{kind}", TITLE)
    assert not list(tmp_path.iterdir())
    draw(points(3), tmp_path / "a.csv", TITLE)


def test_a_chart_leaves_the_settings_of_other_pictures_alone(tmp_path: Path) -> None:
    import matplotlib

    matplotlib.rcParams["font.size"] = 13.0
    draw(points(3), tmp_path / "a.svg", TITLE)
    assert matplotlib.rcParams["font.size"] == 13.0
    matplotlib.rcParams["font.size"] = 31.0
    draw(points(3), tmp_path / "b.svg", TITLE)
    matplotlib.rcdefaults()
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
