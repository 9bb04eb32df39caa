"""The published workflow, start to end: T. Habib, P. Green, A. Sole, Implementing directional
reflectance in a colour managed workflow, 2020.

    python examples/paper/run.py [FOLDER]

Seven samples, generated (samples.py); a coefficient TIFF; Eq. 1 as printed, compiled to a MID and
an MVIS for the paper's lamp; XYZ images at the paper's angles, adapted to D50, D65 and A; its
Table 1, with our residual against float64; and its Figures 3 to 12 with the same axes.
"""

from __future__ import annotations

import csv
import math
import sys
from pathlib import Path

import numpy as np
import tifffile
from samples import LAMP, NOMINAL, coefficients, image, patch

import brdfc
from brdfc.cmm import reference
from brdfc.colour.adaptation import adaptation_matrix
from brdfc.colour.difference import D50, ciede2000
from brdfc.images.apply import apply_to_tiff
from brdfc.pictures.draw import draw_strips, draw_sweeps, write_sweeps
from brdfc.pictures.sources import Source, Subject, open_subjects
from brdfc.pictures.sweep import Sweep, sweeps
from brdfc.profiles.space import xyz_space

MODEL = "ward_printed"
INTENSITY = math.pi
"""I_i, which the paper does not give: pi makes a perfect diffuser, lit along the normal, white."""

TABLE_1 = {  # (incident, reflection): the paper's columns (a) and (b)
    (40, -10): (0.6407, 0.0011),
    (40, 0): (0.6644, 0.0010),
    (40, 10): (0.7157, 5.8370e-4),
    (40, 30): (0.8636, 1.2928e-4),
}
FIGURES_3_TO_8 = [("cyan", 30), ("cyan", 45), ("cyan", 60)]
FIGURES_3_TO_8 += [("magenta", angle) for _, angle in FIGURES_3_TO_8]
FIGURES_9_TO_12 = ["cyan", "magenta", "Pantone 10309C", "Pantone 10213C"]
SWEPT = np.radians(np.arange(-80.0, 81.0, 5.0))
GENERATED = "Coefficients generated, not the paper's."


def eq_1(pixels: np.ndarray, incident: float, reflection: float) -> np.ndarray:
    """Eq. 1 in float64, written out here, independently of brdfc: XYZ under the lamp."""
    rd, ks, m = np.split(pixels.astype(np.float64), [3, 4], axis=-1)
    delta = (incident - reflection) / 2
    lobe = np.exp(-(np.tan(delta) ** 2) / m**2) / (4 * np.pi * m**2)
    specular = ks / np.sqrt(np.cos(incident) * np.cos(reflection)) * lobe
    return INTENSITY * np.cos(incident) * rd / np.pi + specular


def residuals(xyz_d50: np.ndarray, pixels: np.ndarray, angles: tuple[float, float]) -> np.ndarray:
    """CIEDE2000 under D50 against float64 and the exact Bradford matrix."""
    truth = eq_1(pixels, *angles) @ adaptation_matrix(LAMP, D50).T
    return ciede2000(xyz_d50, truth)


def run_chain(folder: Path, profiles: tuple[Path, ...], source: Path) -> dict[str, np.ndarray]:
    """Every sample at every pair of angles to XYZ images; the residual against float64 of each
    pixel: by our engine, and where it is installed by the ICC's."""
    pixels = tifffile.imread(source)
    found: dict[str, list[np.ndarray]] = {"brdfc": []}
    xyz_space().save(folder / "d50.icc")
    for incident, reflection in TABLE_1:
        radians = tuple(float(np.float32(math.radians(a))) for a in (incident, reflection))
        link = brdfc.connect(
            *profiles, env=dict(zip(("incident", "reflection"), radians, strict=True))
        )
        for adapt in (None, "D50", "D65", "A"):
            name = f"xyz_{incident}_{reflection}_{adapt or 'lamp'}.tif"
            run = f"incident={incident}deg, reflection={reflection}deg"
            apply_to_tiff(brdfc.rendering(link, adapt=adapt), source, folder / name, run)
        written = tifffile.imread(folder / f"xyz_{incident}_{reflection}_D50.tif")
        found["brdfc"].append(residuals(written, pixels, radians))
        if reference.available():
            chain = [*profiles, folder / "d50.icc"]
            env = dict(zip(("inci", "refl"), radians, strict=True))
            flat = pixels.reshape(-1, 5)
            judged = reference.chain(chain, flat, [env], encoded=False).xyz[0]
            other = residuals(judged.reshape((*pixels.shape[:2], 3)), pixels, radians)
            found.setdefault("reference engine", []).append(other)
    return {engine: np.array(values) for engine, values in found.items()}


