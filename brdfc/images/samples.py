"""What is made of colours on the way to a file: floats as they are, or integers."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.cmm.rendering import Rendering, Target
from brdfc.source.errors import ValueGivenError

Ends = tuple[float, float]


@dataclass(frozen=True)
class Samples:
    """Of an image that is written: float32, uint16 or uint8. ends: of integers that are numbers,
    what 0 and the greatest stand for; None for floats, and for pictures."""

    kind: np.dtype[Any]
    ends: Ends | None = None

    def counted(self, values: NDArray[Any]) -> tuple[NDArray[Any], int]:
        """Values (..., samples) as they are written, rounded to the nearest and clipped; and how
        many pixels were clipped."""
        if self.ends is None:
            return values, 0
        low, high = self.ends
        greatest = int(np.iinfo(self.kind).max)
        steps = (values.astype(np.float64) - low) * (greatest / (high - low))
        inside = (steps >= -0.5) & (steps <= greatest + 0.5)
        # fmin and fmax make a number of what is none.
        found = np.rint(np.fmin(np.fmax(steps, 0), greatest)).astype(self.kind)
        return found, int((~inside).any(axis=-1).sum())

    def __str__(self) -> str:
        if self.ends is None:
            return ""
        return f"0..{np.iinfo(self.kind).max} are {self.ends[0]:.9g}..{self.ends[1]:.9g}"


_GIVEN = re.compile(r"(float32|uint16|uint8)(?::(.+?)\.\.(.+))?")


def samples(text: str | None, rendering: Rendering) -> Samples:
    """The samples that a text like `uint16:0..2` asks for; None for the usual ones.

    Raises ValueGivenError for a text that says nothing, or what makes no sense of these colours.
    """
    picture = rendering.to is Target.SRGB
    if text is None:
        return Samples(np.dtype(rendering.dtype))
    found = _GIVEN.fullmatch(text.strip())
    if found is None:
        raise ValueGivenError(f"'{text}' are no samples", hint="float32, uint16, uint16:0..2")
    kind, low, high = found.groups()
    if picture:
        if kind == "float32" or low is not None:
            raise ValueGivenError(
                f"--samples {text}: a picture in sRGB has 8 or 16 bits", hint="uint8 or uint16"
            )
        return Samples(np.dtype(kind))
    if kind == "uint8" and rendering.to is not Target.DEVICE:
        raise ValueGivenError("8 bits are for pictures", hint="--to sRGB, or --samples uint16")
    if kind == "float32":
        if low is not None:
            raise ValueGivenError("floats are written as they are: they take no LOW..HIGH")
        return Samples(np.dtype(np.float32))
    if low is None and rendering.to is Target.LAB:
        raise ValueGivenError(
            "CIELAB as integers needs the range that they stand for",
            hint="--samples uint16:-128..128",
        )
    return Samples(np.dtype(kind), ends(low or "0", high or "1"))


def ends(low: str, high: str) -> Ends:
    """The ends of a range of plain numbers; ValueGivenError for any other text."""
    try:
        least, greatest = float(low), float(high)
    except ValueError:
        least = greatest = np.nan
    if not (np.isfinite([least, greatest]).all() and least < greatest):
        raise ValueGivenError(f"'{low}..{high}' is no range", hint="write, say, 0..1")
    return least, greatest
