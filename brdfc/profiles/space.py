"""A profile of a space of XYZ under some light: the far end of a chain, for colour engines.

Chained after an MVIS it makes a colour engine connect both spaces, through `c2sp` of the MVIS and
`s2cp` of this profile, and give colours under this profile's light.
"""

from __future__ import annotations

import numpy as np

from brdfc.colour.conditions import ViewingConditions
from brdfc.icc.header import Header
from brdfc.icc.profile import Profile
from brdfc.icc.types import LocalizedText, Pipeline, Tag
from brdfc.profiles.conditions import condition_tags, header_white, matrix_element
from brdfc.profiles.content import COPYRIGHT


def xyz_space(conditions: ViewingConditions | None = None) -> Profile:
    """The profile of class `spac` whose colours are XYZ under these conditions; None for D50."""
    same = Pipeline(3, 3, (matrix_element(np.eye(3)),))
    tags: dict[str, Tag] = {
        "desc": LocalizedText.english(f"XYZ, {conditions or 'D50'}"),
        "cprt": LocalizedText.english(COPYRIGHT),
        "A2B0": same,
        "B2A0": same,
        **condition_tags(conditions),
    }
    white = header_white(conditions)
    header = Header("spac", colour_space=b"XYZ ", pcs=b"XYZ ", illuminant=white)
    return Profile(header, tags)
