"""Figures of the colour chain, measured again.

    python benchmarks/viewing.py [chain] [map] [spectral] [matrices]

chain     MID, MVIS, the lamp's connection space to D50, in the reference engine: CIEDE2000 against
          float64; beside it what the engine makes of a program without any error
map       the same over incidence 0..80 and reflection -80..80 degrees, drawn to docs/colour_map.png
spectral  reflectances through wavelengths against their colours through X, Y, Z
matrices  c2sp after s2cp
"""

from __future__ import annotations

import math
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import brdfc
from brdfc.calc.program import Element, Op, Program
from brdfc.calc.text import assemble
from brdfc.cmm import reference
from brdfc.cmm.rendering import spectral_grid
from brdfc.colour.adaptation import TRANSFORMS, adaptation_matrix
from brdfc.colour.difference import D50, ciede2000
from brdfc.colour.library import colour_science
from brdfc.icc.profile import Profile
from brdfc.icc.types import Pipeline
from brdfc.profiles.conditions import matrix_element
from brdfc.profiles.content import Content
from brdfc.profiles.multiplex import profile_pair
from brdfc.profiles.space import xyz_space

Array = NDArray[np.float64]

LAMP = (0.97, 1.0, 0.484)
TO_D50 = adaptation_matrix(LAMP, D50)
PAIRS = [(40, -10), (40, 0), (40, 10), (40, 30)]
MODELS = ("ward", "ward_printed")
SETS = 400


def cyan_like(count: int) -> NDArray[np.float32]:
    """Coefficients Rdx, Rdy, Rdz under the lamp, ks, m of prints like cyan: generated."""
    random = np.random.default_rng(1)
    colour = colour_science()
    lab = random.uniform([50, -32, -42], [65, -18, -28], (count, 3))
    rd = colour.Lab_to_XYZ(lab, colour.XYZ_to_xy(np.array(D50))) @ np.linalg.inv(TO_D50).T
    gloss = random.uniform([0.02, 0.08], [0.10, 0.30], (count, 2))
    return np.hstack([rd, gloss]).astype(np.float32)


def exact(name: str, pixels: NDArray[np.float32], incident: float, reflection: float) -> Array:
    """XYZ under the lamp in float64, independently of the compiler."""
    rd, ks, m = np.split(pixels.astype(np.float64), [3, 4], axis=-1)
    lobe = np.exp(-((math.tan((incident - reflection) / 2) / m) ** 2)) / (4 * np.pi * m**2)
    ci, cr = math.cos(incident), math.cos(reflection)
    specular = ks / math.sqrt(ci * cr) * lobe
    if name == "ward_printed":
        return np.asarray(ci * rd / np.pi + specular)
    return np.asarray(ci * (rd / np.pi + specular * LAMP))


def radians(pair: tuple[float, float]) -> tuple[float, float]:
    return float(np.float32(math.radians(pair[0]))), float(np.float32(math.radians(pair[1])))


def summary(values: Array) -> str:
    return f"median {np.median(values):.1e}  maximum {values.max():.1e}"


# ---------------------------------------------------------------- the chain


def chain(folder: Path) -> None:
    """The asked figure, and how much of it is the engine's own arithmetic."""
    print("CIEDE2000 against float64 under D50, through MID, MVIS, the lamp's space and D50;")
    print(f"{SETS} cyan-like sets of coefficients (generated), the paper's four pairs of angles")
    pixels, lamp = cyan_like(SETS), brdfc.viewing_conditions(white=LAMP)
    xyz_space().save(folder / "d50.icc")
    for name in MODELS:
        for goal in ("balanced", "accuracy"):
            made = brdfc.compile(brdfc.load(name), conditions=lamp, optimize=goal)
            mid, mvis = made.save(folder / "w_mvis.icc")
            print(f"  {name}, {goal}")
            judged, ours = [], []
            for pair in PAIRS:
                ti, tr = radians(pair)
                truth = exact(name, pixels, ti, tr) @ TO_D50.T
                run = {"inci": ti, "refl": tr}
                link = brdfc.connect(mid, mvis, env=run)
                ours.append(ciede2000(brdfc.rendering(link, adapt="D50").apply(pixels), truth))
                judged.append(ciede2000(_judged(folder, mid, mvis, pixels, run), truth))
            print(f"    reference engine    {summary(np.concatenate(judged))}")
            print(f"    our engine          {summary(np.concatenate(ours))}")
    _floor(folder, pixels, lamp)


