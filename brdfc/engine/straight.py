"""Chains without jumps: what a run leaves to do for each pixel, as operations on registers.

Registers are planar blocks of pixels that stay in the processor's cache, used again as soon as
nothing reads them any more.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from brdfc.engine.kernels import Values
from brdfc.engine.tables import Interpolation
from brdfc.engine.trace import Chain, Trace
from brdfc.engine.written import Function, Source, Value


@dataclass(frozen=True)
class Step:
    """An operation on registers: constants stand as they are. function: of an element, which alone
    has several targets."""

    name: str
    arguments: tuple[int | np.float32, ...]
    targets: tuple[int, ...]
    function: Function | None = None


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


def straighten(
    chain: Chain,
    channels: int,
    environment: Mapping[str, Values],
    interpolation: Interpolation = Interpolation.LINEAR,
) -> Straight:
    """The straight form of a chain of verified elements in a run; trace.Crooked where it has none.

    environment: variables by signature, one value, or an array of one for each pixel.
    interpolation: of tables of three inputs.
    """
    trace = Trace(channels, environment, interpolation)
    return _allocated(trace, trace.follow(chain))


def _allocated(trace: Trace, outputs: Sequence[Value]) -> Straight:
    """Registers for what is needed, each free again after its last use."""
    needed: set[Source] = {o for o in outputs if isinstance(o, Source)}
    for operation in reversed(trace.made):
        if not needed.isdisjoint(operation.results):
            needed |= {a for a in operation.arguments if isinstance(a, Source)}
    made = [o for o in trace.made if not needed.isdisjoint(o.results)]
    last: dict[Source, int] = {}
    for i, operation in enumerate(made):
        # A result that nothing reads has its register as long as the operation takes.
        last |= {s: i for s in (*operation.results, *operation.arguments) if isinstance(s, Source)}
    last |= {o: len(made) for o in outputs if isinstance(o, Source)}
    inputs = [*trace.inputs, *trace.differing.values()]
    place = {source: source.place for source in inputs}
    count, free = len(inputs), [s.place for s in inputs if s not in last]
    steps = []
    for i, operation in enumerate(made):
        arguments = [place[a] if isinstance(a, Source) else a for a in operation.arguments]
        # Targets of its own: kernels may read an argument after they have begun to write.
        for result in operation.results:
            if not free:
                free.append(count)
                count += 1
            place[result] = free.pop()
        targets = tuple(place[result] for result in operation.results)
        steps.append(Step(operation.name, tuple(arguments), targets, operation.function))
        both = (*operation.arguments, *operation.results)
        read = dict.fromkeys(s for s in both if isinstance(s, Source))
        free += [place[s] for s in read if last[s] == i]
    found = tuple(place[o] if isinstance(o, Source) else o for o in outputs)
    read_inputs = tuple(s.place for s in inputs if s in last)
    variables = tuple(trace.differing)
    return Straight(tuple(steps), trace.channels, variables, found, count, read_inputs)
