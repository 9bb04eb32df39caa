"""The bound on CIEDE2000 holds for changes of any colours, and is nearly attained by small ones."""

from __future__ import annotations

import numpy as np
import pytest

from brdfc.colour.colorimetry import Colorimetry
from brdfc.proof.intervals import Enclosure
from brdfc.proof.pair import Pair
from brdfc.proof.subdivide import bound
from brdfc.symbolic.expression import make, quantity
from brdfc.symbolic.intervals import Interval

BASE, CHANGE = quantity("base", 3), quantity("change", 3)
WHITE = (0.9642, 1.0, 0.8249)


def pair(base: list[tuple[float, float]], change: list[tuple[float, float]]) -> Pair:
    domain = {
        "base": [Interval(*ends) for ends in base],
        "change": [Interval(*ends) for ends in change],
    }
    return Pair(BASE, make("add", BASE, CHANGE), Colorimetry(WHITE), domain)


@pytest.mark.parametrize(
    ("largest", "smallest"),
    [(1.0, 1e-4), (0.01, 1e-6), (300.0, 1.0), (1.0, 1.0)],
    ids=["usual", "dark", "highlights", "large changes"],
)
def test_no_change_is_worth_more(largest: float, smallest: float) -> None:
    """Greys and saturated colours, the straight part of CIELAB, and beyond 100 times white."""
    random = np.random.Generator(np.random.PCG64(11))
    whole = pair([(0, largest)] * 3, [(-largest, largest)] * 3)
    count = 2000
    grey = np.array(WHITE) * random.random((count, 1)) * largest
    base = np.where(random.random((count, 1)) < 0.4, grey, random.random((count, 3)) * largest)
    size = smallest * 10 ** random.uniform(-3, 0, (count, 1))
    change = size * random.uniform(-1, 1, (count, 3))
    low = np.concatenate([base, change], axis=1)
    width = np.concatenate([base * 0.1, abs(change) * 0.1], axis=1) * random.random((count, 1))
    boxes = Enclosure(low, low + width)
    found, _ = whole.bounds(boxes)
    for _ in range(20):
        points = low + random.random(low.shape) * width
        seen = whole.differences(points)
        assert (seen <= found + 1e-6).all()
    assert np.median((seen / found)[seen > 1e-3]) > 0.5


def test_a_bound_is_proved_and_nearly_attained() -> None:
    """A neutral change of a narrow range of colours: branch and bound comes within TIGHT."""
    whole = pair([(0.2, 0.25), (0.2, 0.25), (0.2, 0.25)], [(0, 1e-3), (0, 1e-3), (0, 1e-3)])
    found = bound(whole, 5.0, 20_000, 20_000)
    assert 0 < found.seen <= found.most <= 1.35 * found.seen


def test_a_proof_that_does_not_end_is_given_up() -> None:
    whole = pair([(0.0, 1.0)] * 3, [(0, 1e-3)] * 3)
    found = bound(whole, 1e-6, 2_000)
    assert found.most > 1e-6
    assert found.boxes < 4_000
