"""What a graph of operators will cost about, before it is scheduled."""

from __future__ import annotations

from brdfc.calc.prices import prices
from brdfc.codegen.nodes import Node, postorder


def estimated_price(result: Node) -> float:
    """Nanoseconds a pixel on the reference engine: every operator as often as pixels need it, and
    for every value used again one operator to keep it and one each time to fetch it."""
    table = prices()
    dispatch = table.dispatch
    total = dispatch  # the output
    for node, uses in _uses(result).items():
        needed = min(1.0, uses)
        again = uses - needed
        if node.operator == "vector":
            continue
        total += dispatch * (again + (needed if again > 0 and not node.cheap else 0))
        if node.operator == "env":
            total += needed * dispatch * (3 if node.value else 2)
        elif node.operator == "where":
            total += needed * dispatch * 2
        else:
            total += needed * (dispatch + table.operators[node.operator].first)
    return total


def _uses(result: Node) -> dict[Node, float]:
    """How often a pixel uses each node, on average: of a `where` each branch counts by its share
    of the pixels, in full where that is not known."""
    nodes = postorder(result)
    uses = dict.fromkeys(nodes, 0.0)
    uses[result] = 1.0
    for node in reversed(nodes):
        shares = [1.0] * len(node.arguments)
        if node.operator == "where" and node.share is not None:
            shares = [1.0, node.share, 1 - node.share]
        for argument, share in zip(node.arguments, shares, strict=True):
            uses[argument] += share * min(1.0, uses[node])
    return uses
