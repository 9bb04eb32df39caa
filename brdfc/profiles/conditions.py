"""Viewing conditions as a profile states them, and back: header, `svcn`, `c2sp`, `s2cp`, `wtpt`.

A profile whose light is not D50, seen by the 1931 observer, has a custom connection space. It
connects to others through the matrix to D50 (`c2sp`) and back (`s2cp`).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.program import Matrix
from brdfc.colour.adaptation import adaptation_matrix
from brdfc.colour.conditions import ViewingConditions
from brdfc.colour.difference import D50 as STANDARD_WHITE
from brdfc.colour.illuminants import CUSTOM
from brdfc.colour.spectrum import MOST_STEPS, Grid, interpolation
from brdfc.icc.header import D50, SpectralRange
from brdfc.icc.profile import Profile
from brdfc.icc.types import Pipeline, SpectralViewingConditions, Tag, XYZArray
from brdfc.icc.viewing import ILLUMINANTS
from brdfc.source.errors import LinkError, SpectrumError

XYZ = tuple[float, float, float]

_OBSERVER_CODES = {"1931-2": 1, "1964-10": 2}
_NAMES = {name: code for code, name in ILLUMINANTS.items()}


def header_white(conditions: ViewingConditions | None) -> XYZ:
    """The illuminant of the header, and the media white: a perfect diffuser under the light."""
    return D50 if conditions is None or conditions.standard else conditions.white


def condition_tags(conditions: ViewingConditions | None) -> dict[str, Tag]:
    """The white point, and where conditions are stated the tags that state them."""
    tags: dict[str, Tag] = {"wtpt": XYZArray((header_white(conditions),))}
    if conditions is None:
        return tags
    tags["svcn"] = _viewing(conditions)
    if not conditions.standard:
        to_standard = _single(
            adaptation_matrix(conditions.white, STANDARD_WHITE, conditions.adaptation)
        )
        # The inverse of what is stored, not of what was rounded for it.
        back = _single(np.asarray(np.linalg.inv(to_standard), dtype=np.float64))
        tags |= {"c2sp": _matrix(to_standard), "s2cp": _matrix(back)}
    return tags


def spectral_range(grid: Grid, what: str) -> SpectralRange:
    """A grid as the format has it; its ends are half floats. SpectrumError where they cannot be."""
    for end in (grid.start, grid.end):
        if float(np.float16(end)) != end:
            raise SpectrumError(
                f"the {what} ends at {end:g} nm, which the format cannot hold exactly",
                hint="use whole nanometres, up to 2048 nm",
            )
    return SpectralRange(grid.start, grid.end, grid.steps)


def _viewing(conditions: ViewingConditions) -> SpectralViewingConditions:
    name = conditions.illuminant.replace("FL", "F")
    scaled = tuple(conditions.luminance * v for v in conditions.white)
    single = np.float32
    return SpectralViewingConditions(
        observer=_OBSERVER_CODES.get(conditions.observer, 0),
        observer_range=spectral_range(conditions.grid, "observer"),
        matching=tuple(conditions.matching.astype(single).ravel().tolist()),
        illuminant=_NAMES.get(name, 0),
        temperature=float(single(conditions.temperature)),
        illuminant_range=spectral_range(conditions.grid, "illuminant"),
        power=tuple(conditions.power.astype(single).tolist()),
        white=_three(np.array(scaled, single)),
        surround=_three(np.array(conditions.surround, single)),
    )


def _three(values: NDArray[np.float32]) -> XYZ:
    x, y, z = values.tolist()
    return (x, y, z)


def _single(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    return matrix.astype(np.float32).astype(np.float64)


def _matrix(values: NDArray[np.float64]) -> Pipeline:
    return Pipeline(3, 3, (matrix_element(values),))


def matrix_element(values: NDArray[np.float64]) -> Matrix:
    """A matrix (outputs, inputs) as an element, its entries rounded to float32."""
    outputs, inputs = values.shape
    rounded = values.astype(np.float32).ravel().tolist()
    return Matrix(inputs, outputs, tuple(rounded), (0.0,) * outputs)


def stated_conditions(profile: Profile) -> ViewingConditions | None:
    """The viewing conditions a profile states (`svcn`); None where it states none.

    Raises LinkError for conditions nobody can compute with.
    """
    tag = profile.tags.get("svcn")
    if not isinstance(tag, SpectralViewingConditions):
        return None
    ranges = (tag.illuminant_range, tag.observer_range)
    if not all(2 <= r.steps <= MOST_STEPS for r in ranges):
        steps = " and ".join(f"{r.steps:,}" for r in ranges)
        raise LinkError(f"the viewing conditions ('svcn') have spectra of {steps} wavelengths")
    if not (tag.white[1] > 0 and min(tag.white) >= 0):
        raise LinkError(f"the white of the viewing conditions ('svcn') is {tag.white}")
    light, eye = (Grid(r.start, r.end, r.steps) for r in ranges)
    if not (light.start < light.end and eye.start < eye.end):
        raise LinkError("a spectrum of the viewing conditions ('svcn') ends before it starts")
    # What a sample sends back is read where the observer's functions are, as the ICC's engine does:
    # the functions, in their turn, at the light's wavelengths.
    if not (min(tag.power) >= 0 and max(tag.power) > 0):
        raise LinkError("the light of the viewing conditions ('svcn') has no power")
    matching = np.array(tag.matching).reshape(3, -1) @ interpolation(light, eye.wavelengths)
    x, y, z = tag.white
    observer = next((n for n, c in _OBSERVER_CODES.items() if c == tag.observer), CUSTOM)
    name = ILLUMINANTS.get(tag.illuminant, CUSTOM)
    white: XYZ = (x / y, 1.0, z / y)
    if (tag.illuminant, tag.observer) == (1, 1) and np.allclose(white, STANDARD_WHITE, atol=1e-3):
        white = STANDARD_WHITE
    return ViewingConditions(
        white=white,
        illuminant=name,
        temperature=tag.temperature,
        observer=observer,
        grid=light,
        power=np.array(tag.power),
        matching=matching,
        luminance=y,
        surround=tag.surround,
    )


def profile_white(profile: Profile) -> XYZ:
    """The white of a profile's XYZ: of its viewing conditions, or of its header."""
    stated = stated_conditions(profile)
    if stated is not None:
        return stated.white
    white = profile.header.illuminant
    if white == D50:
        return STANDARD_WHITE
    if not min(white) > 0:
        raise LinkError(f"the profile's illuminant is {white}: no light has that")
    return white
