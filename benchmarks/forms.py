"""Compiled models against literal transcriptions of their textbook formulas, measured again.

    python benchmarks/forms.py [speed] [accuracy] [ward] [ggx]

literal   benchmarks/literal/NAME.calc: operator by operator, a channel at a time, unguarded
compiled  brdfc compile NAME: angles from environment variables, guarded from -90 to 90 degrees
fixed     brdfc compile NAME --set incident=40deg --set reflection=30deg

speed     operators, and nanoseconds a pixel on the reference engine, all programs interleaved
accuracy  worst error of literal and compiled at the same points, angles within 89.9 degrees
ward      worst error of ward, --optimize balanced and accuracy
ggx       worst relative error of ggx where alpha = 0.001
splits    forms that differ by regime: time averaged over angles and pixels of the whole domain
"""

from __future__ import annotations

import math
import re
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.price import fixed, operations
from brdfc.calc.program import Program
from brdfc.calc.text import assemble
from brdfc.cmm import reference
from brdfc.colour.difference import ciede2000
from brdfc.compiler import compile_model, explore_model
from brdfc.engine.interpreter import run
from brdfc.judge.measure import SEEN
from brdfc.judge.strata import Points, points
from brdfc.lang.load import load
from brdfc.lang.model import Model, Quantity
from brdfc.prepared import prepare
from brdfc.profiles.content import Content
from brdfc.profiles.multiplex import profile_pair
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.intervals import Interval

LITERAL = Path(__file__).parent / "literal"
MODELS = ("ward_printed", "cook_torrance", "ggx", "oren_nayar", "ashikhmin_shirley")

INCIDENT, REFLECTION = 40, 30
PIXELS, PASSES, ROUNDS = 20_000, 8, 6
SCALE = 20_000
"""Points a share of the strata: 220,000 in all."""
EQUAL = "equal"
"""The literal transcriptions add the same highlight to X, Y and Z; so do what they are held to."""
STEEPEST = math.radians(89.9)
"""Beyond it the literal programs, which have no guards, divide by nearly nothing."""


# ---------------------------------------------------------------- speed


def speed() -> None:
    """Operators and times of the three programs of each model."""
    angles = {"incident": f"{INCIDENT}deg", "reflection": f"{REFLECTION}deg"}
    programs: dict[tuple[str, str], Program] = {}
    pixels = {}
    for name in MODELS:
        model = load(name)
        compiled = compile_model(model, highlight=EQUAL)
        programs[name, "literal"] = literal(model)
        programs[name, "compiled"] = compiled.program
        programs[name, "fixed"] = compile_model(model, angles, highlight=EQUAL).program
        pixels[name] = usual_pixels(compiled.roles.channels)
    least = timed(programs, pixels)
    print(f"Nanoseconds a pixel on the reference engine, least of {ROUNDS} rounds, MID and MVIS;")
    print(f"incident {INCIDENT} deg, reflection {REFLECTION} deg; operators in brackets")
    print(f"  {'':<18} {'literal':>11} {'compiled':>11} {'fixed':>11}   ratios to literal")
    for name in MODELS:
        kinds = [(name, kind) for kind in ("literal", "compiled", "fixed")]
        columns = [f"{least[k]:5.0f} ({operations(programs[k]):3})" for k in kinds]
        ratios = [f"{least[k] / least[kinds[0]]:.2f}" for k in kinds[1:]]
        print(f"  {name:<18} {' '.join(f'{c:>11}' for c in columns)}   {'  '.join(ratios)}")


def literal(model: Model) -> Program:
    """The literal program; its inputs are the model's channels."""
    roles, _ = prepare(model, {}, ())
    text = (LITERAL / f"{model.name}.calc").read_text(encoding="utf-8")
    return Program(len(roles.channel_names), 3, assemble(text))


def usual_pixels(channels: tuple[Quantity, ...]) -> NDArray[np.float32]:
    """Coefficients around their defaults: half to one and a half times as large."""
    random = np.random.default_rng(1)
    columns = []
    for q in channels:
        factor = random.uniform(0.5, 1.5, (PIXELS, q.type.value.width))
        columns.append(np.clip(np.array(q.default) * factor, q.low, q.high))
    return np.concatenate(columns, axis=1).astype(np.float32)


