"""The built-in functions and the constant: one table for their names, types and meaning."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from brdfc.lang.types import Dimension

PI = "pi"
"""The one built-in constant, a number."""

_NUMBER = frozenset({Dimension.NUMBER})
_ANGLE = frozenset({Dimension.ANGLE})
_EITHER = _NUMBER | _ANGLE


class Shape(Enum):
    """How many components the result has."""

    ELEMENTS = "element by element; scalars broadcast against vectors"
    SCALAR = "one number of whole vectors"
    VECTOR = "a vector as wide as the one given"
    CROSS = "three components of two times three"


@dataclass(frozen=True)
class Function:
    """A built-in function.

    signature shows a call; least and most bound the number of arguments (most is None for any
    number). takes: the dimensions an argument may have, all arguments the same one; gives: the
    dimension of the result, None for that of the arguments.
    """

    signature: str
    least: int
    most: int | None
    takes: frozenset[Dimension]
    gives: Dimension | None
    shape: Shape
    sentence: str

    @property
    def name(self) -> str:
        return self.signature.partition("(")[0]

    def accepts_count(self, count: int) -> bool:
        """Whether it can be called with that many arguments."""
        return self.least <= count and (self.most is None or count <= self.most)


def _elements(
    signature: str,
    takes: frozenset[Dimension],
    gives: Dimension | None,
    sentence: str,
    most: int | None = 1,
    least: int = 1,
) -> Function:
    return Function(signature, least, most, takes, gives, Shape.ELEMENTS, sentence)


# `mod` is left out on purpose: the engines that run profiles disagree about its sign.
_TABLE = (
    _elements("sin(a)", _ANGLE, Dimension.NUMBER, "The sine of an angle."),
    _elements("cos(a)", _ANGLE, Dimension.NUMBER, "The cosine of an angle."),
    _elements("tan(a)", _ANGLE, Dimension.NUMBER, "The tangent of an angle."),
    _elements("asin(x)", _NUMBER, Dimension.ANGLE, "The angle in -90deg..90deg with sine x."),
    _elements("acos(x)", _NUMBER, Dimension.ANGLE, "The angle in 0deg..180deg with cosine x."),
    _elements("atan(x)", _NUMBER, Dimension.ANGLE, "The angle in -90deg..90deg with tangent x."),
    _elements(
        "atan2(y, x)", _NUMBER, Dimension.ANGLE, "The angle of the point (x, y).", most=2, least=2
    ),
    _elements("exp(x)", _NUMBER, Dimension.NUMBER, "e to the power x."),
    _elements("ln(x)", _NUMBER, Dimension.NUMBER, "The natural logarithm."),
    _elements("log10(x)", _NUMBER, Dimension.NUMBER, "The logarithm to base 10."),
    _elements("sqrt(x)", _NUMBER, Dimension.NUMBER, "The square root."),
    _elements("cbrt(x)", _NUMBER, Dimension.NUMBER, "The cube root, negative for negative x."),
    _elements("abs(x)", _EITHER, None, "The magnitude, of a number or of an angle."),
    _elements("sign(x)", _EITHER, Dimension.NUMBER, "-1, 0 or 1, as x is below, at or above 0."),
    _elements("floor(x)", _NUMBER, Dimension.NUMBER, "The largest integer not above x."),
    _elements("ceil(x)", _NUMBER, Dimension.NUMBER, "The smallest integer not below x."),
    _elements("round(x)", _NUMBER, Dimension.NUMBER, "The nearest integer."),
    _elements("trunc(x)", _NUMBER, Dimension.NUMBER, "The integer part, towards 0."),
    _elements("min(x, y, ...)", _EITHER, None, "The smallest of two or more.", most=None, least=2),
    _elements("max(x, y, ...)", _EITHER, None, "The largest of two or more.", most=None, least=2),
    _elements(
        "clamp(x, low, high)", _EITHER, None, "x, held within low..high.", most=3, least=3
    ),
    _elements("radians(a)", _ANGLE, Dimension.NUMBER, "An angle as a number of radians."),
    _elements("degrees(a)", _ANGLE, Dimension.NUMBER, "An angle as a number of degrees."),
    Function("dot(u, v)", 2, 2, _NUMBER, Dimension.NUMBER, Shape.SCALAR, "The scalar product."),
    Function("cross(u, v)", 2, 2, _NUMBER, Dimension.NUMBER, Shape.CROSS, "The vector product."),
    Function("length(v)", 1, 1, _NUMBER, Dimension.NUMBER, Shape.SCALAR, "The length."),
    Function("normalize(v)", 1, 1, _NUMBER, Dimension.NUMBER, Shape.VECTOR, "v over its length."),
)  # fmt: skip
FUNCTIONS: dict[str, Function] = {function.name: function for function in _TABLE}

MISSING: dict[str, str] = {
    "mod": "there is no mod, on purpose: profile engines disagree about it; use x - y*floor(x/y)",
    "pow": "write x^y",
    "log": "write ln(x) or log10(x)",
    "arcsin": "write asin(x)",
    "arccos": "write acos(x)",
    "arctan": "write atan(x) or atan2(y, x)",
    "deg": "write degrees(a)",
    "rad": "write radians(a); a number becomes an angle as x*1rad",
}
"""Functions that other languages have: what to write for them."""
