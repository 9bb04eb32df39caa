"""Profiles connected: samples of an image in, values of a connection space out.

A MID and an MVIS connect by the names of their channels, byte for byte. A channel that the MID
lacks takes the MVIS's default (`mdv `), or 0. The reference engine connects profiles with no name
in common at all, silently; here that is an error. A profile of device values, such as one with the
angles among its channels, needs no other.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from brdfc.cmm.environment import environment_of
from brdfc.cmm.transforms import (
    Values,
    check_colours,
    device_transform,
    pipeline,
    transform_variables,
)
from brdfc.engine import runs
from brdfc.engine.choice import Engine, engine_named
from brdfc.engine.tables import Interpolation, interpolation_named
from brdfc.engine.trace import Chain, Route
from brdfc.icc.profile import Profile
from brdfc.icc.types import Dictionary, NumberArray, Utf8Array
from brdfc.lang.types import TYPES
from brdfc.lang.values import parse_value
from brdfc.profiles.brdf_function import ANGLES
from brdfc.profiles.metadata import Described, describe, describe_constants
from brdfc.source.errors import LinkError, ValueGivenError

ProfileOrPath = Profile | str | Path


@dataclass(frozen=True)
class Link:
    """Connected profiles with the variables of a run.

    channels: the names of the samples of a pixel. profile: the last, in whose connection space the
    values are; transform: the tag that leads there. defaulted: the names of the channels that take
    their default. environment: variables by signature, see engine.interpreter.run. described: what
    the first says of its channels. samples: the names of an image's samples, where the profile was
    compiled for one and takes only some of them. chain: the elements of the profiles' transforms,
    and the route between them. engine, threads, interpolation: how it is run, see engine.runs.
    """

    channels: tuple[str, ...]
    chain: Chain
    profile: Profile
    transform: str
    defaulted: tuple[str, ...]
    environment: Mapping[str, ArrayLike]
    described: tuple[Described, ...]
    samples: tuple[str, ...] = ()
    engine: Engine = Engine.AUTO
    threads: int | None = None
    interpolation: Interpolation = Interpolation.LINEAR

    @property
    def inputs(self) -> int:
        """Samples of a pixel."""
        return len(self.channels)

    @property
    def outputs(self) -> int:
        """Values of a colour: 3 for XYZ, one a wavelength for reflectances."""
        return runs.outputs_of(self.chain, self.inputs)

    def apply(self, pixels: ArrayLike, total: int | None = None) -> Values:
        """Colours (..., outputs), float32, for pixels (..., channels); a white has Y = 1, or
        reflectances of 1. Pixels may lie interleaved or in planes, which is quicker.

        total: how many pixels are to come in all, where these are a part of them.
        Raises ProgramError when the last axis has another length.
        """
        return runs.run(
            self.chain,
            self.inputs,
            pixels,
            self.environment,
            engine=self.engine,
            threads=self.threads,
            total=total,
            interpolation=self.interpolation,
        )

    def together(
        self, others: Sequence[Link], pixels: ArrayLike, total: int | None = None
    ) -> list[Values]:
        """The colours of this link and of others of the same profiles, in one pass over pixels."""
        array = np.asarray(pixels, dtype=np.float32)
        links = [self, *others]
        shape = (*array.shape[:-1], self.outputs)
        results = [np.empty(shape, np.float32) for _ in links]
        runs.sweep(
            self.chain,
            self.inputs,
            array,
            [link.environment for link in links],
            results,
            engine=self.engine,
            threads=self.threads,
            total=total,
            interpolation=self.interpolation,
        )
        return results

    def sweep(
        self, pixels: ArrayLike, /, *, extrapolate: bool = False, **variables: ArrayLike
    ) -> Values:
        """Colours of the same pixels for several values of variables, in one pass over the pixels.

        variables: by name or signature, in radians for angles: a number each, or an array; arrays
        go side by side, as NumPy broadcasts them. All others are as in the link. Returns (...,
        pixels..., outputs), the axes of the variables first: `sweep(pixels, incident=0.7,
        reflection=[-0.5, 0, 0.5])` gives three images. Raises as connect and apply do.
        """
        array = np.asarray(pixels, dtype=np.float32)
        shape, environments = self._environments(variables, extrapolate)
        results = np.empty((len(environments), *array.shape[:-1], self.outputs), np.float32)
        runs.sweep(
            self.chain,
            self.inputs,
            array,
            environments,
            list(results),
            engine=self.engine,
            threads=self.threads,
            interpolation=self.interpolation,
        )
        return results.reshape(*shape, *results.shape[1:])

    def _environments(
        self, variables: Mapping[str, ArrayLike], extrapolate: bool
    ) -> tuple[tuple[int, ...], list[Mapping[str, ArrayLike]]]:
        """The variables of every run of a sweep, and the shape that they are to have."""
        arrays = [_numbers(name, given) for name, given in variables.items()]
        try:
            values = np.broadcast_arrays(*arrays)
        except ValueError:
            sizes = ", ".join(
                f"{n} has {np.size(v):,}" for n, v in zip(variables, arrays, strict=True)
            )
            raise ValueGivenError(
                f"the values of a sweep do not go side by side: {sizes}",
                hint="give as many values of each, or one",
            ) from None
        shape = values[0].shape if values else ()
        found: list[Mapping[str, ArrayLike]] = []
        for place in np.ndindex(shape):
            here = {n: float(v[place]) for n, v in zip(variables, values, strict=True)}
            more = environment_of(self.profile, self.transform, here, extrapolate)
            found.append({**self.environment, **more})
        return shape, found


def connect(
    *profiles: ProfileOrPath,
    env: Mapping[str, float] | None = None,
    transform: str | None = None,
    extrapolate: bool = False,
    engine: Engine | str = Engine.AUTO,
    threads: int | None = None,
    interpolation: Interpolation | str = Interpolation.LINEAR,
) -> Link:
    """Connect a MID to an MVIS, or make ready a single profile of device values.

    env: variables of the run, by the model's name or by four-letter signature, in radians for
    angles. transform: the tag of the last profile to use: "M2B0" (the usual one) or "M2S0" of an
    MVIS, "A2B1" or "bAB0" of a profile of device values. extrapolate: take variables outside the
    ranges that the profile states too. engine: what runs it, a choice.Engine or its name. threads:
    as many as there are processors where None. interpolation: of lookup tables of three inputs, a
    tables.Interpolation or its name; others are always linear.
    Raises ProfileError for what is no profile, LinkError for profiles that do not connect,
    ValueGivenError for variables that do not exist or are outside their range.
    """
    loaded = [_profile(p) for p in profiles]
    if len(loaded) == 1:
        link = _single(loaded[0], env or {}, transform, extrapolate)
    elif len(loaded) == 2:
        link = _pair(loaded[0], loaded[1], env or {}, transform or "M2B0", extrapolate)
    else:
        raise LinkError(
            f"{len(loaded)} profiles do not connect",
            hint="give a MID and an MVIS, or one profile of device values",
        )
    return replace(
        link,
        engine=engine_named(engine),
        threads=threads,
        interpolation=interpolation_named(interpolation),
    )


def _pair(
    source: Profile,
    destination: Profile,
    env: Mapping[str, float],
    transform: str,
    extrapolate: bool,
) -> Link:
    _check_class(source, "mid ", "first", "a MID")
    _check_class(destination, "mvis", "second", "an MVIS")
    first, second = pipeline(source, "A2M0"), pipeline(destination, transform)
    check_colours(destination, transform, second.outputs)
    given, wanted = _names(source), _names(destination)
    if (len(given), len(wanted)) != (first.outputs, second.inputs):
        raise LinkError("the channel names ('mcta') do not match the transforms' channels")
    sources = tuple(given.index(name) if name in given else None for name in wanted)
    if all(index is None for index in sources):
        raise LinkError(
            f"the profiles have no channel in common: {', '.join(given)} and {', '.join(wanted)}",
            hint="compile both from one model, or check that the names agree byte for byte",
        )
    defaults = destination.tags.get("mdv ")
    values = defaults.values if isinstance(defaults, NumberArray) else (0.0,) * len(wanted)
    if len(values) != len(wanted):
        raise LinkError(f"{len(values)} defaults ('mdv ') for {len(wanted)} channels")
    return Link(
        given if first.inputs == len(given) else tuple(map(str, range(first.inputs))),
        (*first.elements, Route(sources, values), *second.elements),
        destination,
        transform,
        tuple(n for n, index in zip(wanted, sources, strict=True) if index is None),
        environment_of(destination, transform, env, extrapolate),
        (*describe(source, "channel"), *describe(source, "unread"), *_fixed(source)),
        scene_samples(source),
    )


def _single(
    profile: Profile, env: Mapping[str, float], transform: str | None, extrapolate: bool = False
) -> Link:
    found = transform or device_transform(profile)
    only = pipeline(profile, found)
    check_colours(profile, found, only.outputs)
    described = describe(profile, "channel")
    names = tuple(name for d in described for name in d.component_names)
    if found.startswith("b") and len(names) + len(ANGLES) == only.inputs:
        # Angles come first, and the profile describes the rest.
        names, described = (*ANGLES, *names), ()
    if len(names) != only.inputs:
        names, described = tuple(map(str, range(only.inputs))), ()
    environment = environment_of(profile, found, env, extrapolate)
    return Link(names, only.elements, profile, found, (), environment, described)


def connect_alone(profile: Profile, env: Mapping[str, float] | None = None) -> Link:
    """A profile without another: of device values, or an MVIS whose channels are given directly,
    as no colour engine takes them. Raises as connect does."""
    if profile.header.device_class != "mvis":
        return _single(profile, env or {}, None)
    only, names = pipeline(profile, "M2B0"), _names(profile)
    check_colours(profile, "M2B0", only.outputs)
    if len(names) != only.inputs:
        raise LinkError("the channel names ('mcta') do not match the transform's channels")
    environment = environment_of(profile, "M2B0", env or {})
    described = describe(profile, "channel")
    return Link(names, only.elements, profile, "M2B0", (), environment, described)


def channel_defaults(link: Link) -> tuple[float, ...]:
    """A value for every channel of a link that was made alone: the profile's, or 0."""
    stated = link.profile.tags.get("mdv ")
    if isinstance(stated, NumberArray) and len(stated.values) == len(link.channels):
        return stated.values
    known = {
        name: value
        for d in link.described
        for name, value in zip(d.component_names, d.default, strict=True)
    }
    return tuple(known.get(name, 0.0) for name in link.channels)


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


def variable_names(link: Link) -> dict[str, str]:
    """The signature of every variable a link's transform reads, by the model's name for it, or by
    the signature where the profile does not say."""
    known = transform_variables(link.profile, link.transform)
    return {(d.name if d else s): s for s, d in known}


def _numbers(name: str, given: ArrayLike) -> NDArray[np.float64]:
    try:
        return np.asarray(given, np.float64)
    except (TypeError, ValueError):
        raise ValueGivenError(
            f"the values of '{name}' are no numbers", hint="angles are given in radians"
        ) from None


def _profile(given: ProfileOrPath) -> Profile:
    return given if isinstance(given, Profile) else Profile.load(given)


def _check_class(profile: Profile, wanted: str, place: str, name: str) -> None:
    found = profile.header.device_class
    if found != wanted:
        raise LinkError(
            f"the {place} profile must be {name} (class '{wanted}'), this is of class '{found}'",
            hint="give the MID first, then the MVIS" if found in ("mid ", "mvis") else None,
        )


def _names(profile: Profile) -> tuple[str, ...]:
    tag = profile.tags.get("mcta")
    if not isinstance(tag, Utf8Array):
        raise LinkError("the profile names no channels ('mcta')")
    return tag.names
