"""Fitting prices to times: a known table is found again, whatever the machine does meanwhile."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from numpy.typing import NDArray

from brdfc.calc.operators import OPERATORS
from brdfc.calc.prices import CONTROL, Price, Prices, read_prices, shipped
from brdfc.calc.program import Block, Program, encoded_length
from brdfc.calc.verify import verify
from brdfc.cli.calibrate_command import command
from brdfc.cmm import reference
from brdfc.cmm.calibrate import ALIKE, calibrate, predicted
from brdfc.cmm.clock import ReferenceClock
from brdfc.cmm.probes import CHANNELS, ELEMENTS, EMPTY, formulas, probes

AROUND = 83.0


@dataclass(frozen=True)
class Stub:
    """Takes exactly what a table says, but for noise and a share of passes that were disturbed."""

    table: Prices
    noise: float = 0.0
    disturbed: float = 0.0

    def together(self, blocks: Sequence[Block]) -> NDArray[np.float64]:
        chance = np.random.default_rng(5)
        times = AROUND + predicted(self.table, blocks)
        times *= 1 + self.noise * chance.standard_normal(len(times))
        times *= np.where(chance.random(len(times)) < self.disturbed, 1.6, 1.0)
        return np.asarray(times)

    def alone(self, block: Block) -> float:
        return self.table.pixel + float(predicted(self.table, [block])[0])


def a_table() -> Prices:
    chance = np.random.default_rng(3)
    rows = {
        name: Price(*chance.uniform(0.5, 20.0, 2).round(2).tolist())
        for name in (*OPERATORS, *CONTROL)
    }
    rows |= {name: rows[group[0]] for group in ALIKE for name in group}
    return Prices(47.0, 3.25, rows | {"noop": Price(0.0, 0.0)})


def first_of(table: Prices) -> dict[str, float]:
    return {name: table.dispatch + price.first for name, price in table.operators.items()}


@pytest.mark.parametrize("quick", [False, True])
def test_a_known_table_is_recovered(quick: bool) -> None:
    known = a_table()
    found = calibrate(Stub(known), quick)
    assert found.table.dispatch == pytest.approx(3.25, abs=0.01)
    assert found.table.pixel == pytest.approx(47.0, abs=0.1)
    assert found.errors.max() < 1e-3
    unmeasured = {"elem", "tint", "tJab", "fJab"}
    for name, cost in first_of(known).items():
        if name not in unmeasured:
            assert first_of(found.table)[name] == pytest.approx(cost, abs=0.05), name
    for name in ("data", "in", "tget", "mul", "tan", "sum", "copy", "smul", "curv", "clut"):
        price = found.table.operators[name]
        assert price.more == pytest.approx(known.operators[name].more, abs=0.05), name
    assert found.table.operators["elem"] == found.table.operators["mtx"]


def test_disturbances_do_not_spoil_the_table() -> None:
    found = calibrate(Stub(a_table(), noise=0.01, disturbed=0.05))
    assert np.median(found.errors) < 0.03
    assert np.quantile(found.errors, 0.85) < 0.06


def test_an_odd_clock_gives_no_negative_prices() -> None:
    found = calibrate(Stub(a_table(), noise=0.5), quick=True).table
    assert found.pixel >= 0
    assert all(price.first >= 0 and price.more >= 0 for price in found.operators.values())


def test_ratios_are_free_of_the_scale() -> None:
    known = a_table()
    twice = {n: Price(2 * p.first, 2 * p.more) for n, p in known.operators.items()}
    found = calibrate(Stub(known))
    slower = Prices(94.0, 6.5, twice)
    assert found.errors_of(slower).max() < 1e-3
    ratios = found.ratios_to(slower)
    assert all(ratios[name] == pytest.approx(1, abs=0.02) for name in ("mul", "tan", "sel"))


def test_probes_and_formulas_verify_and_are_the_same_every_time() -> None:
    every = [*(b for p in probes() for b in (p.few, p.many)), *formulas(1, 60)]
    for block in (*every, EMPTY):
        verify(Program(CHANNELS, 3, block, ELEMENTS))
    assert formulas(1, 60) == formulas(1, 60)
    assert formulas(1, 10) != formulas(2, 10)
    lengths = [encoded_length(block) for block in formulas(2, 60)]
    assert min(lengths) < 20
    assert max(lengths) > 80


def test_the_reference_engine_can_be_timed(tmp_path: Path) -> None:
    pytest.importorskip("iccdev", reason="the reference engine (extra `verify`) is not installed")
    clock = ReferenceClock(rounds=2, repeat=2, pixels=200)
    short, long = clock.together([EMPTY, EMPTY * 30])
    assert 0 < short < long
    assert clock.alone(EMPTY) > 0


def test_the_command_writes_a_table_that_is_read_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    known = a_table()
    monkeypatch.setattr("brdfc.cmm.clock.ReferenceClock", lambda **_options: Stub(known))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    path = tmp_path / "prices.toml"
    done = CliRunner().invoke(command, ["--quick", "-o", str(path)])
    assert done.exit_code == 0, done.output
    assert "prediction error over 60 programs: median" in done.output
    assert "shipped table, scaled to this machine: median" in done.output
    assert "farthest from the shipped ratios" in done.output
    assert f"BRDFC_PRICES={path}" in done.output
    assert first_of(read_prices(path))["tan"] == pytest.approx(first_of(known)["tan"], abs=0.05)

    own = tmp_path / "config" / "brdfc" / "prices.toml"
    own.parent.mkdir(parents=True)
    own.write_text("broken")  # a new table is the way out of a broken one
    done = CliRunner().invoke(command, ["--quick"])
    assert done.exit_code == 0, done.output
    assert read_prices(own).dispatch > 0


def test_without_the_reference_engine_the_error_says_how_to_get_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from brdfc.source.errors import MissingExtraError

    monkeypatch.setattr(reference, "available", lambda: False)
    with pytest.raises(MissingExtraError, match="not installed"):
        calibrate(ReferenceClock(), quick=True)
    assert shipped().dispatch > 0
