"""What one input may take, and what becomes of those that take more or raise what they must not."""

from __future__ import annotations

import gc
import multiprocessing
import signal
import sys
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from multiprocessing.sharedctypes import Synchronized
from pathlib import Path
from typing import Any

SECONDS = 1.0
"""Of the processor's time."""
HANGS = 20.0
"""After so many the input is given up."""
MEGABYTES = 200
ALIKE = 3
"""Findings kept of one kind: raised at one place."""
PART = 20_000
"""Inputs of one process, so that nothing it gathers grows for ever."""


class TakesTooMuch(Exception):
    """An input that takes more time or memory than it may."""


@dataclass
class Findings:
    """Inputs that were no good, each in a file of its own with what it led to beside it. index: of
    the input under way, which a process that dies leaves behind; count: of findings."""

    folder: Path
    kinds: dict[str, int] = field(default_factory=dict)
    shared: Synchronized[Any] = field(default_factory=lambda: multiprocessing.Value("q", 0))
    found: Synchronized[Any] = field(default_factory=lambda: multiprocessing.Value("q", 0))

    @property
    def index(self) -> int:
        return int(self.shared.value)

    @index.setter
    def index(self, value: int) -> None:
        self.shared.value = value

    @property
    def count(self) -> int:
        return int(self.found.value)

    def save(self, name: str, data: bytes, what: str, kind: str) -> None:
        self.found.value += 1
        self.kinds[kind] = self.kinds.get(kind, 0) + 1
        if self.kinds[kind] <= ALIKE:
            self.folder.mkdir(parents=True, exist_ok=True)
            (self.folder / f"{name}.bin").write_bytes(data)
            (self.folder / f"{name}.txt").write_text(what)
            print(f"{name}: {what.strip().splitlines()[-1][:200]}", flush=True)


def judged(target: Callable[[bytes], bool], data: bytes, findings: Findings, name: str) -> bool:
    """Whether the target accepts the input; what it must not do is saved."""
    try:
        return limited(target, data)
    except Exception as error:
        frames = traceback.extract_tb(error.__traceback__)
        ours = [frame for frame in frames if "brdfc" in frame.filename] or frames
        kind = f"{type(error).__name__} {ours[-1].filename}:{ours[-1].lineno}"
        findings.save(name, data, traceback.format_exc(), kind)
        return False


def limited(target: Callable[[bytes], bool], data: bytes) -> bool:
    """The target's answer; TakesTooMuch where it takes too long or too much memory."""
    before = most_memory(again=True)
    started = time.process_time()
    usual = signal.signal(signal.SIGPROF, _hangs)
    signal.setitimer(signal.ITIMER_PROF, HANGS)
    try:
        accepted = target(data)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, usual)
    taken = time.process_time() - started
    if taken > SECONDS:
        raise TakesTooMuch(f"{taken:.2f} s")
    grown = (most_memory() - before) / 1024
    if grown > MEGABYTES:
        raise TakesTooMuch(f"{grown:.0f} MB")
    return accepted


def _hangs(_signal: int, _frame: object) -> None:
    raise TakesTooMuch(f"no end after {HANGS:g} s")


def most_memory(again: bool = False) -> int:
    """The most memory of this process so far, in kilobytes; again: counted from here on. 0 where
    the system does not tell."""
    try:
        if again:
            with open("/proc/self/clear_refs", "w") as file:
                file.write("5")
        with open("/proc/self/status") as file:
            return next(int(line.split()[1]) for line in file if line.startswith("VmHWM"))
    except OSError:
        return 0


def in_processes(
    run: Callable[[range], int], made: Callable[[int], bytes], numbers: range, findings: Findings
) -> int:
    """Run the numbers, a part of them in a process each; one that dies is a finding, and the next
    goes on behind the input it died of. How many were accepted."""
    context = multiprocessing.get_context("fork")
    accepted = context.Value("q", 0)

    gc.freeze()  # what is there already is not walked over again and again

    def work(part: range) -> None:
        accepted.value += run(part)

    started = time.monotonic()
    at = numbers.start
    while at < numbers.stop:
        part = range(at, min(at + PART, numbers.stop))
        process = context.Process(target=work, args=(part,))
        process.start()
        process.join()
        at = part.stop
        if process.exitcode != 0:
            at = findings.index + 1
            what = f"the process ended with {process.exitcode}"
            findings.save(f"died-{findings.index}", made(findings.index), what, what)
        rate = (at - numbers.start) / (time.monotonic() - started)
        print(f"{at:,} of {numbers.stop:,}, {rate:.0f} a second", file=sys.stderr, flush=True)
    return int(accepted.value)
