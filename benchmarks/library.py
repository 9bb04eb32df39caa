"""Every library model in both geometries: compiled, validated, linked, judged, counted.

    python benchmarks/library.py [--points 1e7] [MODEL ...]

A line for each: seconds of a cold compilation, the price by the table, what the reference engine
says of both profiles, CIEDE2000 between that engine and the formula in float64 at random points of
the domain (median and maximum), and NaN, infinite or negative results of the program among as many
points of all strata as asked for.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np

import brdfc
from brdfc.cmm import reference
from brdfc.colour.colorimetry import XYZ_UNDER_D50
from brdfc.compiled import Compiled
from brdfc.compiler import compile_model
from brdfc.judge.rival import subject
from brdfc.judge.stability import count_failures
from brdfc.judge.strata import inside
from brdfc.lang.load import library
from brdfc.prepared import problem_of
from brdfc.symbolic.evaluate import evaluate

RUNS, PIXELS = 100, 100


def differences(compiled: Compiled, folder: Path) -> tuple[str, np.ndarray]:
    """What the reference engine says of the profiles, and its differences from the formula at
    random points of the domain, PIXELS for each of RUNS sets of variables."""
    paths = compiled.save(folder / "m_mvis.icc")
    verdicts = {" ".join(filter(None, reference.validate(path))) for path in paths}
    random = np.random.Generator(np.random.PCG64(1))
    domain, roles = compiled.formula.domain, compiled.roles
    runs = {q.name: inside(random, domain[q.name], (RUNS, 1)) for q in roles.variables}
    drawn = {
        q.name: inside(random, domain[q.name], (PIXELS, q.type.value.width)) for q in roles.channels
    }
    pixels = np.concatenate([drawn[q.name] for q in roles.channels], axis=1)
    sets = [{q.signature: float(runs[q.name][i, 0]) for q in roles.variables} for i in range(RUNS)]
    judged = reference.apply(*paths, pixels, sets).xyz
    found = []
    for i, theirs in enumerate(judged):
        fixed = {name: values[i : i + 1].astype(np.float64) for name, values in runs.items()}
        values = {**{n: v.astype(np.float64) for n, v in drawn.items()}, **fixed}
        exact = evaluate(compiled.formula.exact, values) + np.zeros((PIXELS, 1))
        found.append(XYZ_UNDER_D50.difference(theirs, exact))
    return "; ".join(sorted(verdicts)), np.concatenate(found)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("models", nargs="*")
    parser.add_argument("--points", type=float, default=1e7)
    given = parser.parse_args()
    models = given.models or [n for n, entry in library().items() if entry.kind == "model"]
    points = int(given.points)
    head = f"{'model':<30} {'geometry':<9} {'compile':>8} {'price':>8}  reference"
    print(f"{head}  median dE  max dE   NaN/inf/negative of {points:,}")
    for name in models:
        for geometry in ("plane", "full"):
            model = brdfc.load(name, geometry)
            start = time.perf_counter()
            compiled = compile_model(model, cache=False)
            seconds = time.perf_counter() - start
            with tempfile.TemporaryDirectory() as folder:
                verdict, de = differences(compiled, Path(folder))
            problem = problem_of(compiled.roles, compiled.formula)
            (counted,) = count_failures(problem, [subject(name, compiled.program, problem)], points)
            f = counted.failures
            print(
                f"{name:<30} {geometry:<9} {seconds:6.2f} s {compiled.price:5.0f} ns  {verdict:<9}"
                f"  {np.median(de):.1e}    {de.max():.1e}  {f.nan}/{f.infinite}/{f.negative}",
                flush=True,
            )


if __name__ == "__main__":
    main()
