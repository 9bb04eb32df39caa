"""Runs of straight chains over the same pixels, carried out by NumPy or by machine code.

Each works on a range of pixels, so that threads can share them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.engine.interpreter import HELD
from brdfc.engine.kernels import Values
from brdfc.engine.layout import Samples
from brdfc.engine.native import Code
from brdfc.engine.steps import Machine
from brdfc.engine.straight import Straight

BLOCK, SHARED_BLOCK = 1 << 15, 1 << 16
"""Pixels that NumPy is given at a time: their registers fit the cache. Larger where threads take
turns, which costs them some microseconds each time."""
PIECE = 1 << 14
"""Pixels that machine code is given at a time where there are several runs, or samples to move."""


@dataclass(frozen=True, eq=False)
class Job:
    """A straight chain, its variables that differ between pixels, and where its results go."""

    form: Straight
    variables: Sequence[Values]
    results: Samples


def in_blocks(jobs: Sequence[Job], pixels: Samples, start: int, stop: int) -> None:
    """By NumPy, in blocks that fit the cache."""
    size = BLOCK if stop - start == len(pixels.values) else SHARED_BLOCK
    registers = max(job.form.registers for job in jobs)
    step = max(1, min(size, HELD // max(1, registers), stop - start))
    machine = Machine(registers, step)
    with np.errstate(all="ignore"):
        for first in range(start, stop, step):
            last = min(first + step, stop)
            block = pixels.values[first:last]
            channels = [block[:, channel] for channel in range(block.shape[1])]
            for job in jobs:
                variables = [values[first:last] for values in job.variables]
                found = machine.run(job.form, [*channels, *variables], last - first)
                for channel, values in enumerate(found):
                    job.results.values[first:last, channel] = values


@dataclass(frozen=True, eq=False)
class Compiled:
    """Machine code of a job, and its constants."""

    code: Code
    constants: NDArray[np.float32]


def by_code(
    jobs: Sequence[Job], codes: Sequence[Compiled], pixels: Samples, start: int, stop: int
) -> None:
    """By machine code: where the samples lie if it can read and write them there, else a piece
    after the other in memory of its own. The last few pixels always are such a piece."""
    width = codes[0].code.width
    direct = pixels.direct and all(job.results.direct for job in jobs)
    step = PIECE if len(jobs) > 1 or not direct else max(PIECE, (stop - start) // width * width)
    for first in range(start, stop, step):
        last = min(first + step, stop)
        whole = first + (last - first) // width * width
        if direct and whole > first:
            _piece(jobs, codes, pixels, first, whole)
            first = whole
        if first < last:
            _moved(jobs, codes, pixels, first, last, width)


def _piece(
    jobs: Sequence[Job], codes: Sequence[Compiled], pixels: Samples, first: int, last: int
) -> None:
    inputs = pixels.part(first, last).addresses()
    for job, compiled in zip(jobs, codes, strict=True):
        variables = [values[first:last].ctypes.data for values in job.variables]
        outputs = job.results.part(first, last).addresses()
        compiled.code([*inputs, *variables], outputs, compiled.constants, last - first)


def _moved(
    jobs: Sequence[Job],
    codes: Sequence[Compiled],
    pixels: Samples,
    first: int,
    last: int,
    width: int,
) -> None:
    """Pixels that are few, or lie otherwise, moved to memory that the code can use, and back."""
    count = last - first
    room = count + -count % width
    inside = pixels.room(room)
    inside.values[:count] = pixels.values[first:last]
    moved = []
    for job in jobs:
        variables = [np.zeros(room, np.float32) for _ in job.variables]
        for values, given in zip(variables, job.variables, strict=True):
            values[:count] = given[first:last]
        moved.append(Job(job.form, variables, job.results.room(room)))
    _piece(moved, codes, inside, 0, room)
    for job, done in zip(jobs, moved, strict=True):
        job.results.values[first:last] = done.results.values[:count]
