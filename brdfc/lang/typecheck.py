"""The types of expressions: walking them, through the names and functions that they use.

What operators and built-in functions make of types is in typerules.py.
"""

from __future__ import annotations

from collections.abc import Mapping

from brdfc.lang.functions import FUNCTIONS, PI
from brdfc.lang.limits import MAX_LEVELS
from brdfc.lang.model import Definition, Quantity
from brdfc.lang.report import Report
from brdfc.lang.tree import (
    Binary,
    Call,
    Component,
    Expr,
    LetIn,
    Name,
    Number,
    Parameter,
    Unary,
    Vector,
    Where,
)
from brdfc.lang.typerules import TO_ANGLE, TO_NUMBER, Type, TypeRules
from brdfc.lang.types import NUMBER, TYPES, Dimension
from brdfc.source.span import Span

Locals = Mapping[str, Type]


class TypeChecker:
    """Types within one file. A function is checked once for each list of argument types."""

    def __init__(self, report: Report) -> None:
        self._report = report
        self._rules = TypeRules(self._error)
        # By definition and argument types: the type of the body and how many levels deep it goes.
        self._known: dict[tuple[Span, tuple[Type, ...]], tuple[Type, int]] = {}
        self._calls: list[Span] = []
        self._deepest = 0

    def check(self, definition: Definition) -> Type:
        """The type of a definition by itself; None also where it depends on the arguments."""
        declared = [self._declared(parameter) for parameter in definition.parameters or ()]
        return None if None in declared else self._definition(definition, tuple(declared))

    def _declared(self, parameter: Parameter) -> Type:
        name = parameter.type_name
        if name is None or name in TYPES:
            return TYPES[name].value if name else None
        hint = self._report.suggestion(name, TYPES) or "a parameter without a type takes any"
        message = f"'{name}' is not a type that a parameter can have"
        self._report.error(parameter.span, message, expected=", ".join(TYPES), hint=hint)
        return None

    def _definition(
        self, definition: Definition, arguments: tuple[Type, ...] = (), level: int = 0
    ) -> Type:
        """The type of a definition's body for arguments of these types."""
        key = (definition.span, arguments)
        if key not in self._known:
            self._deepest = level
            names = [parameter.name for parameter in definition.parameters or ()]
            scope = dict(zip(names, arguments, strict=True))
            found = self._of(definition.body, scope, definition, level + 1)
            self._known[key] = (found, self._deepest - level)
        found, levels = self._known[key]
        self._deepest = level + levels
        return found

    def _error(self, span: Span, message: str, hint: str | None = None) -> None:
        """Report, saying for which calls the body was being checked, the innermost first."""
        notes = tuple((call, "in the function called here") for call in reversed(self._calls))
        self._report.error(span, message, hint=hint, notes=notes)

    def _of(self, expr: Expr, names: Locals, within: Definition, level: int) -> Type:
        """The type of an expression in the body of a definition."""
        self._deepest = max(self._deepest, level)
        if level > MAX_LEVELS:
            self._too_deep(expr.span)
            return None

        def of(part: Expr) -> Type:
            return self._of(part, names, within, level + 1)

        rules = self._rules
        match expr:
            case Number():
                return rules.number(expr)
            case Name():
                return self._name(expr, names, within, level)
            case Call():
                return self._call(expr, [of(part) for part in expr.arguments], within, level)
            case Unary():
                return rules.unary(expr, of(expr.operand))
            case Binary():
                return rules.binary(expr, of(expr.left), of(expr.right))
            case Where():
                value, condition = of(expr.value), of(expr.condition)
                return rules.where(expr, value, condition, of(expr.otherwise))
            case Vector():
                return rules.vector(expr, [of(part) for part in expr.components])
            case Component():
                return rules.component(expr, of(expr.vector))
            case LetIn():
                inner = {**names, expr.name: of(expr.value)}
                return self._of(expr.body, inner, within, level + 1)

    def _too_deep(self, span: Span) -> None:
        self._error(
            span,
            f"this is more than {MAX_LEVELS} levels deep, counting what its names stand for",
            "lets that rest on lets that rest on lets ... have to end somewhere",
        )

    # ------------------------------------------------------------ names and calls

    def _name(self, expr: Name, names: Locals, within: Definition, level: int) -> Type:
        if expr.name in names:
            return names[expr.name]
        if expr.name == PI:
            return NUMBER
        symbol = within.scope.get(expr.name)
        if isinstance(symbol, Quantity):
            return symbol.type.value
        if symbol is None or symbol.parameters is not None:
            return None
        return self._reached(expr.span, symbol, (), level)

    def _call(self, expr: Call, given: list[Type], within: Definition, level: int) -> Type:
        function = FUNCTIONS.get(expr.function)
        if function is not None:
            known = [t for t in given if t is not None]
            if len(known) < len(given) or not function.accepts_count(len(given)):
                return None
            return self._rules.built_in(expr, function, known)
        symbol = within.scope.get(expr.function)
        if not isinstance(symbol, Definition) or symbol.parameters is None:
            return None
        if len(symbol.parameters) != len(given) or None in given:
            return None
        pairs = zip(symbol.parameters, expr.arguments, given, strict=True)
        fits = [self._argument(expr, *pair) for pair in pairs]
        if not all(fits):
            return None
        self._calls.append(expr.span)
        try:
            return self._reached(expr.span, symbol, tuple(given), level)
        finally:
            self._calls.pop()

    def _reached(self, span: Span, symbol: Definition, given: tuple[Type, ...], level: int) -> Type:
        """The type of what a name or a call stands for, and its levels added to ours."""
        outer = self._deepest
        found = self._definition(symbol, given, level)
        if found is not None and self._deepest > MAX_LEVELS:
            self._too_deep(span)
            found = None
        self._deepest = max(outer, self._deepest)
        return found

    def _argument(self, call: Call, parameter: Parameter, argument: Expr, given: Type) -> bool:
        """Whether an argument has the type its parameter was declared with."""
        declared = TYPES.get(parameter.type_name or "")
        if declared is None or given == declared.value or given is None:
            return True
        message = (
            f"'{parameter.name}' of '{call.function}' is declared as {declared.name}, "
            f"and this is {given}"
        )
        wants_angle = declared.is_angle and given.dimension is Dimension.NUMBER
        wants_number = not declared.is_angle and given.dimension is Dimension.ANGLE
        hint = TO_ANGLE if wants_angle else TO_NUMBER if wants_number else None
        self._error(argument.span, message, hint)
        return False
