"""A profile's part in a chain: which of its transforms it takes, and from what to what.

A profile is used from its device to the connection space, or the other way round, by what comes
before it. The tags are tried in the order of the ICC's engine (`CIccXform::Create`): the rendering
intent asked for, then those that can stand for it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum, IntEnum
from typing import NamedTuple

from brdfc.calc.program import Element, OpaqueElement
from brdfc.cmm.connection import Triple, from_lab, named_space, scaling, to_lab
from brdfc.cmm.device import lut_elements, matrix_shaper
from brdfc.cmm.transforms import (
    Transform,
    Variables,
    check_fit,
    leads_to_reflectances,
    variables_of,
)
from brdfc.engine.elements import changes_nothing
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import NO_SPACE
from brdfc.icc.types import Pipeline, XYZArray
from brdfc.profiles.conditions import profile_white
from brdfc.source.errors import LinkError


class Intent(IntEnum):
    """Rendering intents, by the number in the names of tags."""

    PERCEPTUAL = 0
    RELATIVE = 1
    SATURATION = 2
    ABSOLUTE = 3


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


@dataclass(frozen=True)
class Stage:
    """transform: the tag, or "matrix" or "gray" for a profile of tone curves. Colours are X, Y, Z
    (see connection.py), whatever the profile's connection space. variables: those that its programs
    read."""

    profile: Profile
    transform: str
    takes: Space
    gives: Space
    inputs: int
    elements: tuple[Element, ...]
    variables: Variables = ()


class Role(NamedTuple):
    """families: how the names of the tags begin, in the order they are tried; others: those that
    are taken only if they are asked for."""

    takes: Kind
    gives: Kind
    families: tuple[str, ...]
    others: tuple[str, ...] = ()


_IDENTIFY = Role(Kind.DEVICE, Kind.MULTIPLEX, ("A2M",))
_VISUALIZE = Role(Kind.MULTIPLEX, Kind.COLOURS, ("M2B",), ("M2S",))
_LINK_BACK = Role(Kind.MULTIPLEX, Kind.DEVICE, ("M2A",))
_FROM_DEVICE = Role(Kind.DEVICE, Kind.COLOURS, ("D2B", "A2B"), ("bAB", "bDB"))
_TO_DEVICE = Role(Kind.COLOURS, Kind.DEVICE, ("B2D", "B2A"))
_ABSTRACT = Role(Kind.COLOURS, Kind.COLOURS, ("D2B", "A2B"))
_DEVICE_LINK = Role(Kind.DEVICE, Kind.DEVICE, ("A2B",))

_ONLY = {"mid ": _IDENTIFY, "mvis": _VISUALIZE, "mlnk": _LINK_BACK}
_ONLY |= {"abst": _ABSTRACT, "link": _DEVICE_LINK}
"""The classes that can be used in one way alone."""
_NEVER = {"nmcl": "names colours", "cenc": "names an encoding"}

_ORDER: dict[Intent | None, tuple[int, ...]] = {
    Intent.PERCEPTUAL: (0, 1, 3),
    Intent.RELATIVE: (1, 3, 0),
    Intent.SATURATION: (2, 0, 1, 3),
    Intent.ABSOLUTE: (3, 1, 0),
}
"""The tags that are tried for an intent, by their numbers."""
_USUAL = {Kind.MULTIPLEX: Intent.PERCEPTUAL}
"""What is meant where no intent is asked for: of channels the tag 0, as the ICC's engine takes it
whatever it is asked for; of devices colours relative to the medium."""


def stage_of(
    profile: Profile,
    given: Space | None,
    following: Profile | None,
    intent: Intent | None,
    transform: str | None,
) -> Stage:
    """The stage of a profile in a chain.

    given: what comes before it, if anything. following: the profile after it. transform: the tag
    that is asked for. Raises LinkError where the profile cannot stand here, or its program cannot
    be proven safe.
    """
    role = _role(profile, given, following)
    takes, gives = _spaces(profile, role)
    if given is not None and given != takes:
        order = "give the MID first, then the MVIS" if role is _IDENTIFY else None
        raise LinkError(f"{given} do not go into a profile that takes {takes}", hint=order)
    wanted = intent
    if wanted is None:
        wanted = _USUAL.get(role.takes, _USUAL.get(role.gives, Intent.RELATIVE))
    found = transform or _found(profile, role, wanted)
    if found is None:
        return _shaped(profile, role, takes, gives, wanted)
    tag = _asked(profile, role, found)
    if leads_to_reflectances(profile, found):
        gives = Space(Kind.REFLECTANCES)
    if transform is not None and intent is None:
        wanted = Intent(int(found[3]))
    elements = _in_space(profile, found, tag, takes, gives, wanted)
    own = tag.elements if isinstance(tag, Pipeline) else ()
    variables = variables_of(profile, found, own)
    return Stage(profile, found, takes, gives, tag.inputs, elements, variables)


def _role(profile: Profile, given: Space | None, following: Profile | None) -> Role:
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
        return _TO_DEVICE
    # An input profile with multiplex channels stands for a MID where channels are what is taken.
    takes_channels = following is not None and (
        following.header.device_class in ("mvis", "mlnk") or _has(following, "M2B")
    )
    return _IDENTIFY if takes_channels and _has(profile, "A2M") else _FROM_DEVICE


def _has(profile: Profile, family: str) -> bool:
    return any(f"{family}{n}" in profile.tags for n in "0123")


def _spaces(profile: Profile, role: Role) -> tuple[Space, Space]:
    header = profile.header
    device = Space(Kind.DEVICE, header.device_space)
    takes = device if role.takes is Kind.DEVICE else Space(role.takes)
    gives = device if role.gives is Kind.DEVICE else Space(role.gives)
    if role is _DEVICE_LINK:
        gives = Space(Kind.DEVICE, header.pcs)
    return takes, gives


# --- which tag ------------------------------------------------------------------------------------


def _found(profile: Profile, role: Role, wanted: Intent) -> str | None:
    """The first tag there is that can be run, of those that can stand for an intent."""
    found = None
    for signature in _tried(role, wanted):
        tag = profile.tags.get(signature)
        if tag is None or leads_to_reflectances(profile, signature):
            continue
        found = found or signature
        if not isinstance(tag, Pipeline) or _known(tag):
            return signature
    return found


def _tried(role: Role, wanted: Intent) -> Iterator[str]:
    for number in _ORDER[wanted]:
        for family in role.families:
            yield f"{family}{number}"


def _known(pipeline: Pipeline) -> bool:
    """Whether every element can be run; the ICC's engine too passes over those it cannot."""
    return all(not isinstance(e, OpaqueElement) or changes_nothing(e) for e in pipeline.elements)


