"""What a graph of operators will cost about, before it is scheduled."""

from __future__ import annotations

from collections import Counter

from brdfc.calc.operators import DISPATCH, OPERATORS
from brdfc.codegen.nodes import Node, postorder


def estimated_price(result: Node) -> float:
    """Nanoseconds a pixel on the reference engine: every operator once, and for every value used
    again one operator to keep it and one each time to fetch it."""
    nodes = postorder(result)
    uses = Counter(argument for node in nodes for argument in node.arguments)
    total = DISPATCH  # the output
    for node in nodes:
        again = max(uses[node] - 1, 0)
        if node.operator == "vector":
            continue
        total += DISPATCH * (again + (again > 0 and not node.cheap))
        if node.operator == "env":
            total += DISPATCH * (3 if node.value else 2)
        elif node.operator == "where":
            total += DISPATCH * 2
        else:
            total += DISPATCH + OPERATORS[node.operator].price
    return total
