"""Random expressions over random domains, and float32 values of them, for tests of properties."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.program import Block, If, Instruction, Op, Program
from brdfc.codegen.emit import Plan, emit
from brdfc.codegen.nodes import Node, postorder
from brdfc.codegen.select import Binding, ChannelBinding, select
from brdfc.engine.interpreter import run
from brdfc.symbolic.expression import Expression, component, const, make, quantity, vector
from brdfc.symbolic.intervals import Interval, single

SCALARS = ("a", "b", "c")
A, B, C = (quantity(name, 1) for name in SCALARS)
V = quantity("v", 3)
BINDINGS: dict[str, Binding] = {
    **{name: ChannelBinding(i, 1) for i, name in enumerate(SCALARS)},
    "v": ChannelBinding(3, 3),
}
INPUTS = 6

ENDS = (-30.0, -2.0, -1.5708, -1.0, -0.3, 0.0, 1e-3, 0.3, 1.0, 1.5708, 2.0, 30.0)
CONSTANTS = [Fraction(n, d) for n, d in ((0, 1), (1, 1), (2, 1), (-1, 1), (1, 3), (7, 2), (-9, 10))]
EXPONENTS = [Fraction(n, d) for n, d in ((2, 1), (3, 1), (5, 1), (-1, 1), (-2, 1), (1, 2), (0, 1))]
UNARY = (
    *("neg", "sqrt", "cbrt", "exp", "ln", "log10", "sin", "cos", "tan", "asin", "acos", "atan"),
    *("abs", "sign", "floor", "ceil", "trunc", "round"),
)
BINARY = ("add", "sub", "mul", "mul", "div", "div", "min", "max", "atan2", "pow")
RELATIONS = ("lt", "le", "gt", "ge", "eq", "ne")


def random_domain(random: Random) -> dict[str, Interval]:
    domain = {}
    for name in (*SCALARS, "v"):
        low, high = sorted(random.sample(ENDS, 2))
        domain[name] = Interval(single(low), single(high))
    return domain


class Expressions:
    """A stream of random expressions that share parts."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.made: dict[int, list[Expression]] = {1: [A, B, C], 3: [V]}

    def value(self, width: int, levels: int) -> Expression:
        random = self.random
        if levels == 0 or random.random() < 0.15:
            return self.leaf(width)
        if random.random() < 0.2:
            return random.choice(self.made[width])
        made = self.wide(levels - 1) if width == 3 else self.scalar(levels - 1)
        self.made[width].append(made)
        return made

    def leaf(self, width: int) -> Expression:
        random = self.random
        if width == 3:
            return V
        choices = [A, B, C, component(V, 1), const(random.choice(CONSTANTS))]
        return random.choice(choices)

    def scalar(self, levels: int) -> Expression:
        random = self.random
        kind = random.random()
        if kind < 0.45:
            operator = random.choice(BINARY)
            left = self.value(1, levels)
            if operator == "pow" and random.random() < 0.8:
                return make("pow", left, const(random.choice(EXPONENTS)))
            # A negative base has a power only where the exponent is a whole constant.
            left = make("abs", left) if operator == "pow" else left
            return make(operator, left, self.value(1, levels))
        if kind < 0.8:
            return make(random.choice(UNARY), self.value(1, levels))
        if kind < 0.85:
            return component(self.value(3, levels), random.randrange(3))
        return self.choice(1, levels)

    def choice(self, width: int, levels: int) -> Expression:
        branches = (self.value(width, levels), self.value(width, levels))
        return make("where", self.condition(levels), *branches)

    def wide(self, levels: int) -> Expression:
        random = self.random
        kind = random.random()
        if kind < 0.5:
            widths = random.choice(((3, 3), (3, 1), (1, 3)))
            operator = random.choice(BINARY)
            if operator == "pow":
                widths = (3, 1)
            left, right = (self.value(w, levels) for w in widths)
            return make(operator, make("abs", left) if operator == "pow" else left, right)
        if kind < 0.7:
            return make(random.choice(UNARY), self.value(3, levels))
        if kind < 0.85:
            return vector([self.value(1, levels) for _ in range(3)])
        return self.choice(3, levels)

    def condition(self, levels: int) -> Expression:
        random = self.random
        kind = random.random()
        if levels > 0 and kind < 0.25:
            parts = (self.condition(levels - 1), self.condition(levels - 1))
            return make(random.choice(("and", "or")), *parts)
        if levels > 0 and kind < 0.35:
            return make("not", self.condition(levels - 1))
        other = const(random.choice(CONSTANTS)) if kind < 0.8 else self.value(1, levels)
        return make(random.choice(RELATIONS), self.value(1, levels), other)


def random_expression(random: Random, levels: int = 4) -> Expression:
    return Expressions(random).value(random.choice((1, 3)), levels)


def points(random: Random, domain: dict[str, Interval], count: int) -> NDArray[np.float32]:
    """Pixels of the domain: its ends, their neighbours, 0 where it is inside, and others."""
    columns = []
    for name in (*SCALARS, "v", "v", "v"):
        i = domain[name]
        ends = np.array([i.low, i.high], dtype=np.float32)
        special = [*ends, *np.nextafter(ends, ends[::-1]), np.clip(np.float32(0), *ends)]
        special += [np.clip(np.float32(1), *ends), np.clip(np.float32(-1), *ends)]
        column = [
            random.choice(special) if random.random() < 0.4 else random.uniform(i.low, i.high)
            for _ in range(count)
        ]
        columns.append(np.clip(np.array(column, dtype=np.float32), *ends))
    return np.stack(columns, axis=-1)


def values_at(pixel: NDArray[np.float32]) -> dict[str, tuple[float, ...]]:
    a, b, c, *v = (float(x) for x in pixel)
    return {"a": (a,), "b": (b,), "c": (c,), "v": tuple(v)}


def naive_block(node: Node) -> Block:
    """Instructions for a graph as if it were a tree: no temporaries, nothing shared."""
    plan = Plan(frozenset(), frozenset(), dict.fromkeys(postorder(node), ()))

    def code(n: Node) -> list[Instruction]:
        if n.operator == "where":
            condition, value, otherwise = n.arguments
            return [*code(condition), If(tuple(code(value)), tuple(code(otherwise)))]
        out: list[Instruction] = [i for a in n.arguments for i in code(a)]
        if n.operator == "vector":
            return out
        if n.operator in ("data", "in", "env"):
            block = emit(n, plan, 10)
            assert block is not None
            return [*out, *block[:-1]]
        return [*out, Op(n.operator, n.count)]

    return (*code(node), Op("out", 0, node.width))


def tree_size(node: Node) -> int:
    sizes: dict[Node, int] = {}
    for n in postorder(node):
        sizes[n] = 1 + sum(sizes[a] for a in n.arguments)
    return sizes[node]


def naive_program(e: Expression) -> Program:
    node = select(e, BINDINGS)
    return Program(INPUTS, e.width, naive_block(node))


def naive_values(e: Expression, pixels: NDArray[np.float32]) -> NDArray[np.float32]:
    return run(naive_program(e), pixels, {})
