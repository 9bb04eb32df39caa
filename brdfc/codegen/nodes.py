"""Calculator operators as a graph, before they are put in order: equal nodes are one object."""

from __future__ import annotations

from dataclasses import dataclass, replace
from weakref import WeakValueDictionary


@dataclass(frozen=True, eq=False, slots=True, weakref_slot=True)
class Node:
    """An operator of the calculator on the values its arguments leave on the stack.

    operator: a name of the operator table with its vector width, fold count or sub-element in
    `count`, or one of `where` (condition, value, otherwise), `vector` (values side by side), `env`,
    `part` (one value of a group). width: values it leaves. start: first channel of `in`, index of
    a `part`. value: of `data`, and the default of
    `env`, whose four letters are signature. share: of a `where`, the part of the pixels that takes
    its first branch, if known.
    """

    operator: str
    arguments: tuple[Node, ...]
    width: int
    count: int = 1
    start: int = 0
    value: float = 0.0
    signature: str = ""
    share: float | None = None

    @property
    def cheap(self) -> bool:
        """Made anew by one operator, so never worth a temporary."""
        return self.operator in ("data", "in")


_Key = tuple[str, tuple[int, ...], int, int, int, float, str, float | None]
_made: WeakValueDictionary[_Key, Node] = WeakValueDictionary()


def _intern(node: Node) -> Node:
    n = node
    arguments = tuple(map(id, n.arguments))
    key = (n.operator, arguments, n.width, n.count, n.start, n.value, n.signature, n.share)
    return _made.setdefault(key, n)


def apply(operator: str, *arguments: Node, width: int, count: int = 1) -> Node:
    """An operator on arguments, in the order they stand on the stack."""
    return _intern(Node(operator, arguments, width, count))


def data(value: float) -> Node:
    """A constant, a float32 already."""
    # -0.0 and 0.0 are equal as keys; a negative zero is never needed.
    return _intern(Node("data", (), 1, value=value + 0.0))


def channels(start: int, width: int) -> Node:
    """Input channels side by side."""
    return _intern(Node("in", (), width, start=start))


def variable(signature: str, default: float) -> Node:
    """An environment variable, or its default where the engine does not define it."""
    return _intern(Node("env", (), 1, value=default, signature=signature))


def vector(values: list[Node]) -> Node:
    """Scalars side by side."""
    return _intern(Node("vector", tuple(values), len(values)))


def where(condition: Node, value: Node, otherwise: Node) -> Node:
    """value where the condition holds, else otherwise; only that one is computed."""
    return _intern(Node("where", (condition, value, otherwise), value.width))


def part(group: Node, index: int) -> Node:
    """One value of an operator that leaves several."""
    return _intern(Node("part", (group,), 1, start=index))


def rebuilt(node: Node, arguments: tuple[Node, ...]) -> Node:
    """The same operator on other arguments."""
    return _intern(replace(node, arguments=arguments))


def shared_out(node: Node, arguments: tuple[Node, ...], share: float) -> Node:
    """The same `where` on other arguments, with its share of pixels."""
    return _intern(replace(node, arguments=arguments, share=share))


def postorder(root: Node) -> list[Node]:
    """Every node below root once, arguments first."""
    found: dict[Node, None] = {}
    waiting = [(root, False)]
    while waiting:
        node, arguments_done = waiting.pop()
        if arguments_done:
            found[node] = None
        elif node not in found:
            waiting.append((node, True))
            waiting += [(a, False) for a in reversed(node.arguments)]
    return list(found)


def needed_by_both(nodes: list[Node], least: int) -> dict[Node, tuple[Node, ...]]:
    """For each `where` of a postorder: what both its branches compute on every path.

    Only the outermost such nodes, and of at least so many operators (shared ones counted as often
    as they are used).
    """
    weight: dict[Node, int] = {}
    always: dict[Node, dict[Node, None]] = {}  # a node, and what it always computes
    both: dict[Node, tuple[Node, ...]] = {}
    for node in nodes:
        weight[node] = 1 + sum(weight[a] for a in node.arguments)
        if node.operator == "where":
            condition, value, otherwise = node.arguments
            common = [n for n in always[value] if n in always[otherwise] and weight[n] >= least]
            inner = {n for c in common for n in always[c] if n is not c}
            both[node] = tuple(n for n in common if n not in inner)
            below = [always[condition], dict.fromkeys(common)]
        else:
            below = [always[a] for a in node.arguments]
        always[node] = {n: None for part in below for n in part}
        always[node][node] = None
    return both
