"""A profile's part in a chain: which of its transforms it takes, and from what to what.

A profile is used from its device to the connection space, or the other way round, by what comes
before it. The tags are tried in the order of the ICC's engine (`CIccXform::Create`): the rendering
intent asked for, then those that can stand for it; `D2B` of each before its `A2B`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from brdfc.calc.program import Element, OpaqueElement
from brdfc.cmm.connection import Triple, from_lab, inverse_scaling, named_space, scaling, to_lab
from brdfc.cmm.device import lut_elements, matrix_shaper
from brdfc.cmm.intents import TRIED, Intent, adjustment
from brdfc.cmm.roles import FROM_DEVICE, IDENTIFY, TO_DEVICE, Kind, Role, Space, role_of, spaces
from brdfc.cmm.transforms import (
    Transform,
    Variables,
    check_fit,
    leads_to_reflectances,
    variables_of,
)
from brdfc.engine.elements import changes_nothing
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import space_channels
from brdfc.icc.types import Pipeline
from brdfc.profiles.brdf_function import ANGLES
from brdfc.profiles.conditions import profile_white
from brdfc.source.errors import LinkError


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
    role = role_of(profile, given, following)
    takes, gives = spaces(profile, role)
    if given is not None and given != takes:
        order = "give the MID first, then the MVIS" if role is IDENTIFY else None
        raise LinkError(f"{given} do not go into a profile that takes {takes}", hint=order)
    wanted = intent
    if wanted is None:
        wanted = _USUAL.get(role.takes, _USUAL.get(role.gives, Intent.RELATIVE))
    found = transform or _found(profile, role, wanted)
    if found is None:
        return _shaped(profile, role, takes, gives, wanted)
    tag = _asked(profile, role, found)
    _check_device(found, takes, tag.inputs)
    _check_device(found, gives, tag.outputs)
    if leads_to_reflectances(profile, found):
        gives = Space(Kind.REFLECTANCES)
    if transform is not None and intent is None:
        wanted = Intent(int(found[3]))
    elements = _in_space(profile, found, tag, takes, gives, wanted)
    own = tag.elements if isinstance(tag, Pipeline) else ()
    variables = variables_of(profile, found, own)
    return Stage(profile, found, takes, gives, tag.inputs, elements, variables)


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
    for number in TRIED[wanted]:
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


def _check_device(signature: str, space: Space, count: int) -> None:
    """That a transform has as many channels as the device of its profile; a BRDF function's has its
    angles before them."""
    known = space_channels(space.device) if space.kind is Kind.DEVICE else None
    if known and known + len(ANGLES) * signature.startswith("b") != count:
        raise LinkError(f"'{signature}' has {count} channels, and {space} are {known}")


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
    adjust = adjustment(profile, wanted, Intent(int(signature[3])), to_black)
    return _from_and_to_xyz(profile, inner, *sides, adjust)


def _shaped(profile: Profile, role: Role, takes: Space, gives: Space, wanted: Intent) -> Stage:
    """The stage of a profile that has tone curves, and a matrix where it has colours."""
    inverse = role is TO_DEVICE
    shaper = matrix_shaper(profile, inverse) if inverse or role is FROM_DEVICE else None
    if shaper is None and takes.kind is not Kind.COLOURS and gives.kind is not Kind.COLOURS:
        raise LinkError(f"the profile has no '{role.families[0]}{TRIED[wanted][0]}' transform")
    if shaper is None:
        tags = [f"{family}{n}" for family in role.families for n in TRIED[wanted]]
        raise LinkError(
            f"the profile (class '{profile.header.device_class}') has no transform from "
            f"{takes} to {gives} that can be run",
            hint=f"one of {', '.join(dict.fromkeys(tags))} is needed",
        )
    adjust = adjustment(profile, wanted, Intent.RELATIVE, to_black=True)
    elements = _from_and_to_xyz(profile, shaper.elements, inverse, not inverse, adjust)
    return Stage(profile, shaper.name, takes, gives, 3 if inverse else shaper.channels, elements)


def _from_and_to_xyz(
    profile: Profile,
    inner: tuple[Element, ...],
    from_xyz: bool,
    to_xyz: bool,
    adjust: tuple[Triple, Triple] | None,
) -> tuple[Element, ...]:
    """Elements between X, Y, Z instead of the profile's own connection space, adjusted."""
    white, is_lab = profile_white(profile), profile.header.pcs == b"Lab "
    before: list[Element] = []
    after: list[Element] = []
    if from_xyz:
        if adjust:
            before.append(inverse_scaling(*adjust))
        if is_lab:
            before.append(to_lab(white))
    if to_xyz:
        if is_lab:
            after.append(from_lab(white))
        if adjust:
            after.append(scaling(*adjust))
    return (*before, *inner, *after)
