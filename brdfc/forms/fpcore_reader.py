"""FPCore 1.2 read into expressions: straight-line formulas, as FPBench's graphics benchmarks are.

Loops, arrays and operators that no formula here can hold are errors with their place.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from itertools import pairwise

from brdfc.forms.fpcore_names import (
    COMPARISONS,
    CONSTANTS,
    OPERATORS,
    UNARY,
    WRITTEN_OUT,
    unescape_name,
)
from brdfc.forms.fpcore_text import Items, Node, Symbol, Text, fail, read_nodes
from brdfc.lang.limits import MAX_LEVELS
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.span import Source
from brdfc.symbolic.expression import Expression, const, make, quantity, walk
from brdfc.symbolic.intervals import INF, Interval, meet

_DECIMAL = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d{1,4})?")
_QUOTIENT = re.compile(r"[-+]?\d+/0*[1-9]\d*")
_HEXADECIMAL = re.compile(r"[-+]?0x[0-9a-fA-F]+(\.[0-9a-fA-F]+)?(p[-+]?\d{1,3})?")
_LONGEST_NAME = 1000


@dataclass(frozen=True)
class Core:
    """One FPCore. domain: the range of each argument as its :pre says, open where it says none;
    precondition: the whole :pre, of which the ranges are only a part."""

    name: str
    arguments: tuple[str, ...]
    expression: Expression
    domain: Mapping[str, Interval]
    precondition: Expression | None
    precision: str


def from_fpcore(text: str, name: str = "<fpcore>") -> tuple[Core, ...]:
    """The FPCores of a text, in their order.

    name: what errors call the text. The same real function is read, not the order of roundings:
    expm1(x) becomes exp(x) - 1. Raises ModelError with the place of what cannot be read.
    """
    return tuple(_core(node) for node in read_nodes(Source(name, text)))


def _core(node: Node) -> Core:
    """One FPCore. What it may hold is bounded, as later stages walk expressions by recursion."""
    if not isinstance(node, Items) or node.head != "FPCore":
        fail(node.span, "expected (FPCore (arguments) properties... formula)")
    rest = list(node.items[1:])
    label = rest.pop(0).text if rest and isinstance(rest[0], Symbol) else ""  # type: ignore[union-attr]
    if not rest or not isinstance(rest[0], Items):
        fail(node.span, "this FPCore has no list of arguments")
    arguments = [_argument(item) for item in rest[0].items]
    known = {symbol: quantity(unescape_name(symbol), 1) for symbol in arguments}
    properties = _properties(rest[1:-1])
    if len(rest) < 2:
        fail(node.span, "this FPCore has no formula")
    expression = _expression(rest[-1], known)
    given = properties.get("pre")
    condition = _expression(given, known) if given else None
    for part in (expression, condition):
        if part is not None and _levels(part) > MAX_LEVELS:
            fail(node.span, f"this FPCore is more than {MAX_LEVELS} operations deep")
    domain = {e.name: Interval(-INF, INF) for e in known.values()}
    if condition is not None:
        _learn(condition, domain)
    return Core(
        _plain(properties.get("name")) or label,
        tuple(domain),
        expression,
        domain,
        condition,
        _plain(properties.get("precision")) or "binary64",
    )


def _levels(expression: Expression) -> int:
    levels: dict[Expression, int] = {}
    for part in walk(expression):
        levels[part] = 1 + max((levels[a] for a in part.arguments), default=0)
    return levels[expression]


def _argument(node: Node) -> str:
    if isinstance(node, Items) and node.head == "!" and node.items:
        node = node.items[-1]  # annotations say how to round, not what it is
    if not isinstance(node, Symbol):
        fail(node.span, "expected the name of an argument", "arrays are not supported")
    return node.text


def _properties(nodes: Sequence[Node]) -> dict[str, Node]:
    found = {}
    for key, value in zip(nodes[::2], nodes[1::2], strict=False):
        if not isinstance(key, Symbol) or not key.text.startswith(":"):
            fail(key.span, "expected a property (:name, :pre, ...)")
        found[key.text[1:]] = value
    if len(nodes) % 2:
        fail(nodes[-1].span, "expected a property and its value, then one formula")
    return found


def _plain(node: Node | None) -> str:
    return node.text if isinstance(node, Symbol | Text) else ""


def _expression(node: Node, known: Mapping[str, Expression]) -> Expression:
    match node:
        case Symbol(text=text):
            return _leaf(node, text, known)
        case Text():
            fail(node.span, "a string is no part of a formula")
        case Items(items=()):
            fail(node.span, "expected an operator and its arguments")
    head, items = node.head, node.items
    if head in ("let", "let*"):
        return _let(node, known)
    if head == "!":
        return _expression(items[-1], known)
    if head == "if" and len(items) != 4:
        fail(node.span, "'if' takes a condition and two values")
    if head != "if" and head not in OPERATORS and (head, len(items) - 1) not in WRITTEN_OUT:
        hint = did_you_mean(head, OPERATORS)
        fail(items[0].span, f"'{items[0].span.text}' is no operator that is read here", hint)
    given = [_expression(item, known) for item in items[1:]]
    return make("where", *given) if head == "if" else _applied(node, head, given)


def _applied(node: Items, head: str, given: list[Expression]) -> Expression:
    if (head, len(given)) in WRITTEN_OUT:
        return WRITTEN_OUT[head, len(given)](*given)
    operator = OPERATORS[head]
    if operator in COMPARISONS and len(given) >= 2:
        if operator == "ne":  # all of them differ, not only neighbours
            pairs = [(a, b) for i, a in enumerate(given) for b in given[i + 1 :]]
        else:
            pairs = list(pairwise(given))
        return reduce(lambda a, b: make("and", a, b), [make(operator, *p) for p in pairs])
    if operator in ("and", "or") and given:
        return reduce(lambda a, b: make(operator, a, b), given)
    wanted = 1 if operator in UNARY else 2
    if len(given) != wanted:
        fail(node.span, f"'{head}' takes {wanted} argument{'s' if wanted > 1 else ''}")
    return make(operator, *given)


def _let(node: Items, known: Mapping[str, Expression]) -> Expression:
    if len(node.items) != 3 or not isinstance(node.items[1], Items):
        fail(node.span, f"'{node.head}' takes a list of names with values, and a formula")
    inner = dict(known)
    for pair in node.items[1].items:
        if not isinstance(pair, Items) or len(pair.items) != 2:
            fail(pair.span, "expected (name value)")
        visible = inner if node.head == "let*" else known
        inner[_argument(pair.items[0])] = _expression(pair.items[1], visible)
    return _expression(node.items[2], inner)


def _leaf(node: Symbol, text: str, known: Mapping[str, Expression]) -> Expression:
    if text in known:
        return known[text]
    if text in CONSTANTS:
        return CONSTANTS[text]
    if len(text) > _LONGEST_NAME:
        fail(node.span, f"a name or number of more than {_LONGEST_NAME:,} letters")
    if _HEXADECIMAL.fullmatch(text):
        return const(Fraction(float.fromhex(text)))
    if not _DECIMAL.fullmatch(text) and not _QUOTIENT.fullmatch(text):
        hint = did_you_mean(text, [*known, *CONSTANTS])
        fail(node.span, f"nothing here is called '{text}'", hint)
    return const(Fraction(text))


def _learn(condition: Expression, domain: dict[str, Interval]) -> None:
    """Narrow the ranges by the bounds in a conjunction; its other parts only stay in it."""
    if condition.operator == "and":
        for part in condition.arguments:
            _learn(part, domain)
    if condition.operator not in ("le", "lt", "ge", "gt", "eq"):
        return
    low, high = condition.arguments
    if condition.operator in ("ge", "gt"):
        low, high = high, low
    _bound(low, high, domain)
    if condition.operator == "eq":
        _bound(high, low, domain)


def _bound(low: Expression, high: Expression, domain: dict[str, Interval]) -> None:
    least, most = _constant(low), _constant(high)
    if high.operator == "quantity" and least is not None:
        domain[high.name] = meet(domain[high.name], Interval(least, INF))
    if low.operator == "quantity" and most is not None:
        domain[low.name] = meet(domain[low.name], Interval(-INF, most))


def _constant(e: Expression) -> float | None:
    """The value of a part without arguments, such as (- (/ PI 2))."""
    from brdfc.symbolic.evaluate import evaluate_precisely

    if any(part.operator == "quantity" for part in walk(e)):
        return None
    return evaluate_precisely(e, {})[0]
