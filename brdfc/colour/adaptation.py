"""Chromatic adaptation: linear, as a matrix between two whites."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from brdfc.colour.library import colour_science
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import ValueGivenError

TRANSFORMS = {
    "bradford": "Bradford",
    "cat02": "CAT02",
    "cat16": "CAT16",
    "vonkries": "Von Kries",
    "xyz": "XYZ Scaling",
}
"""The names a user gives, and those of colour-science. Linear Bradford is what the ICC recommends
(ICC.1:2022, annex E)."""


def adaptation_transform(text: str) -> str:
    """A name of TRANSFORMS as a user writes it; ValueGivenError, with the nearest, for another."""
    name = text.strip().lower().replace(" ", "").replace("-", "")
    if name not in TRANSFORMS:
        hint = did_you_mean(name, TRANSFORMS) or ", ".join(TRANSFORMS)
        raise ValueGivenError(f"there is no adaptation transform '{text}'", hint=hint)
    return name


def adaptation_matrix(
    source: Sequence[float], target: Sequence[float], transform: str = "bradford"
) -> NDArray[np.float64]:
    """The matrix (3, 3) from XYZ under one white to corresponding XYZ under another.

    source and target: the whites, X, Y, Z with Y = 1; transform: of TRANSFORMS.
    """
    matrix = colour_science().adaptation.matrix_chromatic_adaptation_VonKries(
        np.asarray(source, dtype=np.float64),
        np.asarray(target, dtype=np.float64),
        TRANSFORMS[transform],
    )
    return np.asarray(matrix, dtype=np.float64)
