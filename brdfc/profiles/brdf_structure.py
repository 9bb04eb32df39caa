"""BRDF parameter tags (ICC.2): a model's name and its parameters, for a renderer that has it.

`bcpx` holds a structure with the registered type of the model and a transform from device values
to its parameters for X, Y and Z; `bspx` the same for every wavelength. No release of the ICC's
engine that we know applies them. Beside them is the transform of an ordinary input profile, for one
geometry.

The format's text was not at hand: which parameters a type has, in which order, and whether they go
by channel or by parameter, is our choice, stated here and in the profile's metadata.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.program import Matrix
from brdfc.icc.types import NumberArray, Pipeline, Signature, Structure, Tag
from brdfc.lang.model import Model
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import ValueGivenError


@dataclass(frozen=True)
class RegisteredModel:
    """type: the first three letters of the registered signature; the fourth is 0 for mono, 1 for
    colour. parameters: the model's quantities in order; amplitudes: those of them that scale
    light, and so take the colour of the white."""

    type: str
    parameters: tuple[str, ...]
    amplitudes: tuple[str, ...]


def _lobes(type_: str, names: Sequence[str], amplitude: str, count: int) -> RegisteredModel:
    numbered = [f"{name}{i}" for i in range(1, count + 1) for name in names]
    amplitudes = tuple(name for name in numbered if name.startswith(amplitude))
    return RegisteredModel(type_, ("Rd", *numbered), amplitudes)


REGISTERED = {
    "blinn_phong": RegisteredModel("BPh", ("Rd", "ks", "n"), ("ks",)),
    "cook_torrance": RegisteredModel("CT1", ("Rd", "ks", "m", "F0"), ("ks",)),
    "cook_torrance_2": _lobes("CT2", ("ks", "m", "F0"), "ks", 2),
    "cook_torrance_3": _lobes("CT3", ("ks", "m", "F0"), "ks", 3),
    "lafortune": RegisteredModel("La1", ("Rd", "ks", "Cxy", "Cz", "n"), ("ks",)),
    "lafortune_2": _lobes("La2", ("ks", "Cxy", "Cz", "n"), "ks", 2),
    "lafortune_3": _lobes("La3", ("ks", "Cxy", "Cz", "n"), "ks", 3),
    "ward": RegisteredModel("War", ("Rd", "ks", "m"), ("ks",)),
}
"""The library's models that have a registered type."""

ORDERS = ("channel", "parameter")
"""How parameters of several channels follow each other: all of one channel, then all of the next;
or one parameter of all channels, then the next parameter."""


def registered(model: Model) -> RegisteredModel:
    """The registered type of a library model; ValueGivenError where it has none."""
    found = REGISTERED.get(model.origin)
    if found is None:
        listed = ", ".join(REGISTERED)
        raise ValueGivenError(
            f"'{model.origin}' has no registered BRDF type",
            hint=f"of the library's models these have: {listed}",
        )
    return found


def parameter_order(text: str) -> str:
    """A name of ORDERS; ValueGivenError for another."""
    if text not in ORDERS:
        hint = did_you_mean(text, ORDERS) or " or ".join(ORDERS)
        raise ValueGivenError(f"parameters do not go by '{text}'", hint=hint)
    return text


@dataclass(frozen=True)
class Parameter:
    """start: the first device value of a parameter, which has width of them; or its fixed values,
    one for each channel or one for all."""

    start: int = 0
    width: int = 1
    values: tuple[float, ...] = ()


def structure(
    kind: RegisteredModel,
    parameters: Mapping[str, Parameter],
    inputs: int,
    white: Sequence[float],
    order: str,
) -> Tag:
    """The structure of a model for as many channels as the white has.

    parameters: where each of the kind's comes from; inputs: device values. white: what amplitudes
    are multiplied by. order: of ORDERS.
    """
    colour = any(p.width > 1 or len(set(p.values)) > 1 for p in parameters.values())
    colour = colour or (bool(kind.amplitudes) and len(set(white)) > 1)
    channels = len(white) if colour else 1
    rows: list[tuple[NDArray[np.float64], float]] = []
    every = [(c, name) for c in range(channels) for name in kind.parameters]
    if order == "parameter":
        every = [(c, name) for name in kind.parameters for c in range(channels)]
    for channel, name in every:
        p = parameters[name]
        scale = white[channel] if colour and name in kind.amplitudes else 1.0
        row, offset = np.zeros(inputs), 0.0
        if p.values:
            offset = p.values[channel if len(p.values) > 1 else 0] * scale
        else:
            row[p.start + (channel if p.width > 1 else 0)] = scale
        rows.append((row, offset))
    matrix = np.array([row for row, _ in rows], dtype=np.float32)
    offsets = np.array([offset for _, offset in rows], dtype=np.float32)
    element = Matrix(inputs, len(rows), tuple(matrix.ravel().tolist()), tuple(offsets.tolist()))
    return Structure(
        "brdf",
        {
            "type": Signature(kind.type + ("1" if colour else "0")),
            "func": Signature("colr" if colour else "mono"),
            "nump": NumberArray("ui16", (len(kind.parameters),)),
            "xfrm": Pipeline(inputs, len(rows), (element,)),
        },
    )
