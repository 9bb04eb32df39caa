"""A short run of the fuzzer, the same on every machine; and what it would find is found."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import fuzz_limits
import pytest
from fuzz import fuzz, made
from fuzz_limits import Findings, in_processes, judged

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="limits are kept as POSIX does it")


@pytest.mark.parametrize(("target", "count"), [("profile", 500), ("document", 150), ("text", 300)])
def test_damaged_input_gets_an_answer(target: str, count: int, tmp_path: Path) -> None:
    findings = Findings(tmp_path)
    accepted = fuzz(target, 0, range(count), findings, whole=False)
    said = [path.read_text() for path in sorted(tmp_path.glob("*.txt"))]
    assert not findings.count, said[0]
    assert count / 20 < accepted < count * 0.9  # neither is all refused at once, nor all the same


def test_the_same_number_is_the_same_input() -> None:
    inputs = [made("profile", 1, index, whole=False) for index in range(20)]
    assert inputs == [made("profile", 1, index, whole=False) for index in range(20)]
    assert len(set(inputs)) == 20


def fails(data: bytes) -> bool:
    raise KeyError("no such")


def hangs(data: bytes) -> bool:
    while True:
        pass


def grows(data: bytes) -> bool:
    return len(b"x" * 30_000_000) > 0


@pytest.mark.parametrize(
    ("target", "said"),
    [(fails, "KeyError: 'no such'"), (hangs, "no end after 0.2 s"), (grows, " MB")],
)
def test_what_must_not_be_is_found(
    target: object, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fuzz_limits, "HANGS", 0.2)
    monkeypatch.setattr(fuzz_limits, "MEGABYTES", 10)
    if target is grows and not fuzz_limits.most_memory():
        pytest.skip("memory is read from /proc")
    findings = Findings(tmp_path)
    assert not judged(target, b"data", findings, "x")
    assert findings.count == 1
    assert (tmp_path / "x.bin").read_bytes() == b"data"
    assert said in (tmp_path / "x.txt").read_text()


def test_findings_that_are_alike_are_counted_and_some_kept(tmp_path: Path) -> None:
    findings = Findings(tmp_path)
    for index in range(5):
        judged(fails, b"data", findings, f"x{index}")
    assert findings.count == 5
    assert len(list(tmp_path.iterdir())) == 2 * fuzz_limits.ALIKE


def test_a_process_that_dies_is_found_and_the_rest_is_run(tmp_path: Path) -> None:
    findings = Findings(tmp_path)

    def run(numbers: range) -> int:
        for index in numbers:
            findings.index = index
            if index == 3:
                os.kill(os.getpid(), signal.SIGKILL)
        return len(numbers)

    accepted = in_processes(run, lambda index: bytes([index]), range(10), findings)
    assert accepted == 6
    assert (tmp_path / "died-3.bin").read_bytes() == b"\3"
    assert (tmp_path / "died-3.txt").read_text() == "the process ended with -9"
