"""The same run on many machines: a Dask cluster whose workers share a storage with the client.

The client lays the file out. Each task is some windows: a worker reads them from the source, and
writes them to their places in the file, so that no samples travel. A task done twice is the same,
so what a worker had begun when it died is done by another. The client renames the file at last.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from itertools import islice
from threading import Event
from typing import Any

from brdfc import __version__
from brdfc.images.counts import Counts
from brdfc.images.filling import Filling
from brdfc.images.source import SHARED, Readable
from brdfc.images.window import Grid, Window
from brdfc.images.writing import opened_to_fill
from brdfc.source.errors import BrdfcError, ImageError, MissingExtraError

TASK_PIXELS = 1 << 22
"""Pixels of a task, about: seconds of work, little to do again."""
_TIMEOUT = 5
"""Seconds to wait for the scheduler, and for its first worker."""
_ADDRESS = re.compile(r"((tcp|tls|wss?)://)?[^/\s]+:\d{1,5}/?")


@dataclass(frozen=True)
class Share:
    """What a worker is told: the source, what to compute, and where it belongs."""

    source: Readable
    filling: Filling
    version: str = __version__

    def fill(self, windows: Sequence[Window]) -> Counts:
        """Fill some windows; what was counted. Raises ImageError for what a worker cannot reach."""
        if self.version != __version__:
            raise ImageError(f"the worker has brdfc {__version__}, the client {self.version}")
        counts, spoiled = Counts(), Event()
        with self.source.opened() as image, ExitStack() as stack:
            files = [stack.enter_context(opened_to_fill(p.path)) for p in self.filling.results]
            for window in windows:
                counts.add(self.filling.fill(image, files, window, spoiled))
        return counts


def _filled(share: Share, windows: Sequence[Window]) -> Counts | BrdfcError:
    """What a task gives. An error is a result: the same again would be the same error."""
    try:
        return share.fill(windows)
    except BrdfcError as error:
        return error
    except OSError as error:
        reason = f"a worker cannot write it: {error.strerror or error}"
        return ImageError(reason, where=str(share.filling.results[0].path), hint=SHARED)


def fill_on_cluster(
    filling: Filling,
    source: Readable,
    grid: Grid,
    scheduler: str,
    progress: Callable[[int, int], None],
) -> Counts:
    """Fill files that are laid out by the workers of a scheduler (tcp://host:8786); what was
    counted.

    Raises MissingExtraError where distributed is not installed, ImageError where there is no
    scheduler or no worker, for what a worker cannot reach, and where workers die again and again.
    """
    with _connected(scheduler) as client:
        from distributed import as_completed

        share = Share(source, filling)
        # A future that can be computed again, as data that is scattered could not.
        shared = client.submit(_same, share, pure=False)
        tasks = list(_tasks(grid))
        futures = [client.submit(_filled, shared, windows, pure=False) for windows in tasks]
        pixels = {f.key: sum(w.pixels for w in t) for f, t in zip(futures, tasks, strict=True)}
        whole, done = Counts(), 0
        try:
            finished = as_completed(futures, loop=client.loop, with_results=True)
            for future, found in finished:
                if isinstance(found, BrdfcError):
                    raise found
                whole.add(found)
                done += pixels[future.key]
                progress(done, grid.pixels)
        except _lost_workers() as error:
            raise ImageError(f"the cluster cannot do it: {error}", where=scheduler) from error
        finally:
            if done < grid.pixels:
                client.cancel([shared, *futures])
    return whole


def _same(share: Share) -> Share:
    return share


def _tasks(grid: Grid) -> Iterator[tuple[Window, ...]]:
    windows = grid.windows()
    while task := tuple(islice(windows, max(1, TASK_PIXELS // (grid.rows * grid.columns)))):
        yield task


@contextmanager
def _connected(scheduler: str) -> Iterator[Any]:
    try:
        from distributed import Client
    except ImportError as error:
        raise MissingExtraError(
            "a run on a cluster needs the package distributed",
            hint="pip install 'brdfc[distributed]'",
        ) from error
    if not _ADDRESS.fullmatch(scheduler):
        raise ImageError(f"'{scheduler}' is no scheduler's address", hint="tcp://host:8786")
    try:
        client = Client(scheduler, timeout=_TIMEOUT, set_as_default=False)
    except OSError as error:
        raise ImageError(
            f"no scheduler answers: {error}",
            where=scheduler,
            hint="start one with `dask scheduler`, and workers with `dask worker ADDRESS`",
        ) from error
    with client:
        try:
            client.wait_for_workers(1, timeout=_TIMEOUT)
        except TimeoutError as error:
            raise ImageError(
                "the scheduler has no workers",
                where=scheduler,
                hint=f"start some: dask worker {scheduler}",
            ) from error
        yield client


def _lost_workers() -> tuple[type[Exception], ...]:
    """What the library raises where workers die under a task, or do not know brdfc."""
    from concurrent.futures import CancelledError

    from distributed import KilledWorker

    return KilledWorker, CancelledError, ImportError
