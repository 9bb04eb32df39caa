"""No difference that can be seen inside a box exceeds what is proved of it."""

from __future__ import annotations

import math

import numpy as np
import pytest

import brdfc
from brdfc.colour.colorimetry import Colorimetry
from brdfc.prepared import prepare
from brdfc.proof.intervals import Enclosure
from brdfc.proof.pair import Pair
from brdfc.proof.subdivide import spread
from brdfc.scenes.candidates import Known, replacements
from brdfc.symbolic.evaluate import evaluate_parts
from brdfc.symbolic.expression import substituted
from brdfc.symbolic.formula import simplest
from brdfc.symbolic.intervals import Interval

WHITES = ((0.9642, 1.0, 0.8249), (0.97, 1.0, 0.484), (1.0, 1.0, 1.0))
MODELS = (
    "ward",
    "ward_anisotropic",
    "cook_torrance_1982",
    "ggx",
    "oren_nayar",
    "blinn_phong",
    "hapke",
    "print_layer",
    "minnaert",
)


def narrowed(random: np.random.Generator, low: float, high: float) -> Interval:
    """A part of a range, now and then all of it, or next to nothing."""
    width = random.choice([1.0, 0.5, 0.1, 1e-3]) * (high - low)
    start = low + random.random() * (high - low - width)
    return Interval(start, start + width)


def boxes(random: np.random.Generator, pair: Pair, count: int) -> Enclosure:
    """Boxes inside the domain, of any size."""
    whole = pair.whole()
    size = (whole.high - whole.low) * 10 ** random.uniform(-4, 0, (count, whole.low.shape[1]))
    low = whole.low + random.random(size.shape) * (whole.high - whole.low - size)
    return Enclosure(low, low + size)


@pytest.mark.parametrize("name", MODELS)
def test_every_omission_is_bounded_in_every_box(name: str) -> None:
    """The candidates of random scenes, in random boxes, at random points and corners of them."""
    random = np.random.Generator(np.random.PCG64(len(name)))
    model = brdfc.load(name)
    tight = []
    for trial in range(3):
        white = WHITES[trial % len(WHITES)]
        roles, ready = prepare(model, {}, (), True, white)
        domain = {n: narrowed(random, i.low, i.high) for n, i in ready.domain.items()}
        if trial == 0:  # where colours differ, and most proofs are
            domain |= {
                n: Interval(math.radians(20), math.radians(50)) for n in ("incident", "reflection")
            }
        formula = simplest(ready.exact, domain)
        parts = {
            q.name: (domain[q.name],) * q.type.value.width for q in roles.channels + roles.variables
        }
        seen = Pair(formula, formula, Colorimetry(white), parts)
        values = evaluate_parts(formula, seen.by_name(spread(seen, 64)))
        found = list(replacements(formula, Known(parts, values)))
        for index in random.permutation(len(found))[:40]:
            lean = substituted(formula, {found[index].part: found[index].by})
            pair = Pair(formula, lean, Colorimetry(white), parts)
            some = boxes(random, pair, 48)
            bound, _ = pair.bounds(some)
            worst = np.zeros(len(bound))
            for _ in range(24):
                share = random.random(some.low.shape)
                share = np.where(random.random(share.shape) < 0.3, np.round(share), share)
                points = some.low + share * (some.high - some.low)
                seen = pair.differences(points)  # infinite where a replacement is undefined
                worst = np.maximum(worst, np.where(np.isfinite(seen), seen, 0.0))
            assert (worst <= bound + 1e-7).all(), (str(found[index].words), worst / bound)
            counted = (worst > 1e-4) & np.isfinite(bound)
            tight += (worst / bound)[counted].tolist()
    assert np.median(tight) > 0.05  # bounds that are useful, not only true
