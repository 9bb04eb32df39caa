"""What there is to do to an image, prepared and checked before anything is written."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from brdfc.cmm.rendering import Rendering, Target
from brdfc.cmm.roles import Kind
from brdfc.cmm.stages import Stage
from brdfc.icc.profile import Profile
from brdfc.images.computing import Computing, columns
from brdfc.images.counts import Counts
from brdfc.images.description import described
from brdfc.images.format import TILES, Format, encoder, srgb_profile
from brdfc.images.memory import USUAL, Cost, Plan, planned
from brdfc.images.samples import Ends, samples
from brdfc.images.scaling import scaling
from brdfc.images.tiff import WRITING, CoefficientImage
from brdfc.images.window import Grain
from brdfc.source.errors import ImageError


@dataclass(frozen=True)
class Choices:
    """How images are read and written.

    scale: what integers mean, by channel, see scaling.scaling; samples: see samples.samples;
    compression, tile: see Format; memory: bytes that buffers may take; resume: keep what is done
    when a sweep is interrupted, and go on from what was kept; threads: as many as there are
    processors where None; scheduler: the address of a cluster
    that does it, see cluster.
    """

    scale: Mapping[str, Ends] = field(default_factory=dict)
    samples: str | None = None
    compression: str = "none"
    tile: int = 0
    memory: int = USUAL
    resume: bool = False
    threads: int | None = None
    scheduler: str | None = None


@dataclass(frozen=True)
class Job:
    """An image, what is computed of it, and the file that comes out: how it is laid out, a page for
    each description."""

    image: CoefficientImage
    computing: Computing
    format: Format
    descriptions: tuple[str, ...]
    target: Path
    plan: Plan
    identity: Mapping[str, str]

    def refuse_faults(self, counts: Counts) -> None:
        """ImageError where samples were counted that are no numbers."""
        if counts.first is None:
            return
        row, column, channel = counts.first
        names = self.computing.link.channels
        raise ImageError(
            f"{counts.faults} of {self.plan.grid.pixels * len(names):,} samples are NaN or "
            f"infinite, the first at row {row}, column {column}, '{names[channel]}'",
            where=self.image.where,
            hint="mask or fill them first; nothing was written",
        )


def prepared(
    renderings: Sequence[Rendering],
    image: CoefficientImage,
    target: str | Path,
    run: str,
    choices: Choices,
) -> Job:
    """The job of an open image; ImageError for an image that does not fit the link, or choices that
    cannot be kept to."""
    kind = samples(choices.samples, renderings[0])
    # Windows are shared among threads, not the pixels of one.
    renderings = [replace(each, link=replace(each.link, threads=1)) for each in renderings]
    if kind.kind != renderings[0].dtype and kind.ends is None:  # a picture of 16 bits
        renderings = [replace(each, bits=8 * kind.kind.itemsize) for each in renderings]
    rendering = renderings[0]
    link = rendering.link
    wanted = columns(link, image.channels)
    if wanted is None:
        raise ImageError(
            f"the image has {image.channels} samples a pixel, the profile takes "
            f"{len(link.channels)}: {', '.join(link.channels)}",
            where=image.where,
            hint=WRITING if image.channels == 1 else None,
        )
    names = link.samples if image.channels == len(link.samples) else link.channels
    stated = choices.scale
    if not stated and image.kind.kind != "f" and _has_encoding(link.stages[0]):
        stated = {"": (0.0, 1.0)}
    scaled = scaling(stated, names, image.kind, image.where)
    if choices.compression not in ("none", "deflate"):
        encoder(choices.compression)  # a missing package is said before the work
    form = Format(
        image.height,
        image.width,
        rendering.samples,
        kind.kind,
        _tile(image, choices),
        choices.compression,
        *_named_colours(rendering),
    )
    if form.compressed and (choices.resume or choices.scheduler is not None):
        raise ImageError(
            "compressed pages are written from first to last, and can neither be resumed nor "
            "written by many: where a strip lies depends on those before it",
            hint="leave out --compression",
        )
    if choices.scheduler is not None and choices.resume:
        raise ImageError("a run on a cluster cannot be resumed", hint="leave out --resume")
    check_room(target, form, len(renderings))
    profiles = [stage.profile for stage in link.stages]
    texts = tuple(described(each, profiles, kind, scaled, run) for each in renderings)
    computing = Computing(
        tuple(renderings), kind, tuple(wanted), image.channels, image.height * image.width
    )
    grain = form.grain.joined(image.segments.grain, image.width)
    if form.compressed and form.tile:  # in the order of the file, a row of tiles at a time
        grain = Grain(form.tile, grain.columns)
    cost = _cost(computing, image, form)
    plan = planned(
        image.height, image.width, grain, cost, choices.memory, choices.threads, image.where
    )
    opened = image.scaled(scaled)
    identity = _identity(opened, renderings, profiles, form, texts)
    return Job(opened, computing, form, texts, Path(target), plan, identity)


_PHOTOMETRIC = {b"RGB ": "rgb", b"CMYK": "separated"}
"""Device spaces that TIFF has a name for."""
_OF_NO_DEVICE = ("link", "mlnk")
"""Classes that do not say what device values look like, and are not embedded (ICC.1, 8.6)."""


def _has_encoding(first: Stage) -> bool:
    """Whether integers can only mean 0 to 1: of red, green and blue, or inks. Coefficients, in a
    space that says nothing but their number, may mean anything."""
    device = first.takes.kind is Kind.DEVICE and first.takes.device[:2] != b"nc"
    return device and first.gives.kind is not Kind.MULTIPLEX


def _named_colours(rendering: Rendering) -> tuple[str, bytes | None]:
    """What TIFF calls the samples, and the profile to embed."""
    if rendering.to is Target.SRGB:
        return "rgb", srgb_profile()
    if rendering.to is Target.DEVICE:
        link = rendering.link
        last = link.profile
        says = last.header.device_class not in _OF_NO_DEVICE
        embedded = (last.source or last.to_bytes()) if says else None
        return _PHOTOMETRIC.get(link.gives.device, "minisblack"), embedded
    return "minisblack", None


def _tile(image: CoefficientImage, choices: Choices) -> int:
    """The side of the result's tiles. Compressed strips of a tiled source would need whole rows of
    its tiles in memory; the result is tiled then too."""
    grain = image.segments.grain
    if choices.tile or choices.compression == "none" or not image.segments.tiled:
        return choices.tile
    return grain.rows if grain.rows == grain.columns and grain.rows % TILES == 0 else 256


def check_room(target: str | Path, form: Format, pages: int) -> None:
    """ImageError where the folder's disk cannot hold the result."""
    needed = 0 if form.compressed else form.page_bytes * pages
    folder = Path(target).absolute().parent
    free = shutil.disk_usage(folder).free if folder.is_dir() else needed
    if needed > free:
        raise ImageError(
            f"the result takes {needed / 1e9:.3g} GB, and {free / 1e9:.3g} GB are free here",
            where=str(target),
        )


