"""What holds of a program, or at a point of it; verify.py finds it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from operator import and_


@dataclass(frozen=True)
class Facts:
    """What verification found of an element.

    stack: the greatest depth; temporaries: how many are in use; variables: signatures read, those
    of called calculators included. held: values a pixel keeps at once (stack, temporaries,
    channels), and work: values popped and pushed on the dearest path, both with everything that is
    called. nesting: how deep blocks and calls stand in each other.
    """

    stack: int
    temporaries: int
    variables: tuple[str, ...]
    held: int
    work: int
    nesting: int


@dataclass
class State:
    """What holds on every path to a point: depth (least and greatest), work so far (greatest),
    and bit sets of the temporaries and outputs that have been written."""

    least: int = 0
    greatest: int = 0
    work: int = 0
    temporaries: int = 0
    outputs: int = 0


def joined(paths: list[State]) -> State:
    """What holds where paths meet."""
    return State(
        min(path.least for path in paths),
        max(path.greatest for path in paths),
        max(path.work for path in paths),
        reduce(and_, (path.temporaries for path in paths)),
        reduce(and_, (path.outputs for path in paths)),
    )
