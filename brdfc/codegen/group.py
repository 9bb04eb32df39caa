"""Two scalars through one operator: cos(a) and cos(b) as one `cos[2]` of a and b.

The calculator's operators take vectors, and an operator costs its dispatch whatever its width. The
values, and how they are rounded, stay the same.
"""

from __future__ import annotations

from functools import reduce
from operator import or_

from brdfc.codegen.nodes import Node, apply, part, postorder, rebuilt, vector

_UNARY = (
    "cos",
    "sin",
    "tan",
    "sqrt",
    "sq",
    "exp",
    "ln",
    "neg",
    "abs",
    "cb",
    "acos",
    "asin",
    "atan",
)

Pair = tuple[Node, Node]


def pairs(result: Node) -> list[Pair]:
    """Scalars that the same operator makes of different arguments, neither from the other."""
    nodes = postorder(result)
    # Sets of nodes as the bits of a number: a graph of thousands has sets of thousands.
    bit = {node: 1 << i for i, node in enumerate(nodes)}
    below: dict[Node, int] = {}
    for node in nodes:
        below[node] = reduce(or_, (below[a] for a in node.arguments), bit[node])
    found = []
    for name in _UNARY:
        alike = [n for n in nodes if n.operator == name and n.width == 1]
        found += [
            (a, b)
            for i, a in enumerate(alike)
            for b in alike[i + 1 :]
            if not (bit[a] & below[b] or bit[b] & below[a])
        ]
    return found


def grouped(result: Node, pair: Pair) -> Node | None:
    """The graph with a pair computed by one operator; None where one is gone already.

    Where the two arguments are needed elsewhere as well, they are kept as the vector they now are.
    """
    first, second = pair
    nodes = postorder(result)
    if first not in nodes or second not in nodes:
        return None
    arguments = (first.arguments[0], second.arguments[0])
    both = vector(list(arguments))
    group = apply(first.operator, both, width=2, count=2)
    joined = _replaced(result, {first: part(group, 0), second: part(group, 1)})
    if any(a.cheap or a.operator == "part" for a in arguments) or arguments[0] is arguments[1]:
        return joined
    return _replaced(joined, {a: part(both, i) for i, a in enumerate(arguments)}, within=both)


def _replaced(result: Node, new: dict[Node, Node], within: Node | None = None) -> Node:
    """The graph with some nodes replaced everywhere, except below `within`."""
    done = dict(new)
    if within is not None:
        done[within] = within
    for node in postorder(result):
        if node not in done:
            arguments = tuple(done[a] for a in node.arguments)
            done[node] = node if arguments == node.arguments else rebuilt(node, arguments)
    return done[result]
