"""What samples are read from, told so that another process can open the same; and several images of
one size as one image."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from brdfc.images.scaling import Scaling
from brdfc.images.segments import State
from brdfc.images.tiff import KINDS, CoefficientImage, open_samples
from brdfc.images.window import Grain, Window
from brdfc.source.errors import ImageError

SHARED = "every worker needs the source and the result's folder under the client's paths"


class Samples(Protocol):
    """What is read in windows: (rows, columns, channels) float32 each."""

    def window(self, window: Window) -> NDArray[Any]: ...


class Readable(Protocol):
    """What another process can open too."""

    def opened(self) -> AbstractContextManager[Samples]: ...


@dataclass(frozen=True)
class Source:
    """The file of an open image, the state it is in, and what its integers mean."""

    path: Path
    state: State
    scaling: Scaling | None

    @staticmethod
    def of(image: CoefficientImage) -> Source:
        return Source(Path(image.where).absolute(), image.segments.state, image.scaling)

    @contextmanager
    def opened(self) -> Iterator[CoefficientImage]:
        """The image; ImageError where it is not there, or not the same any more."""
        if not self.path.exists():
            raise ImageError("a worker does not see it", where=str(self.path), hint=SHARED)
        with open_samples(self.path, KINDS) as opened:
            image = opened.scaled(self.scaling)
            if image.segments.state != self.state:
                raise ImageError(
                    "the file changed while it was read, or the worker has another",
                    where=str(self.path),
                )
            yield image


@dataclass(frozen=True)
class Beside:
    """Open images of one size, side by side: their channels, one image after the other."""

    images: tuple[CoefficientImage, ...]

    @property
    def grain(self) -> Grain:
        """The least part that can be read of all; see Grain.joined."""
        grain = Grain()
        for image in self.images:
            grain = image.segments.grain.joined(grain, image.width)
        return grain

    def window(self, window: Window) -> NDArray[np.float32]:
        return np.concatenate([image.window(window) for image in self.images], axis=-1)


@dataclass(frozen=True)
class Sources:
    """The files of images side by side."""

    each: Sequence[Source]

    @contextmanager
    def opened(self) -> Iterator[Beside]:
        with ExitStack() as stack:
            yield Beside(tuple(stack.enter_context(one.opened()) for one in self.each))