def _judged(
    folder: Path, mid: Path, mvis: Path, pixels: NDArray[np.float32], run: dict[str, float]
) -> Array:
    profiles = [mid, mvis, folder / "d50.icc"]
    return reference.chain(profiles, pixels, [run], encoded=False).xyz[0]


def _floor(folder: Path, pixels: NDArray[np.float32], lamp: brdfc.ViewingConditions) -> None:
    """The same of a program without error: exact XYZ, rounded once, handed through."""
    passing = Program(3, 3, (Op("in", 0, 3), Op("out", 0, 3)))
    content = Content("exact", passing, ("X", "Y", "Z"), (0.0,) * 3, conditions=lamp)
    mid, mvis = profile_pair(content).save(folder / "p_mvis.icc")
    ways: dict[str, tuple[Element, ...]] = {
        "c2sp as a matrix": (matrix_element(TO_D50),),
        "a matrix and an identity": (matrix_element(TO_D50), matrix_element(np.eye(3))),
        "a calculator, x + (M - 1) x": (_careful(TO_D50),),
    }
    print("  a program without error (exact XYZ, rounded to float32), reference engine")
    for what, elements in ways.items():
        tags = {**Profile.load(mvis).tags, "c2sp": Pipeline(3, 3, elements)}
        replace(Profile.load(mvis), tags=tags).save(folder / "q_mvis.icc")
        found = []
        for pair in PAIRS:
            xyz = exact("ward", pixels, *radians(pair))
            judged = _judged(folder, mid, folder / "q_mvis.icc", xyz.astype(np.float32), {})
            found.append(ciede2000(judged, xyz @ TO_D50.T))
        print(f"    {what:<28}{summary(np.concatenate(found))}")
    rounded = [exact("ward", pixels, *radians(pair)) @ TO_D50.T for pair in PAIRS]
    floor = np.concatenate([ciede2000(xyz.astype(np.float32), xyz) for xyz in rounded])
    print(f"    {'only the result is rounded':<28}{summary(floor)}")


def _careful(matrix: Array) -> Program:
    """The matrix as a correction of what comes in, which rounds less."""
    rows = []
    for k, row in enumerate(matrix - np.eye(3)):
        terms = " ".join(f"{np.float32(v):.9g} in({j}) mul" for j, v in enumerate(row))
        rows.append(f"{terms} sum(3) in({k}) add")
    return Program(3, 3, assemble("{ " + " ".join(rows) + " out[0,3] }"))


# ---------------------------------------------------------------- the map


def angle_map(folder: Path) -> None:
    """The worst and the median of 100 sets at every pair of angles, in steps of 5 degrees."""
    print("\nThe same over incidence 0..80 and reflection -80..80 degrees in steps of 5, 100 sets")
    pixels, lamp = cyan_like(100), brdfc.viewing_conditions(white=LAMP)
    xyz_space().save(folder / "d50.icc")
    incidents, reflections = np.arange(0.0, 81, 5), np.arange(-80.0, 81, 5)
    pairs = [radians((i, r)) for i in incidents for r in reflections]
    for name in MODELS:
        mid, mvis = brdfc.compile(brdfc.load(name), conditions=lamp).save(folder / "w_mvis.icc")
        runs = [{"inci": ti, "refl": tr} for ti, tr in pairs]
        profiles = [mid, mvis, folder / "d50.icc"]
        judged = reference.chain(profiles, pixels, runs, encoded=False).xyz
        truth = np.array([exact(name, pixels, *pair) @ TO_D50.T for pair in pairs])
        found = ciede2000(judged, truth)
        worst = found.max(axis=1).reshape(len(incidents), len(reflections))
        print(f"  {name:<13} {summary(found)}")
        peak = np.unravel_index(worst.argmax(), worst.shape)
        at = f"({incidents[peak[0]]:g}; {reflections[peak[1]]:g})"
        print(f"  {'':<13} worst pair {at}, least of the worst {worst.min():.1e}")
        if name == MODELS[0]:
            _draw(worst, incidents, reflections)


