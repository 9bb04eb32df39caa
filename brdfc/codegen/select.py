"""Choosing operators: an expression becomes a graph of calculator operators.

A vector with a scalar takes one vector-scalar operator, a whole power squares, a chain of sums one
`sum`. Quantities become channels or environment variables by their binding.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from brdfc.codegen.nodes import Node, apply, channels, data, variable, vector, where
from brdfc.source.errors import BrdfcError
from brdfc.symbolic.bounds import LONGEST_CHAIN
from brdfc.symbolic.expression import (
    ONE,
    ZERO,
    Expression,
    component,
    const,
    make,
    rebuild,
    walk,
    whole_exponent,
)
from brdfc.symbolic.intervals import single


@dataclass(frozen=True)
class ChannelBinding:
    """A quantity that comes with the pixel: its first channel and how many it has."""

    start: int
    width: int


@dataclass(frozen=True)
class VariableBinding:
    """A quantity that comes with the run: four-letter signature, and its default value."""

    signature: str
    default: float


Binding = ChannelBinding | VariableBinding


@dataclass(frozen=True)
class CurveBinding:
    """A quantity that a program looks up: the sub-element, a curve set of one channel, and what the
    curve is a function of."""

    element: int
    argument: Expression


# Element by element: operator for equal widths, and for a vector with a scalar on top.
_ARITHMETIC = {
    "add": ("add", "sadd"),
    "sub": ("sub", "ssub"),
    "mul": ("mul", "smul"),
    "div": ("div", "sdiv"),
    "pow": ("pow", "gama"),
}

# The rest by name, in the table's spelling. `min` and `max` keep the order of their arguments: the
# second wins where the first is not a number.
_NAMES = {
    "min": "vmin",
    "max": "vmax",
    "ne": "neq",
    "and": "vand",
    "or": "vor",
    "log10": "log",
    "floor": "flor",
    "trunc": "trnc",
    "round": "rond",
    **{name: name for name in ("lt", "le", "gt", "ge", "eq", "not", "neg", "sqrt", "cbrt", "exp")},
    **{name: name for name in ("ln", "sin", "cos", "tan", "asin", "acos", "atan", "abs")},
    **{name: name for name in ("sign", "ceil")},
}

_FOLDS = {"add": "sum", "mul": "prod"}


def select(expression: Expression, bindings: Mapping[str, Binding | CurveBinding]) -> Node:
    """The graph of operators for an expression; bindings says where its quantities come from."""
    uses = Counter(argument for e in walk(expression) for argument in e.arguments)
    return _Selector(bindings, uses).node(expression)


@dataclass
class _Selector:
    bindings: Mapping[str, Binding | CurveBinding]
    uses: Counter[Expression]
    done: dict[Expression, Node] = field(default_factory=dict)
    parts: dict[tuple[Expression, int], Expression] = field(default_factory=dict)

    def node(self, e: Expression) -> Node:
        if e not in self.done:
            self.done[e] = self.selected(e)
        return self.done[e]

    def wide(self, e: Expression, width: int) -> Node:
        """e with as many components as asked for: a scalar repeated."""
        node = self.node(e)
        return node if node.width == width else vector([node] * width)

    def selected(self, e: Expression) -> Node:
        match e.operator:
            case "const":
                return data(_constant(e))
            case "pi":
                return data(single(3.141592653589793))
            case "quantity":
                return self.quantity(e)
            case "vector":
                return vector([self.node(a) for a in e.arguments])
            case "component":
                return self.component(e.arguments[0], e.index)
            case "where":
                condition, value, otherwise = e.arguments
                values = (self.wide(value, e.width), self.wide(otherwise, e.width))
                return where(self.condition(condition), *values)
            case "pow":
                return self.power(e)
            case "atan2":  # the operator takes x first, the ordinate on top
                y, x = (self.wide(a, e.width) for a in e.arguments)
                return apply("atn2", x, y, width=e.width, count=e.width)
            case "add" | "sub" | "mul" | "div":
                return self.arithmetic(e)
            case _:
                arguments = [self.wide(a, e.width) for a in e.arguments]
                return apply(_NAMES[e.operator], *arguments, width=e.width, count=e.width)

    def condition(self, e: Expression) -> Node:
        """What `if` tests: it holds from one half on, so the ceiling of a value within -1..1 says
        whether that is above 0, with one operator instead of two."""
        if e.operator == "gt" and e.arguments[1] is ZERO and _within_one(e.arguments[0]):
            return apply("ceil", self.node(e.arguments[0]), width=1)
        return self.node(e)

    def quantity(self, e: Expression) -> Node:
        binding = self.bindings[e.name]
        if isinstance(binding, ChannelBinding):
            return channels(binding.start, binding.width)
        if isinstance(binding, CurveBinding):
            argument = self.node(binding.argument)
            return apply("curv", argument, width=1, count=binding.element)
        return variable(binding.signature, single(binding.default))

    def component(self, of: Expression, index: int) -> Node:
        if of.operator != "quantity":
            return self.node(self.pushed_down(of, index))
        binding = self.bindings[of.name]
        assert isinstance(binding, ChannelBinding)  # variables are scalars
        return channels(binding.start + index, 1)

    def arithmetic(self, e: Expression) -> Node:
        a, b = e.arguments
        if e.operator == "mul" and a is b:
            return apply("sq", self.node(a), width=e.width, count=e.width)
        if a.width == b.width == 1 and e.operator in _FOLDS:
            terms = self.terms(e, e.operator)
            if len(terms) > 2:
                return apply(_FOLDS[e.operator], *terms, width=1, count=len(terms))
        plain, scaled = _ARITHMETIC[e.operator]
        if a.width == b.width:
            return apply(plain, self.node(a), self.node(b), width=e.width, count=e.width)
        if b.width == 1:
            return apply(scaled, self.node(a), self.node(b), width=e.width, count=e.width)
        if e.operator in ("add", "mul"):
            return apply(scaled, self.node(b), self.node(a), width=e.width, count=e.width)
        if e.operator == "sub":  # s - v = -v + s
            negative = apply("neg", self.node(b), width=e.width, count=e.width)
            return apply("sadd", negative, self.node(a), width=e.width, count=e.width)
        wide = self.wide(a, e.width)
        return apply(plain, wide, self.node(b), width=e.width, count=e.width)

    def terms(self, e: Expression, operator: str) -> list[Node]:
        """The terms of a chain of sums or products, as far as its parts are not shared."""
        a, b = e.arguments
        chained = (
            a.operator == operator and self.uses[a] == 1 and a.arguments[0] is not (a.arguments[1])
        )
        first = self.terms(a, operator) if chained else [self.node(a)]
        return [*first, self.node(b)]

    def power(self, e: Expression) -> Node:
        base, exponent = e.arguments
        n = whole_exponent(e)
        if n is None or abs(n) > LONGEST_CHAIN:
            if exponent.width == 1 and base.width > 1:
                arguments = (self.node(base), self.node(exponent))
                return apply("gama", *arguments, width=e.width, count=e.width)
            arguments = (self.wide(base, e.width), self.wide(exponent, e.width))
            return apply("pow", *arguments, width=e.width, count=e.width)
        if n < 0:
            return self.node(make("div", ONE, make("pow", base, const(-n))))
        return _whole_power(self.node(base), n) if n else self.wide(ONE, e.width)

    def pushed_down(self, e: Expression, index: int) -> Expression:
        """One component of a vector expression, as an expression of scalars."""
        if e.width == 1:
            return e
        if e.operator in ("quantity", "vector"):
            return component(e, index)
        if (e, index) not in self.parts:
            arguments = [self.pushed_down(a, index) for a in e.arguments]
            self.parts[e, index] = rebuild(e, arguments)
        return self.parts[e, index]


def _whole_power(base: Node, n: int) -> Node:
    """Repeated squaring and cubing: x^5 = (x^2)^2 x."""
    width = base.width

    def unary(operator: str, of: Node) -> Node:
        return apply(operator, of, width=width, count=width)

    if n == 1:
        return base
    if n == 3:
        return unary("cb", base)
    if n % 2 == 0:
        return unary("sq", _whole_power(base, n // 2))
    return apply("mul", _whole_power(base, n - 1), base, width=width, count=width)


def _within_one(e: Expression) -> bool:
    """Whether an expression lies within -1..1 by what it is made of."""
    if e.operator in ("min", "max", "mul"):
        return all(map(_within_one, e.arguments))
    return e.operator in ("sin", "cos")


def _constant(e: Expression) -> float:
    value = single(e.value)
    if math.isinf(value):
        raise BrdfcError(
            f"the constant {e} does not fit a 32-bit float",
            hint="write the formula so that its constants stay below 3.4e38",
        )
    return value
