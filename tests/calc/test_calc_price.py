"""The table of prices: complete, read from where it should be, and good at predicting."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from brdfc.calc import prices as module
from brdfc.calc.curves import CurveSet, SampledCurve
from brdfc.calc.operators import OPERATORS
from brdfc.calc.price import cost, fixed, nanoseconds, operations, price, work
from brdfc.calc.prices import (
    CONTROL,
    SHIPPED,
    parse_prices,
    prices,
    prices_in_use,
    prices_text,
    read_prices,
    shipped,
    user_file,
)
from brdfc.calc.program import Matrix, Op, Program
from brdfc.calc.samples import Samples
from brdfc.calc.tables import LookupTable
from brdfc.calc.text import assemble
from brdfc.source.errors import BrdfcError


@pytest.fixture(autouse=True)
def no_table_of_the_user(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.delenv(module.VARIABLE, raising=False)
    prices.cache_clear()
    yield
    monkeypatch.undo()
    prices.cache_clear()


# ---------------------------------------------------------------- the model


@pytest.mark.parametrize(
    ("text", "executed"),
    [
        ("in 2 mul out", [("in", 1), ("data", 1), ("mul", 1), ("out", 1)]),
        ("1 2 3 in 4 5", [("data", 3), ("in", 1), ("data", 2)]),
        ("in[0,3] tan[3] tsav[0,3] tput[0,3]", [("in", 3), ("tan", 3), ("tsav", 3), ("tput", 3)]),
        ("copy(2,3) posd(4,2) flip(3)", [("copy", 6), ("posd", 2), ("flip", 2)]),
        ("rotl(4,1) noop pop[4]", [("rotl", 4), ("noop", 1), ("pop", 4)]),
        ("sum(4) prod tran(2,3) solv(3,3)", [("sum", 3), ("prod", 1), ("tran", 6), ("solv", 1)]),
        ("in if { tan }", [("in", 1), ("if", 1), ("tan", 1)]),
        ("in if { 1 2 } else { tan }", [("in", 1), ("if_else", 1), ("tan", 1)]),
        ("in if { 1 } 2", [("in", 1), ("if", 1), ("data", 1), ("data", 1)]),
        ("env(inci) if { } else { pop 0.7 }", [("env", 1), ("if_else", 1)]),
        ("in sel case { tan } case { 1 2 } dflt { }", [("in", 1), ("sel", 1), ("tan", 1)]),
    ],
)  # fmt: skip
def test_what_is_executed_is_what_costs(text: str, executed: list[tuple[str, int]]) -> None:
    block = assemble(f"{{ {text} }}")
    assert nanoseconds(block) == pytest.approx(sum(cost(*step) for step in executed))


def test_elements_cost_by_their_size() -> None:
    curves = CurveSet((SampledCurve(0.0, 1.0, Samples.of([0, 1])),) * 3)
    table = LookupTable(2, 1, (2, 2), Samples.of([0] * 4))
    matrix = Matrix(2, 3, (0.0,) * 6, (0.0,) * 3)
    inner = Program(1, 1, assemble("{ in tan out }"))
    calls = {"curv": 3, "clut": 8, "mtx": 6}
    for element, (name, components) in zip((curves, table, matrix), calls.items(), strict=True):
        for call in (name, "elem"):
            assert nanoseconds((Op(call, 0),), (element,)) == pytest.approx(cost(name, components))
        assert nanoseconds((Op(name, 0),)) == pytest.approx(cost(name))
    body = nanoseconds(inner.body)
    assert nanoseconds((Op("calc", 0),), (inner,)) == pytest.approx(cost("calc") + body)


def test_work_takes_the_longest_block() -> None:
    counts = work(assemble("{ in if { tan[3] } else { 1 2 sin } }"))
    assert counts["data", "more"] == 1
    assert counts["sin", "first"] == 1
    assert counts["tan", "first"] == 0


# Nanoseconds a pixel that the reference engine took on the machine of the shipped table.
RECORDED = [
    ("{ in[0,3] out[0,3] }", 73),
    (
        "{ in[0,3] 0.318309873 smul[3] in[3,1] -0.0717967674 in[4,1] sq tsav[0,1] div exp "
        "0.0916193947 prod(3) tget[0,1] div sadd[3] 0.766044438 smul[3] out[0,3] }",
        195,
    ),
    (
        "{ in[5,1] cos tsav[0,1] in[6,1] cos tsav[1,1] vmin 0 gt if { in[0,3] 0.318309873 smul[3] "
        "in[3,1] 0.0795774683 mul in[5,2] sub 0.5 mul tan in[4,1] div sq exp tget[0,2] mul sqrt "
        "in[4,1] sq prod(3) div sadd[3] tget[0,1] smul[3] } else { 0 0 0 } out[0,3] }",
        373,
    ),
    (
        "{ env(vari) if { } else { pop 0.785398185 } tsav[0,1] cos tsav[1,1] env(vari) pop cos "
        "tsav[2,1] vmin 0 gt if { in[0,3] tget[1,1] 0.318309873 mul smul[3] in[3,1] 0.0795774683 "
        "mul tget[0,1] env(vari) pop sub 0.5 mul tan in[4,1] div sq exp tget[1,2] mul sqrt "
        "in[4,1] sq prod(3) div sadd[3] } else { 0 0 0 } out[0,3] }",
        363,
    ),
    (
        "{ in[0,3] in[1,3] in[4,1] gama[3] mul[3] in[0,1] 0.5 pow smul[3] in[5,1] sin in[6,1] "
        "atn2 sadd[3] out[0,3] }",
        279,
    ),
]


@pytest.mark.parametrize(("text", "took"), RECORDED)
def test_predictions_of_recorded_measurements(text: str, took: float) -> None:
    program = Program(7, 3, assemble(text))
    assert fixed() + price(program) == pytest.approx(took, rel=0.15)
    assert operations(program) >= 2


# ---------------------------------------------------------------- the table


def test_the_shipped_table_has_every_operator_and_is_in_use() -> None:
    table = prices()
    assert table == shipped()
    assert set(table.operators) == {*OPERATORS, *CONTROL}
    assert prices_in_use() is None
    assert table.dispatch > 0
    assert table.pixel > 0


def test_a_table_survives_its_text() -> None:
    text = SHIPPED.read_text(encoding="utf-8")
    comment = [line[1:].strip() for line in text.split("\n") if line.startswith("#")]
    assert prices_text(shipped(), comment) == text


def dearer(tmp_path: Path, name: str) -> Path:
    path = tmp_path / name
    text = SHIPPED.read_text(encoding="utf-8").replace("pixel = ", "pixel = 1")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def test_the_table_of_the_user_replaces_the_shipped_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = dearer(tmp_path, "config/brdfc/prices.toml")
    assert own == user_file()
    assert prices_in_use() == own
    assert fixed() > 100
    prices.cache_clear()
    named = dearer(tmp_path, "named.toml")
    monkeypatch.setenv(module.VARIABLE, str(named))
    assert prices_in_use() == named


def test_a_named_table_that_is_not_there_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(module.VARIABLE, str(tmp_path / "none.toml"))
    with pytest.raises(BrdfcError, match=r"none\.toml: cannot be read"):
        prices()


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("pixel", "pixle", "'pixle' is no price"),
        ("tan = ", "tna = ", r"'operators\.tna' is no price[^$]*tan"),
        ("[control]", "[controls]", "'controls' is no price"),
        ("sel = ", "# ", r"'control\.sel' has no price"),
        ("dispatch = ", "dispatch = true # ", "'dispatch' is not a number"),
        ("dispatch = ", "dispatch = 0 # ", "'dispatch' is 0"),
        ("mul = ", "mul = [1] # ", r"'operators\.mul' is not a pair"),
        ("mul = ", "mul = 3 # ", r"'operators\.mul' is not a pair"),
        ("mul = ", "mul = [1, -0.5] # ", r"'operators\.mul' is not a number of nanoseconds"),
        ("mul = ", "mul = [nan, 1] # ", r"'operators\.mul' is not a number of nanoseconds"),
        ("mul = ", "mul = [1, 'x'] # ", r"'operators\.mul' is not a number of nanoseconds"),
        ("mul = ", "mul = = ", "is not TOML"),
    ],
)
def test_a_broken_table_is_an_error_that_names_the_key(
    old: str, new: str, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "broken.toml"
    text = SHIPPED.read_text(encoding="utf-8")
    path.write_text(text.replace(f"\n{old}", f"\n{new}", 1), encoding="utf-8")
    with pytest.raises(BrdfcError, match=message) as caught:
        read_prices(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert "hint: " in str(caught.value)


def test_a_section_that_is_none_and_bytes_that_are_no_text(tmp_path: Path) -> None:
    with pytest.raises(BrdfcError, match="'operators' is not a section"):
        parse_prices("pixel = 1\ndispatch = 1\noperators = 1\ncontrol = 2", None)
    path = tmp_path / "bytes.toml"
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(BrdfcError, match="not UTF-8"):
        read_prices(path)
