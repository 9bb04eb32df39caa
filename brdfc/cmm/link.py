"""A MID and an MVIS, connected: samples of an image in, XYZ out.

Channels connect by name, byte for byte. One the MID lacks takes the MVIS's default (`mdv `), or 0.
The reference engine connects profiles with no name in common at all, silently; here that is an
error.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from brdfc.calc.program import Program
from brdfc.calc.verify import verify
from brdfc.engine.interpreter import run
from brdfc.icc.profile import Profile
from brdfc.icc.types import NumberArray, Pipeline, Utf8Array
from brdfc.profiles.metadata import Described, describe, value_text
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import LinkError, ProgramError, ValueGivenError

ProfileOrPath = Profile | str | Path


@dataclass(frozen=True)
class Link:
    """Two connected profiles with the variables of a run.

    channels: the names of the samples of a pixel. sources: for each channel of the MVIS the
    index of the MID's channel, or None where it takes its default. defaulted: the names of those.
    """

    channels: tuple[str, ...]
    first: Pipeline
    second: Pipeline
    sources: tuple[int | None, ...]
    defaults: tuple[float, ...]
    defaulted: tuple[str, ...]
    environment: Mapping[str, float]
    described: tuple[Described, ...]

    def apply(self, pixels: ArrayLike) -> NDArray[np.float32]:
        """XYZ (..., 3), float32, for pixels (..., channels); Y is 1 for white.

        Raises ProgramError when the last axis has another length.
        """
        connected = _run(self.first, pixels, self.environment)
        shape = connected.shape[:-1]
        columns = [
            connected[..., source] if source is not None else np.full(shape, default, np.float32)
            for source, default in zip(self.sources, self.defaults, strict=True)
        ]
        return _run(self.second, np.stack(columns, axis=-1), self.environment)


def connect(
    mid: ProfileOrPath, mvis: ProfileOrPath, env: Mapping[str, float] | None = None
) -> Link:
    """Connect a MID to an MVIS.

    env: variables of the run, by the model's name or by four-letter signature, in radians for
    angles. Raises ProfileError for what is no profile, LinkError for profiles that do not
    connect, ValueGivenError for variables that do not exist or are outside their range.
    """
    source, destination = _profile(mid), _profile(mvis)
    _check_class(source, "mid ", "first", "a MID")
    _check_class(destination, "mvis", "second", "an MVIS")
    first, second = _pipeline(source, "A2M0"), _pipeline(destination, "M2B0")
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
    described = describe(source, "channel")
    channels = given if first.inputs == len(given) else tuple(map(str, range(first.inputs)))
    return Link(
        channels,
        first,
        second,
        sources,
        values,
        tuple(n for n, index in zip(wanted, sources, strict=True) if index is None),
        _environment(destination, env or {}),
        described,
    )


def transform_variables(mvis: Profile) -> tuple[tuple[str, Described | None], ...]:
    """The variables an MVIS's transform reads: signature, and its description if it has one."""
    described = {d.signature: d for d in describe(mvis, "env")}
    signatures: dict[str, None] = {}
    for element in _pipeline(mvis, "M2B0").elements:
        if isinstance(element, Program):
            try:
                signatures |= dict.fromkeys(verify(element).variables)
            except ProgramError as error:
                raise LinkError(f"the profile's program is refused: {error}") from error
    return tuple((s, described.get(s)) for s in signatures if s not in ("true", "ndef"))


def _environment(mvis: Profile, given: Mapping[str, float]) -> dict[str, float]:
    """Values by signature for a run; by name or signature in what is given."""
    known = transform_variables(mvis)
    by_name = {name: (s, d) for s, d in known for name in ((s, d.name) if d else (s,))}
    environment = {}
    for name, value in given.items():
        if name not in by_name:
            listed = ", ".join(d.name if d else s for s, d in known) or "none"
            raise ValueGivenError(
                f"the profile has no variable '{name}'",
                hint=did_you_mean(name, by_name) or f"its variables: {listed}",
            )
        signature, described = by_name[name]
        if signature in environment:
            raise ValueGivenError(f"'{name}' is given twice, by name and by signature")
        environment[signature] = _in_range(name, value, described)
    return environment


def _in_range(name: str, value: float, described: Described | None) -> float:
    """A variable's value as float32 has it; ValueGivenError where the model does not reach."""
    if not math.isfinite(value):
        raise ValueGivenError(f"{name}={value} is not a finite number")
    rounded = float(np.float32(value))
    if described and not np.float32(described.low) <= rounded <= np.float32(described.high):
        shown = value_text((value,), described.type)
        raise ValueGivenError(
            f"{name}={shown} lies outside the profile's range {described.range_text}"
        )
    return rounded


def _run(
    pipeline: Pipeline, pixels: ArrayLike, environment: Mapping[str, float]
) -> NDArray[np.float32]:
    values = np.asarray(pixels, dtype=np.float32)
    if values.ndim == 0 or values.shape[-1] != pipeline.inputs:
        raise ProgramError(f"{pipeline.inputs} channels are needed, the array is {values.shape}")
    for element in pipeline.elements:
        values = run(element, values, environment)
    return values


def _profile(given: ProfileOrPath) -> Profile:
    return given if isinstance(given, Profile) else Profile.load(given)


def _check_class(profile: Profile, wanted: str, place: str, name: str) -> None:
    found = profile.header.device_class
    if found != wanted:
        raise LinkError(
            f"the {place} profile must be {name} (class '{wanted}'), this is of class '{found}'",
            hint="give the MID first, then the MVIS" if found in ("mid ", "mvis") else None,
        )


def _pipeline(profile: Profile, signature: str) -> Pipeline:
    tag = profile.tags.get(signature)
    if not isinstance(tag, Pipeline):
        raise LinkError(f"the profile has no '{signature}' transform")
    channels = tag.inputs
    for element in tag.elements:
        if element.inputs != channels:
            raise LinkError(f"the elements of '{signature}' do not fit each other's channels")
        channels = element.outputs
    if channels != tag.outputs:
        raise LinkError(f"the elements of '{signature}' do not fit its {tag.outputs} outputs")
    return tag


def _names(profile: Profile) -> tuple[str, ...]:
    tag = profile.tags.get("mcta")
    if not isinstance(tag, Utf8Array):
        raise LinkError("the profile names no channels ('mcta')")
    return tag.names
