"""What a user can say of a file of measurements that the file itself leaves open."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields

from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import MeasurementError


@dataclass(frozen=True)
class Declared:
    """None, or nothing, where it is not said.

    unit: of units.UNITS; angles: of units.ANGLES; mirror: of units.MIRRORS; white: X, Y, Z of the
    light of XYZ values; wavelength: nm, the one to keep, or that of a single value; floor: values
    below it are the instrument's, and dropped; columns: names of columns by what they mean (see
    columns.ROLES); directions: "plane" or "even", what to draw of a dense table; count: how many.
    """

    unit: str | None = None
    angles: str | None = None
    mirror: str | None = None
    white: tuple[float, float, float] | None = None
    wavelength: float | None = None
    floor: float | None = None
    columns: Mapping[str, str] = field(default_factory=dict)
    directions: str | None = None
    count: int | None = None

    @property
    def said(self) -> list[str]:
        """The names of what is said."""
        return [f.name for f in fields(self) if getattr(self, f.name) not in (None, {})]


def declared(**said: object) -> Declared:
    """Declared from keywords; MeasurementError for one that is none."""
    known = {f.name for f in fields(Declared)}
    for name in said:
        if name not in known:
            hint = did_you_mean(name, known) or ", ".join(sorted(known))
            raise MeasurementError(f"nothing of a file is called '{name}'", hint=hint)
    return Declared(**said)  # type: ignore[arg-type]