def table_1(found: dict[str, np.ndarray], folder: Path) -> None:
    """The paper's table, with our column (b) beside its own."""
    cyan = patch(list(NOMINAL).index("cyan"))
    rows = [["angles", "paper (a)", "paper (b)"]]
    rows[0] += [f"{engine} {what}" for engine in found for what in ("median", "maximum")]
    for index, (angles, (a, b)) in enumerate(TABLE_1.items()):
        row = [f"({angles[0]}; {angles[1]})", f"{a:.4f}", f"{b:.1e}"]
        for values in found.values():
            of_cyan = values[index][:, cyan]
            row += [f"{np.median(of_cyan):.1e}", f"{of_cyan.max():.1e}"]
        rows.append(row)
    print("\nTable 1: CIEDE2000 of cyan. (a): the paper's profile against the XYZ of Sole et al.;")
    print("(b): a profile against the same equation in float64. " + GENERATED)
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        cells = (cell.rjust(width) for cell, width in zip(row, widths, strict=True))
        print("  " + "  ".join(cells))
    print("\nAll seven samples, all four pairs of angles:")
    for engine, values in found.items():
        print(f"  {engine:<17} median {np.median(values):.1e}  maximum {values.max():.1e}")
    with (folder / "table_1.csv").open("w", newline="") as stream:
        csv.writer(stream, lineterminator="\n").writerows(rows)


def sample(mvis: Path, name: str) -> Subject:
    """A sample as the subject of a picture: the profile with its coefficients."""
    *rd, ks, m = (f"{value:.9g}" for value in coefficients()[name])
    values = {"Rd": f"({','.join(rd)})", "ks": ks, "m": m}
    (subject,) = open_subjects([Source(str(mvis), values, name)], None, None, None)
    return subject


def figures(mvis: Path, folder: Path) -> None:
    """Figures 3 to 12, as .svg and .png, and the numbers behind them."""
    for number, (name, incident) in enumerate(FIGURES_3_TO_8, start=3):
        radians = math.radians(incident)
        found = sweeps([sample(mvis, name)], [radians], SWEPT, [None, "D50", "D65", "A"])
        pixel = np.array(coefficients()[name], np.float32)
        exact = np.array([eq_1(pixel, radians, angle) for angle in SWEPT])
        d50 = exact @ adaptation_matrix(LAMP, D50).T
        label = "Eq. 1 in float64, D50"
        found.append(Sweep(label, float(incident), np.degrees(SWEPT), d50, D50, measured=True))
        title = f"Figure {number}: {name}, light at {incident} deg"
        for kind in ("svg", "png"):
            path = folder / f"figure_{number:02}.{kind}"
            draw_sweeps(found, path, "Y", title, reverse=True, note=GENERATED)
        write_sweeps(found, folder / f"figure_{number:02}.csv")
    lights = [math.radians(a) for a in (-30, 0, 45, 60)]
    for number, name in enumerate(FIGURES_9_TO_12, start=9):
        found = sweeps([sample(mvis, name)], lights, SWEPT, ["D50"])
        title = f"Figure {number}: {name}, sRGB by incidence"
        for kind in ("svg", "png"):
            clipped = draw_strips(found, folder / f"figure_{number:02}.{kind}", title, GENERATED)
        write_sweeps(found, folder / f"figure_{number:02}.csv")
        if clipped:
            print(f"  figure {number}: {clipped} patches outside sRGB, clipped and marked")


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "paper")
    folder.mkdir(parents=True, exist_ok=True)
    source = folder / "coefficients.tif"
    layout = {"photometric": "minisblack", "planarconfig": "contig", "metadata": None}
    tifffile.imwrite(source, image(), description=GENERATED, **layout)

    lamp = brdfc.viewing_conditions(white=LAMP)
    compiled = brdfc.compile(brdfc.load(MODEL), set={"intensity": INTENSITY}, conditions=lamp)
    profiles = compiled.save(folder / "ward_mvis.icc")
    print("Seven samples, generated: coefficients under the lamp's white (0.97, 1, 0.484)")
    for name, values in coefficients().items():
        print(f"  {name:<15}" + "".join(f"{value:8.4f}" for value in values))
    found = run_chain(folder, profiles, source)
    table_1(found, folder)
    print("\nFigures 3 to 12:")
    figures(profiles[-1], folder)
    print(f"  written to {folder}/figure_03.svg ... figure_12.png, with their numbers as .csv")
    print("\nThe same by hand:")
    print(f"  brdfc compile {MODEL} -o {profiles[-1]} --white 0.97,1,0.484 \\")
    print(f"        --set intensity={INTENSITY:.9g}")
    print(f"  brdfc apply {profiles[0]} {profiles[-1]} {source} -o xyz.tif --adapt D50 \\")
    print("        --env incident=40deg --env reflection=-10deg")
    print(f"  brdfc plot curves '{profiles[-1]} with ks=0.05 as sample' -o y.svg --reverse \\")
    print("        --incident 30deg --reflection -80deg..80deg,5deg --adapt own --adapt D50")


if __name__ == "__main__":
    main()
