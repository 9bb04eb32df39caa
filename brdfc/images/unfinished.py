"""Results that outlive an interruption: an unfinished file, and a journal of how far it is."""

from __future__ import annotations

import fcntl
import json
import os
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from copy import deepcopy
from dataclasses import asdict, dataclass, field
from pathlib import Path

from brdfc.files import place_of, read_file, write_whole
from brdfc.images.counts import Counts
from brdfc.source.errors import BrdfcError, ImageError

_EVERY = 5.0
"""Seconds between two entries: what is lost at most where a machine stops."""
_LIMIT = 1 << 20
"""Bytes of a journal; larger ones are not read."""


@dataclass
class Unfinished:
    """A file that is being filled, from the top down. rows: done, -1 where it is not laid out yet;
    counts: of those. Without a journal nothing is kept."""

    path: Path
    journal: Path | None = None
    run: Mapping[str, str] = field(default_factory=dict)
    rows: int = -1
    counts: Counts = field(default_factory=Counts)
    _saved: float = 0.0

    def reached(self, rows: int, counts: Counts, file: int) -> None:
        """Take note that all rows above are written, with what was counted of the last of them."""
        self.rows = rows
        self.counts.add(counts)
        if self.journal is not None and time.monotonic() - self._saved > _EVERY:
            os.fsync(file)  # the journal never says more than the file holds
            self.save()

    def save(self) -> None:
        assert self.journal is not None
        size = self.path.stat().st_size
        entry = {
            "run": dict(self.run),
            "size": size,
            "rows": self.rows,
            "counts": asdict(self.counts),
        }
        write_whole(self.journal, (json.dumps(entry, indent=1) + "\n").encode())
        self._saved = time.monotonic()


def least_done(several: Sequence[Unfinished]) -> tuple[int, Counts]:
    """The rows that all of several files have, -1 where one is not laid out yet, and their counts;
    all are set back to them."""
    least = min(several, key=lambda each: each.rows)
    rows, counts = least.rows, asdict(least.counts)
    for each in several:
        each.rows, each.counts = rows, Counts(**deepcopy(counts))
    return rows, least.counts


@contextmanager
def unfinished_file(target: str | Path, run: Mapping[str, str]) -> Iterator[Unfinished]:
    """A file beside the target that is renamed to it when the block ends, and kept with its journal
    when that is interrupted or fails.

    run: what makes this run, by name. Raises ImageError where a run of something else was left
    there, or another process is at it.
    """
    final = place_of(target)
    part, journal = (final.parent / f".{final.name}.{end}" for end in ("part", "journal"))
    try:
        file = os.open(part, os.O_RDWR | os.O_CREAT, 0o666)
    except OSError as error:
        raise BrdfcError(f"cannot write here: {error.strerror}", where=str(target)) from error
    try:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise ImageError("another run is writing this", where=str(target)) from error
        state = _found(part, journal, run)
        try:
            yield state
            part.replace(final)
            journal.unlink(missing_ok=True)
        except OSError as error:
            reason = error.strerror or str(error)
            raise BrdfcError(f"cannot be written: {reason}", where=str(target)) from error
        finally:
            if part.exists():
                _keep(state, file)
    finally:
        os.close(file)


def _keep(state: Unfinished, file: int) -> None:
    """Leave what was done; nothing where nothing was, or where it is of no use."""
    if state.rows > 0 and not state.counts.faults:
        os.fsync(file)
        state.save()
    else:
        for path in (state.path, state.journal):
            if path is not None:
                path.unlink(missing_ok=True)


def _found(part: Path, journal: Path, run: Mapping[str, str]) -> Unfinished:
    if not journal.exists():
        return Unfinished(part, journal, run)
    try:
        entry = json.loads(read_file(journal, _LIMIT))
        before, rows, counts = entry["run"], int(entry["rows"]), entry["counts"]
        if entry["size"] != part.stat().st_size:
            raise ValueError("the file is not the one it is about")
        kept = Counts(
            outside={str(n): int(c) for n, c in counts["outside"].items()},
            clipped=int(counts["clipped"]),
            pixels={str(n): int(c) for n, c in counts["pixels"].items()},
        )
        other = [name for name in run if before.get(name) != run[name]]
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise ImageError(
            "the journal of an unfinished run is damaged, or its file",
            where=str(journal),
            hint=f"remove it and {part}",
        ) from error
    if other:
        raise ImageError(
            f"an unfinished run of something else is here: other {', '.join(other)}",
            where=str(journal),
            hint=f"finish that one, or remove it and {part}",
        )
    return Unfinished(part, journal, run, rows, kept)
