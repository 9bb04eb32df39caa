"""Enclosures hold what 50 digits give, for every operator, at the edges of its domain too."""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import mp, mpf

from brdfc.proof import intervals as on
from brdfc.proof.intervals import Enclosure

context = mp.clone()
context.dps = 50

EXACT = {
    "exp": (context.exp, -750, 700),
    "ln": (context.ln, 1e-12, 1e12),
    "log10": (context.log10, 1e-12, 1e12),
    "sqrt": (context.sqrt, 0, 1e6),
    "cbrt": (lambda x: context.sign(x) * context.cbrt(abs(x)), -1e3, 1e3),
    "sin": (context.sin, -20, 20),
    "cos": (context.cos, -20, 20),
    "tan": (context.tan, -4, 4),
    "asin": (context.asin, -1, 1),
    "acos": (context.acos, -1, 1),
    "atan": (context.atan, -1e3, 1e3),
}


@pytest.mark.parametrize("name", EXACT)
def test_functions_of_one_argument(name: str) -> None:
    exact, low, high = EXACT[name]
    random = np.random.Generator(np.random.PCG64(3))
    size = (high - low) * 10 ** random.uniform(-15, 0, (400, 1))
    start = low + random.random(size.shape) * (high - low - size)
    end = np.minimum(start + size, high)
    start[:3], end[:3] = low, high
    found = on.FUNCTIONS[name](Enclosure(start, end))
    for i in range(len(start)):
        for share in (0.0, 1.0, random.random()):
            x = mpf(float(start[i, 0])) + mpf(share) * (float(end[i, 0]) - float(start[i, 0]))
            value = exact(x)
            assert not found.low[i, 0] > value, (name, x)
            assert not found.high[i, 0] < value, (name, x)