def timed(
    programs: Mapping[tuple[str, str], Program], pixels: Mapping[str, NDArray[np.float32]]
) -> dict[tuple[str, str], float]:
    """Least nanoseconds a pixel; all programs run once a round, so that noise meets them alike."""
    variables = {"inci": math.radians(INCIDENT), "refl": math.radians(REFLECTION)}
    least = dict.fromkeys(programs, math.inf)
    with tempfile.TemporaryDirectory() as folder:
        pairs = {}
        for key, program in programs.items():
            names = [f"c{i}" for i in range(program.inputs)]
            pair = profile_pair(Content("timed", program, tuple(names), (0.0,) * len(names)))
            pairs[key] = pair.save(Path(folder) / f"{'_'.join(key)}_mvis.icc")
        for _ in range(ROUNDS):
            for key, (mid, mvis) in pairs.items():
                done = reference.apply(mid, mvis, pixels[key[0]], [variables], repeat=PASSES)
                least[key] = min(least[key], float(done.seconds[0]) / PIXELS * 1e9)
    return least


# ---------------------------------------------------------------- accuracy


@dataclass(frozen=True)
class Sampled:
    """A model at points of its domain, angles within STEEPEST: the exact formula in float64 there,
    and how high its lobe is with the same coefficients."""

    points: Points
    channels: tuple[Quantity, ...]
    variables: tuple[Quantity, ...]
    truth: NDArray[np.float64]
    peak: NDArray[np.float64]


def sampled(name: str, scale: int = SCALE, **narrowed: Interval) -> Sampled:
    """narrowed: ranges to use instead of the declared ones."""
    roles, ready = prepare(load(name), {}, ())
    steep = Interval(-STEEPEST, STEEPEST)
    domain = {**ready.domain, **{q.name: steep for q in roles.variables}, **narrowed}
    at = points(domain, roles.channels + roles.variables, scale)
    values = {name: v.astype(np.float64) for name, v in at.values.items()}
    # Schlick's term may leave a lobe nothing near the normal: so at 45 degrees too.
    mirrors = (values["incident"], np.full((1, 1), math.radians(45)))
    lobes = [
        evaluate(ready.exact, {**values, **{q.name: angle for q in roles.variables}})
        for angle in mirrors
    ]
    peak = np.abs(lobes).max(axis=(0, -1))[:, None]
    return Sampled(at, roles.channels, roles.variables, evaluate(ready.exact, values), peak)


def values_of(program_text: str, at: Sampled) -> NDArray[np.float32]:
    """A program's results, its variables turned into channels so that each point has its own."""
    columns = [at.points.values[q.name] for q in (*at.channels, *at.variables)]
    pixels = np.concatenate(columns, axis=1)
    first = pixels.shape[1] - len(at.variables)
    for i, q in enumerate(at.variables):
        read = rf"env\({q.signature}\)\s+(pop|if {{ }} else {{ pop [^}}]* }})"
        program_text = re.sub(read, f"in[{first + i}]", program_text)
    return run(Program(pixels.shape[1], 3, assemble(program_text)), pixels, {})


@dataclass(frozen=True)
class Worst:
    """Of a program: bits, relative error and CIEDE2000; and points where it is not finite."""

    bits: float
    relative: float
    de: float
    broken: int

    def __str__(self) -> str:
        broken = f", {self.broken} not finite" if self.broken else ""
        return f"{self.bits:5.1f} bits, CIEDE2000 {self.de:7.1e}{broken}"


def worst(program_text: str, at: Sampled, where: NDArray[np.bool_] | None = None) -> Worst:
    """Bits and relative error count where a value is at least SEEN of the peak, and at the points
    given, if they are."""
    result = values_of(program_text, at).astype(np.float64)
    finite = np.isfinite(result).all(axis=-1)
    size = np.abs(at.truth)
    counted = finite[:, None] & (size >= SEEN * at.peak) & (size > 2.0**-100)
    if where is not None:
        counted &= where[:, None]
    error = np.where(counted, np.abs(result - at.truth), 0.0)
    unit = np.spacing(size.astype(np.float32)).astype(np.float64)
    return Worst(
        float(np.log2(1 + error / unit).max()),
        float((error / np.where(counted, size, 1.0)).max()),
        float(ciede2000(result[finite], at.truth[finite]).max()),
        int((~finite).sum()),
    )


