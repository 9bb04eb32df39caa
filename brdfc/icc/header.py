"""The 128 bytes a profile begins with (ICC.2, 7.2)."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass

from brdfc.icc.signatures import NO_SPACE, signature_bytes, signature_text
from brdfc.source.errors import ProfileError

HEADER_SIZE = 128

D50 = (0x0000F6D6 / 65536, 1.0, 0x0000D32D / 65536)
"""The PCS illuminant, exactly as s15Fixed16 holds it."""

# No clock: the same input gives the same bytes on any day.
FIXED_DATE = (2020, 1, 1, 0, 0, 0)

# One format for reading and writing; the fields in the order of the file.
#   size cmm version class space pcs | date | acsp platform flags manufacturer model attributes
#   intent illuminant creator id | spectral PCS, range, bi-spectral range, MCS, subclass, reserved
_LAYOUT = struct.Struct(">I4sI4s4s4s 6H 4s4sI4s4sQ I3i4s16s 4seeHeeH4s4sI")
_SINCE_VERSION_5 = 100
"""Where the fields begin that were reserved before version 5."""


@dataclass(frozen=True)
class SpectralRange:
    """Wavelengths in nanometres, first and last, and how many steps; all 0 where unused."""

    start: float = 0.0
    end: float = 0.0
    steps: int = 0


@dataclass(frozen=True)
class Header:
    """Every field but the file's size and `acsp`, which the writer knows.

    Signatures are text ("mid ", "" for zero); colour spaces are bytes, see signatures.py. The
    illuminant is XYZ; creation_date year, month, day, hour, minute, second in UTC.
    """

    device_class: str
    colour_space: bytes = NO_SPACE
    pcs: bytes = NO_SPACE
    mcs: bytes = NO_SPACE
    spectral_pcs: bytes = NO_SPACE
    spectral_range: SpectralRange = SpectralRange()
    bispectral_range: SpectralRange = SpectralRange()
    version: int = 0x05000000
    creation_date: tuple[int, int, int, int, int, int] = FIXED_DATE
    flags: int = 0
    attributes: int = 0
    rendering_intent: int = 0
    illuminant: tuple[float, float, float] = D50
    cmm: str = ""
    platform: str = ""
    manufacturer: str = ""
    model: str = ""
    creator: str = ""
    device_subclass: str = ""
    profile_id: bytes = bytes(16)
    reserved: int = 0

    @property
    def major_version(self) -> int:
        return self.version >> 24

    @property
    def device_space(self) -> bytes:
        """The space of the device's channels.

        An MLNK has it as PCS in the specification, as data colour space for the reference.
        """
        swapped = self.device_class == "mlnk" and self.colour_space == NO_SPACE
        return self.pcs if swapped else self.colour_space

    def encode(self, size: int) -> bytes:
        """The 128 bytes of a profile of this size."""
        spaces = (self.colour_space, self.pcs, self.spectral_pcs, self.mcs)
        if any(len(space) != 4 for space in spaces) or len(self.profile_id) != 16:
            raise ProfileError("colour spaces are 4 bytes and the profile ID 16", where="header")
        try:
            return _LAYOUT.pack(
                size,
                signature_bytes(self.cmm),
                self.version,
                signature_bytes(self.device_class),
                self.colour_space,
                self.pcs,
                *self.creation_date,
                b"acsp",
                signature_bytes(self.platform),
                self.flags,
                signature_bytes(self.manufacturer),
                signature_bytes(self.model),
                self.attributes,
                self.rendering_intent,
                *(round(value * 65536) for value in self.illuminant),
                signature_bytes(self.creator),
                self.profile_id,
                self.spectral_pcs,
                *_range_fields(self.spectral_range),
                *_range_fields(self.bispectral_range),
                self.mcs,
                signature_bytes(self.device_subclass),
                self.reserved,
            )
        except (struct.error, OverflowError, ValueError) as error:
            raise ProfileError(f"a field does not fit: {error}", where="header") from error

    @staticmethod
    def decode(data: bytes, where: str) -> Header:
        """The header of a profile's bytes, of which there are at least 128.

        The size field and `acsp` are the caller's to check.
        """
        head = data[:HEADER_SIZE]
        if head[8] < 5:
            head = head[:_SINCE_VERSION_5] + bytes(HEADER_SIZE - _SINCE_VERSION_5)
        fields = _LAYOUT.unpack(head)
        _, cmm, version, device_class, colour_space, pcs = fields[:6]
        _, platform, flags, manufacturer, model, attributes = fields[12:18]
        intent, x, y, z, creator, profile_id = fields[18:24]
        spectral_pcs, start, end, steps, bi_start, bi_end, bi_steps = fields[24:31]
        mcs, device_subclass, reserved = fields[31:]
        if not all(math.isfinite(value) for value in (start, end, bi_start, bi_end)):
            raise ProfileError(
                "a spectral range is not a finite number of nanometres",
                where=f"{where}, header at byte 104",
            )
        return Header(
            device_class=signature_text(device_class),
            colour_space=colour_space,
            pcs=pcs,
            mcs=mcs,
            spectral_pcs=spectral_pcs,
            spectral_range=SpectralRange(start, end, steps),
            bispectral_range=SpectralRange(bi_start, bi_end, bi_steps),
            version=version,
            creation_date=fields[6:12],
            flags=flags,
            attributes=attributes,
            rendering_intent=intent,
            illuminant=(x / 65536, y / 65536, z / 65536),
            cmm=signature_text(cmm),
            platform=signature_text(platform),
            manufacturer=signature_text(manufacturer),
            model=signature_text(model),
            creator=signature_text(creator),
            device_subclass=signature_text(device_subclass),
            profile_id=profile_id,
            reserved=reserved,
        )


def _range_fields(spectral: SpectralRange) -> tuple[float, float, int]:
    return spectral.start, spectral.end, spectral.steps
