"""The images of a stack, opened and checked."""

from __future__ import annotations

from contextlib import ExitStack

from brdfc.fit.stack import Stack
from brdfc.images.scaling import Scaling, scaling
from brdfc.images.tiff import KINDS, CoefficientImage, open_samples
from brdfc.source.errors import ImageError


def open_images(stack: ExitStack, seen: Stack) -> list[CoefficientImage]:
    """The images, open as long as the context is, with what their integers mean.

    Raises ImageError for one that cannot be read, that has not 1 or 3 samples a pixel, or is not of
    the size of the first.
    """
    images: list[CoefficientImage] = []
    for path in seen.files:
        image = stack.enter_context(open_samples(path, KINDS))
        shape = image.height, image.width, image.channels
        if image.channels not in (1, 3):
            raise ImageError(
                f"{image.channels} samples a pixel; an image of a stack has 1 or 3",
                where=str(path),
            )
        first = images[0] if images else image
        wanted = first.height, first.width, first.channels
        if shape != wanted:
            raise ImageError(
                "{} rows of {} pixels of {} samples, the first image has {} of {} of {}".format(
                    *shape, *wanted
                ),
                where=str(path),
                hint="all images of a stack are of one size, pixel on pixel",
            )
        images.append(image.scaled(_scaling(seen, image)))
    return images


def _scaling(seen: Stack, image: CoefficientImage) -> Scaling | None:
    """What the integers of an image mean, as the stack says."""
    stated = {} if seen.scale is None or image.kind.kind == "f" else {"": seen.scale}
    if image.kind.kind != "f" and seen.scale is None:
        raise ImageError(
            f"its samples are {image.kind}, and nothing says what they mean",
            where=image.where,
            hint='say it in the stack: scale = "0..1"',
        )
    return scaling(stated, [str(n) for n in range(image.channels)], image.kind, image.where)
