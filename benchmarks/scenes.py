"""Profiles compiled for scenes: what they cost, whether they keep to their tolerance.

    python benchmarks/scenes.py [cyan] [time] [random [--scenes N] [--points N]]

cyan    a cyan print at (40; -10) degrees: the literal transcription, the general profile, and
        profiles for the scene; operators, nanoseconds a pixel on the reference engine and in ours
time    seconds of compiling scenes of several models, in one process that knows no search yet
random  scenes drawn at random, of models, ranges and tolerances: points beyond the tolerance, and
        how near the sampled worst comes to the proved bound (200 scenes take half an hour)
"""

from __future__ import annotations

import argparse
import math
import statistics
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from forms import EQUAL, literal

import brdfc
from brdfc.calc.price import operations
from brdfc.calc.program import Program
from brdfc.calc.text import assemble
from brdfc.cmm import reference
from brdfc.cmm.transforms import variables_of
from brdfc.compiled import Compiled
from brdfc.compiler import compile_model
from brdfc.icc.profile import Profile
from brdfc.lang.load import library, load
from brdfc.lang.model import Quantity
from brdfc.profiles.content import Content
from brdfc.profiles.multiplex import profile_pair
from brdfc.sceneplan import InScene
from brdfc.scenes.scene import Scene
from brdfc.source.errors import SceneError
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.expression import Expression

ANGLES = {"incident": "40deg", "reflection": "-10deg"}
CYAN: dict[str, Any] = {
    "Rd": ["0.1..0.2", "0.15..0.28", "0.35..0.6"],
    "ks": "0.02..0.1",
    "m": "0.08..0.3",
}
MATT: dict[str, Any] = {**CYAN, "m": "0.08..0.1"}
NOTHING = "{ 0 0 0 out[0,3] }"
"""What is below every ratio: the engine's own work for a pixel."""
PIXELS, ROUNDS, PASSES = 20_000, 9, 3

# ---------------------------------------------------------------- the paper's cyan


def cyan() -> None:
    """The paper's cyan at one pair of angles, with Eq. 1 as it is printed."""
    model = load("ward_printed")

    def scene(channels: dict[str, Any], tolerance: float) -> Compiled:
        given = Scene(tolerance=tolerance, variables=ANGLES, channels=channels, highlight=EQUAL)
        return compile_model(model, scene=given)

    made = {
        "general": compile_model(model, highlight=EQUAL),
        "scene, within 0.01": scene(CYAN, 0.01),
        "scene, within 0.1": scene(CYAN, 0.1),
        "scene, m to 0.1, within 0.1": scene(MATT, 0.1),
    }
    print("ward_printed at (40; -10) degrees, coefficients of cyan prints (generated ranges):")
    print("nanoseconds a pixel, least of rounds; CIEDE2000 from the formula at 1e5 random points")
    head = f"{'':<30} {'ops':>4} {'reference':>10} {'ratio':>6} {'ours':>7}"
    print(f"  {head} {'worst':>9} {'proved':>9}")
    with tempfile.TemporaryDirectory() as folder:
        program = literal(model)
        names = tuple(n for q in model.quantities[:3] for n in q.component_names)
        pair = profile_pair(Content("literal", program, names, (0.0,) * len(names)))
        counts = {"literal": operations(program)}
        paths = {"literal": pair.save(Path(folder) / "literal_mvis.icc")}
        paths |= {
            n: c.save(Path(folder) / f"{i}_mvis.icc") for i, (n, c) in enumerate(made.items())
        }
        counts |= {n: operations(c.program) for n, c in made.items()}
        nothing = Content("nothing", Program(1, 3, assemble(NOTHING)), ("ks",), (0.0,))
        paths["nothing"] = profile_pair(nothing).save(Path(folder) / "nothing_mvis.icc")
        counts["nothing"] = operations(nothing.program)
        least = _timed(paths, {n: _pixels(n, made) for n in paths})
    for name, (theirs, ours) in least.items():
        plan = made[name].plan if name in made else None
        worst, proved = "", ""
        if plan is not None:
            found = _sampled(made[name], 100, 1000, 3)
            worst, proved = f"{found.worst:.1e}", f"{plan.fitted.lean.bound.most:.1e}"
        ratio = least["literal"][0] / theirs
        print(
            f"  {name:<30} {counts[name]:4} {theirs:10.0f} {ratio:6.2f} {ours:7.1f} "
            f"{worst:>9} {proved:>9}"
        )


def _pixels(name: str, made: dict[str, Compiled]) -> np.ndarray:
    low, high = ([0.1, 0.15, 0.35, 0.02, 0.08], [0.2, 0.28, 0.6, 0.1, 0.1])
    pixels = np.random.default_rng(1).uniform(low, high, (PIXELS, 5)).astype(np.float32)
    names = ["Rdx", "Rdy", "Rdz", "ks", "m"]
    others = {"literal": tuple(names), "nothing": ("ks",)}
    channels = made[name].roles.channel_names if name in made else others[name]
    return np.ascontiguousarray(pixels[:, [names.index(n) for n in channels]])


