"""From the connection space of a profile to colours for a purpose: XYZ, CIELAB or sRGB.

    reflectances --observer, light--> XYZ under the light --c2sp--> XYZ under D50
        --adaptation--> XYZ under another white --> CIELAB, or sRGB

A profile with a light of its own states how its colours come to D50 (`c2sp`), and its reflectances
become colours under any light.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from brdfc.cmm.connection import custom_conversion
from brdfc.cmm.link import Link
from brdfc.cmm.roles import Kind
from brdfc.colour.adaptation import adaptation_matrix, adaptation_transform
from brdfc.colour.conditions import (
    ViewingConditions,
    normalised_white,
    viewing_conditions,
)
from brdfc.colour.difference import D50, lab
from brdfc.colour.picture import srgb
from brdfc.colour.spectrum import Grid
from brdfc.engine.runs import run
from brdfc.icc.profile import Profile
from brdfc.icc.types import Pipeline
from brdfc.profiles.conditions import profile_white, stated_conditions
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import LinkError, ValueGivenError

XYZ = tuple[float, float, float]
Array = NDArray[np.float64]


class Target(Enum):
    """What colours are rendered to."""

    XYZ = "XYZ"
    LAB = "Lab"
    SRGB = "sRGB"
    SPECTRUM = "spectrum"
    DEVICE = "device"


def target(text: str) -> Target:
    """The target a user means; ValueGivenError, with the nearest, for another text."""
    for found in Target:
        if found.value.lower() == text.strip().lower():
            return found
    known = [t.value for t in Target]
    raise ValueGivenError(
        f"'{text}' is nothing to render to", hint=did_you_mean(text, known) or ", ".join(known)
    )


@dataclass(frozen=True)
class Rendering:
    """A link, and what becomes of its values.

    white: of the XYZ that comes out, or that CIELAB is relative to. observer: the matrix from
    reflectances to XYZ, if they are; to_standard: the profile's own way to D50, if it is taken;
    adaptation: the matrix after that, if any. bits: of a sample of sRGB, 8 or 16.
    """

    link: Link
    to: Target
    white: XYZ
    observer: Array | None = None
    to_standard: Pipeline | None = None
    adaptation: Array | None = None
    note: str = ""
    bits: int = 8

    @property
    def samples(self) -> int:
        """Numbers a pixel of the result has."""
        return self.link.outputs if self.to in _AS_THEY_ARE else 3

    @property
    def dtype(self) -> Any:
        """Of the result: integers for sRGB, float32 for all else."""
        if self.to is not Target.SRGB:
            return np.float32
        return np.uint8 if self.bits == 8 else np.uint16

    def apply(self, pixels: ArrayLike) -> NDArray[Any]:
        """(..., samples) for pixels (..., channels)."""
        return self.counted(pixels)[0]

    def counted(self, pixels: ArrayLike) -> tuple[NDArray[Any], int]:
        """The same, and how many pixels lay outside what sRGB can show; those are clipped to it,
        component by component."""
        return self.finished(self.link.apply(pixels))

    def finished(self, values: NDArray[np.float32]) -> tuple[NDArray[Any], int]:
        """As counted, of the link's own values (..., outputs)."""
        if self.to in _AS_THEY_ARE or (self.to is Target.XYZ and self.plain):
            return values, 0
        exact = self.colours(values)
        if self.to is Target.SRGB:
            picture, outside = srgb(exact, self.bits)
            return picture, int(outside.sum())
        if self.to is Target.LAB:
            exact = lab(exact, self.white)
        return exact.astype(np.float32), 0

    @property
    def plain(self) -> bool:
        """Whether the link's values are the colours that are wanted."""
        return self.observer is None and self.to_standard is None and self.adaptation is None

    def colours(self, values: ArrayLike) -> Array:
        """XYZ (..., 3) in float64, adapted, of values of the link (..., outputs)."""
        exact: Array = np.asarray(values, dtype=np.float64)
        if self.observer is not None:
            exact = exact @ self.observer.T
        if self.to_standard is not None:
            exact = run(self.to_standard.elements, 3, exact, {}).astype(np.float64)
        if self.adaptation is not None:
            exact = exact @ self.adaptation.T
        return exact


_AS_THEY_ARE = (Target.SPECTRUM, Target.DEVICE)
"""What is given as the link has it."""


