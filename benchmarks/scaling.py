"""How time grows: with pixels, with operators, with threads; and a picture of it.

    python benchmarks/scaling.py [-o docs/engine.svg] [--most 1e8]

Ward with its angles fixed, coefficients in planes. For each size the reference engine, our
interpreter, NumPy in blocks and machine code, the latter also with what it takes to make it in a
process that has not loaded its compiler; from that, where the choice between the two ought to
change, and what the engine's own rule says.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from engine import Case, best, case, planes

from brdfc.calc.program import Op, Program
from brdfc.cmm import reference
from brdfc.engine import choice, runs
from brdfc.engine.choice import Engine, threads_at_hand
from brdfc.engine.straight import straighten
from brdfc.icc.types import Pipeline

REFERENCE_MOST, INTERPRETER_MOST = 1_000_000, 10_000_000
LENGTHS = (4, 16, 64, 256, 1024)
NAMES = ("reference", "interpreter", "blocks", "compiled")

Series = dict[str, list[tuple[float, float]]]


def link_run(
    given: Case,
    pixels: np.ndarray,
    result: np.ndarray,
    engine: Engine,
    threads: int | None = None,
) -> None:
    """A case's chain over pixels."""
    link, run = given.link, [given.link.environment]
    runs.sweep(link.chain, link.inputs, pixels, run, [result], engine=engine, threads=threads)


def against_pixels(given: Case, most: int) -> Series:
    """Seconds for numbers of pixels."""
    found: Series = {name: [] for name in NAMES}
    link = given.link
    apart = planes(most, link.inputs)
    for start in range(0, most, len(given.pixels)):
        part = apart[start : start + len(given.pixels)]
        part[:] = given.pixels[: len(part)]
    results = planes(most, 3)
    print(
        f"\n{'pixels':>12} {'reference':>12} {'interpreter':>12} {'blocks':>12} {'compiled':>12}  s"
    )
    count = 1000
    while count <= most:
        ways = {
            engine.value: partial(link_run, given, apart[:count], results[:count], engine)
            for engine in (Engine.INTERPRETER, Engine.BLOCKS, Engine.COMPILED)
            if engine is not Engine.INTERPRETER or count <= INTERPRETER_MOST
        }
        times = best(ways, 5 if count <= 1_000_000 else 3)
        if count <= REFERENCE_MOST:
            some = np.ascontiguousarray(apart[:count])
            runs_of = [reference.apply(*given.profiles, some, [given.variables]) for _ in range(3)]
            times["reference"] = min(float(r.seconds[0]) for r in runs_of)
        for name, value in times.items():
            found[name].append((count, value))
        shown = (f"{times[n]:12.6f}" if n in times else " " * 12 for n in NAMES)
        print(f"{count:13,} {' '.join(shown)}")
        count *= 10
    return found


