"""What every operator computes: the calculator's arithmetic as array functions.

Arithmetic is float32, rounded after every operation. Transcendental functions are computed in
float64 and rounded once: NumPy's own float32 versions change with the processor, this does not,
and it is within one unit in the last place of any good C library.

Where releases of the reference engine disagree, these follow the newest one there is to measure
(the package iccdev 0.1.1), as calc/disagreements.py lists: x/0 is 0, `mod` is the exact remainder
(0 for a divisor below 1e-12), `trnc` and `rond` saturate at 2^31. They do not follow it where it is
wrong: `rond` of an infinity saturates too (the reference gives 10000); every NaN equals every NaN
in `eq`, and `rnum` is 0 for every NaN (the reference knows one bit pattern of them). Generated
programs never depend on any of these.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.disagreements import LEAST_DIVISOR

Values = NDArray[np.float32]
Kernel = Callable[..., Values]


def _single(function: Callable[..., Any]) -> Kernel:
    """Compute in float64, round once to float32."""

    def kernel(*arguments: Values) -> Values:
        wide = (np.asarray(a, dtype=np.float64) for a in arguments)
        return np.asarray(function(*wide)).astype(np.float32)

    return kernel


def _truth(condition: Any) -> Values:
    return np.asarray(condition).astype(np.float32)


def holds(x: Values) -> NDArray[np.bool_]:
    """The truth of a value: at least one half; NaN does not hold."""
    return np.asarray(x >= np.float32(0.5))


def _divide(x: Values, y: Values) -> Values:
    return np.where(y == 0, np.float32(0), x / np.where(y == 0, np.float32(1), y))


def _power(x: Any, y: Any) -> Any:
    """C's pow. Where the exponent is one half for a whole array NumPy takes square roots, which for
    -0 and minus infinity are something else."""
    root = (y == 0.5) & ((x == 0) | (x == -np.inf))
    return np.where(root, np.abs(x), np.power(x, y))


def _remainder(x: Values, y: Values) -> Values:
    good = np.isfinite(x) & np.isfinite(y) & (np.abs(y).astype(np.float64) >= LEAST_DIVISOR)
    return np.where(good, np.fmod(x, np.where(good, y, np.float32(1))), np.float32(0))


def _saturated(x: NDArray[np.float64]) -> Values:
    """The nearest 32-bit integer, as float32; NaN is 0."""
    clipped = np.clip(np.nan_to_num(x, nan=0.0), -2147483648.0, 2147483647.0)
    return (np.trunc(clipped) + 0.0).astype(np.float32)


def _rounded(x: Values) -> Values:
    wide = x.astype(np.float64)
    return _saturated(wide + np.copysign(0.5, wide))


def _equal(x: Values, y: Values) -> NDArray[np.bool_]:
    return np.asarray((x == y) | (np.isnan(x) & np.isnan(y)))


def _lesser(x: Values, y: Values) -> Values:
    return np.where(x < y, x, y)


def _greater(x: Values, y: Values) -> Values:
    return np.where(x > y, x, y)


def _near(x: Values, y: Values) -> Values:
    return _truth(np.abs(x - y).astype(np.float64) < 1e-5)


def selector(x: Values) -> NDArray[np.int64]:
    """The case `sel` takes: rounded half away from zero."""
    return _rounded(np.asarray(x)).astype(np.int64)


CONSTANTS = {"pi": np.pi, "+INF": np.inf, "-INF": -np.inf, "NaN": np.nan}
"""Operators that push a number."""

BINARY: dict[str, Kernel] = {
    "add": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "div": _divide,
    "mod": _remainder,
    "pow": _single(_power),
    "atn2": _single(lambda x, y: np.arctan2(y, x)),
    "lt": lambda x, y: _truth(x < y),
    "le": lambda x, y: _truth(x <= y),
    "eq": lambda x, y: _truth(_equal(x, y)),
    "neq": lambda x, y: _truth(~_equal(x, y)),
    "near": _near,
    "ge": lambda x, y: _truth(x >= y),
    "gt": lambda x, y: _truth(x > y),
    "vmin": _lesser,
    "vmax": _greater,
    "vand": lambda x, y: _truth(holds(x) & holds(y)),
    "vor": lambda x, y: _truth(holds(x) | holds(y)),
    "vxor": lambda x, y: _truth(holds(x) ^ holds(y)),
}
"""(x, y) to one result, component by component; y is the block nearer the top."""

IEEE: dict[str, Kernel] = {**BINARY, "div": np.divide}
"""The same for engines that leave division by zero to the processor."""

UNARY: dict[str, Kernel] = {
    "neg": np.negative,
    "sq": lambda x: x * x,
    "sqrt": np.sqrt,
    "cb": lambda x: x * x * x,
    "cbrt": _single(np.cbrt),
    "sign": lambda x: _truth(x > 0) - _truth(x < 0),
    "abs": lambda x: np.where(x < 0, -x, x),
    "flor": np.floor,
    "ceil": np.ceil,
    "trnc": lambda x: _saturated(x.astype(np.float64)),
    "rond": _rounded,
    "exp": _single(np.exp),
    "log": _single(np.log10),
    "ln": _single(np.log),
    "sin": _single(np.sin),
    "cos": _single(np.cos),
    "tan": _single(np.tan),
    "asin": _single(np.arcsin),
    "acos": _single(np.arccos),
    "atan": _single(np.arctan),
    "rnum": lambda x: _truth(np.isfinite(x)),
    "not": lambda x: _truth(~holds(x)),
}
"""x to one result, component by component."""

SCALED: dict[str, str] = {
    "gama": "pow",
    "sadd": "add",
    "ssub": "sub",
    "smul": "mul",
    "sdiv": "div",
}
"""A vector with one scalar on top: the operator of BINARY that is repeated."""


def _least(values: Sequence[Values]) -> Values:
    """Two values are compared as `vmin` compares them; of more, the deepest is kept until a lesser
    one is found. It matters for NaN: two give y where x is NaN, more give NaN there."""
    if len(values) == 2:
        return _lesser(*values)
    return reduce(lambda x, y: np.where(y < x, y, x), values)


def _greatest(values: Sequence[Values]) -> Values:
    """As _least."""
    if len(values) == 2:
        return _greater(*values)
    return reduce(lambda x, y: np.where(y > x, y, x), values)


FOLDED: dict[str, Callable[[Sequence[Values]], Values]] = {
    "sum": lambda values: reduce(np.add, values),
    "prod": lambda values: reduce(np.multiply, values),
    "min": _least,
    "max": _greatest,
    # A NaN counts as true here and as false everywhere else: the reference tests x < 0.5.
    "and": lambda values: _truth(reduce(np.logical_and, [~(v < 0.5) for v in values])),
    "or": lambda values: _truth(reduce(np.logical_or, [holds(v) for v in values])),
}
"""Many values, deepest first, to one; sums and products round after every term."""


Apply = Callable[..., Any]
"""How the functions below compute an operation: `apply(name, *arguments)`, by a name of the tables
above or of INNER. The interpreter computes at once, a trace writes it down (trace.py)."""


def compute(name: str, *arguments: Values) -> Values:
    """An operation of one result, here and now."""
    if name in FOLDED:
        return FOLDED[name](arguments)
    kernel = BINARY.get(name) or UNARY.get(name) or INNER[name]
    return kernel(*arguments)


def choose(condition: Values, x: Values, y: Values) -> Values:
    """x where the condition holds, else y."""
    return np.where(holds(condition), x, y)


# CIELAB (CIE 15:2004, eq. 8.3-8.8) with the reference's thresholds, and in float64 what it computes
# in float64. tLab(0,0,0) has L = -6e-8 for that reason.

ROOT_ABOVE, CUBE_ABOVE, FOOT, SLOPE = 0.008856, 0.20689303448275862, 16 / 116, 7.787037037037037


def _root(t: Values) -> Values:
    wide = t.astype(np.float64)
    linear = SLOPE * wide + FOOT
    return np.where(wide > ROOT_ABOVE, UNARY["cbrt"](t), linear.astype(np.float32))


def _cube(f: Values) -> Values:
    """The inverse of _root, clipped to 0 below f = 16/116 and for NaN."""
    wide = f.astype(np.float64)
    linear = ((wide - FOOT) / SLOPE).astype(np.float32)
    power = np.where(wide > CUBE_ABOVE, f * f * f, linear)
    return np.where(wide > FOOT, power, np.float32(0))


INNER: dict[str, Kernel] = {
    "choose": choose,
    "lab root": _root,
    "lab cube": _cube,
    "lab lightness": _single(lambda fy: 116 * fy - 16),
    "lab fx": _single(lambda a, fy: a / 500 + fy),
    "lab fz": _single(lambda b, fy: fy - b / 200),
}
"""What operators of several results are made of, and the choice between two values."""

_PI, _STRAIGHT, _CIRCLE = np.float32(np.pi), np.float32(180), np.float32(360)


def _polar(apply: Apply, x: Any, y: Any) -> tuple[Any, ...]:
    hue = apply("div", apply("mul", apply("atn2", x, y), _STRAIGHT), _PI)
    radius = apply("sqrt", apply("add", apply("sq", y), apply("sq", x)))
    negative = apply("lt", hue, np.float32(0))
    return radius, apply("choose", negative, apply("add", hue, _CIRCLE), hue)


def _cartesian(apply: Apply, radius: Any, hue: Any) -> tuple[Any, ...]:
    angle = apply("div", apply("mul", hue, _PI), _STRAIGHT)
    return tuple(apply("mul", radius, apply(name, angle)) for name in ("cos", "sin"))


def _to_lab(apply: Apply, *xyz: Any) -> tuple[Any, ...]:
    """CIELAB of XYZ relative to white."""
    fx, fy, fz = (apply("lab root", v) for v in xyz)
    a = apply("mul", apply("sub", fx, fy), np.float32(500))
    b = apply("mul", apply("sub", fy, fz), np.float32(200))
    return apply("lab lightness", fy), a, b


def _to_xyz(apply: Apply, lightness: Any, a: Any, b: Any) -> tuple[Any, ...]:
    """The inverse of _to_lab."""
    fy = apply("div", apply("add", lightness, np.float32(16)), np.float32(116))
    roots = apply("lab fx", a, fy), fy, apply("lab fz", b, fy)
    return tuple(apply("lab cube", f) for f in roots)


GROUPED: dict[str, tuple[int, Callable[..., tuple[Any, ...]]]] = {
    "ctop": (2, _polar),
    "ptoc": (2, _cartesian),
    "tLab": (3, _to_lab),
    "tXYZ": (3, _to_xyz),
}
"""Blocks of n values each, 2 or 3 of them, to as many: how many, and a function of Apply."""
