"""BRDF function tags (ICC.2): colours from two directions and device values.

`bABx` and `bDBx` take four angles before the device values: the viewer's azimuth and zenith, then
the light's. No release of the ICC's engine that we know applies them; brdfc does. Beside them is
the transform of an ordinary input profile, for one geometry.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from brdfc.icc.profile import Profile
from brdfc.icc.types import Tag
from brdfc.profiles.angles import Sample, azimuth, fixed, reading, zenith
from brdfc.profiles.content import Content
from brdfc.profiles.device import device_profile

ANGLES = ("reflection_azimuth", "reflection", "incident_azimuth", "incident")
"""The quantities of the full geometry in the order of the format."""


def brdf_function_profile(
    content: Content,
    angles: Mapping[str, int],
    still: Mapping[str, float],
    unit: str,
    coefficients: Sequence[Sample],
) -> Profile:
    """A profile of a program in the full geometry.

    angles: the program's channel of each of ANGLES that it has. still: the value of each angle in
    the ordinary transform, radians. unit: of the four angles (see angles.UNITS). coefficients: how
    the program's other channels come from the device values, in their order.
    """
    inputs = content.program.inputs
    others = [c for c in range(inputs) if c not in angles.values()]
    count = len(coefficients)
    read = dict(zip(others, coefficients, strict=True))
    by_channel = {channel: name for name, channel in angles.items()}

    def directed(channel: int) -> Sample:
        if channel in read:
            after = read[channel]
            assert after.sample is not None
            return replace(after, sample=len(ANGLES) + after.sample)
        name = by_channel[channel]
        of = azimuth if name.endswith("azimuth") else zenith
        return of(ANGLES.index(name), unit)

    def at_rest(channel: int) -> Sample:
        return read[channel] if channel in read else fixed(still[by_channel[channel]])

    first = (reading([directed(c) for c in range(inputs)], len(ANGLES) + count),)
    function = content.colorimetric(first)
    more: dict[str, Tag] = {"bAB0": function, "bAB1": function}
    if content.grid is not None:
        spectral = content.spectral(first)
        more |= {"bDB0": spectral, "bDB1": spectral}
    samples: Sequence[Sample] = [at_rest(c) for c in range(inputs)]
    return device_profile(content, samples, count, more)
