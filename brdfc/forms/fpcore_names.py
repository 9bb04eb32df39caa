"""Operators, constants and names of FPCore, and what they are here."""

from __future__ import annotations

import re
from collections.abc import Callable
from fractions import Fraction

from brdfc.symbolic.expression import ONE, PI, Expression, const, make

OPERATORS = {
    "+": "add",
    "-": "sub",
    "*": "mul",
    "/": "div",
    "fabs": "abs",
    "log": "ln",
    "fmin": "min",
    "fmax": "max",
    "<": "lt",
    "<=": "le",
    ">": "gt",
    ">=": "ge",
    "==": "eq",
    "!=": "ne",
    **{
        name: name
        for name in (
            *("pow", "sqrt", "cbrt", "exp", "log10", "sin", "cos", "tan", "asin", "acos", "atan"),
            *("atan2", "floor", "ceil", "trunc", "round", "and", "or", "not"),
        )
    },
}
"""FPCore's operators, and those of expressions that mean the same."""

UNARY = frozenset(
    (
        *("sqrt", "cbrt", "exp", "ln", "log10", "sin", "cos", "tan", "asin", "acos", "atan"),
        *("abs", "floor", "ceil", "trunc", "round", "not"),
    )
)
COMPARISONS = frozenset(("lt", "le", "gt", "ge", "eq", "ne"))

TWO = const(2)


def _half(x: Expression) -> Expression:
    return make("div", x, TWO)


def _exp(x: Expression) -> Expression:
    return make("exp", x)


def _minus(x: Expression) -> Expression:
    return make("neg", x)


WRITTEN_OUT: dict[tuple[str, int], Callable[..., Expression]] = {
    ("-", 1): _minus,
    ("fma", 3): lambda x, y, z: make("add", make("mul", x, y), z),
    ("exp2", 1): lambda x: make("pow", TWO, x),
    ("expm1", 1): lambda x: make("sub", _exp(x), ONE),
    ("log1p", 1): lambda x: make("ln", make("add", ONE, x)),
    ("log2", 1): lambda x: make("div", make("ln", x), make("ln", TWO)),
    ("hypot", 2): lambda x, y: make("sqrt", make("add", make("mul", x, x), make("mul", y, y))),
    ("sinh", 1): lambda x: _half(make("sub", _exp(x), _exp(_minus(x)))),
    ("cosh", 1): lambda x: _half(make("add", _exp(x), _exp(_minus(x)))),
    ("fdim", 2): lambda x, y: make("max", make("sub", x, y), const(0)),
}
"""Operators, by their number of arguments, that expressions have no equal of: the same real value.
"""

CONSTANTS: dict[str, Expression] = {
    "PI": PI,
    "PI_2": make("div", PI, TWO),
    "PI_4": make("div", PI, const(4)),
    "M_1_PI": make("div", ONE, PI),
    "M_2_PI": make("div", TWO, PI),
    "M_2_SQRTPI": make("div", TWO, make("sqrt", PI)),
    "E": make("exp", ONE),
    "LN2": make("ln", TWO),
    "LN10": make("ln", const(10)),
    "LOG2E": make("div", ONE, make("ln", TWO)),
    "LOG10E": make("div", ONE, make("ln", const(10))),
    "SQRT2": make("sqrt", TWO),
    "SQRT1_2": make("sqrt", const(Fraction(1, 2))),
    "TRUE": ONE,
    "FALSE": const(0),
}

_OTHER_WORDS = ("if", "let", "let*", "while", "while*", "for", "tensor", "cast", "array", "digits")
_RESERVED = {
    *(*OPERATORS, *CONSTANTS, *_OTHER_WORDS, "!", "FPCore", "INFINITY", "NAN"),
    *(operator for operator, _ in WRITTEN_OUT),
    *("tanh", "asinh", "acosh", "atanh", "erf", "erfc", "tgamma", "lgamma", "fmod", "remainder"),
    *("copysign", "nearbyint", "signbit", "isfinite", "isinf", "isnan", "isnormal"),
}
_SYMBOL = re.compile(r"[a-zA-Z~!@$%^&*_\-+=<>.?/:][a-zA-Z0-9~!@$%^&*_\-+=<>.?/:]*")
_PLAIN = re.compile(r"[A-Za-z0-9_.-]")


def escape_name(name: str) -> str:
    """A name as a symbol of FPCore that means nothing else there.

    Letters that a symbol cannot have are written as their code, `$3b1.` for alpha, and so is the
    first letter of a word that FPCore has itself.
    """
    letters = [c if _PLAIN.match(c) else f"${ord(c):x}." for c in name]
    if name in _RESERVED or not _SYMBOL.fullmatch("".join(letters)):
        letters[0] = f"${ord(name[0]):x}."
    return "".join(letters)


def unescape_name(symbol: str) -> str:
    """The name that escape_name made a symbol of."""
    return re.sub(r"\$([0-9a-f]{1,5})\.", lambda found: chr(int(found[1], 16)), symbol)
