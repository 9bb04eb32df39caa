"""The same run on many machines: a Dask cluster whose workers share a storage with the client.

The client lays the file out. Each task is some windows: a worker reads them from the source, and
writes them to their places in the file, so that no samples travel. A task done twice is the same,
so what a worker had begun when it died is done by another. The client renames the file at last.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from threading import Event
from typing import Any

from brdfc import __version__
from brdfc.images.computing import Computing
from brdfc.images.counts import Counts
from brdfc.images.filling import fill
from brdfc.images.job import Job
from brdfc.images.scaling import Scaling
from brdfc.images.segments import State
from brdfc.images.tiff import KINDS, open_samples
from brdfc.images.window import Window
from brdfc.images.writing import Places, lay_out, opened_to_fill
from brdfc.source.errors import BrdfcError, ImageError, MissingExtraError

TASK_PIXELS = 1 << 22
"""Pixels of a task, about: seconds of work, little to do again."""
_TIMEOUT = 5
"""Seconds to wait for the scheduler, and for its first worker."""
_ADDRESS = re.compile(r"((tcp|tls|wss?)://)?[^/\s]+:\d{1,5}/?")
_SHARED = "every worker needs the source and the result's folder under the client's paths"


@dataclass(frozen=True)
class Share:
    """What a worker is told: the source and the state it is in, what to compute, and where it
    belongs."""

    source: Path
    state: State
    scaling: Scaling | None
    computing: Computing
    places: Places
    version: str = __version__

    def fill(self, windows: Sequence[Window]) -> Counts:
        """Fill some windows; what was counted. Raises ImageError for what a worker cannot reach."""
        if self.version != __version__:
            raise ImageError(f"the worker has brdfc {__version__}, the client {self.version}")
        if not self.source.exists():
            raise ImageError("a worker does not see it", where=str(self.source), hint=_SHARED)
        counts, spoiled = Counts(), Event()
        with open_samples(self.source, KINDS) as opened, opened_to_fill(self.places.path) as file:
            image = opened.scaled(self.scaling)
            if image.segments.state != self.state:
                raise ImageError(
                    "the file changed while it was read, or the worker has another",
                    where=str(self.source),
                )
            for window in windows:
                counts.add(fill(image, self.computing, self.places, file, window, spoiled))
        return counts


def _filled(share: Share, windows: Sequence[Window]) -> Counts | BrdfcError:
    """What a task gives. An error is a result: the same again would be the same error."""
    try:
        return share.fill(windows)
    except BrdfcError as error:
        return error
    except OSError as error:
        reason = f"a worker cannot write it: {error.strerror or error}"
        return ImageError(reason, where=str(share.places.path), hint=_SHARED)


def fill_on_cluster(
    job: Job, path: Path, scheduler: str, progress: Callable[[int, int], None]
) -> Counts:
    """Fill a file by the workers of a scheduler (tcp://host:8786); what was counted.

    Raises MissingExtraError where distributed is not installed, ImageError where there is no
    scheduler or no worker, for what a worker cannot reach, and where workers die again and again.
    """
    with _connected(scheduler) as client:
        from distributed import as_completed

        places = lay_out(path, job.format, job.descriptions)
        image = job.image
        share = Share(
            Path(image.where).absolute(),
            image.segments.state,
            image.scaling,
            job.computing,
            places,
        )
        # A future that can be computed again, as data that is scattered could not.
        shared = client.submit(_same, share, pure=False)
        tasks = list(_tasks(job))
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
                progress(done, job.plan.grid.pixels)
        except _lost_workers() as error:
            raise ImageError(f"the cluster cannot do it: {error}", where=scheduler) from error
        finally:
            if done < job.plan.grid.pixels:
                client.cancel([shared, *futures])
    job.refuse_faults(whole)
    return whole


def _same(share: Share) -> Share:
    return share


def _tasks(job: Job) -> Iterator[tuple[Window, ...]]:
    grid = job.plan.grid
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
