"""Rendering intents: the tags that are tried for one, and what is done to colours for it."""

from __future__ import annotations

from enum import IntEnum

from brdfc.cmm.connection import Triple
from brdfc.icc.profile import Profile
from brdfc.icc.types import XYZArray
from brdfc.profiles.conditions import profile_white
from brdfc.source.errors import LinkError


class Intent(IntEnum):
    """Rendering intents, by the number in the names of tags."""

    PERCEPTUAL = 0
    RELATIVE = 1
    SATURATION = 2
    ABSOLUTE = 3


TRIED: dict[Intent, tuple[int, ...]] = {
    Intent.PERCEPTUAL: (0, 1, 3),
    Intent.RELATIVE: (1, 3, 0),
    Intent.SATURATION: (2, 0, 1, 3),
    Intent.ABSOLUTE: (3, 1, 0),
}
"""The tags that are tried for an intent, by their numbers."""


_BLACK: Triple = (0.00336, 0.0034731, 0.00287)
"""X, Y, Z of the perceptual reference medium's black point (ICC.1:2022, 6.3.4.3)."""


def adjustment(
    profile: Profile, wanted: Intent, found: Intent, to_black: bool
) -> tuple[Triple, Triple] | None:
    """Factors and offsets from the profile's X, Y, Z to those of an intent; None for none.

    Absolute colours are those relative to the medium times its white. to_black: the profile's
    perceptual colours reach down to black, where the reference medium's do not: those of tables
    before version 4, and of tone curves.
    """
    white = profile_white(profile)
    power = (wanted is Intent.ABSOLUTE) - (found is Intent.ABSOLUTE)
    if power:
        x, y, z = ((m / w) ** power for m, w in zip(_media_white(profile), white, strict=True))
        return (x, y, z), (0.0, 0.0, 0.0)
    if wanted is Intent.PERCEPTUAL and to_black and profile.header.device_class != "abst":
        x, y, z = (1 - b / w for b, w in zip(_BLACK, white, strict=True))
        return (x, y, z), _BLACK
    return None


def _media_white(profile: Profile) -> Triple:
    tag = profile.tags.get("wtpt")
    if not isinstance(tag, XYZArray) or len(tag.values) != 1 or not min(tag.values[0]) > 0:
        raise LinkError(
            "the profile states no white of its medium ('wtpt'), which absolute colours need"
        )
    return tag.values[0]
