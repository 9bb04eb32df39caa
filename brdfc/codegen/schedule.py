"""Putting a graph of operators in order on the stack, and keeping what is needed again.

A value used twice is copied on the stack where it still stands there, else kept in a temporary, or
computed again: whichever the price table says is cheapest. The order in which the first two terms
of sums and products are computed is searched, one change at a time, as long as it pays. Nothing
here changes the arithmetic: the program rounds exactly where the expression has an operator.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from brdfc.calc.price import nanoseconds
from brdfc.calc.program import Block, Program
from brdfc.codegen.emit import Plan, emit
from brdfc.codegen.group import grouped, pairs
from brdfc.codegen.nodes import Node, needed_by_both, postorder
from brdfc.source.errors import BrdfcError

_COMMUTATIVE = ("add", "mul", "sum", "prod")
_WORK = 40_000
"""Values emitted in all attempts, so that compiling stays quick for a model of any size."""
_PAIRS = 300
"""Pairs of operators tried as one vector operator, times the operators of the graph."""
_LARGE = 12
"""Operators from which a part that both branches of a `where` need is computed before it."""
_LONGEST = 200_000
"""Values computed by a program at most; far longer than any useful one."""


def schedule(result: Node, inputs: int) -> Program:
    """The program that computes a graph and writes it to outputs 0.., in the cheapest order found.

    inputs: channels the program has. Deterministic: the same graph gives the same program.
    """
    block, price = _scheduled(result)
    graph = result
    for pair in pairs(result)[: _PAIRS // len(postorder(result))]:
        joined = grouped(graph, pair)
        if joined is not None:
            candidate, cost = _scheduled(joined)
            if cost < price - 1e-9:
                graph, block, price = joined, candidate, cost
    return Program(inputs, result.width, block)


def _scheduled(result: Node) -> tuple[Block, float]:
    """The cheapest block found for one graph, and its price."""
    nodes = postorder(result)
    uses = Counter(argument for node in nodes for argument in node.arguments)
    groups = {node.arguments[0] for node in nodes if node.operator == "part"}
    shared = [n for n in nodes if uses[n] > 1 and not n.cheap and n.operator != "part"]
    commutative = [node for node in nodes if node.operator in _COMMUTATIVE]
    before = needed_by_both(nodes, _LARGE)
    # A plan that keeps too little repeats itself without end, so its length is bounded.
    limit = 4 * len(nodes) + 64
    attempts = _WORK // limit

    shared = [n for n in shared if n not in groups]  # a group is always kept, for its parts
    keep_all = Plan(frozenset(shared) | groups, frozenset(), before)
    best, block = keep_all, emit(result, keep_all, _LONGEST)
    if block is None:
        raise BrdfcError(
            f"the formula expands to more than {_LONGEST:,} operations",
            hint="conditions inside one another double it; share their parts with `let`",
        )
    price = nanoseconds(block)

    def better(plan: Plan) -> Block | None:
        candidate = emit(result, plan, limit)
        return candidate if candidate and nanoseconds(candidate) < price - 1e-9 else None

    changes = [
        lambda plan: replace(plan, kept=frozenset(groups)),
        *(lambda plan, n=n: replace(plan, kept=plan.kept ^ {n}) for n in shared),
        *(lambda plan, n=n: replace(plan, swapped=plan.swapped ^ {n}) for n in commutative),
    ]
    unchanged = 0  # changes in a row that did not pay; once all of them, there is no better one
    position = 0
    while changes and unchanged < len(changes) and attempts > 0:
        plan = changes[position % len(changes)](best)
        found = better(plan)
        if found is None:
            unchanged += 1
        else:
            best, block, price, unchanged = plan, found, nanoseconds(found), 0
        position += 1
        attempts -= 1
    return block, price
