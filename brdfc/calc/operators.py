"""The one table of calculator operators (ICC.2, 11.2.1): signature, operand, stack effect.

The assembler, disassembler, binary codec, verifier, prices and interpreter all read it. Only the
operators that every release of the reference engine knows are `portable`; generated code uses no
others.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import Enum
from functools import cached_property


class Operand(Enum):
    """What the 32-bit word after an operator's signature holds, and how the text writes it.

    Files hold counts less one (or less two, for FOLD); the text and `Op` hold the counts.
    """

    NONE = "none"
    CONSTANT = "a float32; the text form is the bare number"
    SIGNATURE = "(name): four characters"
    SPAN = "[start,count]: first channel or temporary, and how many"
    VECTOR = "[n]: components of a vector"
    FOLD = "(n): how many values become one, two or more"
    COPIES = "(n,times)"
    ROTATION = "(n,places)"
    POSITION = "(position,times): 1 is the top"
    SHAPE = "(rows,columns)"
    ELEMENT = "(index) of a sub-element"


# (least value, subtracted in the file) of the first and second half of each operand's word.
HALVES: dict[Operand, tuple[tuple[int, int], tuple[int, int]]] = {
    Operand.SPAN: ((0, 0), (1, 1)),
    Operand.VECTOR: ((1, 1), (0, 0)),
    Operand.FOLD: ((2, 2), (0, 0)),
    Operand.COPIES: ((1, 1), (1, 1)),
    Operand.ROTATION: ((1, 1), (1, 1)),
    Operand.POSITION: ((1, 1), (1, 1)),
    Operand.SHAPE: ((1, 1), (1, 1)),
    Operand.ELEMENT: ((0, 0), (0, 0)),
}

# The text form may leave arguments out; these stand in for them.
DEFAULTS: dict[Operand, tuple[int, int]] = {
    Operand.SPAN: (0, 1),
    Operand.VECTOR: (1, 0),
    Operand.FOLD: (2, 0),
    Operand.COPIES: (1, 1),
    Operand.ROTATION: (1, 1),
    Operand.POSITION: (1, 1),
    Operand.SHAPE: (1, 1),
    Operand.ELEMENT: (0, 0),
}

ARGUMENTS: dict[Operand, int] = {
    operand: 1 if operand in (Operand.VECTOR, Operand.FOLD, Operand.ELEMENT) else 2
    for operand in HALVES
}


@dataclass(frozen=True)
class Operator:
    """One row: effect gives (values popped, values pushed) for the two operand arguments.

    effect is None where it depends on a sub-element.
    """

    name: str
    operand: Operand
    effect: Callable[[int, int], tuple[int, int]] | None
    meaning: str
    portable: bool = True

    @cached_property
    def signature(self) -> bytes:
        """The four bytes in a file."""
        return self.name.ljust(4).encode("ascii")


def _rows() -> Iterable[Operator]:
    none, vector, fold, span = Operand.NONE, Operand.VECTOR, Operand.FOLD, Operand.SPAN

    yield Operator("data", Operand.CONSTANT, lambda _a, _b: (0, 1), "push the number")
    for name, meaning in {
        "pi": "push 3.14159274",
        "+INF": "push plus infinity",
        "-INF": "push minus infinity",
        "NaN": "push not-a-number",
    }.items():
        yield Operator(name, none, lambda _a, _b: (0, 1), meaning)

    yield Operator("in", span, lambda _s, n: (0, n), "push input channels")
    yield Operator("out", span, lambda _s, n: (n, 0), "pop into output channels, deepest first")
    yield Operator("tget", span, lambda _s, n: (0, n), "push temporaries")
    yield Operator("tput", span, lambda _s, n: (n, 0), "pop into temporaries")
    yield Operator("tsav", span, lambda _s, n: (n, n), "copy to temporaries, keep on the stack")
    yield Operator(
        "env", Operand.SIGNATURE, lambda _a, _b: (0, 2), "push a variable, then 1 if it is defined"
    )

    for name, kind in {
        "curv": "curve set",
        "mtx": "matrix",
        "clut": "lookup table",
        "tint": "tint array",
        "tJab": "XYZ to Jab",
        "fJab": "Jab to XYZ",
        "calc": "calculator",
        "elem": "element of any kind",
    }.items():
        yield Operator(name, Operand.ELEMENT, None, f"apply a {kind}")

    yield Operator(
        "copy", Operand.COPIES, lambda n, t: (n, n * (t + 1)), "repeat the top n values t times"
    )
    yield Operator("rotl", Operand.ROTATION, lambda n, _p: (n, n), "rotate the top n values left")
    yield Operator("rotr", Operand.ROTATION, lambda n, _p: (n, n), "rotate the top n values right")
    yield Operator(
        "posd", Operand.POSITION, lambda p, t: (p, p + t), "push the value at a position t times"
    )
    yield Operator("flip", fold, lambda n, _b: (n, n), "reverse the top n values")
    yield Operator("pop", vector, lambda n, _b: (n, 0), "drop the top n values")
    yield Operator(
        "solv",
        Operand.SHAPE,
        lambda r, c: (r * c + r, c + 1),
        "solve a linear system; then 1 if solved",
    )
    yield Operator("tran", Operand.SHAPE, lambda r, c: (r * c, r * c), "transpose a matrix")

    for name, meaning in {
        "sum": "x1 + x2 + ...",
        "prod": "x1 x2 ...",
        "min": "the least",
        "max": "the greatest",
        "and": "1 if all hold",
        "or": "1 if any holds",
    }.items():
        yield Operator(name, fold, lambda n, _b: (n, 1), meaning)

    for name, meaning in {
        "add": "x + y",
        "sub": "x - y",
        "mul": "x y",
        "div": "x / y; 0 where y is 0",
        "mod": "remainder of x / y with the sign of x; 0 where y is 0",
        "pow": "x to the power y",
        "atn2": "the angle whose tangent is y / x, by quadrant",
        "lt": "1 if x < y",
        "le": "1 if x <= y",
        "eq": "1 if x = y",
        "neq": "1 if x differs from y",
        "near": "1 if |x - y| < 1e-5",
        "ge": "1 if x >= y",
        "gt": "1 if x > y",
        "vmin": "the lesser; y where x is not a number",
        "vmax": "the greater; y where x is not a number",
        "vand": "1 if both hold",
        "vor": "1 if either holds",
    }.items():
        yield Operator(name, vector, lambda n, _b: (2 * n, n), meaning)

    for name, meaning in {
        "gama": "x to the power s",
        "sadd": "x + s",
        "ssub": "x - s",
        "smul": "x s",
        "sdiv": "x / s; 0 where s is 0",
    }.items():
        yield Operator(name, vector, lambda n, _b: (n + 1, n), meaning)

    for name, meaning in {
        "neg": "-x",
        "sq": "x x",
        "sqrt": "square root",
        "cb": "x x x",
        "cbrt": "cube root",
        "sign": "1, 0 or -1",
        "abs": "|x|",
        "flor": "greatest whole number not above x",
        "ceil": "least whole number not below x",
        "trnc": "x without its fraction",
        "rond": "nearest whole number, halves away from 0",
        "exp": "e to the power x",
        "log": "logarithm to base 10",
        "ln": "natural logarithm",
        "sin": "sine",
        "cos": "cosine",
        "tan": "tangent",
        "asin": "arc sine",
        "acos": "arc cosine",
        "atan": "arc tangent",
        "rnum": "1 if x is a finite number",
        "not": "1 if x does not hold",
    }.items():
        yield Operator(name, vector, lambda n, _b: (n, n), meaning)

    for name, meaning in {
        "ctop": "x, y to radius and hue in degrees",
        "ptoc": "radius and hue in degrees to x, y",
    }.items():
        yield Operator(name, vector, lambda n, _b: (2 * n, 2 * n), meaning)
    for name, meaning in {
        "tLab": "XYZ relative to white to CIELAB",
        "tXYZ": "CIELAB to XYZ relative to white",
    }.items():
        yield Operator(name, vector, lambda n, _b: (3 * n, 3 * n), meaning)

    yield Operator("noop", none, lambda _a, _b: (0, 0), "nothing", portable=False)
    yield Operator("scnt", none, lambda _a, _b: (0, 1), "push the stack's depth", portable=False)
    yield Operator("vxor", vector, lambda n, _b: (2 * n, n), "1 if just one holds", portable=False)


OPERATORS: dict[str, Operator] = {operator.name: operator for operator in _rows()}
BY_SIGNATURE: dict[bytes, Operator] = {o.signature: o for o in OPERATORS.values()}

# Control flow is not an operator of the table: it has blocks in the text and jump lengths in files.
IF, ELSE, SELECT, CASE, DEFAULT = b"if  ", b"else", b"sel ", b"case", b"dflt"

CALLED_KINDS = {
    "curv": ("cvst",),
    "mtx": ("matf",),
    "clut": ("clut", "xclt"),
    "tint": ("tint",),
    "tJab": ("XtoJ",),
    "fJab": ("JtoX",),
    "calc": ("calc",),
}
"""The signatures of the elements that an operator may call; `elem` calls any."""
