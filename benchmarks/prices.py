"""What the price model predicts against what the reference engine takes.

    python benchmarks/prices.py [TABLE.toml]

Every library model, with its angles as variables, fixed, and from the pixel, and formulas at
random, each a profile of its own. The table is the one in use, or TABLE.toml. Prices of another
machine are scaled: only their ratios count, and the factor is printed.
"""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import brdfc
from brdfc.calc.price import fixed, operations, price
from brdfc.calc.prices import VARIABLE as PRICES
from brdfc.calc.program import Program
from brdfc.cmm import reference
from brdfc.cmm.probes import CHANNELS, ELEMENTS, VARIABLE, formulas, pixels
from brdfc.lang.load import library
from brdfc.profiles.content import Content
from brdfc.profiles.multiplex import ProfilePair, profile_pair
from brdfc.source.errors import SelfCheckError

ANGLES = {"incident": 0.7, "reflection": 0.4}
TURNS, REPEAT, PIXELS = 2, 60, 1000
Case = tuple[str, Program, ProfilePair, np.ndarray, dict[str, float]]


def models() -> Iterator[Case]:
    """The library as it is compiled."""
    for name, entry in library().items():
        if entry.kind != "model":
            continue
        model = brdfc.load(name)
        angles = {q.name: ANGLES[q.name] for q in model.quantities if q.name in ANGLES}
        ways = [("", {}, ()), (" fixed", angles, ()), (" curved", {}, tuple(angles))]
        for way, values, channels in ways:
            try:
                compiled = brdfc.compile(model, values, channels)
            except SelfCheckError:
                print(f"left out: {name}{way}, which does not pass its self-check")
                continue
            chance = np.random.default_rng(1)
            columns = [
                chance.uniform(max(q.low, -1.5), min(q.high, 1.5), (PIXELS, q.type.value.width))
                for q in compiled.roles.channels
            ]
            signatures = {q.signature: ANGLES[q.name] for q in compiled.roles.variables}
            yield name + way, compiled.program, compiled.pair, np.hstack(columns), signatures


def at_random() -> Iterator[Case]:
    """Formulas that no price was fitted to."""
    names = [f"c{k}" for k in range(CHANNELS)]
    for number, block in enumerate(formulas(3, 60), 1):
        program = Program(CHANNELS, 3, block, ELEMENTS)
        pair = profile_pair(Content("Formula", program, tuple(names), (0.0,) * CHANNELS))
        yield f"formula {number}", program, pair, pixels(PIXELS), {VARIABLE: 0.4}


def measured(pair: ProfilePair, values: np.ndarray, run: dict[str, float]) -> float:
    """Nanoseconds a pixel, the least of several passes."""
    with tempfile.TemporaryDirectory() as folder:
        mid, mvis = pair.save(Path(folder) / "p_mvis.icc")
        seconds = reference.apply(mid, mvis, values, [run], REPEAT).seconds
    return float(seconds[0]) / len(values) * 1e9


def main() -> None:
    if len(sys.argv) > 1:
        os.environ[PRICES] = sys.argv[1]
    cases = [*models(), *at_random()]
    # Turns lie apart, so that a disturbance does not last through all of a program's.
    turns = [[measured(*case[2:]) for case in cases] for _ in range(TURNS)]
    rows = [
        (name, operations(program), fixed() + price(program), min(took))
        for (name, program, *_), *took in zip(cases, *turns, strict=True)
    ]
    scale = statistics.median(took / predicted for _, _, predicted, took in rows)
    print(f"{'program':24}{'operators':>10}{'predicted':>11}{'measured':>10}{'ratio':>7}")
    for name, count, predicted, took in rows:
        ratio = scale * predicted / took
        print(f"{name:24}{count:10}{scale * predicted:8.0f} ns{took:7.0f} ns{ratio:7.2f}")
    errors = [abs(scale * predicted / took - 1) for _, _, predicted, took in rows]
    within = sum(error <= 0.15 for error in errors)
    print(f"factor of this machine {scale:.2f}; {within} of {len(rows)} within 15 %;")
    low, high = np.percentile(errors, [50, 90]) * 100
    print(f"median error {low:.1f} %, 90th percentile {high:.1f} %, worst {max(errors):.1%}")


if __name__ == "__main__":
    main()