def _cost(computing: Computing, image: CoefficientImage, form: Format) -> Cost:
    """What a pixel takes: as it is read, as float32 (numpy's indices of a table are 8 bytes), and
    as it is written, in order and in tiles."""
    read = image.channels * image.kind.itemsize
    if image.kind != np.float32:
        read += image.channels * (4 + (8 if image.greatest else 0))
    pages = 1 if form.compressed else len(computing.renderings)
    written = pages * form.samples * form.kind.itemsize + 2 * form.samples * form.kind.itemsize
    return Cost(read + written, computing.working, image.segments.decoded)


def _identity(
    image: CoefficientImage,
    renderings: Sequence[Rendering],
    profiles: Sequence[Profile],
    form: Format,
    texts: Sequence[str],
) -> dict[str, str]:
    """What makes a run the same one: its source, profiles, variables and result."""
    size, written = image.segments.state
    environments = [sorted(r.link.environment.items()) for r in renderings]
    matrices = [repr((r.white, r.observer, r.adaptation, r.link.interpolation)) for r in renderings]
    return {
        "source": f"{size} bytes of {written}",
        "profiles": digest(*(p.source or p.to_bytes() for p in profiles)),
        "variables": digest(repr(environments).encode()),
        "options": digest(repr((form, matrices, texts)).encode()),
    }


def digest(*parts: bytes) -> str:
    """SHA-256 of some bytes, wherever one of them ends."""
    whole = hashlib.sha256()
    for part in parts:
        whole.update(hashlib.sha256(part).digest())
    return whole.hexdigest()