def accuracy() -> None:
    """Worst error of the literal and the compiled program of each model at the same points."""
    print(f"\nWorst error; bits where a value is above {SEEN:g} of the peak")
    for name in MODELS:
        at = sampled(name)
        text = (LITERAL / f"{name}.calc").read_text(encoding="utf-8")
        before, after = worst(text, at), worst(compile_model(load(name), highlight=EQUAL).text, at)
        print(f"  {name:<18} literal  {before}   ({at.points.count:,} points)")
        print(f"  {'':<18} compiled {after}   ({before.bits - after.bits:+.1f} bits better)")


def ward() -> None:
    """Ward's worst error by goal, everywhere and in the lobe: exp(-tan^2/m^2) at least SEEN."""
    print(f"\nward, worst error by goal; in the lobe: where exp(-tan^2/m^2) >= {SEEN:g}")
    at = sampled("ward")
    ti, tr, m = (at.points.values[n][:, 0].astype(float) for n in ("incident", "reflection", "m"))
    lobe = np.exp(-((np.tan((ti - tr) / 2) / m) ** 2)) >= SEEN
    for goal in ("balanced", "accuracy"):
        compiled = compile_model(load("ward"), optimize=goal, highlight=EQUAL)
        everywhere, inside = worst(compiled.text, at), worst(compiled.text, at, lobe)
        count = operations(compiled.program)
        print(f"  {goal:<9} {count:3} operators: {everywhere}; in the lobe {inside.bits:.2f} bits")


def ggx() -> None:
    """The narrowest highlight of ggx."""
    print("\nggx, alpha = 0.001: worst relative error")
    narrow = float(np.float32(0.001))
    at = sampled("ggx", alpha=Interval(narrow, narrow))
    text = (LITERAL / "ggx.calc").read_text(encoding="utf-8")
    print(f"  literal  {worst(text, at).relative:.1e}")
    print(f"  compiled {worst(compile_model(load('ggx'), highlight=EQUAL).text, at).relative:.1e}")


def splits() -> None:
    """Ward where accuracy is asked for: the careful form everywhere, and only where it is needed.
    The price is one of pixels spread over the domain, so time is averaged over such."""
    random = np.random.default_rng(2)
    model = load("ward")
    roles, _ = prepare(model, {}, ())
    columns = []
    for q in roles.channels:
        drawn = random.uniform(size=(PIXELS, q.type.value.width))
        decades = q.low > 0 and q.high / q.low > 30
        columns.append(
            q.low * (q.high / q.low) ** drawn if decades else q.low + drawn * (q.high - q.low)
        )
    pixels = np.concatenate(columns, axis=1).astype(np.float32)
    angles = random.uniform(-math.pi / 2, math.pi / 2, (100, 2))
    runs = [{"inci": float(a), "refl": float(b)} for a, b in angles]
    print("\nward, the same error with and without a split by regime; spread over the domain")
    explored = explore_model(model, optimize="accuracy", highlight=EQUAL)
    steps = [c for c in explored.derivation() if c.program is not None]
    for c, what in ((steps[-2], "careful everywhere"), (steps[-1], "split")):
        with tempfile.TemporaryDirectory() as folder:
            names = roles.channel_names
            pair = profile_pair(Content("timed", c.program, tuple(names), (0.0,) * len(names)))
            mid, mvis = pair.save(Path(folder) / "timed_mvis.icc")
            done = [reference.apply(mid, mvis, pixels, runs) for _ in range(ROUNDS)]
        took = min(float(d.seconds.mean()) for d in done) / PIXELS * 1e9
        expected = fixed() + c.price
        print(
            f"  {what:<19} {c.measured.bits:.2f} bits, {took:4.0f} ns, by its price {expected:4.0f}"
        )


def main() -> None:
    parts = {"speed": speed, "accuracy": accuracy, "ward": ward, "ggx": ggx, "splits": splits}
    for part in sys.argv[1:] or parts:
        parts[part]()


if __name__ == "__main__":
    main()
