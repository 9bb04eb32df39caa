"""What operators and built-in functions make of types: angles are not numbers, widths agree.

A type is None where an error has been reported already; whatever rests on it stays silent.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from brdfc.lang.functions import Function, Shape
from brdfc.lang.tree import Binary, Call, Component, Expr, Number, Unary, Vector, Where
from brdfc.lang.types import ANGLE, NUMBER, TRUTH, Dimension, ValueType
from brdfc.source.span import Span

TO_NUMBER = "radians(a) is the angle as a number"
TO_ANGLE = "write x*1rad if x is in radians"

Type = ValueType | None


class Complaint(Protocol):
    """How a rule says what is wrong."""

    def __call__(self, span: Span, message: str, hint: str | None = None) -> None: ...


class TypeRules:
    """One method a kind of expression: from the types of its parts to its own."""

    def __init__(self, error: Complaint) -> None:
        self._error = error

    def number(self, expr: Number) -> Type:
        if expr.unit == "nm":
            self._error(expr.span, "nm is only for a spectrum's wavelengths", "write the number")
            return None
        return ANGLE if expr.unit else NUMBER

    def built_in(self, expr: Call, function: Function, given: list[ValueType]) -> Type:
        dimensions = {t.dimension for t in given}
        for argument, type_ in zip(expr.arguments, given, strict=True):
            if type_.dimension not in function.takes:
                wanted = " or ".join(sorted(d.value for d in function.takes))
                hint = None
                if type_.dimension is Dimension.NUMBER:
                    hint = TO_ANGLE
                elif type_.dimension is Dimension.ANGLE:
                    hint = TO_NUMBER
                message = f"'{function.name}' takes {wanted}, and this is {type_}"
                self._error(argument.span, message, hint)
                return None
        if len(dimensions) > 1:
            self._mixed(expr.span, "be compared")
            return None
        if function.shape is not Shape.ELEMENTS:
            scalar = next((i for i, t in enumerate(given) if t.width == 1), None)
            if scalar is not None:
                message = f"'{function.name}' takes vectors, and this is {given[scalar]}"
                self._error(expr.arguments[scalar].span, message)
                return None
        width = self._width(expr.span, given)
        if width is None:
            return None
        if function.shape is Shape.CROSS and width != 3:
            self._error(expr.span, f"'cross' takes vectors of 3, and these are of {width}")
            return None
        if function.shape is Shape.SCALAR:
            width = 1
        return ValueType(function.gives or given[0].dimension, width)

    def unary(self, expr: Unary, operand: Type) -> Type:
        if expr.operator == "not":
            return self._condition(expr.operand, operand)
        return operand if self._value(expr.operand, operand) else None

    def binary(self, expr: Binary, left: Type, right: Type) -> Type:
        if expr.operator in ("and", "or"):
            both = (self._condition(expr.left, left), self._condition(expr.right, right))
            return TRUTH if all(both) else None
        values = (self._value(expr.left, left), self._value(expr.right, right))
        if left is None or right is None or not all(values):
            return None
        compares = expr.operator in ("<", "<=", ">", ">=", "==", "!=")
        if compares and max(left.width, right.width) > 1:
            hint = "compare components, as in v.x < 1; min, max and clamp take vectors"
            self._error(expr.span, "vectors cannot be compared", hint)
            return None
        width = self._width(expr.span, (left, right))
        dimension = self._dimension(expr, left.dimension, right.dimension)
        if dimension is None or width is None:
            return None
        return ValueType(dimension, width)

    def _dimension(self, expr: Binary, left: Dimension, right: Dimension) -> Dimension | None:
        """The dimension that an operator gives for two values; reports what cannot be."""
        number, angle = Dimension.NUMBER, Dimension.ANGLE
        match expr.operator:
            case "+" | "-":
                if left is right:
                    return left
                self._mixed(expr.span, "be added" if expr.operator == "+" else "be subtracted")
            case "*":
                if left is number or right is number:
                    return angle if angle in (left, right) else number
                self._error(expr.span, "angles cannot be multiplied", TO_NUMBER)
            case "/":
                if right is number:
                    return left
                if left is angle:
                    return number
                self._error(expr.right.span, "a number cannot be divided by an angle", TO_NUMBER)
            case "^":
                if left is number and right is number:
                    return number
                if left is angle:
                    self._error(expr.left.span, "an angle cannot be raised to a power", TO_NUMBER)
                else:
                    self._error(expr.right.span, "an exponent cannot be an angle", TO_NUMBER)
            case _:
                if left is right:
                    return Dimension.TRUTH
                self._mixed(expr.span, "be compared")
        return None

    def where(self, expr: Where, value: Type, condition: Type, otherwise: Type) -> Type:
        chosen = self._condition(expr.condition, condition)
        good = (self._value(expr.value, value), self._value(expr.otherwise, otherwise))
        if value is None or otherwise is None or not all(good):
            return None
        if value.dimension is not otherwise.dimension:
            self._mixed(expr.otherwise.span, "be the two branches of one 'where'")
            return None
        width = self._width(expr.span, (value, otherwise))
        return None if width is None or chosen is None else ValueType(value.dimension, width)

    def vector(self, expr: Vector, given: list[Type]) -> Type:
        parts = [t for t in given if t is not None]
        if len(parts) < len(given):
            return None
        for part, type_ in zip(expr.components, parts, strict=True):
            if type_.width > 1:
                self._error(part.span, f"a component is one value, and this is {type_}")
                return None
            if not self._value(part, type_):
                return None
        if len({t.dimension for t in parts}) > 1:
            self._mixed(expr.span, "be components of one vector")
            return None
        return ValueType(parts[0].dimension, len(parts))

    def component(self, expr: Component, vector: Type) -> Type:
        if vector is None:
            return None
        if vector.width == 1:
            self._error(expr.span, f"only a vector has components, and this is {vector}")
            return None
        # A spectrum's components have wavelengths, no letters.
        if expr.index >= vector.width or vector.width > 3:
            letter = "xyz"[expr.index]
            hint = "a formula of .x, .y, .z is for X, Y, Z alone" if vector.width > 3 else None
            self._error(expr.span, f"{vector} has no component '{letter}'", hint)
            return None
        return ValueType(vector.dimension)

    # ------------------------------------------------------------ what several of them ask

    def _value(self, expr: Expr, type_: Type) -> bool:
        """Whether it is no condition; a condition is reported."""
        if type_ is not None and type_.dimension is Dimension.TRUTH:
            hint = "write: 1 where ... else 0"
            self._error(expr.span, "a condition has no value to compute with", hint)
            return False
        return True

    def _condition(self, expr: Expr, type_: Type) -> Type:
        """TRUTH if it is a condition; anything else is reported."""
        if type_ is not None and type_.dimension is not Dimension.TRUTH:
            hint = "compare it with something, as in x > 0"
            self._error(expr.span, f"a condition is needed, and this is {type_}", hint)
            return None
        return type_

    def _width(self, span: Span, types: Sequence[ValueType]) -> int | None:
        """The one width that all have, scalars aside; reports vectors that do not agree."""
        widths = sorted({t.width for t in types} - {1})
        if len(widths) > 1:
            found = " and ".join(str(width) for width in widths)
            self._error(span, f"these are vectors of {found} components, which do not agree")
            return None
        return widths[0] if widths else 1

    def _mixed(self, span: Span, verb: str) -> None:
        hint = "an angle is written with its unit, as 40deg; a number x of radians is x*1rad"
        self._error(span, f"an angle and a number cannot {verb}", hint)
