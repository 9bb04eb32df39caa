"""The figures the documentation quotes, measured and printed again.

    python benchmarks/figures.py [accuracy] [agreement] [speed]

accuracy   profiles through the reference engine against the formula in float64
agreement  our interpreter against the reference engine, in units in the last place
speed      whole processes: brdfc compile ward, brdfc --help
"""

from __future__ import annotations

import math
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import brdfc
from brdfc.cmm import reference
from brdfc.colour.difference import D50, ciede2000
from brdfc.lang.load import library
from brdfc.lang.model import Quantity

ANGLES = [(40, -10), (40, 0), (40, 10), (40, 30)]
RIGHT = float(np.float32(math.pi / 2))


def cyan_like(count: int, random: np.random.Generator) -> np.ndarray:
    """Coefficients Rdx, Rdy, Rdz, ks, m of prints near the paper's cyan: generated, float32."""
    low = np.array([0.10, 0.15, 0.35, 0.02, 0.08])
    high = np.array([0.20, 0.28, 0.60, 0.10, 0.30])
    return random.uniform(low, high, (count, 5)).astype(np.float32)


def eq_1(name: str, pixels: np.ndarray, incident: float, reflection: float) -> np.ndarray:
    """The two Ward forms written out in float64, independently of the compiler."""
    rd, ks, m = np.split(pixels.astype(np.float64), [3, 4], axis=-1)
    ti, tr = math.radians(incident), math.radians(reflection)
    lobe = np.exp(-(np.tan((ti - tr) / 2) ** 2) / m**2) / (4 * np.pi * m**2)
    specular = ks / np.sqrt(np.cos(ti) * np.cos(tr)) * lobe
    if name == "ward_printed":  # as printed: the highlight adds the same to X, Y and Z
        return np.cos(ti) * rd / np.pi + specular
    return np.cos(ti) * (rd / np.pi + specular * np.array(D50))


def accuracy(folder: Path) -> None:
    """CIEDE2000 against float64, 400 random sets of coefficients, the paper's four angle pairs."""
    print("CIEDE2000 (white: D50) of profiles in the reference engine against float64,")
    print("400 random cyan-like sets of coefficients (generated)")
    pixels = cyan_like(400, np.random.default_rng(1))
    for name in ("ward", "ward_printed"):
        mid, mvis = brdfc.compile(brdfc.load(name)).save(folder / f"{name}_mvis.icc")
        runs = [{"inci": math.radians(i), "refl": math.radians(r)} for i, r in ANGLES]
        xyz = reference.apply(mid, mvis, pixels, runs).xyz
        every = []
        for (incident, reflection), result in zip(ANGLES, xyz, strict=True):
            difference = ciede2000(result, eq_1(name, pixels, incident, reflection))
            every.append(difference)
            print(f"  {name:<13} {f'({incident}; {reflection})':>10}", _summary(difference))
        print(f"  {name:<13} {'all':>10}", _summary(np.concatenate(every)))


def _summary(values: np.ndarray) -> str:
    return f"median {np.median(values):.2e}  maximum {values.max():.2e}"


def agreement(folder: Path) -> None:
    """Interpreter against reference engine over the whole domain of each model."""
    print("\nOur interpreter against the reference engine, units in the last place of the result")
    print("(2,000 pixels, 200 angle pairs, edges, peaks and grazing angles included)")
    random = np.random.default_rng(2)
    for name in (n for n, entry in library().items() if entry.kind == "model"):
        model = brdfc.load(name)
        compiled = brdfc.compile(model)
        mid, mvis = compiled.save(folder / f"{name}_mvis.icc")
        pixels = np.concatenate([_draw(q, 2000, random) for q in compiled.roles.channels], axis=1)
        signatures = [q.signature for q in compiled.roles.variables]
        runs = [dict(zip(signatures, pair, strict=False)) for pair in _angle_pairs(random)]
        judged = reference.apply(mid, mvis, pixels, runs).xyz
        every = []
        for run, theirs in zip(runs, judged, strict=True):
            ours = brdfc.connect(mid, mvis, env=run).apply(pixels)
            unit = np.spacing(np.maximum(np.abs(ours), np.float32(2.0**-126))).astype(np.float64)
            every.append(np.abs(ours.astype(np.float64) - theirs) / unit)
        ulp = np.concatenate(every)
        exact = 100 * np.mean(ulp <= 0.5)
        print(f"  {name:<17} maximum {ulp.max():.2f}   within half a unit: {exact:.2f} %")


def _draw(q: Quantity, count: int, random: np.random.Generator) -> np.ndarray:
    shape = (count, q.type.value.width)
    if q.low > 0:
        values = np.exp(random.uniform(math.log(q.low), math.log(q.high), shape))
    else:
        values = random.uniform(q.low, q.high, shape)
    return np.clip(values, q.low, q.high).astype(np.float32)


def _angle_pairs(random: np.random.Generator) -> list[tuple[float, float]]:
    pairs = [(RIGHT, RIGHT), (-RIGHT, 0.2), (0.0, 0.0), (0.7, 0.7), (1.57, 1.569), (0.2, -1.2)]
    pairs += [tuple(random.uniform(-RIGHT, RIGHT, 2)) for _ in range(97)]
    for _ in range(97):
        centre = random.uniform(-RIGHT, RIGHT)
        near = centre + 10 ** random.uniform(-5, 0) * random.choice([-1, 1])
        pairs.append((centre, float(np.clip(near, -RIGHT, RIGHT))))
    return [(float(np.float32(a)), float(np.float32(b))) for a, b in pairs]


def speed(folder: Path) -> None:
    """Whole processes, seconds: median and least of nine runs each."""
    print("\nWhole processes [s], nine runs each after a first")
    brdfc_program = str(Path(sys.executable).with_name("brdfc"))
    commands = {
        "brdfc compile ward": ["compile", "ward", "-o", str(folder / "timed_mvis.icc")],
        "  the same, --effort 1": ["compile", "ward", "-o", str(folder / "t.icc"), "--effort", "1"],
        "  the same, --no-cache": ["compile", "ward", "-o", str(folder / "t.icc"), "--no-cache"],
        "brdfc --help": ["--help"],
    }
    for label, arguments in commands.items():
        seconds = []
        for _ in range(10):
            start = time.perf_counter()
            subprocess.run([brdfc_program, *arguments], check=True, capture_output=True)
            seconds.append(time.perf_counter() - start)
        counted = seconds[1:]
        print(f"  {label:<24} median {statistics.median(counted):.3f}  least {min(counted):.3f}")


def main() -> None:
    parts = {"accuracy": accuracy, "agreement": agreement, "speed": speed}
    chosen = sys.argv[1:] or list(parts)
    with tempfile.TemporaryDirectory() as folder:
        for part in chosen:
            parts[part](Path(folder))


if __name__ == "__main__":
    main()
