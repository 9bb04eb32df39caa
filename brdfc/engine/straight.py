"""Chains without jumps: what a run leaves to do for each pixel, as operations on registers.

Registers are planar blocks of pixels that stay in the processor's cache, used again as soon as
nothing reads them any more.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from brdfc.engine.kernels import Values
from brdfc.engine.trace import Chain, Source, Trace, Value


@dataclass(frozen=True)
class Step:
    """An operation on registers: constants stand as they are."""

    name: str
    arguments: tuple[int | np.float32, ...]
    target: int


@dataclass(frozen=True)
class Straight:
    """steps: on registers, of which the first ones are the channels, then the variables that differ
    between pixels, by name. outputs: registers, or constants. registers: how many there are. read:
    the first registers that anything reads."""

    steps: tuple[Step, ...]
    channels: int
    variables: tuple[str, ...]
    outputs: tuple[int | np.float32, ...]
    registers: int
    read: tuple[int, ...]


def straighten(chain: Chain, channels: int, environment: Mapping[str, Values]) -> Straight:
    """The straight form of a chain of verified elements in a run; trace.Crooked where it has none.

    environment: variables by signature, one value, or an array of one for each pixel.
    """
    trace = Trace(channels, environment)
    return _allocated(trace, trace.follow(chain))


def _allocated(trace: Trace, outputs: Sequence[Value]) -> Straight:
    """Registers for what is needed, each free again after its last use."""
    needed: set[Source] = {o for o in outputs if isinstance(o, Source)}
    for source in reversed(trace.made):
        if source in needed:
            needed |= {a for a in source.arguments if isinstance(a, Source)}
    made = [s for s in trace.made if s in needed]
    last: dict[Source, int] = {}
    for i, source in enumerate(made):
        for argument in source.arguments:
            if isinstance(argument, Source):
                last[argument] = i
    last |= {o: len(made) for o in outputs if isinstance(o, Source)}
    inputs = [*trace.inputs, *trace.differing.values()]
    place = {source: source.place for source in inputs}
    count, free = len(inputs), [s.place for s in inputs if s not in last]
    steps = []
    for i, source in enumerate(made):
        arguments = [place[a] if isinstance(a, Source) else a for a in source.arguments]
        # A target of its own: kernels may read an argument after they have begun to write.
        if not free:
            free.append(count)
            count += 1
        place[source] = free.pop()
        steps.append(Step(source.name, tuple(arguments), place[source]))
        read = dict.fromkeys(a for a in source.arguments if isinstance(a, Source))
        free += [place[a] for a in read if last[a] == i]
    found = tuple(place[o] if isinstance(o, Source) else o for o in outputs)
    read_inputs = tuple(s.place for s in inputs if s in last)
    variables = tuple(trace.differing)
    return Straight(tuple(steps), trace.channels, variables, found, count, read_inputs)
