"""A printed cylinder lit from the side: angles of its own in every pixel.

    python examples/cylinder.py [FOLDER]

An image of normals and heights, and one of coefficients (generated: three bands of ink, matt to
glossy from top to bottom); the angles of every pixel for a lamp beside the camera; Ward compiled so
that it takes them from the pixel; and the sRGB picture, by our engine and, where it is installed,
by the ICC's.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import tifffile
from numpy.typing import NDArray
from PIL import Image

import brdfc
from brdfc.cmm import reference
from brdfc.images.angles import angles_to_tiff
from brdfc.images.apply import apply_to_tiff
from brdfc.images.directions import Arrangement, positions

HEIGHT, WIDTH = 300, 420
RADIUS = 0.9
"""Of the cylinder, in an image that is 2 wide."""
LAMP, CAMERA = (2.5, 1.0, 2.0), (0.0, 0.0, 6.0)
INKS = [(0.22, 0.28, 0.42), (0.30, 0.17, 0.13), (0.68, 0.74, 0.20)]
"""Diffuse X, Y, Z under D50 of three inks: generated, not measured."""


def write(path: Path, image: NDArray[np.float32]) -> None:
    layout = {"photometric": "minisblack", "planarconfig": "contig", "metadata": None}
    tifffile.imwrite(path, image, **layout)


def body() -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Normals and heights of an upright cylinder before a wall."""
    x = positions(0, HEIGHT, HEIGHT, WIDTH, 2.0)[..., 0]
    on_body = np.abs(x) < RADIUS
    across = np.where(on_body, x / RADIUS, 0)
    depth = np.sqrt(1 - across**2)
    normals = np.stack([across, np.zeros_like(x), depth], axis=-1)
    heights = np.where(on_body, RADIUS * depth, 0)
    return normals.astype(np.float32), heights.astype(np.float32)


def prints() -> NDArray[np.float32]:
    """Rdx, Rdy, Rdz, ks, m: bands of ink on the body, a grey wall beside it."""
    image = np.empty((HEIGHT, WIDTH, 5), np.float32)
    x = positions(0, HEIGHT, HEIGHT, WIDTH, 2.0)[..., 0]
    band = np.minimum(np.arange(HEIGHT) * len(INKS) // HEIGHT, len(INKS) - 1)
    image[..., :3] = np.array(INKS)[band][:, None]
    image[..., 3] = 0.08
    image[..., 4] = np.geomspace(0.35, 0.08, HEIGHT)[:, None]
    image[np.abs(x) >= RADIUS] = (0.096, 0.1, 0.082, 0.0, 0.3)
    return image


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "cylinder")
    folder.mkdir(parents=True, exist_ok=True)
    normals, heights = body()
    for name, image in (("normals", normals), ("heights", heights), ("prints", prints())):
        write(folder / f"{name}.tif", image)
    whole = folder / "prints_and_angles.tif"
    faced = angles_to_tiff(
        folder / "normals.tif",
        whole,
        Arrangement(LAMP, CAMERA),
        folder / "heights.tif",
        folder / "prints.tif",
    )
    names = ("incident", "reflection", "incident_azimuth", "reflection_azimuth")
    compiled = brdfc.compile(brdfc.load("ward", "full"), set={"intensity": np.pi}, channels=names)
    mid, mvis = compiled.save(folder / "ward_mvis.icc")
    print(f"samples       {' '.join(compiled.roles.channel_names)}")
    print(f"facing away   {faced.from_light:,} of {HEIGHT * WIDTH:,} pixels from the lamp")
    link = brdfc.connect(mid, mvis)
    applied = apply_to_tiff(
        brdfc.rendering(link, "sRGB"), whole, folder / "cylinder.tif", f"lamp at {LAMP}"
    )
    picture = tifffile.imread(folder / "cylinder.tif")
    Image.fromarray(picture).save(folder / "cylinder.png")
    print(f"picture       {folder}/cylinder.png  ({applied.clipped:,} pixels clipped to sRGB)")
    if reference.available():
        pixels = tifffile.imread(whole).reshape(-1, 9)
        judged = reference.apply(mid, mvis, pixels).xyz[0]
        ours = link.apply(pixels).astype(np.float64)
        unit = np.spacing(np.maximum(np.abs(ours), 1e-30).astype(np.float32))
        most = np.max(np.abs(judged - ours) / unit)
        print(f"reference     XYZ differ by {most:.2f} units in the last place of float32 at most")
    print("\nThe same by hand:")
    print(f"  brdfc angles --normals {folder}/normals.tif --heights {folder}/heights.tif \\")
    print(f"        --light {','.join(map(str, LAMP))} --camera {','.join(map(str, CAMERA))} \\")
    print(f"        --coefficients {folder}/prints.tif -o {whole}")
    channels = " ".join(f"--channel {name}" for name in names)
    print(f"  brdfc compile ward -o {mvis} --geometry full --set intensity={np.pi:.9g} \\")
    print(f"        {channels}")
    print(f"  brdfc apply {mid} {mvis} {whole} -o {folder}/cylinder.tif --to sRGB")


if __name__ == "__main__":
    main()
