"""A checked model to one expression: names resolved, functions inlined, constants put in."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce

from brdfc.lang import tree
from brdfc.lang.model import Definition, Quantity, Role, Symbol
from brdfc.source.diagnostics import Diagnostic
from brdfc.source.errors import ModelError
from brdfc.symbolic.expression import (
    PI,
    Expression,
    component,
    const,
    make,
    quantity,
    vector,
)

MAX_STEPS = 50_000
"""Operations a model may expand to: doubling functions grow faster than any profile can hold."""

_BINARY = {
    "+": "add",
    "-": "sub",
    "*": "mul",
    "/": "div",
    "^": "pow",
    "<": "lt",
    "<=": "le",
    ">": "gt",
    ">=": "ge",
    "==": "eq",
    "!=": "ne",
    "and": "and",
    "or": "or",
}


def build(
    definition: Definition,
    values: Mapping[str, tuple[float, ...]],
    *,
    free: bool = False,
    leave: Collection[str] = (),
) -> Expression:
    """The expression of a definition without parameters, usually a model's radiance.

    values: what is fixed at compile time, one number a component, angles in radians. Quantities
    that are constants by role and absent from values take their default; free leaves them open, and
    leave those of these names.
    """
    return _Builder(values, free, leave).definition(definition)


@dataclass(frozen=True)
class Simpler:
    """A part of a formula that a definition gives, and what another would give in its place."""

    part: Expression
    by: Expression
    words: str


def simpler_parts(
    definition: Definition, values: Mapping[str, tuple[float, ...]], leave: Collection[str] = ()
) -> tuple[Simpler, ...]:
    """What `simpler` clauses offer for the parts of a definition; arguments as for build."""
    builder = _Builder(values, False, leave, offers=[])
    builder.definition(definition)
    return tuple(builder.offers or ())


@dataclass
class _Builder:
    """offers: where what is simpler is collected, or None."""

    values: Mapping[str, tuple[float, ...]]
    free: bool
    leave: Collection[str]
    offers: list[Simpler] | None = None
    done: dict[int, Expression] = field(default_factory=dict)
    steps: int = 0

    def definition(self, definition: Definition) -> Expression:
        if id(definition) not in self.done:
            self.done[id(definition)] = self.called(definition, [])
        return self.done[id(definition)]

    def expression(
        self, node: tree.Expr, scope: Mapping[str, Symbol], local: Mapping[str, Expression]
    ) -> Expression:
        self.steps += 1
        if self.steps > MAX_STEPS:
            message = f"functions of functions expand to more than {MAX_STEPS:,} operations"
            raise ModelError([Diagnostic(node.span, message)])
        match node:
            case tree.Number():
                return _literal(node)
            case tree.Name():
                return self.name(node.name, scope, local)
            case tree.Unary(operator=operator, operand=operand):
                value = self.expression(operand, scope, local)
                return make("neg" if operator == "-" else "not", value)
            case tree.Binary(operator=operator, left=left, right=right):
                a = self.expression(left, scope, local)
                return make(_BINARY[operator], a, self.expression(right, scope, local))
            case tree.Where(value=value, condition=condition, otherwise=otherwise):
                parts = (condition, value, otherwise)
                return make("where", *(self.expression(p, scope, local) for p in parts))
            case tree.Vector(components=components):
                return vector([self.expression(c, scope, local) for c in components])
            case tree.Component(vector=whole, index=index):
                return component(self.expression(whole, scope, local), index)
            case tree.LetIn(name=name, value=value, body=body):
                inner = {**local, name: self.expression(value, scope, local)}
                return self.expression(body, scope, inner)
            case tree.Call(function=function, arguments=arguments):
                given = [self.expression(a, scope, local) for a in arguments]
                user = scope.get(function)
                if isinstance(user, Definition) and user.parameters is not None:
                    return self.called(user, given)
                return _builtin(function, given)
        raise TypeError(f"unknown node {node!r}")

    def called(self, definition: Definition, given: list[Expression]) -> Expression:
        """The body of a definition with these arguments."""
        names = [parameter.name for parameter in definition.parameters or ()]
        local = dict(zip(names, given, strict=True))
        value = self.expression(definition.body, definition.scope, local)
        offers = self.offers
        for name in definition.simpler if offers is not None else ():
            other = definition.scope[name]
            assert isinstance(other, Definition)
            assert offers is not None
            self.offers = None  # of what is simpler itself, nothing is offered
            by = self.called(other, given)
            self.offers = offers
            offers.append(Simpler(value, by, f"{definition.name}: {name} in its place"))
        return value

    def name(
        self, name: str, scope: Mapping[str, Symbol], local: Mapping[str, Expression]
    ) -> Expression:
        if name in local:
            return local[name]
        if name == "pi":
            return PI
        symbol = scope[name]
        if isinstance(symbol, Quantity):
            return self.quantity(symbol)
        return self.definition(symbol)

    def quantity(self, symbol: Quantity) -> Expression:
        fixed = self.values.get(symbol.name)
        left = self.free or symbol.name in self.leave
        if fixed is None and symbol.role is Role.CONSTANT and not left:
            fixed = symbol.default
        if fixed is None:
            return quantity(symbol.name, symbol.type.value.width)
        exact = _exact_angle if symbol.type.is_angle else (lambda value: const(Fraction(value)))
        components = [exact(value) for value in fixed]
        return components[0] if len(components) == 1 else vector(components)


def _literal(number: tree.Number) -> Expression:
    if number.unit == "deg":
        return make("mul", const(number.value / 180), PI)
    return const(number.value)


def _exact_angle(radians: float) -> Expression:
    """A fixed angle: exactly so many degrees where that is what the number stands for.

    90deg must stay the right angle, whose cosine is 0, and not become the float next to it.
    """
    degrees = Fraction(math.degrees(radians)).limit_denominator(10**6)
    if math.isclose(float(degrees) * math.pi / 180, radians, rel_tol=4e-16):
        return make("mul", const(degrees / 180), PI)
    return const(Fraction(radians))


def _dot(a: Expression, b: Expression) -> Expression:
    products = [make("mul", component(a, i), component(b, i)) for i in range(a.width)]
    return reduce(lambda x, y: make("add", x, y), products)


def _cross(a: Expression, b: Expression) -> Expression:
    def minor(i: int, j: int) -> Expression:
        left = make("mul", component(a, i), component(b, j))
        return make("sub", left, make("mul", component(a, j), component(b, i)))

    return vector([minor(1, 2), minor(2, 0), minor(0, 1)])


def _builtin(function: str, given: list[Expression]) -> Expression:
    """A built-in function; those that are shorthand are written out."""
    match function:
        case "min" | "max":
            return reduce(lambda x, y: make(function, x, y), given)
        case "clamp":
            x, low, high = given
            return make("min", make("max", x, low), high)
        case "dot":
            return _dot(*given)
        case "cross":
            return _cross(*given)
        case "length":
            return make("sqrt", _dot(given[0], given[0]))
        case "normalize":
            return make("div", given[0], make("sqrt", _dot(given[0], given[0])))
        case "radians":  # angles are kept in radians
            return given[0]
        case "degrees":
            return make("mul", given[0], make("div", const(180), PI))
        case _:
            return make(function, *given)
