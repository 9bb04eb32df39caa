"""Profiles that are connected: samples of an image in, colours or device values out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from brdfc.cmm.connection import defaults
from brdfc.cmm.environment import environment_of
from brdfc.cmm.roles import Space
from brdfc.cmm.stages import Stage
from brdfc.engine import runs
from brdfc.engine.choice import Engine
from brdfc.engine.kernels import Values
from brdfc.engine.tables import Interpolation
from brdfc.engine.trace import Chain
from brdfc.icc.profile import Profile
from brdfc.profiles.metadata import Described
from brdfc.source.errors import ValueGivenError


@dataclass(frozen=True)
class Link:
    """Connected profiles with the variables of a run.

    channels: the names of the samples of a pixel. stages: the profiles' parts, one or more.
    defaulted: the names of the channels that take their default. environment: variables by
    signature, see engine.interpreter.run. described: what the first profile says of its channels.
    samples: the names of an image's samples, where the profile was compiled for one and takes only
    some of them. chain: the elements of the stages, and what stands between them. engine, threads,
    interpolation: how it is run, see engine.runs.
    """

    channels: tuple[str, ...]
    chain: Chain
    stages: tuple[Stage, ...]
    defaulted: tuple[str, ...]
    environment: Mapping[str, ArrayLike]
    described: tuple[Described, ...]
    samples: tuple[str, ...] = ()
    engine: Engine = Engine.AUTO
    threads: int | None = None
    interpolation: Interpolation = Interpolation.LINEAR

    @property
    def profile(self) -> Profile:
        """The last, in whose space the values are."""
        return self.stages[-1].profile

    @property
    def transform(self) -> str:
        """The tag of the last, or "matrix" or "gray"."""
        return self.stages[-1].transform

    @property
    def gives(self) -> Space:
        """What the values are: X, Y, Z of the last profile's light, reflectances, device values."""
        return self.stages[-1].gives

    @property
    def stated_variables(self) -> tuple[Described, ...]:
        """What the profiles say of the variables that they read."""
        known = (d for stage in self.stages for _, d in stage.variables)
        return tuple(d for d in known if d is not None)

    @property
    def inputs(self) -> int:
        """Samples of a pixel."""
        return len(self.channels)

    @property
    def outputs(self) -> int:
        """Values of a pixel that come out: 3 for XYZ, one a wavelength for reflectances."""
        return runs.outputs_of(self.chain, self.inputs)

    def apply(self, pixels: ArrayLike, total: int | None = None) -> Values:
        """Colours (..., outputs), float32, for pixels (..., channels); a white has Y = 1, or
        reflectances of 1; device values are 0 to 1. Pixels may lie interleaved or in planes, which
        is quicker.

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
            more = environment_of(self.stages, here, extrapolate)
            found.append({**self.environment, **more})
        return shape, found


def channel_defaults(link: Link) -> tuple[float, ...]:
    """A value for every channel of a link that was made alone: the profile's, or 0."""
    if "mdv " in link.profile.tags:
        return defaults(link.profile, link.inputs)
    known = {
        name: value
        for d in link.described
        for name, value in zip(d.component_names, d.default, strict=True)
    }
    return tuple(known.get(name, 0.0) for name in link.channels)


def variable_names(link: Link) -> dict[str, str]:
    """The signature of every variable a link's transform reads, by the model's name for it, or by
    the signature where the profile does not say."""
    known = [v for stage in link.stages for v in stage.variables]
    return {(d.name if d else s): s for s, d in known}


def _numbers(name: str, given: ArrayLike) -> NDArray[np.float64]:
    try:
        return np.asarray(given, np.float64)
    except (TypeError, ValueError):
        raise ValueGivenError(
            f"the values of '{name}' are no numbers", hint="angles are given in radians"
        ) from None
