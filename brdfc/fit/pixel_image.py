"""A stack of images to an image of coefficients, window by window, here or on a cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from brdfc.files import refuse_same, whole_file
from brdfc.fit.measurements import Kind
from brdfc.fit.pixel_computing import DONE, FAILED, FEW, LEFT_OUT, QUALITY, WORKING, PixelComputing
from brdfc.fit.pixels import BATCH, PixelFit
from brdfc.fit.stack import Stack
from brdfc.fit.stack_images import open_images
from brdfc.images.counts import Counts
from brdfc.images.filling import Filling, fill_here
from brdfc.images.format import Format
from brdfc.images.job import check_room, digest
from brdfc.images.memory import USUAL, Cost, Plan, planned
from brdfc.images.source import Beside, Source, Sources
from brdfc.images.tiff import CoefficientImage
from brdfc.images.unfinished import Unfinished, least_done, unfinished_file
from brdfc.images.writing import laid_out, lay_out
from brdfc.lang.model import Model
from brdfc.source.errors import ImageError
from brdfc.symbolic.formula import NO_WHITE
from brdfc.symbolic.serial import to_data

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Options:
    """clip: values from here on are saturated. keep: write coefficients of failed fits too. memory,
    threads, resume, scheduler: as of images (images.job.Choices)."""

    clip: float | None = None
    keep: bool = False
    memory: int = USUAL
    threads: int | None = None
    resume: bool = False
    scheduler: str | None = None


@dataclass(frozen=True)
class Fitted:
    """Of the pixels: how many were fitted, whose fit did not converge, and that had too few usable
    geometries. left_out: samples that are no numbers, negative or saturated. coefficients: their
    names, in the order of the samples."""

    fitted: int
    failed: int
    few: int
    left_out: int
    coefficients: tuple[str, ...]

    @property
    def pixels(self) -> int:
        return self.fitted + self.failed + self.few


@dataclass(frozen=True)
class _Result:
    """A file that is written: what its samples are."""

    path: Path
    form: Format
    about: str


def fit_stack(
    model: Model,
    stack: Stack,
    target: str | Path,
    quality: str | Path | None = None,
    *,
    fixed: Mapping[str, Sequence[float]] = {},
    options: Options = Options(),
    progress: Progress = lambda done, total: None,
) -> Fitted:
    """Fit a model in the full geometry to every pixel of a stack, and write its coefficients as
    float32 samples, in the order of its channels: what `brdfc apply` takes; and beside them, if
    wanted, QUALITY.

    fixed: quantities that are not fitted. The files appear whole or not at all. Raises ImageError
    for images that cannot be read, or are not of one size; FitError for a model that the geometries
    are too few for.
    """
    refuse_same([target, quality], [stack.path, *stack.files])
    if options.scheduler is not None and options.resume:
        raise ImageError("a run on a cluster cannot be resumed", hint="leave out --resume")
    with ExitStack() as opened:
        images = open_images(opened, stack)
        single = images[0].channels == 1
        white = NO_WHITE if not single and stack.kind is Kind.RGB else stack.white
        computing = PixelComputing(
            PixelFit(model, stack.directions, fixed, white),
            stack.factors,
            np.array(white) if single else None,
            options.clip,
            options.keep,
            quality is not None,
        )
        names = tuple(c.name for c in computing.fit.response.coefficients)
        results = list(_results(images[0], model.name, names, target, quality))
        identity = _identity(images, stack, computing)
        with _files(results, options.resume, identity) as unfinished:
            counts = _fill(images, computing, results, unfinished, options, stack.path, progress)
    fitted, failed, few, left_out = (
        counts.pixels.get(name, 0) for name in (DONE, FAILED, FEW, LEFT_OUT)
    )
    return Fitted(fitted, failed, few, left_out, names)


def _results(
    image: CoefficientImage,
    model: str,
    names: Sequence[str],
    target: str | Path,
    quality: str | Path | None,
) -> Iterator[_Result]:
    """The files to be written, once there is room for them."""
    wanted = [(target, f"coefficients of {model}: {', '.join(names)}", len(names))]
    if quality is not None:
        wanted.append((quality, f"of the fits of {model}: {', '.join(QUALITY)}", len(QUALITY)))
    for path, about, samples in wanted:
        form = Format(image.height, image.width, samples, np.dtype(np.float32))
        check_room(path, form, 1)
        yield _Result(Path(path).absolute(), form, about)


def _fill(
    images: Sequence[CoefficientImage],
    computing: PixelComputing,
    results: Sequence[_Result],
    unfinished: Sequence[Unfinished],
    options: Options,
    where: str,
    progress: Progress,
) -> Counts:
    """Lay the files out, or take them as they were left, and fill them."""
    source = Beside(tuple(images))
    plan = _plan(source, computing, results, options, where)
    begun = least_done(unfinished)[0] >= 0
    places = tuple(
        laid_out(each.path, result.form)
        if begun
        else lay_out(each.path, result.form, [result.about])
        for each, result in zip(unfinished, results, strict=True)
    )
    for each in unfinished:
        each.rows = max(each.rows, 0)
    filling = Filling(computing, places)
    if options.scheduler is None:
        return fill_here(filling, source, plan, unfinished, progress)
    from brdfc.images.cluster import fill_on_cluster

    sources = Sources([Source.of(image) for image in images])
    return fill_on_cluster(filling, sources, plan.grid, options.scheduler, progress)


def _plan(
    source: Beside,
    computing: PixelComputing,
    results: Sequence[_Result],
    options: Options,
    where: str,
) -> Plan:
    """Windows that keep to the limit of memory."""
    first = source.images[0]
    samples = len(source.images) * first.channels
    bands = samples if computing.neutral is None else 3 * samples
    # As they are read, as float32, side by side, and as BRDF in float64.
    held = samples * (first.kind.itemsize + 8) + 17 * bands
    held += sum(3 * 4 * result.form.samples for result in results)
    segment = max(image.segments.decoded for image in source.images)
    cost = Cost(held, WORKING * bands, segment, BATCH)
    return planned(
        first.height,
        first.width,
        source.grain,
        cost,
        options.memory,
        options.threads,
        where,
    )


@contextmanager
def _files(
    results: Sequence[_Result], resume: bool, identity: Mapping[str, str]
) -> Iterator[list[Unfinished]]:
    """Files to fill, renamed at the end: the first one last."""
    with ExitStack() as stack:
        if resume:
            yield [stack.enter_context(unfinished_file(r.path, identity)) for r in results]
        else:
            yield [Unfinished(stack.enter_context(whole_file(r.path))) for r in results]


def _identity(
    images: Sequence[CoefficientImage], stack: Stack, computing: PixelComputing
) -> dict[str, str]:
    """What makes a run the same one."""
    response = computing.fit.response
    states = [(image.where, image.segments.state, str(image.scaling)) for image in images]
    seen = stack.directions.tolist(), stack.factors.tolist(), response.white
    formula = to_data(response.reflectance), response.coefficients
    how = computing.clip, computing.keep, computing.quality
    return {
        name: digest(repr(what).encode())
        for name, what in (
            ("images", states),
            ("geometries", seen),
            ("model", formula),
            ("options", how),
        )
    }
