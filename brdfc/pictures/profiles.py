"""A profile as the subject of a picture: an MVIS, or a profile of device values, on our engine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from brdfc.cmm.connect import connect_alone
from brdfc.cmm.link import Link, channel_defaults, variable_names
from brdfc.cmm.rendering import Rendering, rendering
from brdfc.icc.profile import Profile
from brdfc.lang.values import parse_value
from brdfc.pictures.sources import AZIMUTHS, DIRECTIONS, XYZ, Array, Source
from brdfc.profiles.metadata import Described, describe
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import LinkError, ValueGivenError


@dataclass(frozen=True)
class ProfileSubject:
    """pixel: a value for every channel. places: the channels that are directions, by name;
    variables: the signatures of the variables that are; open: what the profile says of both."""

    label: str
    link: Link
    pixel: tuple[float, ...]
    places: Mapping[str, int]
    variables: Mapping[str, str]
    open: Mapping[str, Described]

    @property
    def white(self) -> XYZ:
        return rendering(self.link).white

    @property
    def full(self) -> bool:
        return any(name in self.places or name in self.variables for name in AZIMUTHS)

    @property
    def ranges(self) -> Mapping[str, tuple[float, float]]:
        return {
            name: (d.origin + d.step * d.low, d.origin + d.step * d.high)
            for name, d in self.open.items()
        }

    def colours(self, angles: Mapping[str, Array]) -> Array:
        count = len(next(iter(angles.values())))
        pixels = np.tile(np.array(self.pixel, np.float32), (count, 1))
        for name, place in self.places.items():
            sample = self.open.get(name)
            pixels[:, place] = (
                (angles[name] - sample.origin) / sample.step if sample else angles[name]
            )
        run = {signature: angles[name] for name, signature in self.variables.items()}
        turned = replace(self.link, environment={**self.link.environment, **run})
        return turned.apply(pixels).astype(np.float64)

    def adapted(self, xyz: Array, adapt: str | None, transform: str) -> tuple[Array, XYZ]:
        found: Rendering = rendering(self.link, adapt=adapt, transform=transform)
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
        if not all(one.low <= v <= one.high for v in values):
            message = f"{name}={text} lies outside the profile's range {one.range_text}"
            raise ValueGivenError(message)
        if name in known:
            fixed[name] = values[0]
        else:
            pixel |= dict(zip(one.component_names, values, strict=True))
    open_angles = [n for n in DIRECTIONS if n not in source.values]
    places = {n: link.channels.index(n) for n in open_angles if n in link.channels}
    variables = {n: known[n] for n in open_angles if n in known}
    if not places and not variables:
        raise ValueGivenError(
            f"'{source.reference}' has no angle 'incident' or 'reflection' to turn",
            hint="a picture needs a profile that takes them as variables or from the pixel",
        )
    turned = {n: described[n] for n in (*places, *variables) if n in described}
    ready = connect_alone(profile, fixed)
    return ProfileSubject(source.label, ready, tuple(pixel.values()), places, variables, turned)
