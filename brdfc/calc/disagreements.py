"""What releases of the reference engine disagree about, and what brdfc does: one table.

`older` is release 2.2.61, `newer` the one that can be measured (the package iccdev 0.1.1). The
engines here follow the newer one where it is not plainly wrong (engine/kernels.py).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from brdfc.calc.bounds import BINARY, FOLDED, UNARY, least_size
from brdfc.symbolic.bounds import WHOLE_LIMIT
from brdfc.symbolic.intervals import Interval

SINGULAR, LEAST_DIVISOR = 1e-8, 1e-12
"""The determinant below which the newer release solves no system, whatever its scale, and the
divisor below which `mod` is 0 there."""


@dataclass(frozen=True)
class Disagreement:
    """One row. applies: whether an operation may get there, by its operands' intervals, those of
    one component of a vector (`solv`: the matrix if it is 3 x 3, else none); when: the same in
    words; older, newer, here: what it gives there.

    example: a text that leaves one such result, and result: what that is here and in the newer
    release (None: it has no one result to compare).
    """

    operators: tuple[str, ...]
    applies: Callable[..., bool]
    when: str
    older: str
    newer: str
    here: str
    example: str
    result: float | None

    def finding(self, name: str, operands: Sequence[Interval]) -> str:
        """One line on an operation whose operands lie so."""
        last = f" ({_shown(operands[-1])})" if len(operands) in (1, 2) else ""
        said = f"'{name}': {self.when}{last}; older releases give {self.older}"
        return f"{said}, newer ones {self.newer}" if self.newer != "the same" else said


def _shown(a: Interval) -> str:
    """A range as a reader takes it in."""
    text = f"{a.low:.6g}" if a.low == a.high else f"{a.low:.6g}..{a.high:.6g}"
    if (a.low, a.high) == (-math.inf, math.inf):
        text = "any number"
    return f"{text} or NaN" if a.undefined else text


def _zero_divisor(_x: Interval, y: Interval) -> bool:
    return y.has_zero


def _least_divisor(_x: Interval, y: Interval) -> bool:
    return least_size(y) < LEAST_DIVISOR


def _not_finite(*operands: Interval) -> bool:
    return not all(operand.finite for operand in operands)


def _beyond_int(x: Interval) -> bool:
    return not (x.finite and x.low > -WHOLE_LIMIT and x.high < WHOLE_LIMIT)


def _quotient(x: Interval, y: Interval) -> float:
    size, least = max(-x.low, x.high), least_size(y)
    return size / least if least > 0 else math.inf


def _long_quotient(x: Interval, y: Interval) -> bool:
    return _quotient(x, y) >= WHOLE_LIMIT


def _rounded_quotient(x: Interval, y: Interval) -> bool:
    """A quotient below 1 leaves what is divided as it is; a power of two divides exactly."""
    exact = y.low == y.high and abs(math.frexp(y.low)[0]) == 0.5
    return not exact and _quotient(x, y) >= 1


def _may_be_nan(*operands: Interval) -> bool:
    return all(operand.undefined for operand in operands)


def _outside_table(x: Interval) -> bool:
    return x.undefined or x.low < 0 or x.high > 1


def _other_shape(*matrix: Interval) -> bool:
    return not matrix


def _near_singular(*matrix: Interval) -> bool:
    m, mul, sub = matrix, BINARY["mul"], BINARY["sub"]
    minors = [
        sub(mul(m[3 + c], m[6 + d]), mul(m[3 + d], m[6 + c])) for c, d in ((1, 2), (0, 2), (0, 1))
    ]
    first, second, third = (mul(m[column], minors[column]) for column in range(3))
    determinant = UNARY["abs"](FOLDED["sum"]((sub(first, second), third)))
    return determinant.undefined or determinant.low < SINGULAR


DISAGREEMENTS = (
    Disagreement(
        ("div", "sdiv"), _zero_divisor, "the divisor may be 0",
        "an infinity or NaN", "0", "0", "1 0 div", 0.0,
    ),
    Disagreement(
        ("mod",), _least_divisor, "the divisor may be 0, or below 1e-12",
        "what is divided, or any number", "0", "0", "7 0 mod", 0.0,
    ),
    Disagreement(
        ("mod",), _not_finite, "an operand may be infinite or NaN",
        "an infinity or NaN", "0", "0", "+INF 2 mod", 0.0,
    ),
    Disagreement(
        ("mod",), _long_quotient, "the quotient may reach 2^31",
        "any number", "the exact remainder", "the exact remainder", "1e10 0.75 mod", 0.25,
    ),
    Disagreement(
        ("mod",), _rounded_quotient, "the quotient may be rounded to a whole number",
        "0 just below a multiple", "the exact remainder", "the exact remainder", "1 0.1 mod",
        0.09999998658895493,
    ),
    Disagreement(
        ("trnc",), _beyond_int, "the value may reach 2^31 or be NaN",
        "-2147483648", "+-2147483648, and 0 of NaN", "the same", "NaN trnc", 0.0,
    ),
    Disagreement(
        ("rond",), _beyond_int, "the value may reach 2^31 or be NaN",
        "-2147483648", "+-2147483648, 0 of NaN, and 10000 of an infinity", "+-2147483648, 0 of NaN",
        "3e9 rond", 2147483648.0,
    ),
    Disagreement(
        ("sel",), _may_be_nan, "the selector may be NaN",
        "the default", "the first case", "the first case", "NaN sel case { 5 } dflt { 6 }", 5.0,
    ),
    Disagreement(
        ("eq", "neq"), _may_be_nan, "both values may be NaN",
        "equal for one pattern of bits only", "the same", "every NaN equals every NaN",
        "NaN NaN eq", 1.0,
    ),
    Disagreement(
        ("rnum",), _may_be_nan, "the value may be NaN",
        "0 for one pattern of bits only", "the same", "0 for every NaN", "NaN rnum", 0.0,
    ),
    Disagreement(
        ("solv",), _other_shape, "the system is not 3 x 3",
        "zeros, or what the host's own solver finds", "the same", "zeros",
        "2 0 0 2 1 1 solv(2,2) pop(2)", 0.0,
    ),
    Disagreement(
        ("solv",), _near_singular, "the determinant may be below 1e-8",
        "no solution, or what the host's own solver finds", "no solution", "no solution",
        "1 0 0 0 1 0 0 0 1e-9 1 1 1 solv(3,3) pop(3)", 0.0,
    ),
    Disagreement(
        ("clut",), _outside_table, "an input may be outside 0..1 or NaN",
        "what lies beside the table in memory", "the end of the table", "the end of the table",
        "", None,
    ),
    Disagreement(
        ("curv",), _not_finite, "an input of a sampled curve may be infinite or NaN",
        "other numbers", "1 for an infinity, else 0", "the same", "", None,
    ),
)  # fmt: skip
"""Every row, an operator's gravest first."""

BY_OPERATOR = {
    name: [row for row in DISAGREEMENTS if name in row.operators]
    for row in DISAGREEMENTS
    for name in row.operators
}