def _asked(profile: Profile, role: Role, signature: str) -> Transform:
    if signature[:3] not in (*role.families, *role.others) or signature[3:] not in set("0123"):
        raise LinkError(
            f"'{signature}' does not lead from {role.takes.value} to {role.gives.value}",
            hint=", ".join(f"{family}..." for family in (*role.families, *role.others)),
        )
    tag = profile.tags.get(signature)
    if not isinstance(tag, Transform):
        spectral = "compile the model with --spectral 400nm..700nm,10nm"
        hint = spectral if signature.startswith(("M2S", "D2B")) else None
        raise LinkError(f"the profile has no '{signature}' transform", hint=hint)
    return tag


# --- what it does ---------------------------------------------------------------------------------


def _in_space(
    profile: Profile, signature: str, tag: Transform, takes: Space, gives: Space, wanted: Intent
) -> tuple[Element, ...]:
    """The elements of a transform, from and to X, Y, Z where it is one of colours."""
    sides = (takes.kind is Kind.COLOURS, gives.kind is Kind.COLOURS)
    check_fit(tag, signature)
    if isinstance(tag, Pipeline):
        inner = tag.elements
    else:
        inner = lut_elements(tag, profile.header.pcs, *sides)
    if not any(sides):
        return inner
    for side, count in zip(sides, (tag.inputs, tag.outputs), strict=True):
        if side and (count, profile.header.pcs) not in ((3, b"XYZ "), (3, b"Lab ")):
            space = named_space(profile.header.pcs)
            raise LinkError(f"'{signature}' leads to {count} values of '{space}', not to X, Y, Z")
    to_black = not isinstance(tag, Pipeline) and profile.header.major_version < 4
    adjustment = _adjustment(profile, wanted, Intent(int(signature[3])), to_black)
    return _from_and_to_xyz(profile, inner, *sides, adjustment)


