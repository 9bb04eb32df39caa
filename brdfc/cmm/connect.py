"""Profiles connected: samples of an image in, values of a connection space or a device out.

Any chain that the ICC's engine connects: a MID to an MVIS by the names of their channels, colours
through XYZ or CIELAB to the profile of a display or a printer, device values to device values. A
channel that the MID lacks takes the MVIS's default (`mdv `), or 0. The reference engine connects
profiles with no name in common at all, silently; here that is an error.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

from brdfc.cmm.connection import (
    channel_names,
    channels_between,
    colours_joined,
    component_names,
)
from brdfc.cmm.environment import environment_of
from brdfc.cmm.intents import Intent
from brdfc.cmm.link import Link
from brdfc.cmm.roles import Kind
from brdfc.cmm.stages import Stage, stage_of
from brdfc.engine import runs
from brdfc.engine.choice import Engine, engine_named
from brdfc.engine.tables import Interpolation, interpolation_named
from brdfc.engine.trace import Chain
from brdfc.icc.profile import Profile
from brdfc.icc.types import Dictionary
from brdfc.lang.types import TYPES
from brdfc.lang.values import parse_value
from brdfc.profiles.brdf_function import ANGLES
from brdfc.profiles.metadata import Described, describe, describe_constants
from brdfc.source.errors import LinkError, ValueGivenError

ProfileOrPath = Profile | str | Path


def connect(
    *profiles: ProfileOrPath,
    env: Mapping[str, float] | None = None,
    transform: str | None = None,
    intent: Intent | str | None = None,
    extrapolate: bool = False,
    engine: Engine | str = Engine.AUTO,
    threads: int | None = None,
    interpolation: Interpolation | str = Interpolation.LINEAR,
) -> Link:
    """Connect profiles, the first the one that the samples are of: a MID to an MVIS, to the profile
    of a display or printer; device values to colours, and on.

    env: variables of the run, by the model's name or by four-letter signature, in radians for
    angles; each profile that reads one gets it. transform: the tag of the last profile to use:
    "M2B0" (the usual one) or "M2S0" of an MVIS, "A2B1" or "bAB0" of a profile of device values.
    intent: an Intent, or its name; None for colours relative to the medium. extrapolate: take
    variables outside the ranges that the profiles state too. engine: what runs it, a choice.Engine
    or its name. threads: as many as there are processors where None. interpolation: of lookup
    tables of three inputs, a tables.Interpolation or its name; others are always linear.
    Raises ProfileError for what is no profile, LinkError for profiles that do not connect, or whose
    programs cannot be proven safe, ValueGivenError for variables that do not exist or are outside
    their range.
    """
    loaded = [_profile(p) for p in profiles]
    if not loaded:
        raise LinkError("no profiles to connect")
    if loaded[0].header.device_class == "mvis":
        raise LinkError(
            f"the first of {len(loaded)} profiles is an MVIS, and it needs a MID", hint=_ORDER
        )
    stages = _stages(loaded, intent_named(intent), transform)
    if stages[-1].gives.kind is Kind.MULTIPLEX:
        raise LinkError(
            f"the last of {len(loaded)} profiles is a MID, and it needs an MVIS", hint=_ORDER
        )
    link = _joined(stages, env or {}, extrapolate)
    return replace(
        link,
        engine=engine_named(engine),
        threads=threads,
        interpolation=interpolation_named(interpolation),
    )


_ORDER = "give the MID first, then the MVIS"


def connect_alone(profile: Profile, env: Mapping[str, float] | None = None) -> Link:
    """A profile without another: of device values, or an MVIS whose channels are given directly,
    as no colour engine takes them. Raises as connect does."""
    return _joined(_stages([profile], None, None), env or {}, extrapolate=False)


def intent_named(given: Intent | str | None) -> Intent | None:
    """The intent of a name, in any case; ValueGivenError for another text."""
    if given is None or isinstance(given, Intent):
        return given
    try:
        return Intent[given.strip().upper()]
    except KeyError:
        names = ", ".join(i.name.lower() for i in Intent)
        raise ValueGivenError(f"'{given}' is no rendering intent", hint=names) from None


def _stages(
    profiles: Sequence[Profile], intent: Intent | None, transform: str | None
) -> tuple[Stage, ...]:
    """Each profile's part; a LinkError says which profile it is about."""
    stages: list[Stage] = []
    for index, profile in enumerate(profiles):
        following = profiles[index + 1] if index + 1 < len(profiles) else None
        given = stages[-1].gives if stages else None
        asked = transform if following is None else None
        try:
            stages.append(stage_of(profile, given, following, intent, asked))
        except LinkError as error:
            places = [f"profile {index + 1} of {len(profiles)}"] if len(profiles) > 1 else []
            where = ", ".join([*places, *([error.where] if error.where else [])])
            raise LinkError(error.message, where=where or None, hint=error.hint) from error
    return tuple(stages)


