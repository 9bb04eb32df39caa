"""Where releases of the reference engine disagree, or the one at hand is known to be wrong.

A value that rests on such a point is compared with nothing; it is left out and counted.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

DISPUTED: Mapping[str, str] = {
    "div": "x/0 and x sdiv 0 are infinite or NaN in one release and 0 in the next",
    "mod": "remainders by less than 1e-12, of or by what is not finite, and of quotients from 2^24 "
    "on: rounding errors in one release, exact or 0 in the next",
    "trnc": "from 2^31 on and of what is not finite: one integer, or the nearest",
    "rond": "the same, and 10000 for infinities; selectors are rounded so too",
    "rnum": "of the many bit patterns of NaN the reference knows one",
    "eq": "two NaNs are equal where they have that pattern, or differ, here and in `neq`",
    "curv": "a curve of what is not finite, and a quotient by 0 in a formula of a curve",
}
"""What is left out, by the operator that it comes from."""

_BITS = {name: np.int64(1 << k) for k, name in enumerate(DISPUTED)}


def mark(name: str, where: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The bit of a point in dispute, for the pixels that come upon it."""
    return np.where(where, _BITS[name], np.int64(0))


def counts(marks: NDArray[np.int64]) -> dict[str, int]:
    """How many values rest on each of the points."""
    return {name: int(((marks & bit) != 0).sum()) for name, bit in _BITS.items()}