def _shaped(profile: Profile, role: Role, takes: Space, gives: Space, wanted: Intent) -> Stage:
    """The stage of a profile that has tone curves, and a matrix where it has colours."""
    inverse = role is _TO_DEVICE
    shaper = matrix_shaper(profile, inverse) if inverse or role is _FROM_DEVICE else None
    if shaper is None and takes.kind is not Kind.COLOURS and gives.kind is not Kind.COLOURS:
        raise LinkError(f"the profile has no '{role.families[0]}{_ORDER[wanted][0]}' transform")
    if shaper is None:
        tags = [f"{family}{n}" for family in role.families for n in _ORDER[wanted]]
        raise LinkError(
            f"the profile (class '{profile.header.device_class}') has no transform from "
            f"{takes} to {gives} that can be run",
            hint=f"one of {', '.join(dict.fromkeys(tags))} is needed",
        )
    adjustment = _adjustment(profile, wanted, Intent.RELATIVE, to_black=True)
    elements = _from_and_to_xyz(profile, shaper.elements, inverse, not inverse, adjustment)
    return Stage(profile, shaper.name, takes, gives, 3 if inverse else shaper.channels, elements)


def _from_and_to_xyz(
    profile: Profile,
    inner: tuple[Element, ...],
    from_xyz: bool,
    to_xyz: bool,
    adjustment: tuple[Triple, Triple] | None,
) -> tuple[Element, ...]:
    """Elements between X, Y, Z instead of the profile's own connection space, adjusted."""
    white, is_lab = profile_white(profile), profile.header.pcs == b"Lab "
    before: list[Element] = []
    after: list[Element] = []
    if from_xyz:
        if adjustment:
            before.append(_inverse(*adjustment))
        if is_lab:
            before.append(to_lab(white))
    if to_xyz:
        if is_lab:
            after.append(from_lab(white))
        if adjustment:
            after.append(scaling(*adjustment))
    return (*before, *inner, *after)


def _inverse(factors: Triple, offsets: Triple) -> Element:
    x, y, z = (1 / f for f in factors)
    a, b, c = (-o / f for o, f in zip(offsets, factors, strict=True))
    return scaling((x, y, z), (a, b, c))


_BLACK: Triple = (0.00336, 0.0034731, 0.00287)
"""X, Y, Z of the perceptual reference medium's black point (ICC.1:2022, 6.3.4.3)."""


def _adjustment(
    profile: Profile, wanted: Intent, found: Intent, to_black: bool
) -> tuple[Triple, Triple] | None:
    """Factors and offsets from the profile's X, Y, Z to those of an intent; None for none.

    Absolute colours are those relative to the medium times its white. to_black: the profile's
    perceptual colours reach down to black, where the reference medium's do not: those of tables
    before version 4, and of tone curves.
    """
    white = profile_white(profile)
    power = (wanted is Intent.ABSOLUTE) - (found is Intent.ABSOLUTE)
    if power:
        x, y, z = ((m / w) ** power for m, w in zip(_media_white(profile), white, strict=True))
        return (x, y, z), (0.0, 0.0, 0.0)
    if wanted is Intent.PERCEPTUAL and to_black and profile.header.device_class != "abst":
        x, y, z = (1 - b / w for b, w in zip(_BLACK, white, strict=True))
        return (x, y, z), _BLACK
    return None


def _media_white(profile: Profile) -> Triple:
    tag = profile.tags.get("wtpt")
    if not isinstance(tag, XYZArray) or len(tag.values) != 1 or not min(tag.values[0]) > 0:
        raise LinkError(
            "the profile states no white of its medium ('wtpt'), which absolute colours need"
        )
    return tag.values[0]
