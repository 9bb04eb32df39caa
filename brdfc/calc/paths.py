"""The stack and the temporaries of a program whose values are intervals, through its branches.

Branches run one after the other on the same state; each is undone when it ends, and what they
leave is joined. So a branch costs what it changes, however much there is on the stack. Beneath what
is known, the stack is endless and unknown.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from brdfc.calc.bounds import UNKNOWN, either
from brdfc.symbolic.intervals import Interval, meet


@dataclass(slots=True, eq=False)
class Value:
    """A value that a program computes: where it lies, and the operation and operands it is from, as
    far as conditions are looked through (conditions.py)."""

    bounds: Interval
    name: str = ""
    operands: Sequence[Value] = ()


NOTHING_KNOWN = Value(UNKNOWN)
"""Any value of which nothing is known."""


@dataclass
class Effort:
    """How many values may still be looked at; then nothing more is known. each: what one counts."""

    left: int
    each: int = 1

    def spend(self, values: int) -> None:
        self.left -= values * self.each


@dataclass(slots=True)
class _Branch:
    """What has changed since a branch began. mark: the least depth of the stack since then; taken:
    the values that stood above it, topmost first; stored: temporaries, and narrowed: bounds, as
    they were before."""

    mark: int
    taken: list[Value] = field(default_factory=list)
    stored: dict[int, Value] = field(default_factory=dict)
    narrowed: list[tuple[Value, Interval]] = field(default_factory=list)


@dataclass(slots=True)
class Left:
    """What a branch leaves: the stack above a depth, and temporaries. bounds: of values whose
    bounds are narrower in the branch than outside."""

    mark: int
    pushed: list[Value]
    stored: dict[int, Value]
    bounds: dict[Value, Interval]

    def of(self, value: Value) -> Interval:
        return self.bounds.get(value, value.bounds)


class State:
    """Stack, top last, and temporaries. When the effort is spent all is unknown, and operations
    take no time to speak of."""

    def __init__(self, effort: Effort) -> None:
        self.stack: list[Value] = []
        self.temporaries: dict[int, Value] = {}
        self._branches: list[_Branch] = []
        self._effort = effort

    @property
    def forgotten(self) -> bool:
        return self._effort.left <= 0

    def pop(self, count: int) -> list[Value]:
        """The top of the stack, deepest first."""
        if self.forgotten:
            return [NOTHING_KNOWN] * count
        depth = max(0, len(self.stack) - count)
        known = self.stack[depth:]
        del self.stack[depth:]
        if self._branches and depth < (branch := self._branches[-1]).mark:
            branch.taken += reversed(known[: branch.mark - depth])
            branch.mark = depth
        return [NOTHING_KNOWN] * (count - len(known)) + known

    def push(self, values: Sequence[Value]) -> None:
        if not self.forgotten:
            self.stack += values

    def put(self, first: int, values: Sequence[Value]) -> None:
        """Store values in temporaries from the first on."""
        if self.forgotten:
            return
        for index, value in enumerate(values, first):
            if self._branches:
                stored = self._branches[-1].stored
                stored.setdefault(index, self.temporaries.get(index, NOTHING_KNOWN))
            self.temporaries[index] = value

    def get(self, first: int, count: int) -> list[Value]:
        if self.forgotten:
            return [NOTHING_KNOWN] * count
        return [self.temporaries.get(i, NOTHING_KNOWN) for i in range(first, first + count)]

    def narrow(self, value: Value, bounds: Interval, number: bool = False) -> None:
        """What a condition says of a value, for the rest of the branch. number: it is not NaN."""
        if value is NOTHING_KNOWN:
            return
        known = value.bounds
        narrower = meet(known, bounds)
        if number and narrower.undefined:
            narrower = Interval(narrower.low, narrower.high, False, narrower.gap)
        if narrower != known:
            self._branches[-1].narrowed.append((value, known))
            value.bounds = narrower

    def enter(self) -> None:
        """A branch begins."""
        self._branches.append(_Branch(len(self.stack)))

    def leave(self) -> Left:
        """A branch ends: all is as before it."""
        branch = self._branches.pop()
        left = Left(
            branch.mark,
            self.stack[branch.mark :],
            {i: self.temporaries[i] for i in branch.stored},
            {value: value.bounds for value, _ in branch.narrowed},
        )
        self.stack[branch.mark :] = reversed(branch.taken)
        self.temporaries.update(branch.stored)
        for value, bounds in reversed(branch.narrowed):
            value.bounds = bounds
        return left

    def join(self, paths: Sequence[Left]) -> None:
        """What holds after branches of which one was taken; stacks are aligned at their tops."""
        mark = min(path.mark for path in paths)
        self._effort.spend(sum(path.mark - mark + len(path.pushed) for path in paths))
        if self.forgotten:
            return
        under = self.pop(len(self.stack) - mark)
        stacks = [under[: path.mark - mark] + path.pushed for path in paths]
        depth = min(map(len, stacks))
        if any(len(stack) > depth for stack in stacks):  # what lies beneath is not one value
            self._effort.spend(mark)
            self.pop(mark)
        tops = [stack[len(stack) - depth :] for stack in stacks]
        self.push([_joined(values, paths) for values in zip(*tops, strict=True)])
        for index in dict.fromkeys(i for path in paths for i in path.stored):
            self._effort.spend(len(paths))
            if self.forgotten:
                return
            old = self.temporaries.get(index, NOTHING_KNOWN)
            values = [path.stored.get(index, old) for path in paths]
            self.put(index, [_joined(values, paths)])


def _joined(values: Sequence[Value], paths: Sequence[Left]) -> Value:
    """One value on all paths stays what it is."""
    first = values[0]
    if all(value is first for value in values):
        return first
    if any(value is NOTHING_KNOWN for value in values):
        return NOTHING_KNOWN
    bounds = [path.of(value) for value, path in zip(values, paths, strict=True)]
    return Value(either(*bounds), "either")