def _joined(stages: tuple[Stage, ...], env: Mapping[str, float], extrapolate: bool) -> Link:
    """The link of stages that fit each other."""
    chain: Chain = stages[0].elements
    missing: tuple[str, ...] = ()
    for place, (before, after) in enumerate(pairwise(stages), 2):
        if before.gives.kind is Kind.MULTIPLEX:
            route, missing = channels_between(before.profile, after.profile)
            _check_names(before, after)
            chain += (route, *after.elements)
        elif before.gives.kind is Kind.COLOURS:
            chain = colours_joined(chain, before.profile, after.profile, after.elements)
        else:
            _check_counts(before, after, f"profile {place} of {len(stages)}")
            chain += after.elements
    channels, described = _samples(stages[0])
    environment = environment_of(stages, env, extrapolate)
    samples = scene_samples(stages[0].profile) if len(stages) > 1 else ()
    return Link(channels, chain, stages, missing, environment, described, samples)


def _check_counts(before: Stage, after: Stage, where: str) -> None:
    """That device values fit, of spaces too that say no count."""
    given = runs.outputs_of(before.elements, before.inputs)
    if given != after.inputs:
        raise LinkError(
            f"{given} values do not go into a profile that takes {after.inputs}", where=where
        )


def _check_names(before: Stage, after: Stage) -> None:
    """That both have as many names as channels."""
    given = runs.outputs_of(before.elements, before.inputs)
    names = len(channel_names(before.profile)), len(channel_names(after.profile))
    if names != (given, after.inputs):
        raise LinkError("the channel names ('mcta') do not match the transforms' channels")


def _samples(first: Stage) -> tuple[tuple[str, ...], tuple[Described, ...]]:
    """The names of the samples of a pixel, and what the profile says of them."""
    profile, count = first.profile, first.inputs
    if first.takes.kind is Kind.MULTIPLEX:
        names = channel_names(profile)
        if len(names) != count:
            raise LinkError("the channel names ('mcta') do not match the transform's channels")
        return names, describe(profile, "channel")
    described = describe(profile, "channel")
    if first.gives.kind is Kind.MULTIPLEX:
        names = channel_names(profile)
        described = (*described, *describe(profile, "unread"), *_fixed(profile))
    else:
        names = tuple(name for d in described for name in d.component_names)
        if first.transform.startswith("b") and len(names) + len(ANGLES) == count:
            return (*ANGLES, *names), ()  # angles come first, and the profile describes the rest
    if len(names) == count:
        return names, described
    if first.gives.kind is not Kind.MULTIPLEX:
        described = ()
    space = first.takes.device if first.takes.kind is Kind.DEVICE else b"XYZ "
    return component_names(space, count), described


def _fixed(profile: Profile) -> Iterator[Described]:
    """The quantities that a profile for a scene was compiled for one value of."""
    if not scene_samples(profile):
        return
    for name, text in describe_constants(profile).items():
        declared = TYPES["angle" if text.endswith("deg") else "number"]
        try:
            (value,) = parse_value(text, declared, name)
        except ValueGivenError:  # a colour, or a text that makes no sense
            continue
        yield Described(name, declared, value, value, (value,), "", "")


def scene_samples(profile: Profile) -> tuple[str, ...]:
    """The names of the samples of images that a profile for a scene was compiled for; none where
    it does not say."""
    meta = profile.tags.get("meta")
    return tuple((meta.get("scene.samples") or "").split()) if isinstance(meta, Dictionary) else ()


def _profile(given: ProfileOrPath) -> Profile:
    return given if isinstance(given, Profile) else Profile.load(given)
