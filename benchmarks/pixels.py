"""How many pixels a second a model is fitted to, and whether fits are as good as single ones.

    python benchmarks/pixels.py [--model ward --model ggx] [--pixels 200000] [--geometries 40]
                                [--threads 2] [--noise 0.02] [--compare 100] [--rounds 3]

A stack of images is made from a model, with coefficients spread at random over their ranges (those
searched by their logarithm over the middle of it) and noise that grows with the signal. Printed, a
model a line:

    pixel/s    of `brdfc fit-image`, reading and writing included, best of rounds
    CPU        pixels per second of processor time, of all threads together
    converged  share of the pixels
    worse      of so many pixels fitted one by one from 12 starts (fit.fitting.search): how many
               have a root mean square that is lower by more than 1 %
"""

from __future__ import annotations

import argparse
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import tifffile

from brdfc.fit.fitting import search
from brdfc.fit.measurements import Kind, checked
from brdfc.fit.pixel_image import Fitted, Options, fit_stack
from brdfc.fit.response import Response
from brdfc.fit.stack import read_stack
from brdfc.lang.load import load

WHITE = (0.9642, 1.0, 0.8249)
ROW = 500


def geometries(count: int) -> list[tuple[int, int]]:
    """Degrees in the plane of incidence: half of them near the mirror direction."""
    incidences = (10, 25, 40, 55, 70)
    each = -(-count // len(incidences))
    near = [round(k * 4 - 2 * each / 2) for k in range((each + 1) // 2)]
    far = np.linspace(-60, 30, each - len(near)).round().astype(int).tolist()
    pairs = [(i, o) for i in incidences for o in [*(min(i + n, 80) for n in near), *far]]
    return pairs[:count]


def truths(response: Response, pixels: int) -> np.ndarray:
    random = np.random.default_rng(3)
    columns = []
    for c in response.coefficients:
        at = random.random(pixels)
        if c.logarithmic:
            columns.append(c.low * (c.high / c.low) ** (0.4 + 0.5 * at))
        else:
            columns.append(c.low + at * (c.high - c.low))
    return np.stack(columns, axis=1)


def written(
    folder: Path, name: str, pixels: int, count: int, noise: float
) -> tuple[Path, Response]:
    pairs = geometries(count)
    at = np.radians([[i, abs(o), 0, 180 if o >= 0 else 0] for i, o in pairs])
    response = Response(load(name, "full"), at, {}, WHITE)
    random = np.random.default_rng(1)
    height = -(-pixels // ROW)
    values = np.empty((height * ROW, count, 3), np.float32)
    truth = truths(response, height * ROW)
    for part in range(0, len(values), 4096):
        here = response.values(truth[part : part + 4096])
        here *= np.maximum(1 + noise * random.standard_normal(here.shape), 0.01)
        values[part : part + 4096] = here
    lines = ["# unit: brdf", "file,incident,reflection"]
    for number, (i, o) in enumerate(pairs):
        image = np.ascontiguousarray(values[:, number]).reshape(height, ROW, 3)
        tifffile.imwrite(
            folder / f"{number}.tif", image, photometric="minisblack", planarconfig="contig"
        )
        lines.append(f"{number}.tif,{i},{o}")
    path = folder / "stack.csv"
    path.write_text("\n".join(lines) + "\n")
    return path, response


def timed(name: str, path: Path, threads: int) -> tuple[Fitted, float, float]:
    wall, processor = time.perf_counter(), time.process_time()
    found = fit_stack(
        load(name, "full"),
        read_stack(path),
        path.parent / "out.tif",
        path.parent / "quality.tif",
        options=Options(threads=threads),
    )
    return found, time.perf_counter() - wall, time.process_time() - processor


def worse(path: Path, response: Response, count: int) -> int:
    """Of so many pixels, evenly spread."""
    stack = read_stack(path)
    images = [tifffile.imread(file).reshape(-1, 3) for file in stack.files]
    loss = tifffile.imread(path.parent / "quality.tif").reshape(-1, 3)[:, 0]
    empty = checked(stack.directions, np.ones((len(images), 3)), Kind.XYZ, white=WHITE)
    found = 0
    for pixel in np.linspace(0, len(loss) - 1, count).astype(int):
        values = np.array([image[pixel] for image in images], dtype=np.float64)
        single = search(response, replace(empty, values=values), "cube-root")
        found += bool(loss[pixel] > 1.01 * single.loss + 1e-6)
    return found


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--model", action="append")
    parser.add_argument("--pixels", type=int, default=200_000)
    parser.add_argument("--geometries", type=int, default=40)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--noise", type=float, default=0.02)
    parser.add_argument("--compare", type=int, default=100)
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args()
    print("model        pixel/s       CPU  converged  worse")
    for name in given.model or ["ward", "ggx"]:
        with tempfile.TemporaryDirectory() as folder:
            path, response = written(
                Path(folder), name, given.pixels, given.geometries, given.noise
            )
            runs = [timed(name, path, given.threads) for _ in range(given.rounds)]
            found, wall = runs[0][0], min(run[1] for run in runs)
            processor = min(run[2] for run in runs)
            bad = worse(path, response, given.compare)
            print(
                f"{name:<12}{found.pixels / wall:>8,.0f}{found.pixels / processor:>10,.0f}"
                f"{100 * found.fitted / found.pixels:>9.2f} %  {bad} of {given.compare}",
                flush=True,
            )


if __name__ == "__main__":
    main()
