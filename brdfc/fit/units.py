"""The units that files of measurements have their angles and their values in."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import MeasurementError

Array = NDArray[np.float64]

_GRAZING = 1e-6
"""Cosines below this divide nothing: the value is missing."""


@dataclass(frozen=True)
class Unit:
    """meaning: for people; brdfs: what a perfect unit of BRDF has in it, from the cosines of the
    zeniths of incidence and reflection."""

    meaning: str
    brdfs: Callable[[Array, Array], Array]


UNITS: Mapping[str, Unit] = {
    "brdf": Unit("BRDF f in 1/sr", lambda ci, co: np.ones_like(ci)),
    # CIE 17.4: the radiance over that of a perfect diffuser lit the same way.
    "radiance-factor": Unit("pi f", lambda ci, co: np.full_like(ci, math.pi)),
    "percent": Unit("radiance factor in percent", lambda ci, co: np.full_like(ci, 100 * math.pi)),
    # The radiance under a light that has unit irradiance on a surface that faces it.
    "brdf-cos-incident": Unit("f times the cosine of incidence", lambda ci, co: ci),
    # The cosine-corrected BSDF of ASTM E2387.
    "brdf-cos-reflection": Unit("f times the cosine of reflection", lambda ci, co: co),
}
"""By the name that files and options have for them."""
_OTHER_NAMES = {"1/sr": "brdf", "sr-1": "brdf", "bsdf": "brdf", "sr^-1": "brdf"}

ANGLES: Mapping[str, Callable[[Array], Array]] = {"degrees": np.radians, "radians": np.array}
"""The units of angle, and how they become radians."""
_ALL_BELOW = 1.6
"""Zeniths in degrees that are all below this are suspected to be radians."""
MIRRORS = {"+": 1.0, "-": -1.0}
"""In files without azimuths: the sign that the zenith of reflection has on the mirror side of light
at a positive zenith."""


def chosen(text: str, known: Mapping[str, object], what: str, where: str = "") -> str:
    """The name that a text means; MeasurementError, with the nearest, for none."""
    name = "-".join(text.strip().lower().split())
    name = name if name in known else _OTHER_NAMES.get(name, name)
    if name not in known:
        hint = did_you_mean(name, known) or ", ".join(known)
        raise MeasurementError(f"'{text}' is no {what}", where=where or None, hint=hint)
    return name


def to_brdf(values: Array, unit: str, incident: Array, reflection: Array) -> Array:
    """Values (n, k) in a unit of UNITS as BRDF in 1/sr; NaN where a cosine vanishes. incident and
    reflection: zeniths (n,), radians."""
    with np.errstate(all="ignore"):  # what is no number is refused with the rest of its row
        per_brdf = UNITS[unit].brdfs(np.cos(incident), np.cos(reflection))
        converted = values / np.where(per_brdf > _GRAZING, per_brdf, np.nan)[:, None]
    return np.asarray(converted)


def to_radians(zeniths: Array, unit: str, where: str) -> tuple[Array, str]:
    """Angles (n, 2) of a unit of ANGLES in radians, and a remark where they look like the other.

    Raises MeasurementError for zeniths that cannot be radians.
    """
    largest = float(np.nanmax(np.abs(zeniths), initial=0.0))
    if unit == "radians" and largest > math.pi:
        raise MeasurementError(
            f"a zenith of {largest:g} radians cannot be",
            where=where,
            hint="if the angles are degrees, say so: --angles degrees",
        )
    suspect = unit == "degrees" and 0.1 < largest < _ALL_BELOW
    remark = (
        f"no zenith is above {largest:.3g} degrees: if they are radians, say so: --angles radians"
    )
    return ANGLES[unit](zeniths), remark if suspect else ""
