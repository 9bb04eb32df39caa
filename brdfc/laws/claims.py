"""A law that a model claims, and what a search for its worst point found, in words."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

from brdfc.laws.reflectance import ANGLES
from brdfc.symbolic.expression import Expression

Point = Mapping[str, tuple[float, ...]]
"""The value of every quantity, one number a component, angles in radians."""
RAISED = "'"
"""After a quantity's name: a second, larger value of it."""

COUNTED = {"energy": "albedos", "reciprocal": "pairs", "increasing": "steps"}
_WORST = {
    "energy": "{} at worst",
    "bounded": "{} at worst",
    "positive": "{} at least",
    "reciprocal": "relative difference {} at worst",
    "increasing": "relative fall {} at worst",
}


@dataclass(frozen=True)
class Claim:
    """name: reciprocal, positive, energy, bounded or increasing; bound: of energy and bounded;
    quantities: what increasing is about; condition: on the parameters, where the law is claimed,
    if not everywhere; text: as the model writes it, its name if left out."""

    name: str
    bound: float | None = None
    quantities: tuple[str, ...] = ()
    condition: Expression | None = None
    text: str = ""

    def __str__(self) -> str:
        return self.text or self.name


@dataclass(frozen=True)
class LawResult:
    """What the worst point found is.

    holds: whether the law holds even there. settled: False where a figure is uncertain by more
    than decides it, or has no value, so that holds means nothing. worst: the albedo, the
    reflectance, the least radiance, or the relative difference or fall; at: where, of the
    directions those that the figure depends on; points: how many were tried; angles: the names
    in `at` that are angles.
    """

    claim: Claim
    holds: bool
    settled: bool
    worst: float
    at: Point
    points: int
    angles: Collection[str]

    def __str__(self) -> str:
        worst = f"{self.worst:.5g}" if math.isfinite(self.worst) else "no value"
        said = _WORST[self.claim.name].format(worst)
        counted = COUNTED.get(self.claim.name, "points")
        doubt = "" if self.settled else "; not settled, the figure is uncertain"
        where = shown(self.at, self.angles)
        return f"{self.claim}: {said} ({where}), of {self.points:,} {counted}{doubt}"


def shown(point: Point, angles: Collection[str]) -> str:
    """A point as a model's text would give it: incident=80deg m=0.2 Rd=(0.1, 0.2, 0.3).

    angles: the quantities to write in degrees; of them the directions come first.
    """
    ordered = sorted(point, key=lambda name: name not in ANGLES)
    return " ".join(
        f"{name}={_value(point[name], name.removesuffix(RAISED) in angles)}" for name in ordered
    )


def _value(components: tuple[float, ...], is_angle: bool) -> str:
    texts = [f"{math.degrees(c):.7g}deg" if is_angle else f"{c:.5g}" for c in components]
    return texts[0] if len(set(texts)) == 1 else f"({', '.join(texts)})"
