"""Linear systems and matrices, in the reference engine's order of operations.

`apply` computes an operation, or writes it down: see kernels.Apply.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial, reduce
from typing import Any

import numpy as np

from brdfc.calc.disagreements import SINGULAR
from brdfc.calc.program import Matrix
from brdfc.engine.kernels import Apply

_SINGULAR = np.float32(SINGULAR)


def solve(matrix: Sequence[Any], right: Sequence[Any], rows: int, apply: Apply) -> list[Any]:
    """`solv`: the solution, then 1 where there is one, else zeros and 0.

    Only 3 x 3 systems are solved, as in the reference engine; any other shape gives zeros. Cramer's
    rule in float32, by columns of cofactors, in the reference's order of operations.
    """
    add, sub, mul = (partial(apply, name) for name in ("add", "sub", "mul"))
    columns = len(matrix) // rows
    if (rows, columns) != (3, 3):
        return [np.zeros((), dtype=np.float32)[()]] * (columns + 1)
    m = [matrix[3 * row : 3 * row + 3] for row in range(3)]

    def minor(row: int, column: int) -> Any:
        (r, s), (c, d) = ([i for i in range(3) if i != k] for k in (row, column))
        return sub(mul(m[r][c], m[s][d]), mul(m[r][d], m[s][c]))

    terms = [mul(m[0][column], minor(0, column)) for column in range(3)]
    determinant = add(sub(terms[0], terms[1]), terms[2])
    solved = apply("not", apply("lt", apply("abs", determinant), _SINGULAR))
    solution = []
    for j in range(3):
        signed = [mul(np.float32((-1) ** (i + j)), minor(i, j)) for i in range(3)]
        inverse = [apply("div", value, determinant) for value in signed]
        x = reduce(add, [mul(value, right[i]) for i, value in enumerate(inverse)])
        solution.append(apply("choose", solved, x, np.float32(0)))
    return [*solution, solved]


_OFFSETS_LAST = {(3, 3), (3, 4), (4, 3), (4, 4)}
"""Shapes (inputs, outputs) the reference engine has written out; elsewhere offsets come first."""


def apply_matrix(matrix: Matrix, inputs: Sequence[Any], apply: Apply) -> list[Any]:
    """One channel a row; offsets that are all 0 are not added (that would turn -0 into 0)."""
    rows = np.array(matrix.values, dtype=np.float32).reshape(matrix.outputs, matrix.inputs)
    offsets = np.array(matrix.offsets, dtype=np.float32)
    written_out = (matrix.inputs, matrix.outputs) in _OFFSETS_LAST
    results = []
    for row, offset in zip(rows, offsets, strict=True):
        terms = [apply("mul", c, x) for c, x in zip(row, inputs, strict=True)]
        if not written_out:
            terms.insert(0, offset)
        elif offsets.any():
            terms.append(offset)
        results.append(reduce(partial(apply, "add"), terms))
    return results
