"""Expressions over the real numbers, as a graph: equal expressions are one object.

Sharing makes common subexpressions visible, and lets every later stage use an expression as a key.
A vector is one expression of some width; an operator with a scalar and a vector acts on every
component. Nothing here simplifies: what is written is what stands, until a named step rewrites it
(SymPy's constructors, in contrast, would turn (ti - tr)/2 into ti/2 - tr/2, which costs accuracy).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from weakref import WeakValueDictionary


@dataclass(frozen=True, eq=False, slots=True, weakref_slot=True)
class Expression:
    """An operator and its arguments; compared by identity (see make).

    width: number of components. value: of a `const`, exact. name: of a `quantity`. index: of a
    `component`.
    """

    operator: str
    arguments: tuple[Expression, ...]
    width: int
    value: Fraction = Fraction(0)
    name: str = ""
    index: int = 0

    def __str__(self) -> str:
        return describe(self)

    def __repr__(self) -> str:
        return f"<{describe(self)}>"


_Key = tuple[str, tuple[int, ...], int, Fraction, str, int]
_made: WeakValueDictionary[_Key, Expression] = WeakValueDictionary()


def _intern(expression: Expression) -> Expression:
    e = expression
    key = (e.operator, tuple(map(id, e.arguments)), e.width, e.value, e.name, e.index)
    return _made.setdefault(key, e)


def make(operator: str, *arguments: Expression) -> Expression:
    """An operator applied element by element; widths are equal or 1."""
    return _intern(Expression(operator, arguments, max(a.width for a in arguments)))


def const(value: Fraction | int) -> Expression:
    """An exact rational constant."""
    return _intern(Expression("const", (), 1, value=Fraction(value)))


PI = _intern(Expression("pi", (), 1))
ZERO, ONE = const(0), const(1)


def quantity(name: str, width: int) -> Expression:
    """A channel, variable or constant of the model, by name."""
    return _intern(Expression("quantity", (), width, name=name))


def vector(components: Sequence[Expression]) -> Expression:
    """Scalars side by side."""
    return _intern(Expression("vector", tuple(components), len(components)))


def component(of: Expression, index: int) -> Expression:
    """One component of a vector."""
    if of.operator == "vector":
        return of.arguments[index]
    return _intern(Expression("component", (of,), 1, index=index))


def rebuild(expression: Expression, arguments: Sequence[Expression]) -> Expression:
    """The same operator with other arguments."""
    if all(new is old for new, old in zip(arguments, expression.arguments, strict=True)):
        return expression
    if expression.operator == "component":
        return component(arguments[0], expression.index)
    if expression.operator == "vector":
        return vector(arguments)
    return make(expression.operator, *arguments)


def constant_vector(values: Sequence[float]) -> Expression:
    """Numbers side by side, exactly."""
    return vector([const(Fraction(value)) for value in values])


def walk(root: Expression) -> Iterator[Expression]:
    """Every expression below root once, arguments before what uses them."""
    seen: set[Expression] = set()
    waiting = [(root, False)]
    while waiting:
        expression, arguments_done = waiting.pop()
        if arguments_done:
            yield expression
        elif expression not in seen:
            seen.add(expression)
            waiting.append((expression, True))
            waiting += [(a, False) for a in reversed(expression.arguments)]


def substituted(root: Expression, new: Mapping[Expression, Expression]) -> Expression:
    """The expression with some parts, wherever they occur, replaced by others."""
    if not new:
        return root
    done: dict[Expression, Expression] = {}
    for e in walk(root):
        done[e] = new[e] if e in new else rebuild(e, [done[a] for a in e.arguments])
    return done[root]


def whole_exponent(e: Expression) -> int | None:
    """The exponent of a `pow`, if it is a whole constant."""
    exponent = e.arguments[1]
    whole = exponent.operator == "const" and exponent.value.denominator == 1
    return int(exponent.value) if whole else None


def nearest(value: Fraction) -> float:
    """The nearest float64; infinite where it overflows."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


_INFIX = {
    "add": "+",
    "sub": "-",
    "mul": "*",
    "div": "/",
    "pow": "^",
    "lt": "<",
    "le": "<=",
    "gt": ">",
    "ge": ">=",
    "eq": "==",
    "ne": "!=",
    "and": "and",
    "or": "or",
}


def describe(expression: Expression, levels: int = 5) -> str:
    """The expression in the language's own notation, fully bracketed inside.

    What lies deeper than so many levels is `...`: with shared parts written out, the whole could
    be of any length.
    """
    operator, arguments = expression.operator, expression.arguments
    if operator == "const":
        exact = expression.value
        short = exact.denominator < 1000 and abs(exact.numerator) < 10**9
        return str(exact) if short else f"{nearest(exact):.6g}"
    if operator in ("quantity", "pi"):
        return expression.name or "pi"
    if levels == 0:
        return "..."
    texts = [describe(a, levels - 1) for a in arguments]
    if operator in _INFIX:
        return f"({texts[0]} {_INFIX[operator]} {texts[1]})"
    if operator == "neg":
        return f"-{texts[0]}"
    if operator == "where":
        return f"({texts[1]} where {texts[0]} else {texts[2]})"
    if operator == "component":
        index = expression.index
        return f"{texts[0]}.{'xyz'[index]}" if index < 3 else f"{texts[0]}[{index}]"
    return f"{'' if operator == 'vector' else operator}({', '.join(texts)})"
