"""The calculator's operators on several pixels at a time: what kernels.py computes, as LLVM's text.

A truth is 1 or 0 as the calculator has it; the mask that it came from is remembered, so that a
choice between values does not test it again.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from brdfc.engine.functions import FUNCTIONS
from brdfc.engine.kernels import CUBE_ABOVE, FOOT, ROOT_ABOVE, SLOPE
from brdfc.engine.lanes import Lanes

Emit = Callable[..., str]


def holds(lanes: Lanes, x: str) -> str:
    """The mask of a truth: at least one half."""
    if ("mask", x) in lanes.known:
        return lanes.known["mask", x][0]
    return lanes.test("oge", "F", x, 0.5)


def _truth(lanes: Lanes, mask: str) -> str:
    value = lanes.convert("uitofp", "M", mask, "F")
    lanes.known["mask", value] = (mask,)
    return value


def choose(lanes: Lanes, condition: str, x: str, y: str) -> str:
    return lanes.pick("F", holds(lanes, condition), x, y)


def wide(lanes: Lanes, x: str) -> str:
    """In float64; once for every value."""
    if ("wide", x) not in lanes.known:
        lanes.known["wide", x] = (lanes.convert("fpext", "F", x, "D"),)
    return lanes.known["wide", x][0]


def narrow(lanes: Lanes, x: str) -> str:
    return lanes.convert("fptrunc", "D", x, "F")


def _in_float64(function: Emit) -> Emit:
    def emit(lanes: Lanes, *arguments: str) -> str:
        return narrow(lanes, function(lanes, *(wide(lanes, a) for a in arguments)))

    return emit


def _plain(operation: str) -> Emit:
    return lambda lanes, *arguments: lanes.do(operation, "F", *arguments)


def _known(function: str) -> Emit:
    return lambda lanes, x: lanes.call(function, "F", x)


def _relation(relation: str) -> Emit:
    return lambda lanes, x, y: _truth(lanes, lanes.test(relation, "F", x, y))


def _divide(lanes: Lanes, x: str, y: str) -> str:
    quotient = lanes.do("fdiv", "F", x, y)
    return lanes.pick("F", lanes.test("oeq", "F", y, 0.0), 0.0, quotient)


def _remainder(lanes: Lanes, x: str, y: str) -> str:
    good = lanes.either("and", _finite(lanes, x), _finite(lanes, y))
    size = lanes.call("fabs", "D", wide(lanes, y))
    good = lanes.either("and", good, lanes.test("oge", "D", size, 1e-12))
    over = lanes.pick("F", good, y, 1.0)
    return lanes.pick("F", good, lanes.do("frem", "F", x, over), 0.0)


def _finite(lanes: Lanes, x: str) -> str:
    return lanes.test("olt", "F", lanes.call("fabs", "F", x), math.inf)


def _saturated(lanes: Lanes, x: str) -> str:
    """The nearest 32-bit integer, as float32; NaN is 0."""
    x = lanes.pick("D", lanes.test("uno", "D", x, x), 0.0, x)
    x = lanes.pick("D", lanes.test("olt", "D", x, -2147483648.0), -2147483648.0, x)
    x = lanes.pick("D", lanes.test("ogt", "D", x, 2147483647.0), 2147483647.0, x)
    return narrow(lanes, lanes.do("fadd", "D", lanes.call("trunc", "D", x), 0.0))


def _rounded(lanes: Lanes, x: str) -> str:
    exact = wide(lanes, x)
    half = lanes.call("copysign", "D", 0.5, exact)
    return _saturated(lanes, lanes.do("fadd", "D", exact, half))


def _equal(lanes: Lanes, x: str, y: str) -> str:
    both = lanes.either("and", lanes.test("uno", "F", x, x), lanes.test("uno", "F", y, y))
    return lanes.either("or", lanes.test("oeq", "F", x, y), both)


def _not(lanes: Lanes, mask: str) -> str:
    return lanes.either("xor", mask, "splat (i1 true)")


def _near(lanes: Lanes, x: str, y: str) -> str:
    apart = lanes.call("fabs", "F", lanes.do("fsub", "F", x, y))
    return _truth(lanes, lanes.test("olt", "D", wide(lanes, apart), 1e-5))


def _sign(lanes: Lanes, x: str) -> str:
    masks = (lanes.test(relation, "F", x, 0.0) for relation in ("ogt", "olt"))
    above, below = (lanes.convert("uitofp", "M", mask, "F") for mask in masks)
    return lanes.do("fsub", "F", above, below)


def _absolute(lanes: Lanes, x: str) -> str:
    """So that -0 stays what it is."""
    return lanes.pick("F", lanes.test("olt", "F", x, 0.0), lanes.do("fneg", "F", x), x)


def _square(lanes: Lanes, x: str) -> str:
    return lanes.do("fmul", "F", x, x)


def _joined(operation: str) -> Emit:
    return lambda lanes, x, y: _truth(
        lanes, lanes.either(operation, holds(lanes, x), holds(lanes, y))
    )


def _lesser(relation: str, lanes: Lanes, x: str, y: str) -> str:
    return lanes.pick("F", lanes.test(relation, "F", x, y), x, y)


def _extreme(relation: str) -> Emit:
    """As kernels.py has it: two values as `vmin` and `vmax`, more from the deepest on."""

    def emit(lanes: Lanes, *values: str) -> str:
        if len(values) == 2:
            return _lesser(relation, lanes, *values)
        found = values[0]
        for value in values[1:]:
            found = _lesser(relation, lanes, value, found)
        return found

    return emit


def _repeated(operation: str) -> Emit:
    def emit(lanes: Lanes, *values: str) -> str:
        found = values[0]
        for value in values[1:]:
            found = lanes.do(operation, "F", found, value)
        return found

    return emit


def _all_hold(lanes: Lanes, *values: str) -> str:
    """A NaN counts as true here: see kernels.FOLDED."""
    found = "splat (i1 true)"
    for value in values:
        found = lanes.either("and", found, lanes.test("uge", "F", value, 0.5))
    return _truth(lanes, found)


def _one_holds(lanes: Lanes, *values: str) -> str:
    found = "zeroinitializer"
    for value in values:
        found = lanes.either("or", found, holds(lanes, value))
    return _truth(lanes, found)


def _root(lanes: Lanes, t: str) -> str:
    exact = wide(lanes, t)
    cube_root = narrow(lanes, FUNCTIONS["cbrt"](lanes, exact))
    line = lanes.do("fadd", "D", lanes.do("fmul", "D", exact, SLOPE), FOOT)
    above = lanes.test("ogt", "D", exact, ROOT_ABOVE)
    return lanes.pick("F", above, cube_root, narrow(lanes, line))


def _cube(lanes: Lanes, f: str) -> str:
    exact = wide(lanes, f)
    line = lanes.do("fdiv", "D", lanes.do("fsub", "D", exact, FOOT), SLOPE)
    cube = lanes.do("fmul", "F", _square(lanes, f), f)
    above = lanes.test("ogt", "D", exact, CUBE_ABOVE)
    found = lanes.pick("F", above, cube, narrow(lanes, line))
    return lanes.pick("F", lanes.test("ogt", "D", exact, FOOT), found, 0.0)


OPERATORS: dict[str, Emit] = {
    **{name: _in_float64(function) for name, function in FUNCTIONS.items()},
    "add": _plain("fadd"),
    "sub": _plain("fsub"),
    "mul": _plain("fmul"),
    "div": _divide,
    "mod": _remainder,
    "neg": _plain("fneg"),
    "sq": _square,
    "cb": lambda lanes, x: lanes.do("fmul", "F", _square(lanes, x), x),
    "sqrt": _known("sqrt"),
    "flor": _known("floor"),
    "ceil": _known("ceil"),
    "trnc": lambda lanes, x: _saturated(lanes, wide(lanes, x)),
    "rond": _rounded,
    "abs": _absolute,
    "sign": _sign,
    "rnum": lambda lanes, x: _truth(lanes, _finite(lanes, x)),
    "not": lambda lanes, x: _truth(lanes, _not(lanes, holds(lanes, x))),
    "lt": _relation("olt"),
    "le": _relation("ole"),
    "gt": _relation("ogt"),
    "ge": _relation("oge"),
    "eq": lambda lanes, x, y: _truth(lanes, _equal(lanes, x, y)),
    "neq": lambda lanes, x, y: _truth(lanes, _not(lanes, _equal(lanes, x, y))),
    "near": _near,
    "vmin": partial(_lesser, "olt"),
    "vmax": partial(_lesser, "ogt"),
    "vand": _joined("and"),
    "vor": _joined("or"),
    "vxor": _joined("xor"),
    "sum": _repeated("fadd"),
    "prod": _repeated("fmul"),
    "min": _extreme("olt"),
    "max": _extreme("ogt"),
    "and": _all_hold,
    "or": _one_holds,
    "choose": choose,
    "lab root": _root,
    "lab cube": _cube,
    "lab lightness": _in_float64(
        lambda lanes, fy: lanes.do("fsub", "D", lanes.do("fmul", "D", fy, 116.0), 16.0)
    ),
    "lab fx": _in_float64(
        lambda lanes, a, fy: lanes.do("fadd", "D", lanes.do("fdiv", "D", a, 500.0), fy)
    ),
    "lab fz": _in_float64(
        lambda lanes, b, fy: lanes.do("fsub", "D", fy, lanes.do("fdiv", "D", b, 200.0))
    ),
}
"""Every operation of a straight chain, by name."""
