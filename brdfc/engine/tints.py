"""Tint arrays: linear interpolation between steps, as the reference engine computes it: a step's
share is rounded to float32, and the sum of both is taken in float64.

Of arrays of whole numbers the reference takes the step before the one it should, and 0 as the
first; that is not followed. They stand for 0 to 1 as in tables, and are interpolated as floats are.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from brdfc.calc.tints import TintArray
from brdfc.engine.kernels import Values
from brdfc.engine.tables import held


def apply_tint(tint: TintArray, inputs: Sequence[Values]) -> list[Values]:
    """The outputs, for an input held within 0..1; NaN counts as 0."""
    steps = tint.samples.values.reshape(-1, tint.outputs)
    last = len(steps) - 1
    position = held(inputs[0]) * np.float32(last)
    index = np.minimum(position.astype(np.intp), last - 1)
    above = position - index.astype(np.float32)
    below = np.float32(1) - above
    lower, upper = (steps[i].astype(np.float64) for i in (index, index + 1))
    sums = (lower * below[..., None] + upper * above[..., None]).astype(np.float32)
    return [sums[..., channel] for channel in range(tint.outputs)]