def rendering(
    link: Link,
    to: Target | str | None = None,
    adapt: str | None = None,
    conditions: ViewingConditions | None = None,
    transform: str = "bradford",
) -> Rendering:
    """What becomes of a link's values.

    to: a Target, or its name; None for device values where the link leads to a device, and else for
    XYZ. adapt: the white that colours are adapted to: the name of an
    illuminant, X,Y,Z, or None for the profile's own; sRGB has D65, and needs none. conditions: the
    light and the observer that reflectances are seen with; the profile's own where None.
    transform: how colours are adapted where the profile does not say (see adaptation.TRANSFORMS).

    Raises LinkError where a profile does not say enough of its colours, and ValueGivenError for
    what makes no sense of this profile.
    """
    gives = link.gives.kind
    to = target(to) if isinstance(to, str) else to
    if to is None:
        to = Target.DEVICE if gives is Kind.DEVICE else Target.XYZ
    if (to is Target.DEVICE) != (gives is Kind.DEVICE) or gives is Kind.MULTIPLEX:
        raise LinkError(
            f"the profiles lead to {link.gives}, not to {_MEANT[to]}",
            hint="the profile of a display or printer as the last leads to device values, any "
            "other to colours",
        )
    spectral = gives is Kind.REFLECTANCES
    if to is Target.SPECTRUM and not spectral:
        raise LinkError("the profile has no reflectances to give", hint=_SPECTRAL)
    if to in _AS_THEY_ARE:
        if adapt is not None or conditions is not None:
            what = "reflectances" if spectral else "device values"
            raise ValueGivenError(f"a light or an adaptation changes no {what}")
        note = "reflectances" if spectral else ""
        return Rendering(link, to, (1.0, 1.0, 1.0), note=note)
    if conditions is not None and not spectral:
        raise LinkError(
            f"another light or observer needs reflectances, and '{link.transform}' leads to none",
            hint=f"leave out --transform, or {_SPECTRAL}",
        )
    if spectral:
        found = _of_reflectances(link, to, conditions)
    else:
        found = Rendering(link, to, profile_white(link.profile))
    return _adapted(found, adapt, adaptation_transform(transform))


_MEANT = dict.fromkeys(Target, "colours") | {Target.DEVICE: "device values"}
_SPECTRAL = "compile the model with --spectral 400nm..700nm,10nm"


def seen_conditions(
    link: Link, light: str | None, observed_by: str | None
) -> ViewingConditions | None:
    """The conditions that a profile's reflectances are seen under with another light or observer:
    of the two, what is not given is the profile's. None where neither is."""
    if light is None and observed_by is None:
        return None
    stated = stated_conditions(link.profile) or viewing_conditions()
    return stated.seen_with(light, observed_by)


def spectral_grid(profile: Profile) -> Grid:
    """The wavelengths of a profile's reflectances; LinkError where it has none."""
    found = profile.header.spectral_range
    if profile.header.spectral_pcs[:2] != b"rs" or found.steps < 2 or found.start >= found.end:
        raise LinkError("the profile's spectral connection space is not one of reflectances")
    return Grid(found.start, found.end, found.steps)


def adapted_xyz(
    xyz: ArrayLike, white: XYZ, adapt: str | None, transform: str = "bradford"
) -> tuple[Array, XYZ]:
    """XYZ (..., 3) under a white as it is under another, and that white.

    adapt and transform: as for rendering; to D50 by linear Bradford, and from there.
    """
    exact = np.asarray(xyz, dtype=np.float64)
    if adapt is None:
        return exact, white
    _, wanted = _white(adapt)
    onward = adaptation_matrix(D50, wanted, adaptation_transform(transform))
    both = onward @ adaptation_matrix(white, D50)
    return exact @ both.T, wanted


def _of_reflectances(link: Link, to: Target, conditions: ViewingConditions | None) -> Rendering:
    seen = conditions or stated_conditions(link.profile) or viewing_conditions()
    grid = spectral_grid(link.profile)
    if grid.steps != link.outputs:
        raise LinkError(f"{link.outputs} reflectances at {grid.steps:,} wavelengths")
    matrix = seen.reflectances_to_xyz(grid)
    return Rendering(link, to, seen.white, observer=matrix, note=f"under {seen}")


def _adapted(found: Rendering, adapt: str | None, transform: str) -> Rendering:
    if found.to is Target.SRGB:
        if adapt is not None and adapt.strip().upper() != "D65":
            raise ValueGivenError(f"sRGB is seen under D65, not {adapt}", hint="leave out --adapt")
        adapt = "D50"  # where the conversion to sRGB, which adapts to D65, starts from
    if adapt is None:
        return found
    name, white = _white(adapt)
    # Reflectances under another light than the profile's come to D50 as the user says.
    own = found.observer is None or _same(found.white, profile_white(found.link.profile))
    if found.white != D50 and own:
        found = replace(found, to_standard=custom_conversion(found.link.profile, "c2sp"), white=D50)
    if white != found.white:
        matrix = adaptation_matrix(found.white, white, transform)
        found = replace(found, adaptation=matrix, white=white)
    said = "" if found.to is Target.SRGB else f"adapted to {name}"
    return replace(found, note=", ".join(part for part in (found.note, said) if part))


def _same(a: XYZ, b: XYZ) -> bool:
    return bool(np.allclose(a, b, rtol=0, atol=1e-6))


def _white(text: str) -> tuple[str, XYZ]:
    """The name of a white, and X, Y, Z."""
    words = text.split(",")
    if len(words) == 1:
        return text.strip(), viewing_conditions(light=text).white
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        raise ValueGivenError(
            f"'{text}' is no white", hint="name an illuminant, or give three numbers X,Y,Z"
        ) from None
    return text, normalised_white(numbers)