def _timed(
    paths: dict[str, tuple[Path, ...]], pixels: dict[str, np.ndarray]
) -> dict[str, tuple[float, float]]:
    """Least nanoseconds a pixel on the reference engine and in ours; all take turns in a round."""
    variables = {"inci": math.radians(40), "refl": math.radians(-10)}
    least = dict.fromkeys(paths, (math.inf, math.inf))
    links = {n: brdfc.connect(*p, env=_known(p[-1], variables)) for n, p in paths.items()}
    for _ in range(ROUNDS):
        for name, (mid, mvis) in paths.items():
            done = reference.apply(mid, mvis, pixels[name], [variables], repeat=PASSES)
            start = time.perf_counter()
            links[name].apply(pixels[name])
            ours = (time.perf_counter() - start) / PIXELS * 1e9
            theirs = float(done.seconds[0]) / PIXELS * 1e9
            least[name] = (min(least[name][0], theirs), min(least[name][1], ours))
    return least


def _known(mvis: Path, variables: dict[str, float]) -> dict[str, float]:
    """The variables that a profile has."""
    profile = Profile.load(mvis)
    known = {name for name, _ in variables_of(profile, "M2B0", profile.tags["M2B0"].elements)}
    return {n: v for n, v in variables.items() if n in known}


# ---------------------------------------------------------------- samples of a scene


@dataclass(frozen=True)
class Sampled:
    """worst: of the profile, from the whole formula; lean: of the lean formula from the whole one,
    in float64; over: points beyond the tolerance; points: that were compared."""

    worst: float
    lean: float
    over: int
    points: int


def _sampled(compiled: Compiled, runs: int, pixels: int, seed: int) -> Sampled:
    """A profile at random points of its scene, half of the values at ends of their ranges."""
    assert compiled.plan is not None
    plan, at = compiled.plan, compiled.plan.at
    random = np.random.default_rng(seed)
    worst = lean = 0.0
    over = count = 0
    for _ in range(runs):
        run = {q.name: _drawn(random, at, q, 1) for q in at.roles.variables}
        columns = {q.name: _drawn(random, at, q, pixels) for q in at.roles.channels}
        every = {n: v for q in at.roles.channels for n, v in _parts(q, columns[q.name])}
        env = {n: float(v[0, 0]) for n, v in run.items()}
        link = brdfc.connect(compiled.mid, compiled.mvis, env=env)
        found = link.apply(np.concatenate([every[n] for n in link.channels], axis=-1))
        values = {n: v.astype(np.float64) for n, v in {**columns, **run}.items()}
        truth = _evaluated(at.ready.exact, values, pixels)
        known = np.isfinite(truth).all(axis=-1)
        off = np.where(known, at.colorimetry.difference(found, truth), 0.0)
        own = {n: v.astype(np.float64) for n, v in {**every, **columns, **run}.items()}
        left = _evaluated(plan.fitted.formula.exact, own, pixels)
        apart = np.where(known, at.colorimetry.difference(left, truth), 0.0)
        worst, lean = max(worst, float(off.max())), max(lean, float(apart.max()))
        over += int((~(off <= at.scene.tolerance)).sum())
        count += pixels
    return Sampled(worst, lean, over, count)


def _evaluated(e: Expression, values: dict[str, np.ndarray], count: int) -> np.ndarray:
    return np.broadcast_to(evaluate(e, values), (count, e.width))


def _drawn(random: np.random.Generator, at: InScene, q: Quantity, count: int) -> np.ndarray:
    ranges = at.narrowed.ranges.get(q.name)
    ends = ranges or [at.ready.domain[q.name]] * q.type.value.width
    share = random.random((count, len(ends)))
    share = np.where(random.random(share.shape) < 0.5, np.round(share), share)
    low, high = np.array([e.low for e in ends]), np.array([e.high for e in ends])
    return np.clip(low + share * (high - low), low, high).astype(np.float32)


def _parts(q: Quantity, values: np.ndarray) -> list[tuple[str, np.ndarray]]:
    alone = [(name, values[:, i : i + 1]) for i, name in enumerate(q.component_names)]
    return [(q.name, values), *alone]


# ---------------------------------------------------------------- random scenes


def random_scene(number: int) -> tuple[str, Scene]:
    """A model and a scene for it."""
    random = np.random.default_rng(1000 + number)
    names = [n for n, entry in library().items() if entry.kind == "model"]
    name = str(random.choice(names))
    model = load(name)
    sections: dict[str, dict[str, Any]] = {"channel": {}, "env": {}}
    for q in model.quantities:
        if q.role.value not in sections:
            continue
        low, high = (max(q.low, -1.4), min(q.high, 1.4)) if q.type.is_angle else (q.low, q.high)
        if q.type.name == "roughness":
            low = max(low, 0.02)
        unit = "rad" if q.type.is_angle else ""
        texts = []
        width = 0.0 if random.random() < 0.25 else 10 ** random.uniform(-1.5, -0.2)
        for _ in range(q.type.value.width):
            start = low + random.random() * (1 - width) * (high - low)
            end = start + width * (high - low)
            texts.append(f"{start!r}{unit}..{end!r}{unit}" if width else f"{start!r}{unit}")
        sections[q.role.value][q.name] = texts if len(texts) > 1 else texts[0]
    tolerance = float(10 ** random.uniform(-2, 0))
    return name, Scene(tolerance=tolerance, variables=sections["env"], channels=sections["channel"])


