"""A print looked at from one side: profiles for that, and no more.

    python examples/scene.py [FOLDER] [--chart]

Writes an image of coefficients near a cyan print's (generated), a scene at (40; -10) degrees whose
ranges are measured from it, and compiles Ward for the general case and for the scene. The image
goes through both, and through the model as it is (compiled for exactly that image); the colours are
compared. With --chart every model of the library is compared in the scene (half a minute).
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import tifffile

from brdfc.colour.difference import ciede2000

SCENE = """tolerance = 0.1

[variables]
incident = "40deg"
reflection = "-10deg"

[channels]
from = "coefficients.tif"
samples = ["Rd", "ks", "m"]
"""
ANGLES = ["--env", "incident=40deg", "--env", "reflection=-10deg"]


def brdfc(folder: Path, *arguments: str) -> None:
    """Run a command, showing it and what it prints."""
    print(f"\n$ brdfc {' '.join(arguments)}", flush=True)
    code = "from brdfc.cli.main import main; main()"
    subprocess.run([sys.executable, "-c", code, *arguments], cwd=folder, check=True)


def main() -> None:
    names = [a for a in sys.argv[1:] if a != "--chart"]
    folder = Path(names[0] if names else "scene")
    folder.mkdir(parents=True, exist_ok=True)
    ends = np.array([[0.1, 0.2], [0.15, 0.28], [0.35, 0.6], [0.02, 0.1], [0.05, 0.1]])
    random = np.random.default_rng(1)
    image = random.uniform(ends[:, 0], ends[:, 1], (400, 500, 5)).astype(np.float32)
    tifffile.imwrite(
        folder / "coefficients.tif", image, photometric="minisblack", planarconfig="contig"
    )
    (folder / "scene.toml").write_text(SCENE)
    brdfc(folder, "compile", "ward", "-o", "ward_mvis.icc")
    brdfc(folder, "compile", "ward", "-o", "scene_mvis.icc", "--scene", "scene.toml")
    brdfc(folder, "check", "scene_mvis.icc", "--scene", "scene.toml")
    for name in ("ward", "scene"):
        pair = [f"{name}_mid.icc", f"{name}_mvis.icc"]
        brdfc(folder, "apply", *pair, "coefficients.tif", "-o", f"{name}.tif", *ANGLES)
    model = ["ward", "coefficients.tif", "-o", "image.tif", "--tolerance", "0.1", *ANGLES]
    brdfc(folder, "apply", *model)
    general = tifffile.imread(folder / "ward.tif")
    print()
    for name in ("scene", "image"):
        worst = ciede2000(tifffile.imread(folder / f"{name}.tif"), general).max()
        print(f"{name}.tif: CIEDE2000 {worst:.1e} from the general profile's colours, at most")
    if "--chart" in sys.argv:
        brdfc(folder, "scene-chart", "scene.toml", "-o", "models.png")


if __name__ == "__main__":
    main()
