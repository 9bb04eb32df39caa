"""Stacks of images, made up from a model: coefficients that change over the image, with noise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import tifffile

from brdfc.fit.response import Response
from brdfc.lang.load import load

D50 = (0.9642, 1.0, 0.8249)
ANGLES = [
    (i, o)
    for i in (10, 25, 40, 55, 70)
    for o in (-60, -30, 0, i - 12, i - 5, i, i + 5, min(i + 12, 80))
]
"""Degrees in the plane of incidence, a reflection on the mirror side positive: 40 geometries."""


def directions(angles: list[tuple[int, int]] = ANGLES) -> np.ndarray:
    return np.radians([[i, abs(o), 0, 180 if o >= 0 else 0] for i, o in angles])


def coefficients(name: str, height: int, width: int) -> np.ndarray:
    """(height, width, p)."""
    y, x = np.mgrid[:height, :width] / max(height, width)
    found = {
        "lambert": [0.1 + 0.8 * x, 0.2 + 0.5 * y, 0.3 + 0.3 * x * y],
        "ward": [0.1 + 0.8 * x, 0.2 + 0.5 * y, 0.3 + 0.3 * x * y, 0.02 + 0.1 * x, 0.05 + 0.3 * y],
        "ggx": [0.1 + 0.8 * x, 0.2 + 0.5 * y, 0.3 + 0 * x, 0.3 + 0.5 * x, 0.1 + 0.3 * y, 0.05 + y],
    }[name]
    return np.stack(found, axis=-1)


def reflected(name: str, truth: np.ndarray, noise: float = 0.0) -> np.ndarray:
    """(height, width, n, 3) float32, BRDF."""
    values = Response(load(name, "full"), directions(), {}, D50).values(truth)
    random = np.random.default_rng(1)
    values *= np.maximum(1 + noise * random.standard_normal(values.shape), 0.01)
    return values.astype(np.float32)


def write_stack(
    folder: Path, values: np.ndarray, unit: str = "brdf", says: str = "", **options: object
) -> Path:
    """Images of (height, width, n, channels), and the file that lists them."""
    folder.mkdir(exist_ok=True)
    text = f'unit = "{unit}"\n{says}\n'
    for number, (incident, reflection) in enumerate(ANGLES[: values.shape[2]]):
        image = np.ascontiguousarray(values[:, :, number])
        tifffile.imwrite(
            folder / f"{number}.tif",
            image,
            photometric="minisblack",
            planarconfig="contig" if image.shape[-1] > 1 else None,
            **options,
        )
        text += f'[[image]]\nfile = "{number}.tif"\n'
        text += f'incident = "{incident}deg"\nreflection = "{reflection}deg"\n'
    path = folder / "stack.toml"
    path.write_text(text)
    return path
