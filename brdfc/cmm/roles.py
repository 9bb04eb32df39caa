"""What a profile does in a chain, by its class and what stands before it: from its device to the
connection space, or the other way round."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from brdfc.cmm.connection import named_space
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import NO_SPACE
from brdfc.source.errors import LinkError


class Kind(Enum):
    """What the values between profiles are."""

    DEVICE = "device values"
    MULTIPLEX = "multiplex channels"
    COLOURS = "colours"
    REFLECTANCES = "reflectances"


class Space(NamedTuple):
    """device: which, of device values."""

    kind: Kind
    device: bytes = NO_SPACE

    def __str__(self) -> str:
        named = self.kind is Kind.DEVICE
        return f"{self.kind.value} of {named_space(self.device)}" if named else self.kind.value


class Role(NamedTuple):
    """families: how the names of the tags begin, in the order they are tried; others: those that
    are taken only if they are asked for."""

    takes: Kind
    gives: Kind
    families: tuple[str, ...]
    others: tuple[str, ...] = ()


IDENTIFY = Role(Kind.DEVICE, Kind.MULTIPLEX, ("A2M",))
_VISUALIZE = Role(Kind.MULTIPLEX, Kind.COLOURS, ("M2B",), ("M2S",))
_LINK_BACK = Role(Kind.MULTIPLEX, Kind.DEVICE, ("M2A",))
FROM_DEVICE = Role(Kind.DEVICE, Kind.COLOURS, ("D2B", "A2B"), ("bAB", "bDB"))
TO_DEVICE = Role(Kind.COLOURS, Kind.DEVICE, ("B2D", "B2A"))
_ABSTRACT = Role(Kind.COLOURS, Kind.COLOURS, ("D2B", "A2B"))
_DEVICE_LINK = Role(Kind.DEVICE, Kind.DEVICE, ("A2B",))

_ONLY = {"mid ": IDENTIFY, "mvis": _VISUALIZE, "mlnk": _LINK_BACK}
_ONLY |= {"abst": _ABSTRACT, "link": _DEVICE_LINK}
"""The classes that can be used in one way alone."""
_NEVER = {"nmcl": "names colours", "cenc": "names an encoding"}


def role_of(profile: Profile, given: Space | None, following: Profile | None) -> Role:
    """given: what comes before the profile, if anything. following: the profile after it.

    Raises LinkError where the profile has no place.
    """
    kind = profile.header.device_class
    if kind in _NEVER:
        raise LinkError(f"a profile of class '{kind}' {_NEVER[kind]}: it has no place in a chain")
    if given is not None and given.kind is Kind.MULTIPLEX:
        if kind not in ("mvis", "mlnk") and not _has(profile, "M2B"):
            raise LinkError(
                f"after a MID the next profile must be an MVIS, this is of class '{kind}'",
                hint="an MVIS (class 'mvis') or an MLNK ('mlnk') takes multiplex channels",
            )
        return _ONLY.get(kind, _VISUALIZE)
    if kind in _ONLY:
        return _ONLY[kind]
    if given is not None and given.kind is Kind.COLOURS:
        return TO_DEVICE
    # An input profile with multiplex channels stands for a MID where channels are what is taken.
    takes_channels = following is not None and (
        following.header.device_class in ("mvis", "mlnk") or _has(following, "M2B")
    )
    return IDENTIFY if takes_channels and _has(profile, "A2M") else FROM_DEVICE


def _has(profile: Profile, family: str) -> bool:
    return any(f"{family}{n}" in profile.tags for n in "0123")


def spaces(profile: Profile, role: Role) -> tuple[Space, Space]:
    """What a profile takes and gives in a role."""
    header = profile.header
    device = Space(Kind.DEVICE, header.device_space)
    takes = device if role.takes is Kind.DEVICE else Space(role.takes)
    gives = device if role.gives is Kind.DEVICE else Space(role.gives)
    if role is _DEVICE_LINK:
        gives = Space(Kind.DEVICE, header.pcs)
    return takes, gives
