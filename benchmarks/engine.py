"""How fast programs run here, against the reference engine in the same run.

    python benchmarks/engine.py [--pixels 4e6] [MODEL ...]

Millions of pixels a second, best of rounds, every engine in turn in each round: the ICC's reference
engine on the same profiles, NumPy in blocks, and machine code; pixels interleaved as a TIFF has
them or in planes, on one thread and on as many as there are processors. Where gcc is there, a
kernel for Ward written by hand, and what memory allows. Results are compared with the
interpreter's.
"""

from __future__ import annotations

import argparse
import ctypes
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import brdfc
from brdfc.cmm import reference
from brdfc.compiled import Compiled
from brdfc.compiler import compile_model
from brdfc.engine import native, runs
from brdfc.engine.choice import Engine, threads_at_hand
from brdfc.engine.forms import straight_form
from brdfc.lang.load import load

ROUNDS = 7
REFERENCE_PIXELS = 100_000
ANGLES = {"incident": 0.7, "reflection": 0.3}
HERE = Path(__file__).parent


@dataclass
class Case:
    """A model made ready. pixels: (count, channels), interleaved; variables: of the run."""

    name: str
    compiled: Compiled
    link: brdfc.Link
    pixels: np.ndarray
    variables: dict[str, float]
    profiles: list[Path]


def case(name: str, count: int, folder: Path, per_pixel: bool = False) -> Case:
    """Coefficients around a model's defaults, angles fixed for the run; or, with per_pixel, in the
    full geometry and different in every pixel."""
    model = load(name, "full" if per_pixel else None)
    turned = [q.name for q in model.quantities if q.role.value == "env"] if per_pixel else []
    compiled = compile_model(model, channels=turned)
    random = np.random.default_rng(1)
    columns = []
    for q in compiled.roles.channels:
        shape = (count, q.type.value.width)
        if q.name in turned:
            low, high = max(q.low, -1.4), min(q.high, 1.4)
            columns.append(random.uniform(low, high, shape))
        else:
            near = np.array(q.default) * random.uniform(0.5, 1.5, shape)
            columns.append(np.clip(near, q.low, q.high))
    pixels = np.concatenate(columns, axis=1).astype(np.float32)
    variables = {q.name: ANGLES.get(q.name, q.default[0]) for q in compiled.roles.variables}
    signatures = {q.signature: variables[q.name] for q in compiled.roles.variables}
    saved = list(compiled.save(folder / f"{name}{'_full' * per_pixel}_mvis.icc"))
    link = brdfc.connect(*saved, env=variables)
    return Case(name, compiled, link, pixels, signatures, saved)


def seconds(function: Callable[[], object]) -> float:
    start = time.perf_counter()
    function()
    return time.perf_counter() - start


def best(functions: dict[str, Callable[[], object]], rounds: int = ROUNDS) -> dict[str, float]:
    """Seconds of each, the best of rounds in which all take turns, after one round that is not
    counted."""
    found = dict.fromkeys(functions, float("inf"))
    for function in functions.values():
        function()
    for _ in range(rounds):
        for name, function in functions.items():
            found[name] = min(found[name], seconds(function))
    return found


def planes(count: int, channels: int) -> np.ndarray:
    """Room for (count, channels), each channel in a plane."""
    return np.zeros((channels, count), np.float32).T


def ways(given: Case, threads: int) -> dict[str, Callable[[], object]]:
    """Every way to run a case."""
    link, pixels = given.link, given.pixels
    count = len(pixels)
    apart = planes(*pixels.shape)
    apart[:] = pixels
    results = {"planes": planes(count, 3), "interleaved": np.zeros((count, 3), np.float32)}
    found: dict[str, Callable[[], object]] = {}
    for engine in (Engine.BLOCKS, Engine.COMPILED):
        for layout, values in (("planes", apart), ("interleaved", pixels)):
            for several in sorted({1, threads}):

                def go(
                    engine: Engine = engine,
                    layout: str = layout,
                    values: np.ndarray = values,
                    several: int = several,
                ) -> None:
                    runs.sweep(
                        link.chain,
                        link.inputs,
                        values,
                        [link.environment],
                        [results[layout]],
                        engine=engine,
                        threads=several,
                    )

                found[f"{engine.value}, {layout}, {several}"] = go
    return found


def agreement(given: Case) -> str:
    """Of machine code with the interpreter, on the first pixels."""
    link, few = given.link, given.pixels[:REFERENCE_PIXELS]
    first, second = (
        runs.run(link.chain, link.inputs, few, link.environment, engine=e)
        for e in (Engine.INTERPRETER, Engine.COMPILED)
    )
    other = int((first.view(np.int32) != second.view(np.int32)).sum())
    return f"{other:,} of {first.size:,} values differ from the interpreter's"


