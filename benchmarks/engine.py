"""How fast programs run here, against the reference engine in the same run.

    python benchmarks/engine.py [--pixels 1e6] [MODEL ...]

Millions of pixels a second, best of rounds, angles fixed for the run: the reference engine on the
same profile, our interpreter one operator at a time, and the way without jumps that is usually
taken. Results of the last two are compared bit by bit.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import brdfc
from brdfc.cmm import reference
from brdfc.compiler import compile_model
from brdfc.engine import blocks, interpreter
from brdfc.lang.load import load

ROUNDS = 5
REFERENCE_PIXELS = 100_000


def seconds(function: Callable[[], object]) -> float:
    start = time.perf_counter()
    function()
    return time.perf_counter() - start


def measure(name: str, count: int, folder: Path) -> None:
    compiled = compile_model(load(name))
    random = np.random.default_rng(1)
    columns = []
    for q in compiled.roles.channels:
        factor = random.uniform(0.5, 1.5, (count, q.type.value.width))
        columns.append(np.clip(np.array(q.default) * factor, q.low, q.high))
    pixels = np.concatenate(columns, axis=1).astype(np.float32)
    angles = {"inci": 0.7, "refl": 0.3}
    env = {q.signature: angles.get(q.signature, q.default[0]) for q in compiled.roles.variables}
    mid, mvis = compiled.save(folder / f"{name}_mvis.icc")
    program, few = compiled.program, pixels[:REFERENCE_PIXELS]
    theirs, slow, quick, whole = [], [], [], []
    link = brdfc.connect(mid, mvis, env=env)
    for _ in range(ROUNDS):
        done = reference.apply(mid, mvis, few, [env])
        theirs.append(float(done.seconds[0]) * count / len(few))
        slow.append(seconds(lambda: interpreter.run(program, pixels, env)))
        quick.append(seconds(lambda: blocks.run(program, pixels, env)))
        whole.append(seconds(lambda: link.apply(pixels)))
    first, second = (run(program, few, env) for run in (interpreter.run, blocks.run))
    same = np.array_equal(first.view(np.int32), second.view(np.int32))
    rates = [count / min(times) / 1e6 for times in (theirs, slow, quick, whole)]
    print(
        f"  {name:<22} {rates[0]:9.1f} {rates[1]:11.1f} {rates[2]:7.1f} {rates[3]:12.1f} "
        f"{rates[2] / rates[0]:9.0f}   {'the same bits' if same else 'OTHER BITS'}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="*", default=["ward", "cook_torrance", "ggx", "oren_nayar"])
    parser.add_argument("--pixels", type=float, default=1e6)
    given = parser.parse_args()
    print(f"millions of pixels a second, of {int(given.pixels):,}")
    print(f"  {'':<22} reference interpreter  blocks MID and MVIS  ratio to reference")
    with tempfile.TemporaryDirectory() as folder:
        for name in given.models:
            measure(name, int(given.pixels), Path(folder))


if __name__ == "__main__":
    main()
