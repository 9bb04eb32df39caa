"""Searches remembered on disk: by content, and never in the way."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from brdfc.calc import prices as price_table
from brdfc.calc.binary import encode_element
from brdfc.calc.program import Program
from brdfc.calc.text import assemble
from brdfc.colour.colorimetry import Colorimetry
from brdfc.compiler import compile_model
from brdfc.judge import cache
from brdfc.judge.cache import folder, holds, key, recall, remember, summary
from brdfc.judge.explore import explore
from brdfc.judge.goals import GOALS, Goal
from brdfc.judge.problem import Problem
from brdfc.lang.load import load
from brdfc.prepared import prepare, problem_of
from brdfc.symbolic.expression import make, quantity, vector
from brdfc.symbolic.formula import Formula
from brdfc.symbolic.intervals import Interval
from brdfc.symbolic.serial import to_data

AIM = GOALS["balanced"]
OTHER = encode_element(Program(1, 3, assemble("{ in copy(1,2) out[0,3] }"))).hex()


@pytest.fixture(scope="module")
def ward() -> Problem:
    return problem_of(*prepare(load("ward"), {}, ()))


@pytest.fixture(scope="module")
def found(ward: Problem) -> cache.Remembered:
    explored = explore(ward, AIM, 20)
    assert explored is not None
    return summary(ward, explored)


@pytest.fixture(autouse=True)
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))


def test_what_is_remembered_comes_back(ward: Problem, found: cache.Remembered) -> None:
    assert recall("entry", ward) is None
    remember("entry", found)
    again = recall("entry", ward)
    assert again == found
    assert again is not None
    assert again.expression is found.expression


def entry() -> Path:
    return folder() / "entry.json"


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"{",
        b"null",
        b"[]",
        b"{}",
        b"\xff\xfe",
        b"[" * 100_000,
        b'{"derivation": [], "expression": [["pi", [], null]]}',
        b" " * (2 << 20),
    ],
    ids=["empty", "cut", "null", "list", "object", "binary", "deep", "no derivation", "large"],
)
def test_a_broken_file_counts_as_none(ward: Problem, text: bytes) -> None:
    entry().parent.mkdir(parents=True)
    entry().write_bytes(text)
    assert recall("entry", ward) is None


def chain(data: dict[str, Any], levels: int) -> None:
    rows = [["quantity", [], ["ks", 1]]]
    rows += [["sin", [i], None] for i in range(levels)]
    data["expression"] = [*rows, ["vector", [levels] * 3, None]]


def set_expression(*rows: list[Any]) -> Callable[[dict[str, Any]], None]:
    return lambda data: data.update(expression=list(rows))


HOSTILE: dict[str, Callable[[dict[str, Any]], None]] = {
    "unknown operator": set_expression(["quantity", [], ["Rd", 3]], ["launch", [0], None]),
    "too few arguments": set_expression(["quantity", [], ["Rd", 3]], ["add", [0], None]),
    "too many arguments": set_expression(["quantity", [], ["Rd", 3]], ["sin", [0, 0], None]),
    "a fraction over 0": set_expression(["const", [], [1, 0]]),
    "itself as argument": set_expression(["sin", [0], None]),
    "from the end": set_expression(["quantity", [], ["Rd", 3]], ["sin", [-1], None]),
    "another quantity": set_expression(["quantity", [], ["other", 3]]),
    "another width": set_expression(["quantity", [], ["ks", 3]]),
    "a scalar": set_expression(["quantity", [], ["ks", 1]]),
    "no such component": set_expression(
        ["quantity", [], ["Rd", 3]], ["component", [0], 7], ["vector", [1, 1, 1], None]
    ),
    "too deep": lambda data: chain(data, 5000),
    "text for a number": lambda data: data.update(forms="many"),
    "text for a price": lambda data: data["derivation"][0].update(price="cheap"),
    "a list for a rule": lambda data: data["derivation"][0].update(rule=["a"]),
    "no program": lambda data: data.update(program="xyz"),
    "a broken program": lambda data: data.update(program=data["program"][:-16]),
    "another program": lambda data: data.update(program=OTHER),
    "guards that are none": lambda data: data.update(guards=[["a", 1]]),
    "no figures": lambda data: data["derivation"][0].update(measured={}),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_counts_as_none(ward: Problem, found: cache.Remembered, name: str) -> None:
    remember("entry", found)
    data = json.loads(entry().read_text())
    HOSTILE[name](data)
    entry().write_text(json.dumps(data))
    assert recall("entry", ward) is None


def test_a_folder_that_cannot_be_written_is_no_error(
    ward: Problem, found: cache.Remembered, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    remember("entry", found)
    assert recall("entry", ward) is None
    assert compile_model(load("lambert")).form is not None


def test_no_home_folder_is_no_error(
    ward: Problem, found: cache.Remembered, monkeypatch: pytest.MonkeyPatch
) -> None:
    def homeless() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setattr(Path, "home", homeless)
    remember("entry", found)
    assert recall("entry", ward) is None
    assert not holds("entry")


def test_the_key_changes_with_whatever_a_search_depends_on(
    ward: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    keys = [key(ward, AIM, 20)]
    assert key(ward, AIM, 20) == keys[0]
    other = vector([make("sin", quantity("ks", 1))] * 3)
    assert to_data(other) != to_data(ward.exact)
    domain = ward.formula.domain
    narrow = {**domain, "m": Interval(0.1, 1.0)}
    keys += [
        key(replace(ward, formula=Formula(other, domain)), AIM, 20),
        key(replace(ward, formula=Formula(ward.exact, narrow)), AIM, 20),
        key(replace(ward, quantities=ward.quantities[::-1]), AIM, 20),
        key(replace(ward, colorimetry=Colorimetry((0.97, 1.0, 0.484))), AIM, 20),
        key(ward, GOALS["speed"], 20),
        key(ward, Goal("ulp", 8.0), 20),
        key(ward, AIM, 21),
    ]
    table = price_table.prices()
    one = {**table.operators, "tan": price_table.Price(99.0, 1.0)}
    for changed in (replace(table, dispatch=table.dispatch + 1), replace(table, operators=one)):
        monkeypatch.setattr(cache, "prices", lambda changed=changed: changed)
        keys.append(key(ward, AIM, 20))
    assert len(set(keys)) == len(keys)
