"""The one table of calculator operators (ICC.2, 11.2.1): signature, operand, stack effect, price.

The assembler, disassembler, binary codec, verifier, price and interpreter all read it. Only the
operators that every release of the reference engine knows are `portable`; generated code uses no
others.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import Enum


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

    effect is None where it depends on a sub-element. price is the time one execution takes on the
    reference engine beyond the DISPATCH that every operator costs, in nanoseconds.
    """

    name: str
    operand: Operand
    effect: Callable[[int, int], tuple[int, int]] | None
    meaning: str
    price: float = 0.0
    portable: bool = True

    @property
    def signature(self) -> bytes:
        """The four bytes in a file."""
        return self.name.ljust(4).encode("ascii")


DISPATCH = 4.65
"""Nanoseconds the reference engine takes for any operator (least squares over 22 programs)."""


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

    for name, (kind, price) in {
        "curv": ("curve set", 6.4),
        "mtx": ("matrix", 0.0),
        "clut": ("lookup table", 8.0),
        "tint": ("tint array", 0.0),
        "tJab": ("XYZ to Jab", 0.0),
        "fJab": ("Jab to XYZ", 0.0),
        "calc": ("calculator", 0.0),
        "elem": ("element of any kind", 0.0),
    }.items():
        yield Operator(name, Operand.ELEMENT, None, f"apply a {kind}", price)

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

    for name, (meaning, price) in {
        "add": ("x + y", 0.0),
        "sub": ("x - y", 0.0),
        "mul": ("x y", 0.0),
        "div": ("x / y; 0 where y is 0", 0.0),
        "mod": ("remainder of x / y with the sign of x; 0 where y is 0", 0.0),
        "pow": ("x to the power y", 11.6),
        "atn2": ("the angle whose tangent is y / x, by quadrant", 12.9),
        "lt": ("1 if x < y", 0.0),
        "le": ("1 if x <= y", 0.0),
        "eq": ("1 if x = y", 0.0),
        "neq": ("1 if x differs from y", 0.0),
        "near": ("1 if |x - y| < 1e-5", 0.0),
        "ge": ("1 if x >= y", 0.0),
        "gt": ("1 if x > y", 0.0),
        "vmin": ("the lesser; y where x is not a number", 0.0),
        "vmax": ("the greater; y where x is not a number", 0.0),
        "vand": ("1 if both hold", 0.0),
        "vor": ("1 if either holds", 0.0),
    }.items():
        yield Operator(name, vector, lambda n, _b: (2 * n, n), meaning, price)

    for name, (meaning, price) in {
        "gama": ("x to the power s", 11.6),
        "sadd": ("x + s", 0.0),
        "ssub": ("x - s", 0.0),
        "smul": ("x s", 0.0),
        "sdiv": ("x / s; 0 where s is 0", 0.0),
    }.items():
        yield Operator(name, vector, lambda n, _b: (n + 1, n), meaning, price)

    for name, (meaning, price) in {
        "neg": ("-x", 0.0),
        "sq": ("x x", 0.0),
        "sqrt": ("square root", 0.0),
        "cb": ("x x x", 0.0),
        "cbrt": ("cube root", 2.0),
        "sign": ("1, 0 or -1", 0.0),
        "abs": ("|x|", 0.0),
        "flor": ("greatest whole number not above x", 0.0),
        "ceil": ("least whole number not below x", 0.0),
        "trnc": ("x without its fraction", 0.0),
        "rond": ("nearest whole number, halves away from 0", 0.0),
        "exp": ("e to the power x", 1.4),
        "log": ("logarithm to base 10", 2.2),
        "ln": ("natural logarithm", 2.2),
        "sin": ("sine", 2.2),
        "cos": ("cosine", 2.2),
        "tan": ("tangent", 12.9),
        "asin": ("arc sine", 12.9),
        "acos": ("arc cosine", 12.9),
        "atan": ("arc tangent", 12.9),
        "rnum": ("1 if x is a finite number", 0.0),
        "not": ("1 if x does not hold", 0.0),
    }.items():
        yield Operator(name, vector, lambda n, _b: (n, n), meaning, price)

    for name, meaning in {
        "ctop": "x, y to radius and hue in degrees",
        "ptoc": "radius and hue in degrees to x, y",
    }.items():
        yield Operator(name, vector, lambda n, _b: (2 * n, 2 * n), meaning, 12.9)
    for name, meaning in {
        "tLab": "XYZ relative to white to CIELAB",
        "tXYZ": "CIELAB to XYZ relative to white",
    }.items():
        yield Operator(name, vector, lambda n, _b: (3 * n, 3 * n), meaning, 6.0)

    yield Operator("noop", none, lambda _a, _b: (0, 0), "nothing", portable=False)
    yield Operator("scnt", none, lambda _a, _b: (0, 1), "push the stack's depth", portable=False)
    yield Operator("vxor", vector, lambda n, _b: (2 * n, n), "1 if just one holds", portable=False)


OPERATORS: dict[str, Operator] = {operator.name: operator for operator in _rows()}
BY_SIGNATURE: dict[bytes, Operator] = {o.signature: o for o in OPERATORS.values()}

# Control flow is not an operator of the table: it has blocks in the text and jump lengths in files.
IF, ELSE, SELECT, CASE, DEFAULT = b"if  ", b"else", b"sel ", b"case", b"dflt"
