"""What long calculators take: to read and prove a profile, and to run a program on many pixels.

    python benchmarks/profiles.py [read] [run] [--operators N] [--pixels N]

read    a profile of about a megabyte, nearly all of it one calculator of 125,000 operators: seconds
        to read it, to prove it safe, to look for what releases of the reference engine disagree
        about, and to write it again; best of rounds
run     a program of 10,000 operators without branches on a million pixels, by each engine, a
        process each: seconds, and the peak of its memory, beside that of a process that only
        imports what it needs and makes the pixels and the results

Programs are random: constants that differ, arithmetic, functions now and then, temporaries.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from brdfc.calc.portability import portability
from brdfc.calc.price import operations
from brdfc.calc.program import Op, Program
from brdfc.calc.verify import verify
from brdfc.icc.profile import Profile
from brdfc.profiles.content import Content
from brdfc.profiles.multiplex import profile_pair

MB = 10**6
NAMES = ("a", "b", "c", "d")
TEMPORARIES = 50
ENGINES = ("interpreter", "blocks", "compiled", "auto")


def straight_program(operators: int, seed: int = 1) -> Program:
    """Four channels to three, so many operators: values fall in and out of temporaries."""
    random = np.random.default_rng(seed)
    body = [Op("in", 0, 4), Op("tput", 0, 4)]
    written = 4
    while len(body) < operators - 8:
        sources = random.integers(0, written, 2)
        target = int(random.integers(0, min(TEMPORARIES, written + 1)))
        written = max(written, target + 1)
        body += [
            Op("tget", int(sources[0]), 1),
            Op("data", value=float(np.float32(random.uniform(-1, 1)))),
            Op(str(random.choice(["mul", "add", "sub"])), 1),
            Op("sin" if random.random() < 0.2 else "neg", 1),
            Op("tget", int(sources[1]), 1),
            Op(str(random.choice(["vmin", "vmax", "add", "mul"])), 1),
            Op("tput", target, 1),
        ]
    return Program(4, 3, (*body, Op("tget", 0, 3), Op("out", 0, 3)))


def best(rounds: int, work: Callable[[], object]) -> float:
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def read(operators: int) -> None:
    program = straight_program(operators)
    pair = profile_pair(Content("Long", program, NAMES, (0.0,) * 4))
    with tempfile.TemporaryDirectory() as folder:
        _, path = pair.save(Path(folder) / "long_mvis.icc")
        profile = Profile.load(path)
        (kept,) = profile.tags["M2B0"].elements
        size = Path(path).stat().st_size
        print(f"{size / MB:.2f} MB, {operations(kept):,} operators")
        steps = {
            "read and prove": lambda: verify(Profile.load(path).tags["M2B0"].elements[0]),
            "read": lambda: Profile.load(path),
            "prove": lambda: verify(kept),
            "portability": lambda: portability(kept),
            # One that was made: of what was read and not changed the bytes are there already.
            "write": pair.mvis.to_bytes,
        }
        for name, step in steps.items():
            print(f"    {name:<16} {best(5, step):6.3f} s")


CHILD = """
import re, sys, time
import numpy as np
sys.path.insert(0, {folder!r})
from profiles import straight_program
from brdfc.engine.runs import run
pixels = np.random.default_rng(0).uniform(0, 1, ({pixels}, 4)).astype(np.float32)
results = np.ones(({pixels}, 3), np.float32)
start = time.perf_counter()
if {engine!r} != "none":
    results = run((straight_program({operators}),), 4, pixels, {{}}, engine={engine!r})
took = time.perf_counter() - start
peak = re.search(r"VmHWM:\\s*(\\d+) kB", open("/proc/self/status").read())[1]
print(took, int(peak) * 1024)
"""


def run(operators: int, pixels: int) -> None:
    """The peak is what Linux says of each process."""
    moved = pixels * (4 + 3) * 4 / MB
    print(f"{operators:,} operators, {pixels:,} pixels; inputs and results are {moved:.0f} MB")
    folder = str(Path(__file__).parent)
    base = 0.0
    for engine in ("none", *ENGINES):
        code = CHILD.format(folder=folder, pixels=pixels, engine=engine, operators=operators)
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        if done.returncode:
            sys.exit(done.stderr)
        took, peak = map(float, done.stdout.split())
        if engine == "none":
            base = peak
            print(f"    {'no run':<12} {'':9} {peak / MB:4.0f} MB")
            continue
        more = (peak - base) / MB
        print(
            f"    {engine:<12} {took:7.2f} s {peak / MB:4.0f} MB at most, {more:.0f} MB of the run"
        )


def main() -> None:
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("which", nargs="*", help="read, run; both where none is named")
    parser.add_argument("--operators", type=int)
    parser.add_argument("--pixels", type=int, default=1_000_000)
    given = parser.parse_args()
    which = given.which or ["read", "run"]
    if "read" in which:
        read(given.operators or 125_000)
    if "run" in which:
        run(given.operators or 10_000, given.pixels)


if __name__ == "__main__":
    main()