def against_operators(profiles: list[Path], folder: Path) -> Series:
    """Nanoseconds a pixel for programs of so many multiplications and additions."""
    from brdfc.icc.profile import Profile

    found: Series = {name: [] for name in NAMES if name != "interpreter"}
    pixels = np.random.default_rng(2).uniform(0.2, 0.8, (200_000, 5)).astype(np.float32)
    apart = planes(*pixels.shape)
    apart[:] = pixels
    mid, mvis = profiles
    base = Profile.load(mvis)
    print(f"\n{'operators':>12} {'reference':>12} {'blocks':>12} {'compiled':>12}  ns a pixel")
    for length in LENGTHS:
        body = [Op("in", 0, 1)]
        for k in range(length // 2):
            body += [Op("in", 1 + k % 4, 1), Op("mul", 1), Op("in", k % 5, 1), Op("add", 1)]
        program = Program(5, 3, (*body, Op("copy", 1, 2), Op("out", 0, 3)))
        tags = {**base.tags, "M2B0": Pipeline(5, 3, (program,))}
        path = folder / f"long_{length}.icc"
        replace(base, tags=tags).save(path)
        result = planes(len(apart), 3)
        long = partial(runs.sweep, (program,), 5, apart, [{}], [result], threads=1)
        ways = {e.value: partial(long, engine=e) for e in (Engine.BLOCKS, Engine.COMPILED)}
        times = best(ways)
        runs_of = [reference.apply(mid, path, pixels, [{}]) for _ in range(3)]
        times["reference"] = min(float(r.seconds[0]) for r in runs_of)
        for name in found:
            found[name].append((length, times[name] / len(pixels) * 1e9))
        shown = " ".join(f"{times[n] / len(pixels) * 1e9:12.2f}" for n in found)
        print(f"{length:12,} {shown}")
    return found


def against_threads(cases: list[Case]) -> Series:
    """Millions of pixels a second for numbers of threads."""
    found: Series = {}
    print(f"\n{'threads':>12}  Mpixel/s")
    for given in cases:
        apart = planes(*given.pixels.shape)
        apart[:] = given.pixels
        result = planes(len(apart), 3)
        for engine in (Engine.BLOCKS, Engine.COMPILED):
            every = range(1, threads_at_hand() + 1)
            ways = {str(n): partial(link_run, given, apart, result, engine, n) for n in every}
            times = best(ways)
            name = f"{given.name}, {engine.value}"
            found[name] = [(int(n), len(apart) / t / 1e6) for n, t in times.items()]
            shown = ", ".join(f"{n}: {rate:.0f}" for n, rate in found[name])
            print(f"{'':12}  {name:<28} {shown}")
    return found


COLD = """
import sys, time
import numpy as np
import brdfc
from brdfc.engine.choice import Engine
link = brdfc.connect(*sys.argv[1:3], env={"incident": 0.7, "reflection": 0.3}, engine="compiled")
pixels = np.full((64, 5), 0.5, np.float32)
start = time.perf_counter()
link.apply(pixels)
print(time.perf_counter() - start)
"""


def cold_start(profiles: list[Path]) -> float:
    """Seconds to the first machine code in a process that has not loaded its compiler."""
    command = [sys.executable, "-c", COLD, *map(str, profiles)]
    done = [subprocess.run(command, capture_output=True, text=True, check=True) for _ in range(5)]
    return min(float(d.stdout) for d in done)


def break_even(series: Series, cold: float, given: Case) -> None:
    """Where compiling for a run pays, measured and by the rule."""
    (count, slow), (_, quick) = series["blocks"][-1], series["compiled"][-1]
    measured = cold / ((slow - quick) / count)
    form = straighten(
        given.link.chain,
        given.link.inputs,
        {n: np.asarray(v, np.float32) for n, v in given.link.environment.items()},
    )
    print(
        f"\nthe first machine code of a process takes {cold * 1e3:.0f} ms; it pays from "
        f"{measured:,.0f} pixels on"
    )
    loaded = sys.modules.pop("llvmlite", None)  # as in a process that has not loaded it
    pixels = choice.making(form) / choice.saved(form)
    if loaded is not None:
        sys.modules["llvmlite"] = loaded
    print(f"the rule takes it from {pixels:,.0f} on")


def picture(path: str, pixels: Series, operators: Series, threads: Series) -> None:
    from matplotlib.figure import Figure

    from brdfc.charts.saved import DASHES, SERIES, SHAPES, saved

    def draw() -> Figure:
        figure = Figure(figsize=(12, 4), layout="constrained")
        left, middle, right = figure.subplots(1, 3)
        colours = dict(zip(NAMES, SERIES, strict=False))
        for axes, series, x, y in (
            (left, pixels, "pixels", "seconds"),
            (middle, operators, "operators", "ns a pixel, one thread"),
        ):
            for (name, points), mark in zip(series.items(), SHAPES, strict=False):
                line = {"color": colours[name], "marker": mark, "label": name}
                axes.loglog(*zip(*points, strict=True), **line)
            axes.set(xlabel=x, ylabel=y)
        for k, (name, points) in enumerate(threads.items()):
            line = {"color": SERIES[k // 2], "marker": SHAPES[k], "linestyle": DASHES[k % 2]}
            right.semilogy(*zip(*points, strict=True), label=name, **line)
        right.set_ylim(bottom=min(y for points in threads.values() for _, y in points) / 10)
        right.set(xlabel="threads", ylabel="Mpixel/s", xticks=range(1, threads_at_hand() + 1))
        titles = ("ward, angles fixed", "multiplications and additions", "threads")
        for axes, title in zip((left, middle, right), titles, strict=True):
            axes.set_title(title)
            axes.grid(alpha=0.3)
            axes.legend(frameon=False, fontsize=8)
        return figure

    Path(path).write_bytes(saved(draw, Path(path).suffix[1:]))
    print(f"wrote {path}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", dest="output", default="docs/engine.svg")
    parser.add_argument("--most", type=float, default=1e8)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        ward = case("ward", 1_000_000, folder)
        cold = cold_start(ward.profiles)
        pixels = against_pixels(ward, int(given.most))
        break_even(pixels, cold, ward)
        operators = against_operators(ward.profiles, folder)
        full = case("cook_torrance", 1_000_000, folder, per_pixel=True)
        full.name = "cook_torrance, angles a pixel"
        threads = against_threads([ward, full])
    picture(given.output, pixels, operators, threads)


if __name__ == "__main__":
    main()
