"""One plan to one block of instructions: a walk over the graph, values left on the stack."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from brdfc.calc.operators import OPERATORS, Operand
from brdfc.calc.program import Block, If, Instruction, Op
from brdfc.codegen.nodes import Node

_TEMPORARY = ("tget", "tput", "tsav")


@dataclass(frozen=True)
class Plan:
    """kept: nodes that may be put into temporaries for later; swapped: commutative nodes whose
    first two arguments are computed in the other order; before: for a `where`, the kept nodes to
    compute before it, as both branches need them."""

    kept: frozenset[Node]
    swapped: frozenset[Node]
    before: Mapping[Node, tuple[Node, ...]]


class _TooLongError(Exception):
    """The plan repeats too much to be worth finishing."""


@dataclass
class _Path:
    """The state along one path: code so far, what stands on the stack (node and component, top
    last), and which nodes are in temporaries."""

    code: list[Instruction] = field(default_factory=list)
    stack: list[tuple[Node, int]] = field(default_factory=list)
    saved: dict[Node, int] = field(default_factory=dict)


def emit(result: Node, plan: Plan, limit: int) -> Block | None:
    """Instructions that compute a graph and write it to outputs 0..; None where more than limit
    values would have to be computed or fetched."""
    emitter = _Emitter(plan, limit)
    path = _Path()
    try:
        emitter.value(result, path)
    except _TooLongError:
        return None
    path.code.append(Op("out", 0, result.width))
    return emitter.without_unread(tuple(path.code))


class _Emitter:
    def __init__(self, plan: Plan, limit: int) -> None:
        self.plan = plan
        self.left = limit
        self.temporaries: dict[Node, int] = {}
        self.free = 0
        self.reads: Counter[int] = Counter()

    def value(self, node: Node, path: _Path) -> None:
        """Leave a node's values on top of the stack."""
        self.left -= 1
        if self.left < 0:
            raise _TooLongError
        if node.operator == "part":
            self.part(node, path)
            return
        if node.cheap or not (self.copied(node, path) or self.fetched(node, path)):
            self.computed(node, path)
        path.stack += [(node, i) for i in range(node.width)]

    def part(self, node: Node, path: _Path) -> None:
        """One value of a group: copied from the stack, or fetched after the group is put away."""
        (group,), index = node.arguments, node.start
        if (group, index) in path.stack:
            position = path.stack[::-1].index((group, index)) + 1
            path.code.append(Op("posd", position, 1) if position > 1 else Op("copy", 1, 1))
        else:
            if group not in path.saved:
                self.value(group, path)
                del path.stack[len(path.stack) - group.width :]
                saving = path.code.pop()
                assert isinstance(saving, Op), saving
                path.code.append(Op("tput", saving.first, saving.second))
            self.reads[path.saved[group]] += 1
            push_span(path.code, "tget", path.saved[group] + index, 1)
        path.stack.append((group, index))

    def arguments(self, nodes: list[Node], path: _Path) -> None:
        """Leave several nodes' values on the stack; all parts of a group in order are the group."""
        at = 0
        while at < len(nodes):
            group = nodes[at].arguments[0] if nodes[at].operator == "part" else None
            run = nodes[at : at + group.width] if group else []
            if (
                group
                and all(
                    n.operator == "part" and n.arguments[0] is group and n.start == i
                    for i, n in enumerate(run)
                )
                and len(run) == group.width
            ):
                self.value(group, path)
                at += group.width
            else:
                self.value(nodes[at], path)
                at += 1

    def copied(self, node: Node, path: _Path) -> bool:
        """Copy the values where they still stand on the stack."""
        slots = [(node, i) for i in range(node.width)]
        depth = len(path.stack)
        if path.stack[depth - node.width :] == slots:
            path.code.append(Op("copy", node.width, 1))
            return True
        if node.width == 1 and slots[0] in path.stack:
            position = path.stack[::-1].index(slots[0]) + 1
            path.code.append(Op("posd", position, 1))
            return True
        return False

    def fetched(self, node: Node, path: _Path) -> bool:
        """Fetch the values from the temporaries that hold them."""
        if node not in path.saved:
            return False
        start = path.saved[node]
        self.reads[start] += 1
        push_span(path.code, "tget", start, node.width)
        return True

    def computed(self, node: Node, path: _Path) -> None:
        depth = len(path.stack)
        if node.operator == "where":
            self.choice(node, path)
        elif node.operator == "vector" and len(set(node.arguments)) == 1 and not node.cheap:
            self.repeated(node, path)
        else:
            arguments = list(node.arguments)
            if node in self.plan.swapped:
                arguments[:2] = arguments[1::-1]
            self.arguments(arguments, path)
            self.operator(node, path)
        del path.stack[depth:]
        if node in self.plan.kept:
            if node not in self.temporaries:
                self.temporaries[node] = self.free
                self.free += node.width
            start = self.temporaries[node]
            path.code.append(Op("tsav", start, node.width))
            path.saved[node] = start

    def operator(self, node: Node, path: _Path) -> None:
        code = path.code
        if node.operator == "data":
            code.append(Op("data", value=node.value))
        elif node.operator == "in":
            push_span(code, "in", node.start, node.width)
        elif node.operator == "env":
            code.append(Op("env", signature=node.signature))
            if node.value == 0:  # an undefined variable is 0 already; drop the flag
                code.append(Op("pop", 1))
            else:
                code.append(If((), (Op("pop", 1), Op("data", value=node.value))))
        elif node.operator != "vector":
            two = OPERATORS[node.operator].operand in (Operand.COPIES, Operand.SPAN)
            code.append(Op(node.operator, node.count, 1 if two else 0))

    def repeated(self, node: Node, path: _Path) -> None:
        """The same scalar in every component: pushed again if constant, else copied."""
        (scalar,) = set(node.arguments)
        self.value(scalar, path)
        times = node.width - 1
        if scalar.operator == "data":
            path.code += [Op("data", value=scalar.value)] * times
        else:
            path.code.append(Op("copy", 1, times))

    def choice(self, node: Node, path: _Path) -> None:
        """`condition if { value } else { otherwise }`; what a branch keeps stays in that branch,
        unless both keep it."""
        condition, value, otherwise = node.arguments
        for shared in self.plan.before[node]:
            if shared in self.plan.kept and shared not in path.saved:
                self.value(shared, path)
                path.code.append(Op("pop", shared.width))
                del path.stack[len(path.stack) - shared.width :]
        self.value(condition, path)
        path.stack.pop()
        branches = []
        for branch in (value, otherwise):
            inner = _Path([], list(path.stack), dict(path.saved))
            self.value(branch, inner)
            branches.append(inner)
        first, second = (tuple(branch.code) for branch in branches)
        path.code.append(If(first, second, node.share))
        path.saved = {k: v for k, v in branches[0].saved.items() if k in branches[1].saved}

    def without_unread(self, block: Block) -> Block:
        """The block without saves that nothing reads, temporaries numbered without gaps."""
        places: dict[int, int] = {}
        for node, start in self.temporaries.items():
            if self.reads[start]:
                for index in range(start, start + node.width):
                    places[index] = len(places)

        def clean(block: Block) -> Block:
            cleaned: list[Instruction] = []
            for instruction in block:
                if isinstance(instruction, If):
                    otherwise = instruction.otherwise
                    instruction = replace(
                        instruction,
                        then=clean(instruction.then),
                        otherwise=None if otherwise is None else clean(otherwise),
                    )
                elif isinstance(instruction, Op) and instruction.name in _TEMPORARY:
                    if instruction.first not in places:
                        continue
                    start = places[instruction.first]
                    instruction = Op(instruction.name, start, instruction.second)
                cleaned.append(instruction)
            return tuple(cleaned)

        return clean(block)


def push_span(code: list[Instruction], name: str, start: int, count: int) -> None:
    """Push channels or temporaries; one operator does what stands side by side."""
    last = code[-1] if code else None
    if isinstance(last, Op) and last.name == name and last.first + last.second == start:
        code[-1] = Op(name, last.first, last.second + count)
    else:
        code.append(Op(name, start, count))
