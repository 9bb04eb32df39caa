"""Random calculator programs that verify: every operator, nested branches, sub-elements."""

from __future__ import annotations

from random import Random

import numpy as np

from brdfc.calc.program import Block, If, Instruction, Matrix, Op, Program, Select
from brdfc.engine.kernels import BINARY, FOLDED, GROUPED, SCALED, UNARY

CHANNELS, OUTPUTS, VARIABLES = 4, 3, ("inci", "refl")
SPECIAL = [
    *(0.0, -0.0, 1.0, -1.0, 0.5, -0.5, 2.0, 3.0, 1e-40, -1e-40, 3e38, -3e38),
    *(np.inf, -np.inf, np.nan, 2.0**31, 0.49999997, 2.0**20, 1e7, -1e30),
]
_INNER = Program(2, 1, (Op("in", 0, 2), Op("atn2", 1), Op("out", 0, 1)))
_MATRIX = Matrix(3, 3, (0.5, 0.25, -1, 2, 1, 0.125, 0, -0.75, 1.5), (0.0, 0.5, -0.25))


def special_pixels(random: np.random.Generator, count: int, channels: int) -> np.ndarray:
    """Mostly usual values, some special ones."""
    usual = random.uniform(-2, 2, (count, channels))
    special = random.choice(SPECIAL, (count, channels))
    return np.where(random.random(usual.shape) < 0.12, special, usual).astype(np.float32)


def random_program(seed: int, length: int = 25) -> Program:
    random = Random(seed)
    body = _Writer(random)
    body.values(3)
    for _ in range(random.randrange(4, length)):
        body.step(2)
    while body.depth < OUTPUTS:
        body.values(1)
    body.write(Op("out", 0, OUTPUTS))
    return Program(CHANNELS, OUTPUTS, tuple(body.block), (_MATRIX, _INNER))


class _Writer:
    """A block under construction, and how deep the stack is."""

    def __init__(self, random: Random, depth: int = 0, stored: int = 0) -> None:
        self.random, self.depth, self.stored = random, depth, stored
        self.block: list[Instruction] = []

    def write(self, step: Instruction, change: int = 0) -> None:
        self.block.append(step)
        self.depth += change

    def values(self, count: int) -> None:
        for _ in range(count):
            kind = self.random.random()
            if kind < 0.6:
                self.write(Op("in", self.random.randrange(CHANNELS), 1), 1)
            elif kind < 0.75:
                value = self.random.choice([*SPECIAL, self.random.uniform(-3, 3)])
                self.write(Op("data", value=float(np.float32(value))), 1)
            elif kind < 0.8:
                self.write(Op(self.random.choice(["pi", "+INF", "-INF", "NaN"])), 1)
            elif kind < 0.85 and self.stored:
                self.write(Op("tget", self.random.randrange(self.stored), 1), 1)
            else:
                name = self.random.choice([*VARIABLES, "none", "true", "ndef"])
                self.write(Op("env", signature=name), 2)

    def step(self, levels: int) -> None:
        """One more operation, of those that there is enough on the stack for."""
        random, depth = self.random, self.depth
        kind = random.random()
        if depth < 2 or (kind < 0.15 and depth < 30):
            self.values(random.randrange(1, 4))
        elif kind < 0.35:
            n = random.randrange(1, min(3, depth) + 1)
            self.write(Op(random.choice(list(UNARY)), n))
        elif kind < 0.6:
            n = random.randrange(1, min(3, depth // 2) + 1)
            self.write(Op(random.choice(list(BINARY)), n), -n)
        elif kind < 0.65:
            n = random.randrange(1, min(3, depth - 1) + 1)
            self.write(Op(random.choice(list(SCALED)), n), -1)
        elif kind < 0.7:
            n = random.randrange(2, min(5, depth) + 1)
            self.write(Op(random.choice(list(FOLDED)), n), 1 - n)
        elif kind < 0.75:
            name = random.choice([g for g, (blocks, _) in GROUPED.items() if blocks <= depth])
            self.write(Op(name, 1))
        elif kind < 0.85:
            self.rearranged()
        elif kind < 0.89:
            self.called()
        elif levels:
            self.branched(levels - 1)

    def rearranged(self) -> None:
        random, depth = self.random, self.depth
        name = random.choice(
            ["copy", "rotl", "rotr", "posd", "flip", "pop", "tsav", "tput", "scnt"]
        )
        n = random.randrange(2, min(5, depth) + 1)
        if name in ("copy", "posd"):
            times = random.randrange(1, 3)
            self.write(Op(name, n, times), times * (n if name == "copy" else 1))
        elif name in ("rotl", "rotr"):
            self.write(Op(name, n, random.randrange(1, n)))
        elif name == "flip":
            self.write(Op(name, n))
        elif name == "pop":
            self.write(Op(name, 1), -1)
        elif name == "scnt":
            self.write(Op(name), 1)
        else:
            self.write(Op(name, 0, 2), -2 if name == "tput" else 0)
            self.stored = max(self.stored, 2)

    def called(self) -> None:
        if self.depth >= 12 and self.random.random() < 0.5:
            self.write(Op("solv", 3, 3), 4 - 12)
        elif self.depth >= 3 and self.random.random() < 0.5:
            self.write(Op("mtx", 0))
        else:
            self.write(Op("calc", 1), -1)

    def branched(self, levels: int) -> None:
        """Bodies that each leave one value more than they find below the condition."""
        self.depth -= 1

        def body() -> Block:
            inner = _Writer(self.random, self.depth, self.stored)
            for _ in range(self.random.randrange(1, 5)):
                inner.step(levels)
            inner.values(1)
            while inner.depth < self.depth + 1:
                inner.values(1)
            if inner.depth > self.depth + 1:
                inner.write(Op("pop", inner.depth - self.depth - 1))
            return tuple(inner.block)

        if self.random.random() < 0.6:
            self.write(If(body(), body()), 1)
        else:
            cases = tuple(body() for _ in range(self.random.randrange(1, 4)))
            self.write(Select(cases, body()), 1)
