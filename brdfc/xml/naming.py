"""Names for what a program has by number: channels from the profile, temporaries by use."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

from brdfc.calc.disassembly import Naming
from brdfc.calc.program import MAX_TEMPORARIES, Block, Op, walk

Slice = tuple[int, int]
"""The first and how many."""
_TEMPORARY = ("tget", "tput", "tsav")


@dataclass(frozen=True)
class Names:
    """Names of channels in and out, as slices; empty where there are none."""

    inputs: dict[str, Slice]
    outputs: dict[str, Slice]

    def within(self, inputs: int, outputs: int) -> Names:
        """Those of a side that has channels for them all: a damaged profile's may have fewer."""
        return Names(
            self.inputs if _end(self.inputs) <= inputs else {},
            self.outputs if _end(self.outputs) <= outputs else {},
        )


def _end(slices: dict[str, Slice]) -> int:
    return max((first + size for first, size in slices.values()), default=0)


NO_NAMES = Names({}, {})


def group(channels: Sequence[str]) -> dict[str, Slice]:
    """Channel names as identifiers, each a slice; Rdx, Rdy, Rdz are one, Rd[3]. Empty where names
    would be alike."""
    words = [re.sub(r"\W", "_", name, flags=re.ASCII) for name in channels]
    words = [f"_{word}" if not word or word[0].isdigit() else word for word in words]
    slices: dict[str, Slice] = {}
    index = 0
    while index < len(words):
        word = words[index]
        three = words[index : index + 3] == [word[:-1] + letter for letter in "xyz"]
        size, name = (3, word[:-1]) if three and len(word) > 1 else (1, word)
        if name in slices:
            return {}
        slices[name] = index, size
        index += size
    return slices


def declared(slices: dict[str, Slice]) -> str:
    """As InputNames has them: "Rd[3] ks m"."""
    return " ".join(f"{name}[{size}]" if size > 1 else name for name, (_, size) in slices.items())


def variables(body: Block) -> dict[str, Slice]:
    """The temporaries of a main function as variables: those that are used together are one. What
    reaches beyond the last temporary, in a program that cannot be run, stays a number."""
    spans = {
        (op.first, op.first + op.second)
        for op in walk(body)
        if isinstance(op, Op) and op.name in _TEMPORARY and op.first + op.second <= MAX_TEMPORARIES
    }
    merged: list[list[int]] = []
    for start, end in sorted(spans):
        if merged and start < merged[-1][1]:
            merged[-1][1] = max(end, merged[-1][1])
        else:
            merged.append([start, end])
    return {f"t{start}": (start, end - start) for start, end in merged}


def naming(names: Names, temporaries: dict[str, Slice]) -> Naming:
    """How operations are written by these names; what lies across several stays a number."""
    tables = {"in": _Table(names.inputs), "out": _Table(names.outputs)}
    tables |= dict.fromkeys(_TEMPORARY, _Table(temporaries))

    def text(op: Op) -> str | None:
        found = tables[op.name].find(op.first, op.second) if op.name in tables else None
        if found is None:
            return None
        name, offset, whole = found
        if whole:
            return f"{op.name}{{{name}}}"
        if op.name in _TEMPORARY:
            count = f",{op.second}" if op.second > 1 else ""
            return f"{op.name}{{{name}[{offset}{count}]}}"
        if op.name == "out":
            return None  # 2.2.61 holds the range of outputs against the count of inputs
        count = f",{op.second}" if op.second > 1 else ""
        return f"in{{{name}[{offset}]{count}}}"

    return text


class _Table:
    """Slices by where they begin."""

    def __init__(self, slices: dict[str, Slice]) -> None:
        self.rows = sorted((first, size, name) for name, (first, size) in slices.items())
        self.firsts = [first for first, _, _ in self.rows]

    def find(self, first: int, count: int) -> tuple[str, int, bool] | None:
        """The name of the slice that these lie in, how far into it, and whether they are all."""
        at = bisect_right(self.firsts, first) - 1
        if at < 0:
            return None
        start, size, name = self.rows[at]
        if first + count > start + size:
            return None
        return name, first - start, (first, count) == (start, size)