def by_hand(folder: Path) -> ctypes.CDLL | None:
    """The kernels of ward.c, or None without gcc."""
    if shutil.which("gcc") is None:
        return None
    library = folder / "ward.so"
    options = ["-O3", "-march=native", "-fPIC", "-shared"]
    subprocess.run(["gcc", *options, HERE / "ward.c", "-o", library], check=True)
    return ctypes.CDLL(str(library))


def hand_ways(library: ctypes.CDLL, given: Case, threads: int) -> dict[str, Callable[[], object]]:
    """The kernels written by hand on the same pixels, in planes."""
    count = len(given.pixels)
    inputs = [np.ascontiguousarray(given.pixels[:, k]) for k in range(5)]
    outputs = [np.zeros(count, np.float32) for _ in range(3)]
    pool = ThreadPoolExecutor(threads)

    def run(function: Callable[..., None], several: int, *constants: float) -> None:
        def part(start: int, stop: int) -> None:
            places = [ctypes.c_void_p(v.ctypes.data + 4 * start) for v in inputs + outputs]
            function(*places, ctypes.c_long(stop - start), *map(ctypes.c_float, constants))

        ends = [count * k // several // 16 * 16 for k in range(several)] + [count]
        list(pool.map(part, ends[:-1], ends[1:]))

    ward = (0.041091353, 10.741724, 0.7648422)  # (40; 17) degrees, as the program has them
    found: dict[str, Callable[[], object]] = {}
    for several in sorted({1, threads}):
        found[f"C by hand, planes, {several}"] = lambda n=several: run(library.ward, n, *ward)
        found[f"copy of planes, {several}"] = lambda n=several: run(library.copy, n)
    return found


def measure(given: Case, threads: int, folder: Path) -> None:
    count = len(given.pixels)
    few = given.pixels[:REFERENCE_PIXELS]
    found = ways(given, threads)
    library = by_hand(folder) if given.name == "ward" else None
    if library is not None:
        found |= hand_ways(library, given, threads)
    theirs: list[float] = []

    def reference_run() -> None:
        done = reference.apply(*given.profiles, few, [given.variables])
        theirs.append(float(done.seconds[0]))

    times = best({"reference": reference_run, **found})
    slow = min(theirs) / len(few)
    print(f"\n{given.compiled.model.name}: {', '.join(given.link.channels)}; {agreement(given)}")
    print(f"  {'reference engine':<30} {1e-6 / slow:8.1f} Mpixel/s")
    for name in found:
        rate = count / times[name]
        print(f"  {name:<30} {rate / 1e6:8.1f} Mpixel/s  {rate * slow:6.0f} times the reference")
    if library is not None:
        compiled = min(v for k, v in times.items() if k.startswith("compiled, planes"))
        hand = min(v for k, v in times.items() if k.startswith("C by hand"))
        copied = min(v for k, v in times.items() if k.startswith("copy"))
        print(
            f"  machine code is {hand / compiled:.2f} of C by hand, {copied / compiled:.2f} of copy"
        )


def first_run(given: Case) -> None:
    """What it takes to make machine code, in a process that has made some already."""
    native._kept.clear()
    form = straight_form(given.link.chain, given.link.inputs, _arrays(given))
    assert form is not None
    shape, _ = native.shape_of(form, 1, 1)
    took = min(seconds(lambda: native.Code(shape)) for _ in range(3))
    print(f"  {given.compiled.model.name:<14} {len(form.steps):3} steps: {took * 1e3:5.1f} ms")


def _arrays(given: Case) -> dict[str, np.ndarray]:
    return {n: np.asarray(v, np.float32) for n, v in given.link.environment.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="*", default=["ward", "cook_torrance", "ggx", "oren_nayar"])
    parser.add_argument("--pixels", type=float, default=4e6)
    given = parser.parse_args()
    threads, count = threads_at_hand(), int(given.pixels)
    print(f"{count:,} pixels; layout and threads as named, of {threads} processors")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        cases = [case(model, count, folder) for model in given.models]
        for one in cases:
            measure(one, threads, folder)
        for model in ("cook_torrance", "ggx"):
            if model in given.models:
                cases.append(case(model, count, folder, per_pixel=True))
                measure(cases[-1], threads, folder)
        print("\nmaking machine code")
        for one in cases:
            first_run(one)


if __name__ == "__main__":
    main()
