"""A profile of device values, coefficients and angles side by side (class `scnr`), as an input
profile has colours: the transform `A2B1`, and with wavelengths `D2B1`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from brdfc.calc.program import Element
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import n_channel_space
from brdfc.icc.types import Tag
from brdfc.profiles.angles import Sample, is_identity, reading
from brdfc.profiles.content import Content


def device_profile(
    content: Content, samples: Sequence[Sample], count: int, more: Mapping[str, Tag] | None = None
) -> Profile:
    """A profile for images of so many samples.

    samples: what each channel of the program comes from. more: further tags.
    """
    first: tuple[Element, ...] = ()
    if not is_identity(samples, count):
        first = (reading(samples, count),)
    tags: dict[str, Tag] = {
        **content.texts("coefficients to colours"),
        "A2B1": content.colorimetric(first),
        **content.colours(),
        **(more or {}),
    }
    if content.grid is not None:
        tags["D2B1"] = content.spectral(first)
    return Profile(content.header("scnr", colour_space=n_channel_space(count)), tags)
