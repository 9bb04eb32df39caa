"""What a chart shows: candidates with their price and their errors, and the front of the two."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from brdfc.source.errors import BrdfcError

AS_WRITTEN = "as written"
"""The name of the formula as the model has it."""


@dataclass(frozen=True)
class Point:
    """One candidate.

    layer: what kind of choice it is ("forms"). name: short, unique within its layer. price: ns a
    pixel. bits, mean_bits: error at worst and in the mean, log2(1 + units in the last place). de:
    worst CIEDE2000. formula: in the notation of the language. steps: the rules that led to it.
    bound_bits: what the error is proven not to exceed, where there is a proof; `bits` is only the
    worst that was seen. Raises BrdfcError for a figure that no chart can show.
    """

    layer: str
    name: str
    price: float
    bits: float
    mean_bits: float
    de: float
    operators: int
    formula: str
    steps: tuple[str, ...]
    bound_bits: float | None
    chosen: bool

    def __post_init__(self) -> None:
        figures = {"price": self.price, "bits": self.bits, "mean_bits": self.mean_bits}
        figures |= {"de": self.de, "bound_bits": self.bound_bits or 0.0}
        where = f"{self.layer}, {self.name}"
        for what, figure in figures.items():
            if not math.isfinite(figure) or figure < 0:
                message = f"{what} = {figure} cannot be charted"
                hint = "a form that fails (NaN, infinity) is no candidate"
                raise BrdfcError(message, where=where, hint=hint)
        if self.price == 0:
            message = "price = 0 cannot be charted"
            raise BrdfcError(message, where=where, hint="every program takes time")


def front(points: Iterable[Point], error: str) -> tuple[Point, ...]:
    """The points that no other beats in both price and error, cheapest first.

    error: the attribute to set against the price ("bits", "de"). Of equals one stands for all: the
    chosen one, else the one of fewest steps, else the first given.
    """

    def rank(p: Point) -> tuple[float, float, bool, int]:
        return (p.price, getattr(p, error), not p.chosen, len(p.steps))

    best = math.inf
    found = []
    for point in sorted(points, key=rank):
        if getattr(point, error) < best:
            best = getattr(point, error)
            found.append(point)
    return tuple(found)