@dataclass(frozen=True)
class Outcome:
    """number, name: of the scene and its model; failed: why there is no profile."""

    number: int
    name: str
    tolerance: float
    omissions: int
    bound: float
    seen: float
    sampled: Sampled | None
    price: float
    seconds: float
    failed: str = ""


def outcome(task: tuple[int, int]) -> Outcome:
    number, points = task
    name, scene = random_scene(number)
    start = time.perf_counter()
    try:
        compiled = compile_model(load(name), scene=scene)
    except SceneError as error:
        return Outcome(number, name, scene.tolerance, 0, 0, 0, None, 0, 0, error.message)
    seconds = time.perf_counter() - start
    assert compiled.plan is not None
    lean = compiled.plan.fitted.lean
    runs = 64 if compiled.plan.at.roles.variables else 8
    found = _sampled(compiled, runs, -(-points // runs), number)
    return Outcome(
        number,
        name,
        scene.tolerance,
        len(lean.omissions),
        lean.bound.most,
        lean.bound.seen,
        found,
        compiled.price,
        seconds,
    )


def random_scenes(scenes: int, points: int) -> None:
    print(f"{scenes} random scenes, {points:,} points each; CIEDE2000")
    with ProcessPoolExecutor(2) as pool:
        found = list(pool.map(outcome, [(i, points) for i in range(scenes)]))
    made = [o for o in found if o.sampled is not None]
    for o in found:
        if o.failed:
            print(f"  {o.number:3} {o.name}: no profile: {o.failed[:150]}")
            continue
        assert o.sampled is not None
        print(
            f"  {o.number:3} {o.name:<30} tolerance {o.tolerance:7.4f}  left out {o.omissions:2}  "
            f"proved {o.bound:8.1e}  seen {max(o.seen, o.sampled.lean):8.1e}  profile "
            f"{o.sampled.worst:8.1e}  over {o.sampled.over}  {o.price:5.0f} ns  {o.seconds:4.1f} s"
        )
    lean = [o for o in made if o.omissions]
    ratios = [max(o.seen, o.sampled.lean) / o.bound for o in lean if o.sampled]
    print(f"{len(made)} profiles, {len(found) - len(made)} refused as no program rounds so little")
    print(f"points beyond the tolerance: {sum(o.sampled.over for o in made if o.sampled)}")
    beyond = sum(o.sampled.lean > o.bound for o in lean if o.sampled)
    print(f"scenes with something left out: {len(lean)}; sampled beyond the bound: {beyond}")
    print(
        f"sampled worst over proved bound: mean {statistics.mean(ratios):.2f}, "
        f"median {statistics.median(ratios):.2f}, least {min(ratios):.2f}"
    )
    seconds = [o.seconds for o in made]
    print(
        f"compiling: median {statistics.median(seconds):.1f} s, 90 % below "
        f"{sorted(seconds)[int(0.9 * len(seconds))]:.1f} s, at most {max(seconds):.1f} s "
        "(two at a time)"
    )


# ---------------------------------------------------------------- time


def times() -> None:
    """Seconds of compiling a scene, of models from plain to rich."""
    print("seconds to compile for a scene: angles of -20..20 degrees under 40, ranges of a print")
    angles = {"incident": "40deg", "reflection": "-20deg..20deg"}
    channels: dict[str, Any] = {
        **CYAN,
        "m": "0.1..0.15",
        "alpha": "0.1..0.15",
        "F0": "0.04..0.05",
        "mx": "0.1..0.15",
        "my": "0.1..0.15",
    }
    for name in ("ward", "cook_torrance", "ggx", "ward_anisotropic", "cook_torrance_1982"):
        model = load(name)
        own = {n: v for n, v in channels.items() if model.quantity(n) is not None}
        more = {"orientation": "0deg"} if model.quantity("orientation") else {}
        for tolerance in (0.01, 0.1):
            given = Scene(tolerance=tolerance, variables={**angles, **more}, channels=own)
            seconds = []
            for _ in range(3):
                start = time.perf_counter()
                found = compile_model(model, scene=given, cache=False)
                seconds.append(time.perf_counter() - start)
            print(
                f"  {name:<20} within {tolerance:<5} {min(seconds):5.2f} s   {found.price:4.0f} ns"
            )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*", default=["cyan", "time"])
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--points", type=float, default=1e6)
    given = parser.parse_args()
    if "cyan" in given.parts:
        cyan()
    if "time" in given.parts:
        times()
    if "random" in given.parts:
        random_scenes(given.scenes, int(given.points))


if __name__ == "__main__":
    main()
