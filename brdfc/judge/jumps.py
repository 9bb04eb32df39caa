"""Jumps of a program that its formula does not have.

Points drawn at random never lie to both sides of a jump, so jumps are searched for: between two
points that differ in one number, the half across which the error changes more is halved again,
until the two are neighbouring floats. What is left between them is the jump, if there is one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.symbolic.intervals import LARGEST

STEP = 0.01
"""A jump of this share of the value counts, where the formula itself moves by less nearby."""
_AROUND = 4
"""The formula is looked at so many floats to either side: where it jumps itself, as at a horizon
that its text cuts off, a program may jump a few floats away."""

Pixels = NDArray[np.float32]
Values = NDArray[np.float64]


@dataclass(frozen=True)
class Jumps:
    """Of so many lines: which end in a jump, how large (a share of the value), and between which
    neighbouring floats: `at` is the lower end, (lines, channels)."""

    found: NDArray[np.bool_]
    size: Values
    at: Pixels


def jumps(
    values: Callable[[Pixels], Pixels],
    exact: Callable[[Pixels], Values],
    precise: Callable[[Pixels], Values],
    starts: Pixels,
    ends: Pixels,
    floor: Values,
) -> Jumps:
    """Search along lines from starts to ends, (lines, channels), that differ in one channel each.

    values: the program; exact: its formula, in float64, and precise: with more digits, which has
    the last word. floor: (lines, 1), above 0: what a jump at lesser values is measured against.
    """
    lines = np.arange(len(starts))
    channel = np.argmax(starts != ends, axis=1)
    first, last = _ordinals(starts[lines, channel]), _ordinals(ends[lines, channel])
    low, high = np.minimum(first, last), np.maximum(first, last)

    def moved(ordinal: NDArray[np.int64]) -> Pixels:
        at = starts.copy()
        at[lines, channel] = _floats(ordinal)
        return at

    def known(ordinal: NDArray[np.int64]) -> tuple[Values, Values]:
        """The error, and the value it is compared with; where there is none, neither."""
        at = moved(ordinal)
        truth = np.clip(np.nan_to_num(exact(at)), -LARGEST, LARGEST)
        result = np.clip(np.nan_to_num(values(at).astype(np.float64)), -LARGEST, LARGEST)
        return result - truth, np.abs(truth)

    def across(a: tuple[Values, Values], b: tuple[Values, Values]) -> Values:
        size = np.maximum(np.maximum(a[1], b[1]), floor)
        return np.asarray(np.max(np.abs(a[0] - b[0]) / size, axis=1))

    lower, upper = known(low), known(high)
    while (high - low > 1).any():
        middle = (low + high) // 2
        between = known(middle)
        left = (across(lower, between) >= across(between, upper)) & (high - low > 1)
        right = ~left & (high - low > 1)
        high, low = np.where(left, middle, high), np.where(right, middle, low)
        upper = _chosen(left, between, upper)
        lower = _chosen(right, between, lower)
    size = across(lower, upper)
    found = size > STEP
    for function in (exact, precise):  # the second is slow, and asked only where it matters
        for line in np.flatnonzero(found):
            window = np.repeat(starts[line : line + 1], 2 * _AROUND + 2, axis=0)
            window[:, channel[line]] = _floats(low[line] + np.arange(-_AROUND, _AROUND + 2))
            truth, pair = function(window), values(window[_AROUND : _AROUND + 2])
            least = np.maximum(np.abs(truth).max(axis=0), floor[line])
            with np.errstate(invalid="ignore"):  # of what is no number nothing is found
                size[line] = np.max(np.abs(np.diff(pair.astype(np.float64), axis=0)) / least)
                smooth = np.max(np.ptp(truth, axis=0) / least) < STEP
            found[line] = smooth and size[line] > STEP
    return Jumps(found, size, moved(low))


def _chosen(
    which: NDArray[np.bool_], new: tuple[Values, Values], old: tuple[Values, Values]
) -> tuple[Values, Values]:
    return np.where(which[:, None], new[0], old[0]), np.where(which[:, None], new[1], old[1])


def _ordinals(x: Pixels) -> NDArray[np.int64]:
    """The place of each float in their order."""
    bits = x.view(np.int32).astype(np.int64)
    return np.where(bits < 0, -(bits & 0x7FFFFFFF), bits)


def _floats(ordinal: NDArray[np.int64]) -> Pixels:
    bits = np.where(ordinal < 0, np.int64(0x80000000) - ordinal, ordinal)
    return bits.astype(np.uint32).view(np.float32)
