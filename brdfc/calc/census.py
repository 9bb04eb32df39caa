"""What kinds of operators a main function has."""

from __future__ import annotations

from collections import Counter

from brdfc.calc.program import Block, Op, walk

KINDS: dict[str, tuple[str, ...]] = {
    "constants": ("data", "pi", "+INF", "-INF", "NaN"),
    "channels": ("in", "out"),
    "temporaries": ("tget", "tput", "tsav"),
    "variables": ("env",),
    "elements": ("curv", "mtx", "clut", "tint", "tJab", "fJab", "calc", "elem"),
    "stack": ("copy", "rotl", "rotr", "posd", "flip", "pop", "scnt", "noop", "tran"),
    "arithmetic": (
        *("sum", "prod", "add", "sub", "mul", "div", "mod", "sadd", "ssub", "smul", "sdiv"),
        *("neg", "sq", "cb", "abs", "sign", "flor", "ceil", "trnc", "rond", "solv"),
    ),
    "comparisons": (
        *("min", "max", "vmin", "vmax", "and", "or", "vand", "vor", "vxor", "not", "rnum"),
        *("lt", "le", "eq", "neq", "near", "ge", "gt"),
    ),
    "functions": (
        *("pow", "gama", "sqrt", "cbrt", "exp", "log", "ln", "sin", "cos", "tan", "asin"),
        *("acos", "atan", "atn2", "ctop", "ptoc", "tLab", "tXYZ"),
    ),
}
"""Every operator of the table, by kind."""
CONTROL = "choices"
"""The kind of `if` and `sel`."""

_KIND_OF = {name: kind for kind, names in KINDS.items() for name in names}


def census(body: Block) -> dict[str, int]:
    """How many operators of each kind a main function has, most first; none of the functions it
    calls."""
    found = Counter(_KIND_OF[i.name] if isinstance(i, Op) else CONTROL for i in walk(body))
    return dict(sorted(found.items(), key=lambda item: (-item[1], item[0])))
