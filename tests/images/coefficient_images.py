"""Images of Ward's coefficients for tests, and what writes them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import tifffile


def coefficients(height: int = 23, width: int = 17) -> np.ndarray:
    random = np.random.default_rng(3)
    image = random.uniform(0, 1, (height, width, 5)).astype(np.float32)
    image[..., 4] = random.uniform(0.05, 0.5, (height, width))
    return image


def write(path: Path, image: np.ndarray, **options: object) -> Path:
    layout = {"photometric": "minisblack", "planarconfig": "contig", **options}
    data = np.moveaxis(image, -1, 0) if layout["planarconfig"] == "separate" else image
    tifffile.imwrite(path, data, **layout)
    return path


def left(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())
