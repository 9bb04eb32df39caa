"""A search for the worst point of a cube: many seeds, every quantity swept over its range from
some of them, then the worst of all improved in steps.

Everything is drawn from one fixed sequence, so the same search finds the same point.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from brdfc.laws.reflectance import Array, Values
from brdfc.laws.space import Space

Badness = Callable[[Values], Array]
"""How bad points are (points,), by their quantities (points, components)."""
_AT_ONCE = 1 << 13


@dataclass(frozen=True)
class Effort:
    """seeds: points drawn; swept: points of the sweeps together; starts: how many of the worst are
    improved; tries: new points for each in a round; rounds; kept: how many are handed on."""

    seeds: int
    swept: int
    starts: int
    tries: int
    rounds: int
    kept: int


def search(
    badness: Badness, space: Space, effort: Effort, starts: Array | None = None
) -> tuple[Array, int]:
    """The worst points (kept, dimensions) of the cube, the worst first, and how many were tried.

    starts: points to improve instead of seeds and sweeps. Points without a value are never the
    worst.
    """
    random = np.random.Generator(np.random.PCG64(1))

    def judged(x: Array) -> Array:
        found = []
        for i in range(0, len(x), _AT_ONCE):
            values = space.values(x[i : i + _AT_ONCE])
            bad = badness(values)
            found.append(np.where(np.isnan(bad) | ~space.allows(values), -np.inf, bad))
        return np.concatenate(found)

    if starts is None:
        x = space.drawn_back(seeds(random, space, effort.seeds))
        bad = judged(x)
        # The first seed has all parameters at their upper ends.
        swept = space.drawn_back(sweeps(space, x[[int(bad.argmax()), 0]], effort.swept))
        x, bad = np.concatenate([x, swept]), np.concatenate([bad, judged(swept)])
    else:
        x, bad = starts, judged(starts)
    order = np.argsort(-bad, kind="stable")
    best = order[: effort.starts]
    moved, moved_bad = improved(random, judged, space, x[best], bad[best], effort)
    found = np.concatenate([moved, x[order[: effort.kept]]])
    value = np.concatenate([moved_bad, bad[order[: effort.kept]]])
    worst = np.argsort(-value, kind="stable")[: effort.kept]
    worst = worst[value[worst] > -np.inf]
    return found[worst], len(x) + len(best) * effort.tries * effort.rounds


def seeds(random: np.random.Generator, space: Space, count: int) -> Array:
    """Points of the cube: inside, on its sides and in its corners; of the parameters, some all at
    their defaults, or at one end; and of vectors, half with equal components."""
    x = random.random((count, space.dimensions))
    share = random.choice([0.0, 0.3, 0.8], size=(count, 1))
    x = np.where(random.random(x.shape) < share, np.round(x), x)
    for name in dict.fromkeys(axis.name for axis in space.axes[: space.parameters]):
        first, *rest = space.columns(name)
        grey = random.random(count) < 0.5
        for column in rest:
            x[:, column] = np.where(grey, x[:, first], x[:, column])
    of_parameters = x[:, : space.parameters]
    tenth = count // 10
    of_parameters[:tenth] = 1.0
    of_parameters[tenth : tenth + tenth // 2] = 0.0
    of_parameters[2 * tenth : 3 * tenth] = space.defaults
    return x


def sweeps(space: Space, bases: Array, count: int) -> Array:
    """About count points: from every base, each quantity alone over its whole range, so that what
    happens at one value only is not passed over. The components of a vector move together."""
    groups: dict[str, list[int]] = {}
    for i, axis in enumerate(space.axes):
        groups.setdefault(axis.name or str(i), []).append(i)
    steps = np.linspace(0, 1, count // (len(groups) * len(bases)))
    found = []
    for base in bases:
        for columns in groups.values():
            line = np.repeat(base[None], len(steps), axis=0)
            line[:, columns] = steps[:, None]
            found.append(line)
    return np.concatenate(found)


def improved(
    random: np.random.Generator,
    judged: Callable[[Array], Array],
    space: Space,
    x: Array,
    bad: Array,
    effort: Effort,
) -> tuple[Array, Array]:
    """Every point moved to worse ones nearby, by steps that shrink where they find none."""
    count, dimensions = x.shape
    size = np.full((count, 1, 1), 0.2)
    for _ in range(effort.rounds):
        shape = (count, effort.tries, dimensions)
        moved = random.random(shape) < max(0.3, 1 / dimensions)
        step = np.where(moved, size * random.standard_normal(shape), 0.0)
        tried = np.clip(x[:, None] + step, 0, 1)
        to_end = moved & (random.random(shape) < 0.1)
        tried = np.where(to_end, np.round(tried), tried).reshape(-1, dimensions)
        tried = space.drawn_back(tried)
        found = judged(tried).reshape(count, effort.tries)
        which = found.argmax(axis=1)
        worst = found[np.arange(count), which]
        better = worst > bad
        x = np.where(better[:, None], tried.reshape(shape)[np.arange(count), which], x)
        bad = np.where(better, worst, bad)
        size = np.where(better[:, None, None], size, size * 0.6)
    return x, bad
