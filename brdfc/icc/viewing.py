"""`svcn`: the light, the observer and the surround that colours are meant for (ICC.2, 10.2.25)."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from typing import ClassVar

from brdfc.icc.header import SpectralRange
from brdfc.icc.layout import unpack
from brdfc.icc.tag import Tag
from brdfc.source.errors import ProfileError

XYZ = tuple[float, float, float]

OBSERVERS = {0: "custom", 1: "CIE 1931 2 degree", 2: "CIE 1964 10 degree"}
"""The codes of standard observers."""

ILLUMINANTS = {
    0: "custom",
    **dict(enumerate(("D50", "D65", "D93", "F2", "D55", "A", "E", "F8"), start=1)),
    **dict(enumerate(("blackbody", "daylight", "B", "C", "F1", "F3", "F4"), start=9)),
    **dict(enumerate(("F5", "F6", "F7", "F9", "F10", "F11", "F12"), start=16)),
}
"""The codes of standard illuminants; blackbody and daylight go with a colour temperature."""


@dataclass(frozen=True)
class SpectralViewingConditions(Tag):
    """Codes of OBSERVERS and ILLUMINANTS, and the spectra themselves.

    matching: the colour matching functions, all of x, then y, then z, over observer_range; power:
    the illuminant's spectral power over illuminant_range, relative. white and surround: XYZ in
    cd/m2. temperature: kelvin, or 0.
    """

    type_signature: ClassVar[str] = "svcn"
    observer: int
    observer_range: SpectralRange
    matching: tuple[float, ...]
    illuminant: int
    temperature: float
    illuminant_range: SpectralRange
    power: tuple[float, ...]
    white: XYZ
    surround: XYZ

    def encode(self) -> bytes:
        for name, values, steps in (
            ("observer", self.matching, 3 * self.observer_range.steps),
            ("illuminant", self.power, self.illuminant_range.steps),
        ):
            if len(values) != steps:
                raise ProfileError(f"{len(values)} values of the {name}, its range says {steps}")
        _refuse_not_finite((*self.matching, *self.power, *self.white, *self.surround), "'svcn'")
        try:
            return (
                struct.pack(">4sII", b"svcn", 0, self.observer)
                + _range_bytes(self.observer_range)
                + struct.pack(f">{len(self.matching)}f", *self.matching)
                + struct.pack(">If", self.illuminant, self.temperature)
                + _range_bytes(self.illuminant_range)
                + struct.pack(f">{len(self.power)}f", *self.power)
                + struct.pack(">6f", *self.white, *self.surround)
            )
        except (struct.error, OverflowError) as error:
            raise ProfileError(f"'svcn' cannot hold a value: {error}") from error

    @staticmethod
    def decode(data: bytes, where: str) -> SpectralViewingConditions:
        observer, *observer_range = unpack("IeeH2x", data, 8, where)
        place = 20
        matching = unpack(f"{3 * observer_range[2]}f", data, place, where)
        place += 4 * len(matching)
        illuminant, temperature, *illuminant_range = unpack("IfeeH2x", data, place, where)
        place += 16
        power = unpack(f"{illuminant_range[2]}f", data, place, where)
        x, y, z, *surround = unpack("6f", data, place + 4 * len(power), where)
        ends = (*observer_range, *illuminant_range, temperature)
        _refuse_not_finite((*ends, *matching, *power, x, y, z, *surround), where)
        return SpectralViewingConditions(
            observer,
            SpectralRange(*observer_range),
            matching,
            illuminant,
            temperature,
            SpectralRange(*illuminant_range),
            power,
            (x, y, z),
            (surround[0], surround[1], surround[2]),
        )


def _range_bytes(spectral: SpectralRange) -> bytes:
    return struct.pack(">eeHH", spectral.start, spectral.end, spectral.steps, 0)


def _refuse_not_finite(values: tuple[float, ...], where: str) -> None:
    if not all(map(math.isfinite, values)):
        raise ProfileError("a value is not a finite number", where=where)
