"""The names of the format as data: device classes and colour spaces; the tags stand in tags.py.

A signature is four characters of text here ("A2M0", "mdv "), and "" where the file has four zero
bytes. Only colour spaces are bytes, because some end in a binary count: `nc0005` in print is
6E 63 00 05 in a file.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from brdfc.source.errors import ProfileError

# --- device classes -----------------------------------------------------------------------------

Requirement = tuple[tuple[str, ...], ...]
"""Alternatives, each a set of tags that must all be there."""


def _any_of(*families: str) -> Requirement:
    """One of the four tags of these families, e.g. A2B0 to A2B3."""
    return tuple((f"{family}{n}",) for family in families for n in "0123")


class DeviceClass(NamedTuple):
    """A device class: its name, and the requirements of which each must be met from version 5 on,
    and before, where versions 2 and 4 ask for others."""

    name: str
    required: tuple[Requirement, ...]
    before_5: tuple[Requirement, ...] = ()

    def requirements(self, major_version: int) -> tuple[Requirement, ...]:
        """What a profile of a version must have."""
        return self.before_5 if self.before_5 and major_version < 5 else self.required


_TO_PCS = _any_of("A2B", "D2B")
_FROM_PCS = _any_of("B2A", "B2D")
_MATRIX = ("rXYZ", "gXYZ", "bXYZ", "rTRC", "gTRC", "bTRC")
_GRAY = ("kTRC",)
_TABLES = tuple(f"{family}{n}" for family in ("A2B", "B2A") for n in "012")
_NAMES: Requirement = (("mcta",),)

# MID, MVIS and MLNK: the stricter reading, the transform and the names; the reference's earlier
# releases accept either alone.
DEVICE_CLASSES: dict[str, DeviceClass] = {
    "mid ": DeviceClass("multiplex identification", ((("A2M0",),), _NAMES)),
    "mvis": DeviceClass("multiplex visualization", (_any_of("M2B", "M2S"), _NAMES)),
    "mlnk": DeviceClass("multiplex link", ((("M2A0",),), _NAMES)),
    "scnr": DeviceClass("input", ((*_TO_PCS, _MATRIX, _GRAY),), ((("A2B0",), _MATRIX, _GRAY),)),
    "mntr": DeviceClass(
        "display",
        ((*_TO_PCS, _MATRIX, _GRAY), (*_FROM_PCS, _MATRIX, _GRAY)),
        ((("A2B0", "B2A0"), _MATRIX, _GRAY),),
    ),
    "prtr": DeviceClass(
        "output",
        ((*_TO_PCS, _GRAY), (*_FROM_PCS, _GRAY)),
        tuple(((tag,), _GRAY) for tag in (*_TABLES, "gamt")),
    ),
    "spac": DeviceClass("colour space", (_TO_PCS, _FROM_PCS), ((("A2B0", "B2A0"),),)),
    "abst": DeviceClass("abstract", (_TO_PCS,), ((("A2B0",),),)),
    "link": DeviceClass("device link", ((("A2B0",), ("D2B0",)),), ((("A2B0",),), (("pseq",),))),
    "nmcl": DeviceClass("named colour", ((("ncl2",), ("nmcl",)),), ((("ncl2",),),)),
    "cenc": DeviceClass("colour encoding", ((("rfnm",),),)),
}
MULTIPLEX_CLASSES = ("mid ", "mvis", "mlnk")

# Tags that make no sense in a class, beside a multiplex connection space for example. A printer of
# one ink has a kTRC, although the reference warns of it.
NOT_IN: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(MULTIPLEX_CLASSES, (*_TABLES, "pseq", "gamt", "ncl2")),
    "nmcl": (*_TABLES, "pseq", "gamt"),
    "abst": ("A2B1", "A2B2", "B2A1", "B2A2", "ncl2", "gamt"),
    "link": ("A2B1", "A2B2", "B2A1", "B2A2", "ncl2", "gamt", "wtpt"),
}
ONLY_IN_INPUT_AND_DISPLAY = (*_MATRIX, "cicp")

# --- colour spaces ------------------------------------------------------------------------------

NO_SPACE = bytes(4)

# Samples of the ordinary spaces; 2CLR..FCLR are added below.
SPACE_SIZES: dict[bytes, int] = {
    b"GRAY": 1,
    b"XYZ ": 3,
    b"Lab ": 3,
    b"Luv ": 3,
    b"YCbr": 3,
    b"Yxy ": 3,
    b"RGB ": 3,
    b"HSV ": 3,
    b"HLS ": 3,
    b"CMY ": 3,
    b"CMYK": 4,
}
SPACE_SIZES |= {b"%XCLR" % n: n for n in range(2, 16)}
COUNTED_SPACES = (b"nc", b"mc", b"rs", b"ts", b"es", b"bs", b"sm")
"""Prefixes followed by a binary u16 count: device, multiplex, and the spectral PCSs."""

_COUNTED_TEXT = re.compile("(nc|mc|rs|ts|es|bs|sm)([0-9A-Fa-f]{4})")


def counted_space(prefix: str, count: int) -> bytes:
    """The signature of a space with a binary count, e.g. ("rs", 31) for 31 reflectances."""
    if prefix.encode() not in COUNTED_SPACES:
        raise ProfileError(f"'{prefix}' does not begin a colour space with a count")
    if not 1 <= count <= 0xFFFF:
        raise ProfileError(f"a colour space has 1 to 65535 channels, not {count}")
    return prefix.encode() + count.to_bytes(2, "big")


def n_channel_space(count: int) -> bytes:
    """The device space of so many channels: n_channel_space(5) is 6E 63 00 05."""
    return counted_space("nc", count)


def multiplex_space(count: int) -> bytes:
    """The multiplex connection space of so many channels: multiplex_space(5) is 6D 63 00 05."""
    return counted_space("mc", count)


def space_channels(space: bytes) -> int | None:
    """How many channels a space has; 0 for no space, None for one that is not known."""
    if space == NO_SPACE:
        return 0
    if space[:2] in COUNTED_SPACES and space not in SPACE_SIZES:
        return int.from_bytes(space[2:], "big") or None
    return SPACE_SIZES.get(space)


def space_text(space: bytes) -> str:
    """A space as people write it: "nc0005" (the count in hexadecimal), "XYZ ", "" for none."""
    if space[:2] in COUNTED_SPACES and space not in SPACE_SIZES:
        return space[:2].decode() + space[2:].hex().upper()
    return signature_text(space)


def space_from_text(text: str) -> bytes:
    """The inverse of space_text: "nc0005", "RGB" or "RGB "; "" is no space."""
    counted = _COUNTED_TEXT.fullmatch(text)
    if counted:
        return counted[1].encode() + bytes.fromhex(counted[2])
    return signature_bytes(text.ljust(4) if text else text)


# --- signatures as text -------------------------------------------------------------------------


def signature_text(data: bytes) -> str:
    """Four bytes as text; any byte is kept (Latin-1), four zeros are ""."""
    return data.decode("latin-1") if data != NO_SPACE else ""


def signature_bytes(text: str) -> bytes:
    """Four characters as bytes, "" as four zeros."""
    try:
        data = text.encode("latin-1") if text else NO_SPACE
    except UnicodeEncodeError:
        data = b""
    if len(data) != 4:
        raise ProfileError(f"a signature is four Latin-1 characters, not {text!r}")
    return data
