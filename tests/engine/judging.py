"""Random programs judged by the reference engine, each within a bound that is computed for it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from disputed import DISPUTED, counts
from engine_reference import encoded, judged
from followed import Bounds
from intervals import Floats, Interval, place

from brdfc.calc.program import Program
from brdfc.calc.text import disassemble
from brdfc.cmm.reference import ENCODING
from brdfc.engine.interpreter import run
from brdfc.source.errors import BrdfcError


@dataclass(frozen=True)
class Failure:
    """A program that is wrong somewhere, of what pixels and variables, and where."""

    program: Program
    pixels: Floats
    environment: Mapping[str, float]
    text: str


@dataclass
class Tally:
    """What became of programs, and of their values: agreed, by the floats between the ends of their
    interval (the bits of that number); left out, by what they rest on; and unbounded."""

    programs: int = 0
    values: int = 0
    agreed: Counter[int] = field(default_factory=Counter)
    disputed: Counter[str] = field(default_factory=Counter)
    left_out: int = 0
    unbounded: int = 0
    failures: list[Failure] = field(default_factory=list)

    def report(self) -> str:
        def share(count: int) -> str:
            return f"{count:,} ({count / max(1, self.values):.2%})"

        exact, close = self.agreed[0], sum(n for bits, n in self.agreed.items() if 0 < bits <= 4)
        lines = [
            f"{self.programs:,} programs, {self.values:,} values; {len(self.failures)} are wrong",
            f"agree: {share(self.agreed.total())}",
            f"  of intervals of one float, or NaN: {share(exact)}",
            f"  of up to 16 floats: {share(close)}",
            f"  of more, at most 2^{max(self.agreed, default=0)}: "
            f"{share(self.agreed.total() - exact - close)}",
            f"unbounded: {share(self.unbounded)}",
            f"left out: {share(self.left_out)}; of them for",
        ]
        lines += [f"  {name}: {self.disputed[name]:,} ({why})" for name, why in DISPUTED.items()]
        return "\n".join([*lines, *(failure.text for failure in self.failures)])


def judge(
    folder: Path,
    programs: Sequence[Program],
    pixels: Floats,
    environment: Mapping[str, float],
    tally: Tally,
) -> None:
    """Our results and the reference's against the bounds, into a tally. pixels: (n, channels)."""
    try:
        theirs = judged(folder, programs, pixels, (environment,))[0]
    except BrdfcError as error:  # the reference refuses one of them, or crashes on it
        if len(programs) == 1:
            text = f"the reference fails: {error}\n{shown(programs[0])}"
            tally.failures.append(Failure(programs[0], pixels, environment, text))
            return
        half = len(programs) // 2
        for part in (programs[:half], programs[half:]):
            judge(folder, part, pixels, environment, tally)
        return
    for program, found in zip(programs, theirs, strict=True):
        tally.programs += 1
        wrong = _compared(program, pixels, environment, found, tally)
        if wrong:
            text = f"{wrong[0]}\n{shown(program)}"
            tally.failures.append(Failure(program, pixels, environment, text))


def _compared(
    program: Program,
    pixels: Floats,
    environment: Mapping[str, float],
    theirs: Floats,
    tally: Tally,
) -> list[str]:
    """One program's values into a tally; a line for each output that is wrong."""
    ours, wrong = run(program, pixels, environment), []
    for channel, interval in enumerate(Bounds.run(program, pixels, environment)):
        good = interval.contains(ours[:, channel])
        good &= in_encoding(interval).contains(theirs[:, channel])
        for pixel in np.flatnonzero(_counted(tally, interval, good))[:1]:
            ends = (np.broadcast_to(v, good.shape)[pixel] for v in (interval.low, interval.high))
            numbers = [ours[pixel, channel], theirs[pixel, channel] * ENCODING, *ends]
            values = "{:.9g}, the reference {:.9g}, between {:.9g} and {:.9g}".format(*numbers)
            wrong.append(f"output {channel} of {pixels[pixel].tolist()}: {values}")
    return wrong


def in_encoding(interval: Interval) -> Interval:
    """As values leave the reference."""
    return Interval(encoded(interval.low), encoded(interval.high), interval.nan)


def _counted(tally: Tally, interval: Interval, good: np.ndarray) -> np.ndarray:
    """Which values are wrong."""
    rests = np.broadcast_to(interval.disputed, good.shape)
    free = rests == 0
    unbounded = free & np.isneginf(interval.low) & np.isposinf(interval.high)
    tally.values += len(good)
    tally.left_out += int((~free).sum())
    tally.disputed.update(counts(rests))
    tally.unbounded += int(unbounded.sum())
    floats = np.maximum(place(interval.high) - place(interval.low), 0)
    bits = np.where(floats > 0, np.ceil(np.log2(np.maximum(floats, 1) + 1)), 0).astype(int)
    tally.agreed.update(np.broadcast_to(bits, good.shape)[free & ~unbounded & good].tolist())
    return free & ~good


def shown(program: Program) -> str:
    """A program and the sub-elements that it may call."""
    elements = [f"element {i}: {element}" for i, element in enumerate(program.elements)]
    return "\n".join([disassemble(program.body).rstrip(), *elements])
