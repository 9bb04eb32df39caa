"""The options of a command that says how images are read and written."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from brdfc.cmm.link import Link
    from brdfc.images.job import Choices


def image_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """What integers mean, what is written and how, limits, and where it is done; see choices."""
    for option in (
        click.option(
            "--scheduler",
            metavar="ADDRESS",
            help="Have it done by a Dask cluster on a shared storage: tcp://host:8786. Needs "
            "brdfc[distributed].",
        ),
        click.option(
            "--resume",
            is_flag=True,
            help="Of a sweep: keep what is done when it is interrupted, and go on from what an "
            "earlier run kept.",
        ),
        click.option(
            "--threads",
            type=click.IntRange(1, 1024),
            metavar="N",
            help="How many compute at once. Default: as many as there are processors.",
        ),
        click.option(
            "--memory",
            metavar="SIZE",
            help="What buffers may take in all: 256MB, 1GiB. Default: 192MB.",
        ),
        click.option(
            "--tile",
            type=click.IntRange(16, 4096),
            metavar="PIXELS",
            help="Write square tiles of this side, a multiple of 16. Default: strips.",
        ),
        click.option(
            "--compression",
            type=click.Choice(["none", "deflate", "lzw", "zstd"]),
            default="none",
            help="How the result is compressed; lzw and zstd need brdfc[codecs]. Default: none.",
        ),
        click.option(
            "--samples",
            metavar="float32|uint16[:LOW..HIGH]",
            help="What is written; uint16 stands for 0..1, or LOW..HIGH. With --to sRGB: uint8, "
            "the default, or uint16.",
        ),
        click.option(
            "--scale",
            multiple=True,
            metavar="[NAME=]LOW..HIGH",
            help="What the integers of IMAGE mean, 0 and the greatest: of all samples, or of one. "
            "Repeatable.",
        ),
    ):
        function = option(function)
    return function


def choices(
    link: Link,
    scale: Sequence[str],
    samples: str | None,
    compression: str,
    tile: int | None,
    memory: str | None,
    threads: int | None,
    resume: bool,
    scheduler: str | None,
) -> Choices:
    """How images are read and written, as the options say it."""
    from brdfc.images.job import Choices
    from brdfc.images.memory import USUAL, parse_size

    return Choices(
        scale=_scale(scale, link),
        samples=samples,
        compression=compression,
        tile=tile or 0,
        memory=USUAL if memory is None else parse_size(memory),
        resume=resume,
        threads=threads,
        scheduler=scheduler,
    )


def _scale(texts: Sequence[str], link: Link) -> dict[str, tuple[float, float]]:
    """Ends by channel, in the units that the profile declares; "" for all that are not named."""
    from brdfc.images.samples import ends
    from brdfc.lang.values import parse_value
    from brdfc.source.diagnostics import did_you_mean

    names = {*link.samples, *link.channels}
    described = {name: d for d in link.described for name in (d.name, *d.component_names)}
    found: dict[str, tuple[float, float]] = {}
    for text in texts:
        name, separator, reach = text.rpartition("=")
        name, (low, dots, high) = name.strip(), reach.partition("..")
        if not dots or (separator and not name):
            raise click.UsageError(f"--scale takes LOW..HIGH or NAME=LOW..HIGH, not '{text}'")
        known = described.get(name)
        if name and known is None and name not in names:
            hint = (
                did_you_mean(name, [*described, *names]) or f"they are {', '.join(sorted(names))}"
            )
            raise click.UsageError(f"--scale {text}: no sample is called '{name}'; {hint}")
        if known is not None and known.type.is_angle and (known.origin, known.step) == (0, 1):
            parts = [parse_value(part, known.type, name)[0] for part in (low, high)]
            both = (parts[0], parts[1])
        else:
            both = ends(low, high)
        whole = known is not None and name == known.name
        for each in known.component_names if known is not None and whole else (name,):
            if each in found:
                raise click.UsageError(f"--scale gives '{each or 'all'}' twice")
            found[each] = both
    return found
