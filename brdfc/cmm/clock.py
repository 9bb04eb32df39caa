"""Taking the time of programs on the reference engine."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.program import Block, Op, Program, Select
from brdfc.cmm import reference
from brdfc.cmm.probes import CHANNELS, ELEMENTS, EMPTY, VARIABLE, pixels
from brdfc.profiles.content import Content
from brdfc.profiles.multiplex import profile_pair

_Array = NDArray[np.float64]


class Clock(Protocol):
    """Something that takes the time of programs, in nanoseconds a pixel."""

    def together(self, blocks: Sequence[Block]) -> _Array:
        """Of many in turn, each longer by the same unknown time."""
        ...

    def alone(self, block: Block) -> float:
        """Of one as a profile of its own: all that a pixel takes."""
        ...


@dataclass(frozen=True)
class ReferenceClock:
    """The reference engine. Least times over rounds, in which programs take turns: what else the
    machine does then makes none of them dear."""

    rounds: int = 12
    repeat: int = 4
    pixels: int = 1000

    def together(self, blocks: Sequence[Block]) -> _Array:
        """All as cases of one program, picked by a variable."""
        select = Select((*blocks, EMPTY))
        body = (Op("env", signature="prog"), Op("pop", 1), select)
        numbers = [{"prog": float(k), VARIABLE: 0.4} for k in range(len(blocks))]
        times = self._times(Program(CHANNELS, 3, body, ELEMENTS), numbers * self.rounds)
        least: _Array = times.reshape(self.rounds, len(blocks)).min(axis=0)
        return least

    def alone(self, block: Block) -> float:
        program = Program(CHANNELS, 3, block, ELEMENTS)
        return float(self._times(program, [{VARIABLE: 0.4}] * self.rounds).min())

    def _times(self, program: Program, runs: Sequence[Mapping[str, float]]) -> _Array:
        names = [f"c{k}" for k in range(program.inputs)]
        pair = profile_pair(Content("Prices", program, tuple(names), (0.0,) * len(names)))
        values = pixels(self.pixels)
        with tempfile.TemporaryDirectory() as folder:
            mid, mvis = pair.save(Path(folder) / "prices_mvis.icc")
            seconds = reference.apply(mid, mvis, values, runs, self.repeat).seconds
        nanoseconds: _Array = seconds / self.pixels * 1e9
        return nanoseconds
