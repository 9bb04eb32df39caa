"""The main job, start to end: compile Ward, apply it to an image of coefficients, look, compare.

    python examples/demo.py [FOLDER]

Seven colour patches like a set of prints, each with a gloss that changes smoothly across it, seen
at the four angle pairs of Habib, Green and Sole (2020). The coefficients are generated: the
measured ones are not public.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
import tifffile
from PIL import Image, ImageDraw

import brdfc
from brdfc.cmm import reference
from brdfc.colour.difference import ciede2000
from brdfc.colour.picture import srgb
from brdfc.images.apply import apply_to_tiff
from brdfc.symbolic.evaluate import evaluate

PATCHES = {  # diffuse XYZ under D50 and specular coefficient: generated, not measured
    "white": (0.80, 0.83, 0.68, 0.040),
    "red": (0.27, 0.17, 0.06, 0.055),
    "cyan": (0.18, 0.22, 0.37, 0.050),
    "blue violet": (0.14, 0.10, 0.26, 0.045),
    "magenta": (0.28, 0.16, 0.15, 0.050),
    "green": (0.15, 0.22, 0.11, 0.060),
    "orange": (0.44, 0.38, 0.10, 0.045),
}
ANGLES = [(40, -10), (40, 0), (40, 10), (40, 30)]
GLOSS = (0.08, 0.35)
"""Roughness at the left and at the right edge of a patch."""
WIDTH, HEIGHT = 96, 96


def coefficients() -> np.ndarray:
    """The image: (HEIGHT, 7 WIDTH, 5) float32, samples Rdx, Rdy, Rdz, ks, m."""
    image = np.empty((HEIGHT, WIDTH * len(PATCHES), 5), dtype=np.float32)
    for index, values in enumerate(PATCHES.values()):
        patch = image[:, index * WIDTH : (index + 1) * WIDTH]
        patch[..., :4] = values
        patch[..., 4] = np.geomspace(*GLOSS, WIDTH)
    return image


def contact_sheet(rows: list[np.ndarray], path: Path) -> int:
    """The sRGB patches, a row an angle pair, with labels; returns how many pixels were clipped."""
    left, top, gap = 110, 40, 10
    sheet = Image.new(
        "RGB", (left + rows[0].shape[1] + gap, top + len(rows) * (HEIGHT + gap)), (58, 58, 58)
    )
    draw = ImageDraw.Draw(sheet)
    for index, name in enumerate(PATCHES):
        draw.text((left + index * WIDTH + 4, 10), name, fill="white")
        draw.text((left + index * WIDTH + 4, 23), "glossy > matt", fill=(170, 170, 170))
    clipped = 0
    for row, ((incident, reflection), xyz) in enumerate(zip(ANGLES, rows, strict=True)):
        picture, outside = srgb(xyz)
        clipped += int(outside.sum())
        y = top + row * (HEIGHT + gap)
        sheet.paste(Image.fromarray(picture), (left, y))
        draw.text((8, y + HEIGHT // 2 - 14), f"light {incident} deg", fill="white")
        draw.text((8, y + HEIGHT // 2), f"viewer {reflection} deg", fill="white")
    sheet.save(path)
    return clipped


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "demo")
    folder.mkdir(parents=True, exist_ok=True)
    compiled = brdfc.compile(brdfc.load("ward"), set={"intensity": math.pi})
    mid, mvis = compiled.save(folder / "ward_mvis.icc")
    image = coefficients()
    source = folder / "coefficients.tif"
    tifffile.imwrite(source, image, photometric="minisblack", planarconfig="contig", metadata=None)

    print("CIEDE2000 against the formula in float64 (white: D50), over all pixels")
    print(f"{'angles [deg]':>14} {'brdfc median':>14} {'maximum':>10}", end="")
    print(f" {'reference engine median':>24} {'maximum':>10}" if reference.available() else "")
    rows, files = [], []
    values = {"Rd": image[..., :3], "ks": image[..., 3:4], "m": image[..., 4:5]}
    values = {name: array.astype(np.float64) for name, array in values.items()}
    for incident, reflection in ANGLES:
        radians = {"incident": math.radians(incident), "reflection": math.radians(reflection)}
        link = brdfc.connect(mid, mvis, env=radians)
        target = folder / f"xyz_{incident}_{reflection}.tif"
        run = f"incident={incident}deg, reflection={reflection}deg"
        apply_to_tiff(brdfc.rendering(link), source, target, run)
        xyz = tifffile.imread(target)
        run = {"inci": np.float32(radians["incident"]), "refl": np.float32(radians["reflection"])}
        angles = {"incident": run["inci"], "reflection": run["refl"]}
        truth = evaluate(
            compiled.formula.exact,
            {**values, **{name: np.array([float(v)]) for name, v in angles.items()}},
        )
        columns = [ciede2000(xyz, truth)]
        if reference.available():
            run = {name: float(value) for name, value in run.items()}
            judged = reference.apply(mid, mvis, image.reshape(-1, 5), [run]).xyz[0]
            columns.append(ciede2000(judged.reshape(truth.shape), truth))
        print(f"{f'{incident}; {reflection}':>14}", end="")
        for column, width in zip(columns, (14, 24), strict=False):
            print(f" {np.median(column):>{width}.1e} {column.max():>10.1e}", end="")
        print()
        rows.append(xyz)
        files.append(target)
    picture = folder / "appearance.png"
    clipped = contact_sheet(rows, picture)

    print(f"\nprofiles      {mid}  {mvis}")
    print(f"coefficients  {source}  (generated, not measured)")
    print(f"XYZ images    {'  '.join(map(str, files))}")
    print(f"sRGB picture  {picture}  ({clipped} pixels clipped to what sRGB can show)")
    print("\nThe same by hand:")
    print(f"  brdfc compile ward -o {mvis} --set intensity={math.pi:.9g}")
    print(f"  brdfc apply {mid} {mvis} {source} -o {files[0]} \\")
    print("        --env incident=40deg --env reflection=-10deg")


if __name__ == "__main__":
    main()
