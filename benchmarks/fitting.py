"""How well models are fitted: to real paints, from random starts, and how sure the answers are.

    python benchmarks/fitting.py paints|starts|intervals [--data ../shared/data/cornell]

paints: the mean CIEDE2000 and the time of fits to measured coatings. starts: of 200 random starts,
how many come within 1 % of the best, by the recipe from one start, from twelve, and by Nelder and
Mead's method alone. intervals: how many of 200 intervals of 95 % hold the truth of generated
measurements, with noise of 1 % and 5 %, and with 3 % that all bands of a geometry share. The first
two need Cornell's files, as they travel with
pbrt-v2.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # small systems: threads only wait

import argparse
import time
from pathlib import Path

import numpy as np

from brdfc.colour.conditions import viewing_conditions
from brdfc.fit.colours import to_xyz
from brdfc.fit.fit import fit, in_ranges, response_to
from brdfc.fit.fitting import Method, search
from brdfc.fit.formats import read_measurements
from brdfc.fit.measurements import Kind, Measurements, checked
from brdfc.lang.load import load

HERE = Path(__file__).resolve().parents[1]
TRIALS = 200
PAINTS = (
    ("garnet_red", "ward", {}),
    ("garnet_red", "ggx", {}),
    ("garnet_red", "ggx", {"ks": (0.0, 10.0)}),
    ("garnet_red", "cook_torrance", {}),
    ("garnet_red", "abc_microfacet", {}),
    ("acryl_blue", "ward", {}),
    ("acryl_blue", "ggx", {}),
    ("mystique", "ggx", {}),
)


def paint(folder: Path, name: str) -> Measurements:
    return to_xyz(read_measurements(folder / f"{name}.brdf"), viewing_conditions())


def paints(folder: Path) -> None:
    print("CIEDE2000: mean, 95 %; seconds; starts that came to the best of twelve")
    for name, model, ranges in PAINTS:
        measured = paint(folder, name)
        start = time.perf_counter()
        found = fit(load(model, "full"), measured, ranges=ranges)
        took = time.perf_counter() - start
        assert found.difference is not None
        mean, most, _ = found.difference
        wide = "".join(f", {n} up to {high:g}" for n, (_, high) in ranges.items())
        state = "" if found.converged else "  DID NOT CONVERGE"
        print(
            f"  {name:<11} {model + wide:<22} {mean:6.3f} {most:7.3f} {took:6.2f} s  "
            f"{found.agreed}/{found.starts}{state}"
        )


def starts(folder: Path) -> None:
    ways = {
        "recipe, one start": {"starts": 1},
        "recipe, twelve starts": {},
        "Nelder-Mead alone": {"starts": 1, "method": Method.SIMPLEX},
    }
    for name, model, ranges in (
        ("garnet_red", "ward", {}),
        ("garnet_red", "ggx", {"ks": (0.0, 10.0)}),
        ("acryl_blue", "ward", {}),
    ):
        measured = paint(folder, name)
        response = response_to(in_ranges(load(model, "full"), ranges), measured)
        ends = {way: [] for way in ways}
        seconds = dict.fromkeys(ways, 0.0)
        said = dict.fromkeys(ways, 0)
        for seed in range(TRIALS):
            for way, how in ways.items():
                start = time.perf_counter()
                found = search(response, measured, seed=seed, **how)
                seconds[way] += time.perf_counter() - start
                ends[way].append(found.loss)
                said[way] += found.converged
        best = min(min(losses) for losses in ends.values())
        print(f"{name}, {model}: the least mean CIEDE2000 is {best:.3f}")
        for way, losses in ends.items():
            near = np.mean(np.array(losses) <= best * 1.01)
            print(
                f"  {way:<22} {near:6.1%} within 1 %, worst {max(losses):.2f}, "
                f"{said[way] / TRIALS:.0%} say that they converged, "
                f"{seconds[way] / TRIALS:.2f} s each"
            )


def directions(count: int, seed: int = 0) -> np.ndarray:
    """At seven incidences, half of them near the mirror direction."""
    random = np.random.default_rng(seed)
    incident = random.choice(np.radians([10.0, 20, 30, 40, 50, 60, 70]), count)
    near = random.random(count) < 0.5
    spread = random.normal(0, 0.15, (2, count))
    zenith = np.where(near, np.abs(incident + spread[0]), random.uniform(0, 1.3, count))
    azimuth = np.where(near, np.pi + spread[1], random.uniform(-3, 3, count))
    return np.stack([incident, np.minimum(zenith, 1.35), 0 * incident, azimuth], axis=1)


def intervals(_folder: Path) -> None:
    white = viewing_conditions().white
    at = directions(200)
    for model, truth in (
        ("ward", (0.1, 0.2, 0.6, 0.05, 0.15)),
        ("ggx", (0.1, 0.2, 0.6, 0.5, 0.2, 0.05)),
    ):
        loaded = load(model, "full")
        empty = checked(at, np.ones((len(at), 3)), Kind.XYZ, white=white, name="generated")
        clean = response_to(loaded, empty).values(np.array(truth))
        for objective in ("cube-root", "de2000"):
            for noise, bands in ((0.01, 3), (0.05, 3), (0.03, 1)):
                inside = np.zeros(len(truth))
                for trial in range(TRIALS):
                    random = np.random.default_rng(trial)
                    noisy = clean * (1 + noise * random.standard_normal((len(clean), bands)))
                    measured = checked(at, noisy, Kind.XYZ, white=white, name="generated")
                    found = fit(loaded, measured, objective=objective, starts=3)
                    pairs = zip(found.estimates, truth, strict=True)
                    inside += [e.low <= value <= e.high for e, value in pairs]
                shares = ", ".join(
                    f"{e.name} {share:.1%}"
                    for e, share in zip(found.estimates, inside / TRIALS, strict=True)
                )
                kind = "of a geometry" if bands == 1 else "of a band"
                print(f"{model}, {objective}, noise {kind} of {noise:.0%}: {shares}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["paints", "starts", "intervals"])
    parser.add_argument("--data", type=Path, default=HERE.parent / "shared" / "data" / "cornell")
    given = parser.parse_args()
    {"paints": paints, "starts": starts, "intervals": intervals}[given.what](given.data)


if __name__ == "__main__":
    main()
