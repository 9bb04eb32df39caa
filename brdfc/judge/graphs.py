"""Values of operator graphs in float32, as a program rounds them.

A program's arithmetic is its graph's arithmetic, whatever the schedule.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from brdfc.codegen.nodes import Node, postorder, rebuilt, shared_out
from brdfc.engine.kernels import BINARY, FOLDED, SCALED, UNARY, holds

Values = NDArray[np.float32]


class Graphs:
    """Float32 values of operator graphs at fixed points.

    channels: (points, channels); variables: (points,) by signature.
    """

    def __init__(self, channels: Values, variables: Mapping[str, Values]) -> None:
        self.channels = channels
        self.variables = variables
        self._held: dict[Node, NDArray[np.bool_]] = {}  # forms of one formula share conditions

    def only(self, which: NDArray[np.bool_]) -> Graphs:
        """The same at some of the points."""
        return Graphs(self.channels[which], {n: v[which] for n, v in self.variables.items()})

    def values(self, node: Node) -> Values:
        """(points, width) of a graph."""
        done: dict[Node, list[Values]] = {}
        with np.errstate(all="ignore"):
            for part in postorder(node):
                done[part] = self._computed(part, [done[a] for a in part.arguments])
        return np.stack(np.broadcast_arrays(*done[node], self.channels[:, 0])[:-1], axis=-1)

    def shared_out(self, result: Node) -> Node:
        """The same graph, with the share of the points that takes each branch, of those that come
        to it."""
        nodes = postorder(result)
        taken = {n: self._taken(n) for n in nodes if n.operator == "where"}
        if not taken:
            return result
        everywhere = np.ones(len(self.channels), dtype=np.bool_)
        reached = dict.fromkeys(nodes, ~everywhere)
        reached[result] = everywhere
        new: dict[Node, Node] = {}
        for node in reversed(nodes):
            here = reached[node]
            inside = [here] * len(node.arguments)
            if node in taken:
                inside[1:] = [here & taken[node], here & ~taken[node]]
            for argument, mask in zip(node.arguments, inside, strict=True):
                reached[argument] = reached[argument] | mask
        for node in nodes:
            arguments = tuple(new[a] for a in node.arguments)
            if node in taken:
                count = max(int(reached[node].sum()), 1)
                share = int((reached[node] & taken[node]).sum()) / count
                new[node] = shared_out(node, arguments, share)
            else:
                new[node] = rebuilt(node, arguments)
        return new[result]

    def _taken(self, choice: Node) -> NDArray[np.bool_]:
        """The points at which a `where` takes its first branch."""
        condition = choice.arguments[0]
        if condition not in self._held:
            self._held[condition] = np.asarray(holds(self.values(condition)[:, 0]))
        return self._held[condition]

    def _computed(self, node: Node, parts: list[list[Values]]) -> list[Values]:
        """The columns of a node, from those of its arguments."""
        name = node.operator
        if name == "data":
            return [np.asarray(node.value, dtype=np.float32)]
        if name == "in":
            return [self.channels[:, node.start + i] for i in range(node.width)]
        if name == "env":
            return [self.variables[node.signature]]
        if name == "vector":
            return [column for part in parts for column in part]
        if name == "where":
            condition, value, otherwise = parts
            taken = holds(condition[0])
            return [np.where(taken, a, b) for a, b in zip(value, otherwise, strict=True)]
        if name in FOLDED:
            return [FOLDED[name]([part[0] for part in parts])]
        if name in SCALED:
            return [BINARY[SCALED[name]](x, parts[1][0]) for x in parts[0]]
        kernel = UNARY[name] if name in UNARY else BINARY[name]
        return [kernel(*column) for column in zip(*parts, strict=True)]
