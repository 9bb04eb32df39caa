"""A profile as the subject of a picture: an MVIS, or a profile of device values, on our engine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from brdfc.cmm.link import Link, channel_defaults, connect_alone, variable_names
from brdfc.cmm.rendering import Rendering, rendering
from brdfc.icc.profile import Profile
from brdfc.lang.values import parse_value
from brdfc.pictures.sources import AZIMUTHS, INCIDENT, REFLECTION, XYZ, Array, Source
from brdfc.profiles.metadata import describe
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import LinkError, ValueGivenError

DIRECTIONS = (INCIDENT, REFLECTION, *AZIMUTHS)


@dataclass(frozen=True)
class ProfileSubject:
    """pixel: a value for every channel; places: the channels that are angles, by name; variables:
    the variables that are, by name."""

    label: str
    profile: Profile
    link: Link
    pixel: tuple[float, ...]
    places: Mapping[str, int]
    variables: frozenset[str]
    fixed: Mapping[str, float]

    @property
    def white(self) -> XYZ:
        return rendering(self.link).white

    @property
    def full(self) -> bool:
        return any(name in self.places or name in self.variables for name in AZIMUTHS)

    def colours(self, angles: Mapping[str, Array]) -> Array:
        count = len(next(iter(angles.values())))
        pixels = np.tile(np.array(self.pixel, np.float32), (count, 1))
        for name, place in self.places.items():
            pixels[:, place] = angles[name]
        runs = np.stack(
            [angles[name] for name in sorted(self.variables)] or [np.zeros(count)], axis=-1
        )
        result = np.empty((count, 3))
        # A variable is one for a whole run, so points with the same angles go together.
        keys, which = np.unique(runs, axis=0, return_inverse=True)
        for number, key in enumerate(keys):
            run = dict(zip(sorted(self.variables), key.tolist(), strict=False))
            chosen = which.ravel() == number
            link = connect_alone(self.profile, {**self.fixed, **run})
            result[chosen] = link.apply(pixels[chosen])
        return result

    def adapted(self, xyz: Array, adapt: str | None) -> tuple[Array, XYZ]:
        found: Rendering = rendering(self.link, adapt=adapt)
        return found.colours(xyz), found.white


def profile_subject(source: Source) -> ProfileSubject:
    """The subject of a profile: channels and variables that a source gives no value for have the
    profile's defaults, but directions."""
    profile = Profile.load(source.reference)
    link = connect_alone(profile, {})
    if link.outputs != 3:
        raise LinkError(f"'{source.reference}' gives {link.outputs} values, not X, Y, Z")
    described = {d.name: d for d in (*describe(profile, "channel"), *describe(profile, "env"))}
    pixel = dict(zip(link.channels, channel_defaults(link), strict=True))
    known = variable_names(link)
    fixed: dict[str, float] = {}
    for name, text in source.values.items():
        if name not in described:
            hint = did_you_mean(name, described) or f"it has {', '.join(described) or 'no names'}"
            raise ValueGivenError(f"'{source.reference}' has no quantity '{name}'", hint=hint)
        one = described[name]
        values = parse_value(text, one.type, name)
        if name in known:
            fixed[name] = values[0]
        else:
            pixel |= dict(zip(one.component_names, values, strict=True))
    open_angles = [n for n in DIRECTIONS if n not in source.values]
    places = {n: link.channels.index(n) for n in open_angles if n in link.channels}
    variables = frozenset(n for n in open_angles if n in known)
    if not places and not variables:
        raise ValueGivenError(
            f"'{source.reference}' has no angle 'incident' or 'reflection' to turn",
            hint="compile it without fixing them",
        )
    return ProfileSubject(
        source.label, profile, link, tuple(pixel.values()), places, variables, fixed
    )
