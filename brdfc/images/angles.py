"""An image of normals to an image of angles, band by band."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from brdfc.files import refuse_same
from brdfc.images.directions import NAMES, Arrangement, Faced, angles, positions
from brdfc.images.tiff import CoefficientImage, open_samples
from brdfc.images.writing import write_colours
from brdfc.source.errors import ImageError

_KINDS = (np.uint8, np.uint16, np.float32)


def angles_to_tiff(
    normals: str | Path,
    target: str | Path,
    scene: Arrangement,
    heights: str | Path | None = None,
    coefficients: str | Path | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Faced:
    """Write the angles of every pixel as float32 samples, in radians, in the order of NAMES.

    normals: a TIFF of three samples: float32 components, or 8 or 16 bit integers for -1..1, as
    normal maps have them. heights: a float32 TIFF of one sample, z in the scene's unit.
    coefficients: a float32 TIFF whose samples come first in the target, so that it is what a
    profile with the angles among its channels takes. progress gets pixels done and in all.
    Raises ImageError for images that do not fit, and for normals that have no direction.
    """
    refuse_same([target], [normals, heights, coefficients])
    faced = Faced()
    with ExitStack() as stack:
        image = stack.enter_context(open_samples(normals, _KINDS))
        if image.channels != 3:
            raise ImageError(
                f"{image.channels} samples a pixel; a normal has 3: x, y, z", where=str(normals)
            )
        raised = _beside(stack, heights, image, "heights")
        if raised is not None and raised.channels != 1:
            raise ImageError(f"{raised.channels} samples; a height is one", where=str(heights))
        others = _beside(stack, coefficients, image, "coefficients")

        def bands() -> Iterator[NDArray[np.float32]]:
            top = 0
            for band in image.bands():
                rows = slice(top, top + len(band))
                vectors = _vectors(band, image, str(normals), top)
                size = (len(band), image.height, image.width)
                places = positions(top, *size, scene.width)
                if raised is not None:
                    places[..., 2] = _finite(raised.rows(rows), str(heights), top)[..., 0]
                found = angles(vectors, places, scene, faced)
                if others is not None:
                    more = _finite(others.rows(rows), str(coefficients), top)
                    found = np.concatenate([more, found], axis=-1)
                yield found
                top += len(band)
                progress(top * image.width, image.height * image.width)

        names = NAMES[scene.geometry]
        samples = len(names) + (others.channels if others else 0)
        about = f"angles in radians: {', '.join(names)}"
        about = f"coefficients, then {about}" if others else about
        write_colours(target, (image.height, image.width, samples), bands(), about)
    return faced


def _beside(
    stack: ExitStack, path: str | Path | None, image: CoefficientImage, what: str
) -> CoefficientImage | None:
    """Another image of the same size."""
    if path is None:
        return None
    found: CoefficientImage = stack.enter_context(open_samples(path, (np.float32,)))
    if (found.height, found.width) != (image.height, image.width):
        raise ImageError(
            f"{found.height} rows of {found.width} {what}, {image.height} rows of "
            f"{image.width} normals",
            where=str(path),
        )
    return found


def _finite(band: NDArray[np.float32], where: str, top: int) -> NDArray[np.float32]:
    """The same, once it is sure that all of it are numbers."""
    bad = ~np.isfinite(band)
    if bad.any():
        row, column, _ = (int(i) for i in np.argwhere(bad)[0])
        raise ImageError(
            f"{int(bad.sum())} samples of this part are NaN or infinite, the first at row "
            f"{top + row}, column {column}",
            where=where,
        )
    return band


def _vectors(
    band: NDArray[np.float32], image: CoefficientImage, where: str, top: int
) -> NDArray[np.float64]:
    wide = band.astype(np.float64)
    if image.greatest:
        # 127.5 of 255 is 0: the middle of a normal map's grey.
        wide = wide * (2 / image.greatest) - 1
    size = np.linalg.norm(wide, axis=-1)
    bad = ~(np.isfinite(size) & (size > 0))
    if bad.any():
        row, column = (int(i) for i in np.argwhere(bad)[0])
        raise ImageError(
            f"{int(bad.sum())} normals of this part have no direction, the first at row "
            f"{top + row}, column {column}",
            where=where,
            hint="mask them with (0, 0, 1)",
        )
    return wide
