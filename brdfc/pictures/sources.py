"""What a picture is of: a model or a profile with values for its coefficients, as a user says it.

ward
ward with ks=0.1 m=0.2 Rd=(0.1,0.2,0.3) as cyan
lamp_mvis.icc with ks=0.1
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from brdfc.colour.conditions import ViewingConditions
from brdfc.source.errors import ValueGivenError

Array = NDArray[np.float64]
XYZ = tuple[float, float, float]

INCIDENT, REFLECTION = "incident", "reflection"
AZIMUTHS = ("incident_azimuth", "reflection_azimuth")
DIRECTIONS = (INCIDENT, REFLECTION, *AZIMUTHS)


class Subject(Protocol):
    """Something whose colours can be asked for.

    label: its name in a picture; white: of its XYZ, Y = 1; full: directions are zeniths and
    azimuths; ranges: of its angles by name, radians, where it says.
    """

    @property
    def label(self) -> str: ...

    @property
    def white(self) -> XYZ: ...

    @property
    def full(self) -> bool: ...

    @property
    def ranges(self) -> Mapping[str, tuple[float, float]]: ...

    def colours(self, angles: Mapping[str, Array]) -> Array:
        """XYZ (points, 3) for angles (points,) in radians by name; those it does not have are left
        aside. ValueGivenError where it has no angle at all."""
        ...

    def adapted(self, xyz: Array, adapt: str | None, transform: str) -> tuple[Array, XYZ]:
        """XYZ as it comes to another white (see cmm.rendering), None for its own, and that white;
        transform: of colour.adaptation."""
        ...


@dataclass(frozen=True)
class Source:
    """reference: a model's name or file, or a profile's file; values: as text by name."""

    reference: str
    values: Mapping[str, str] = field(default_factory=dict)
    label: str = ""

    @property
    def is_profile(self) -> bool:
        return self.reference.lower().endswith((".icc", ".icm"))


_WHOLE = re.compile(r"(?P<reference>.+?)(?:\s+with\s+(?P<values>.+?))?(?:\s+as\s+(?P<label>.+))?")
_VALUE = re.compile(r"([A-Za-z_]\w*)=(\([^()]*\)|[^\s(),]+)\s*,?")


def source(text: str, more: Mapping[str, str]) -> Source:
    """A source as a user writes it: REFERENCE [with NAME=VALUE ...] [as LABEL].

    more: values for every source. Raises ValueGivenError.
    """
    found = _WHOLE.fullmatch(text.strip())
    if not found:
        raise ValueGivenError("a source is the name of a model, or the file of a model or profile")
    values = dict(more)
    rest = found["values"] or ""
    position = 0
    while position < len(rest):
        one = _VALUE.match(rest, position)
        if not one:
            raise ValueGivenError(
                f"'{rest[position:]}' in '{text}' is no NAME=VALUE",
                hint="write: ward with ks=0.1 Rd=(0.1,0.2,0.3) as LABEL",
            )
        values[one[1]] = one[2]
        position = one.end() + len(rest[one.end() :]) - len(rest[one.end() :].lstrip())
    reference = found["reference"]
    return Source(reference, values, found["label"] or Path(reference).stem)


def angles_of(text: str) -> Array:
    """Angles in radians of `-80deg..80deg,5deg`; ValueGivenError for any other text."""
    found = re.fullmatch(
        r"(-?\d+\.?\d*)(?:deg)?\.\.(-?\d+\.?\d*)(?:deg)?,(\d+\.?\d*)(?:deg)?", text.replace(" ", "")
    )
    if not found:
        raise ValueGivenError(f"'{text}' is no range of angles", hint="write -80deg..80deg,5deg")
    low, high, step = (float(number) for number in found.groups())
    if not (low < high and step > 0 and (high - low) / step <= 20_000):
        raise ValueGivenError(f"'{text}' goes nowhere, or in too many steps")
    count = math.floor((high - low) / step + 1e-9) + 1
    return np.radians(np.arange(count, dtype=np.float64) * step + low)


def angle_of(text: str) -> float:
    """An angle in radians of `30deg` or `0.5rad`; ValueGivenError for any other text."""
    from brdfc.lang.types import TYPES
    from brdfc.lang.values import parse_value

    return parse_value(text, TYPES["angle"], "angle")[0]


def open_subjects(
    sources: Sequence[Source],
    geometry: str | None,
    conditions: ViewingConditions | None,
    highlight: str | None,
    usual: str | None = None,
) -> list[Subject]:
    """The subjects of sources. geometry, conditions, highlight and usual: of those that are models,
    see model_subject."""
    from brdfc.pictures.models import model_subject
    from brdfc.pictures.profiles import profile_subject

    subjects: list[Subject] = []
    for one in sources:
        if one.is_profile:
            subjects.append(profile_subject(one))
        else:
            subjects.append(model_subject(one, geometry, conditions, highlight, usual))
    labels = [s.label for s in subjects]
    for label in labels:
        if labels.count(label) > 1:
            raise ValueGivenError(
                f"two sources are called '{label}'", hint="name them: ward with m=0.2 as LABEL"
            )
    return subjects
