"""What the integers of an image mean: a scaling that the user states, never one that is guessed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.source.errors import ImageError

Ends = tuple[float, float]


@dataclass(frozen=True)
class Scaling:
    """For each channel what 0 and what the greatest integer mean; greatest: 255 or 65535."""

    ends: tuple[Ends, ...]
    greatest: int

    def apply(self, integers: NDArray[Any]) -> NDArray[np.float32]:
        """float32 for integers (..., channels), in the same layout: rounded once, from float64."""
        values = np.empty_like(integers, dtype=np.float32)
        if len(set(self.ends)) == 1:
            # "clip" changes no index, and spares numpy a copy of the result.
            return np.take(self._table(self.ends[0]), integers, out=values, mode="clip")
        for channel, ends in enumerate(self.ends):
            values[..., channel] = self._table(ends)[integers[..., channel]]
        return values

    def _table(self, ends: Ends) -> NDArray[np.float32]:
        low, high = ends
        steps = np.arange(self.greatest + 1, dtype=np.float64)
        return (low + steps * ((high - low) / self.greatest)).astype(np.float32)

    def __str__(self) -> str:
        told = sorted(set(self.ends))
        if len(told) == 1:
            return f"0..{self.greatest} are {told[0][0]:.9g}..{told[0][1]:.9g}"
        each = ", ".join(f"{low:.9g}..{high:.9g}" for low, high in self.ends)
        return f"0..{self.greatest} are, in the order of the samples, {each}"


def scaling(
    stated: Mapping[str, Ends], names: Sequence[str], kind: np.dtype[Any], where: str
) -> Scaling | None:
    """The scaling of an image whose samples have these names; None for floats, which need none.

    stated: ends by channel, "" for all that are not named. Raises ImageError where integers have
    no scaling, or floats have one.
    """
    if kind.kind == "f":
        if stated:
            raise ImageError(
                f"its samples are {kind}, which are taken as they are; --scale is for integers",
                where=where,
            )
        return None
    missing = [name for name in names if name not in stated and "" not in stated]
    if missing:
        raise ImageError(
            f"its samples are {kind}, and nothing says what they mean: {', '.join(missing)}",
            where=where,
            hint="state it: --scale 0..1 for all, --scale NAME=LOW..HIGH for one",
        )
    ends = tuple(stated[name] if name in stated else stated[""] for name in names)
    return Scaling(ends, int(np.iinfo(kind).max))
