"""What a graph of operators will cost about, before it is scheduled."""

from __future__ import annotations

from collections import Counter

from brdfc.calc.prices import prices
from brdfc.codegen.nodes import Node, postorder


def estimated_price(result: Node) -> float:
    """Nanoseconds a pixel on the reference engine: every operator once, and for every value used
    again one operator to keep it and one each time to fetch it."""
    nodes = postorder(result)
    uses = Counter(argument for node in nodes for argument in node.arguments)
    table = prices()
    dispatch = table.dispatch
    total = dispatch  # the output
    for node in nodes:
        again = max(uses[node] - 1, 0)
        if node.operator == "vector":
            continue
        total += dispatch * (again + (again > 0 and not node.cheap))
        if node.operator == "env":
            total += dispatch * (3 if node.value else 2)
        elif node.operator == "where":
            total += dispatch * 2
        else:
            total += dispatch + table.operators[node.operator].first
    return total