def _draw(worst: Array, incidents: Array, reflections: Array) -> None:
    from matplotlib.colors import LogNorm
    from matplotlib.figure import Figure

    from brdfc.charts.saved import saved

    def draw() -> Figure:
        figure = Figure(figsize=(7.5, 4.2), facecolor="white")
        axes = figure.add_axes((0.09, 0.13, 0.76, 0.72))
        step = float(reflections[1] - reflections[0]) / 2
        extent = (reflections[0] - step, reflections[-1] + step)
        extent += (incidents[0] - step, incidents[-1] + step)
        options = {"origin": "lower", "extent": extent, "aspect": "auto", "cmap": "cividis"}
        image = axes.imshow(worst, norm=LogNorm(1e-6, 1e-4), **options)
        axes.set_xlabel("reflection angle [deg]")
        axes.set_ylabel("incidence angle [deg]")
        bar = figure.colorbar(image, cax=figure.add_axes((0.87, 0.13, 0.025, 0.72)))
        bar.set_label("worst CIEDE2000 of 100 sets")
        title = "Ward, lamp to D50, in the reference engine: CIEDE2000 against float64"
        figure.text(0.02, 0.975, title, va="top", fontsize=11, fontweight="bold")
        figure.text(0.02, 0.915, "Coefficients generated, like cyan.", va="top", color="#444444")
        return figure

    path = Path(__file__).parents[1] / "docs" / "colour_map.png"
    path.write_bytes(saved(draw, "png"))
    print(f"  drawn to docs/{path.name}")


# ---------------------------------------------------------------- spectra, matrices


def spectral(_folder: Path) -> None:
    """Smooth reflectances by wavelength, and their colours through X, Y, Z: the same colours."""
    print("\nCIEDE2000 between the spectral and the colorimetric path, 200 smooth reflectances")
    random = np.random.default_rng(2)
    grid = np.arange(400, 701, 10.0)
    phase, period = random.uniform(0, 6.3, (200, 1)), random.uniform(30, 200, (200, 1))
    spectra = (0.5 + 0.45 * np.sin(grid / period + phase)).astype(np.float32)
    gloss = random.uniform([0.02, 0.08], [0.10, 0.30], (200, 2)).astype(np.float32)
    wide = brdfc.load("ward", spectral="400nm..700nm,10nm")
    for light in ("A", "D50", "D65", "FL2", "FL11"):
        conditions = brdfc.viewing_conditions(light)
        one = brdfc.compile(wide, conditions=conditions)
        other = brdfc.compile(brdfc.load("ward"), conditions=conditions)
        matrix = conditions.reflectances_to_xyz(spectral_grid(one.mvis))
        colours = (spectra.astype(np.float64) @ matrix.T).astype(np.float32)
        found = []
        for pair in (*PAIRS, (40, 40), (75, 70), (0, 0)):
            env = dict(zip(("incident", "reflection"), radians(pair), strict=True))
            first = brdfc.connect(one.mid, one.mvis, env=env, transform="M2S0")
            second = brdfc.connect(other.mid, other.mvis, env=env)
            by_wavelength = brdfc.rendering(first).apply(np.hstack([spectra, gloss]))
            by_colour = brdfc.rendering(second).apply(np.hstack([colours, gloss]))
            found.append(ciede2000(by_wavelength, by_colour, conditions.white))
        print(f"  {light:<5} {summary(np.concatenate(found))}")


def matrices(_folder: Path) -> None:
    """The farthest that c2sp after s2cp is from the identity, as float32 computes it."""
    print("\nc2sp after s2cp: the largest difference from the identity")
    for transform in TRANSFORMS:
        worst = 0.0
        for light in ("A", "D65", "FL2", "FL11", "blackbody:2000K", "daylight:20000K"):
            conditions = brdfc.viewing_conditions(light, adaptation=transform)
            made = brdfc.compile(brdfc.load("lambert"), conditions=conditions, effort=1)
            both = np.eye(3, dtype=np.float32)
            for tag in ("s2cp", "c2sp"):
                (element,) = made.mvis.tags[tag].elements
                both = np.array(element.values, np.float32).reshape(3, 3) @ both
            worst = max(worst, float(np.abs(both.astype(np.float64) - np.eye(3)).max()))
        print(f"  {transform:<9} {worst:.1e}")


def main() -> None:
    parts = {"chain": chain, "map": angle_map, "spectral": spectral, "matrices": matrices}
    with tempfile.TemporaryDirectory() as folder:
        for part in sys.argv[1:] or list(parts):
            parts[part](Path(folder))


if __name__ == "__main__":
    main()
