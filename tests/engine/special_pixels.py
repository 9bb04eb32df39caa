"""Pixels of usual values with some special ones among them."""

from __future__ import annotations

import numpy as np

SPECIAL = [
    *(0.0, -0.0, 1.0, -1.0, 0.5, -0.5, 2.0, 3.0, 1e-40, -1e-40, 3e38, -3e38),
    *(np.inf, -np.inf, np.nan, 2.0**31, 0.49999997, 2.0**20, 1e7, -1e30),
]


def special_pixels(
    random: np.random.Generator, count: int, channels: int, share: float = 0.12
) -> np.ndarray:
    """(count, channels): between -2 and 2, but for a share of special values."""
    usual = random.uniform(-2, 2, (count, channels))
    special = random.choice(SPECIAL, (count, channels))
    return np.where(random.random(usual.shape) < share, special, usual).astype(np.float32)
