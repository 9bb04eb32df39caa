"""Linear systems and matrices, in the reference engine's order of operations."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce

import numpy as np

from brdfc.calc.program import Matrix
from brdfc.engine.kernels import Values

SINGULAR = np.float32(1e-8)
"""The determinant below which the reference engine does not solve a system, whatever its scale."""


def solve(matrix: Sequence[Values], right: Sequence[Values], rows: int) -> list[Values]:
    """`solv`: the solution, then 1 where there is one, else zeros and 0.

    Only 3 x 3 systems are solved, as in the reference engine; any other shape gives zeros. Cramer's
    rule in float32, by columns of cofactors, in the reference's order of operations.
    """
    columns = len(matrix) // rows
    if (rows, columns) != (3, 3):
        return [np.zeros((), dtype=np.float32)] * (columns + 1)
    m = np.array(np.broadcast_arrays(*matrix)).reshape(3, 3, *np.broadcast(*matrix).shape)

    def minor(row: int, column: int) -> Values:
        (r, s), (c, d) = ([i for i in range(3) if i != k] for k in (row, column))
        return np.asarray(m[r, c] * m[s, d] - m[s, c] * m[r, d])

    determinant = m[0, 0] * minor(0, 0) - m[0, 1] * minor(0, 1) + m[0, 2] * minor(0, 2)
    solved = ~(np.abs(determinant) < SINGULAR)
    solution = []
    for j in range(3):
        inverse = [np.float32((-1) ** (i + j)) * minor(i, j) / determinant for i in range(3)]
        x = inverse[0] * right[0] + inverse[1] * right[1] + inverse[2] * right[2]
        solution.append(np.where(solved, x, np.float32(0)))
    return [*solution, solved.astype(np.float32)]


_OFFSETS_LAST = {(3, 3), (3, 4), (4, 3), (4, 4)}
"""Shapes (inputs, outputs) the reference engine has written out; elsewhere offsets come first."""


def apply_matrix(matrix: Matrix, inputs: Sequence[Values]) -> list[Values]:
    """One channel a row; offsets that are all 0 are not added (that would turn -0 into 0)."""
    rows = np.array(matrix.values, dtype=np.float32).reshape(matrix.outputs, matrix.inputs)
    offsets = np.array(matrix.offsets, dtype=np.float32)
    written_out = (matrix.inputs, matrix.outputs) in _OFFSETS_LAST
    results = []
    for row, offset in zip(rows, offsets, strict=True):
        terms = [c * x for c, x in zip(row, inputs, strict=True)]
        if not written_out:
            terms.insert(0, offset)
        elif offsets.any():
            terms.append(offset)
        results.append(np.asarray(reduce(np.add, terms)))
    return results
