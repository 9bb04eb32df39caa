"""Compiled models never get to where releases of the reference engine disagree.

In the ranges that their profiles state; wider, most of them divide by what may be 0.
"""

import pytest

import brdfc
from brdfc.calc.portability import portability
from brdfc.programs import examined, transforms

MODELS = [
    *(
        (name, "plane")
        for name in ("ward", "ggx", "cook_torrance_1982", "oren_nayar", "phong", "eon")
    ),
    *((name, "full") for name in ("ward", "ggx", "cook_torrance", "hapke", "disney_anisotropic")),
    *((name, "full") for name in ("ashikhmin_shirley", "blinn_phong", "lafortune_3")),
]


@pytest.mark.parametrize(("name", "geometry"), MODELS)
def test_no_remarks(name, geometry):
    made = brdfc.compile(brdfc.load(name, geometry), effort=1)
    for profile in made.profiles:
        for tag, pipeline in transforms(profile.tags):
            for found in examined(profile, tag, pipeline):
                assert found is not None
                assert found.facts is not None
                assert found.remarks == []


@pytest.mark.parametrize("layout", ["ncolour", "brdf-function"])
def test_elements_one_after_the_other(layout):
    """The first element makes the second one's channels of the device values."""
    made = brdfc.compile(brdfc.load("ward", "full"), effort=1, encode=layout)
    (profile,) = made.profiles
    for tag, pipeline in transforms(profile.tags):
        remarks = [found.remarks for found in examined(profile, tag, pipeline) if found]
        assert not any(remarks), tag


def test_what_the_ranges_are_for():
    made = brdfc.compile(brdfc.load("ward"), effort=1)
    (first, *_) = portability(made.program)
    assert "'div': the divisor may be 0" in first
