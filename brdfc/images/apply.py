"""Linked profiles on an image of coefficients, window by window; several of them for a sweep."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from threading import Event

from brdfc.cmm.rendering import Rendering
from brdfc.files import refuse_same, whole_file
from brdfc.images.counts import Counts
from brdfc.images.filling import Filling, fill_here
from brdfc.images.job import Choices, Job, prepared
from brdfc.images.source import Source
from brdfc.images.stream import in_order
from brdfc.images.tiff import KINDS, open_samples
from brdfc.images.unfinished import Unfinished, unfinished_file
from brdfc.images.window import Window
from brdfc.images.writing import laid_out, lay_out, write_compressed

Progress = Callable[[int, int], None]


@dataclass
class Applied:
    """What was done: pixels of the source, for each channel how many samples lay outside its range,
    and how many pixels were clipped to what the samples of the result can hold."""

    pixels: int = 0
    clipped: int = 0
    outside: dict[str, int] = field(default_factory=dict)


def apply_to_tiff(
    rendering: Rendering | Sequence[Rendering],
    source: str | Path,
    target: str | Path,
    run: str = "",
    progress: Progress = lambda done, total: None,
    choices: Choices = Choices(),  # noqa: B008 - frozen
) -> Applied:
    """Evaluate a TIFF of coefficients to a TIFF of what the rendering gives, or to a page for each
    of several: of the same profiles with other variables. run: more to say in its description.

    The target appears whole or not at all. Raises ImageError for an image that does not fit the
    link, that holds NaN or infinity anywhere (with their count), that cannot be read, or that
    changes while it is. progress gets pixels done and pixels in all.
    """
    several = (rendering,) if isinstance(rendering, Rendering) else tuple(rendering)
    refuse_same([target], [source])
    with open_samples(source, KINDS) as image:
        job = prepared(several, image, target, run, choices)
        if job.format.compressed:
            counts = _compress(job, progress)
        elif choices.scheduler is not None:
            with whole_file(job.target.absolute()) as temporary:
                counts = _fill_on_cluster(job, temporary, choices.scheduler, progress)
        elif choices.resume:
            with unfinished_file(target, job.identity) as unfinished:
                counts = _fill(job, unfinished, progress)
        else:
            with whole_file(target) as temporary:
                counts = _fill(job, Unfinished(temporary), progress)
        return Applied(image.height * image.width, counts.clipped, counts.outside)


def _fill(job: Job, unfinished: Unfinished, progress: Progress) -> Counts:
    """All pages in one pass over the source, each window to where it belongs."""
    if unfinished.rows < 0:
        places = lay_out(unfinished.path, job.format, job.descriptions)
        unfinished.rows = 0
    else:
        places = laid_out(unfinished.path, job.format)
    filling = Filling(job.computing, (places,))
    counts = fill_here(filling, job.image, job.plan, [unfinished], progress)
    job.refuse_faults(counts)
    return counts


def _fill_on_cluster(job: Job, path: Path, scheduler: str, progress: Progress) -> Counts:
    from brdfc.images.cluster import fill_on_cluster

    filling = Filling(job.computing, (lay_out(path, job.format, job.descriptions),))
    source = Source.of(job.image)
    counts = fill_on_cluster(filling, source, job.plan.grid, scheduler, progress)
    job.refuse_faults(counts)
    return counts


def _compress(job: Job, progress: Progress) -> Counts:
    """Page after page, a pass over the source each: where a strip lies is known when those before
    it are compressed."""
    spoiled = Event()
    whole, grid = Counts(), job.plan.grid
    done, pixels = 0, grid.pixels * len(job.descriptions)

    def segments(page: int) -> Generator[bytes]:
        nonlocal done
        computing = job.computing.page(page)

        def work(window: Window) -> tuple[Window, list[bytes], Counts]:
            pages, counts = computing.run(job.image.window(window), window, spoiled)
            encoded = [part for v in pages for part in job.format.encoded(window, v)]
            return window, encoded, counts

        with closing(in_order(work, grid.windows(), job.plan.workers)) as results:
            for window, encoded, counts in results:
                whole.add(counts if page == 0 else Counts(clipped=counts.clipped))
                yield from encoded
                done += window.pixels
                progress(done, pixels)
        job.refuse_faults(whole)

    with whole_file(job.target) as temporary:
        pages = ((text, segments(page)) for page, text in enumerate(job.descriptions))
        write_compressed(temporary, job.format, len(job.descriptions), pages)
    return whole
