"""Published parameters of the MERL materials, read, and put in the terms of the library's models.

The files are those of the BSDF benchmark (github.com/bsdfbenchmark/bbm, folder fits): comments with
#, else a line a material,

    name = Aggregate(Lambertian(albedo = [r, g, b]), Lobe(name = value, name = [r, g, b], ...))

Their red, green and blue have no XYZ, and colour the lobe, where a model here has one strength for
all three. So a material is three pixels, one a colour, with Rd the same in X, Y and Z.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Values = dict[str, Array]

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "data" / "merl"
"""Beside the checkout; nothing of it is in the project."""

COLOURS = 3
_MATERIAL = re.compile(
    r"(?P<name>\S+) = Aggregate\("
    r"Lambertian\((?P<body>[^()]*)\), (?P<kind>\w+)\((?P<lobe>[^()]*)\)\)"
)
_VALUE = re.compile(r"(\w+) = (\[[^\]]*\]|[^\s,\[\]]+)(?:, |$)")


@dataclass(frozen=True)
class Fits:
    """A file of fits. lobe: what the file calls it; channels: of the model, each by its values."""

    file: str
    lobe: str
    materials: int
    channels: Mapping[str, Callable[[Values], Array]]


def same(name: str) -> Callable[[Values], Array]:
    return lambda values: values[name]


def normal_reflectance(values: Values) -> Array:
    """Of a dielectric of index eta."""
    return np.asarray(((values["eta"] - 1.0) / (values["eta"] + 1.0)) ** 2)


WARD = {"ks": same("albedo"), "m": same("roughness")}
PUBLISHED = {
    "ward": Fits("ngan_ward.fit", "NganWard", 86, WARD),
    "ward_duer": Fits("ngan_wardduer.fit", "NganWardDuer", 86, WARD),
    # what this file calls eta is the reflectance at normal incidence: it goes from 0.002 to 0.999
    "cook_torrance_ngan": Fits(
        "ngan_cooktorrance.fit", "NganCookTorrance", 86, WARD | {"F0": same("eta")}
    ),
    "cook_torrance_1982": Fits(
        "low_cooktorrance_E1.fit", "LowCookTorrance", 100, WARD | {"F0": normal_reflectance}
    ),
    "abc_microfacet": Fits(
        "low_lowmicrofacet_E2.fit",
        "LowMicrofacetFit",
        100,
        {name: same(name) for name in ("A", "B", "C", "eta")},
    ),
}
"""By the library model that the numbers are meant for."""


def published(model: str) -> dict[str, Values]:
    """The channels of every material by its name, each (3,): one a colour."""
    fits = PUBLISHED[model]
    found = {}
    for name, (body, lobe) in read((FOLDER / fits.file).read_text(), fits.lobe).items():
        channels = {channel: value(lobe) for channel, value in fits.channels.items()}
        found[name] = {"Rd": body["albedo"], **channels}
    return found


def read(text: str, lobe: str) -> dict[str, tuple[Values, Values]]:
    """The values of the Lambertian and of the lobe of every material, each (3,).

    Raises ValueError for a line of another form, another lobe, or a value of neither 1 nor 3.
    """
    found = {}
    for line in text.splitlines():
        if not line or line.startswith("#"):
            continue
        match = _MATERIAL.fullmatch(line)
        if not match or match["kind"] != lobe or match["name"] in found:
            raise ValueError(f"no material with a {lobe}, or one met before: {line}")
        found[match["name"]] = _values(match["body"]), _values(match["lobe"])
    return found


def _values(text: str) -> Values:
    if _VALUE.sub("", text):
        raise ValueError(f"not a list of values: {text}")
    rows = {
        name: [float(x) for x in row.strip("[]").split(",")] for name, row in _VALUE.findall(text)
    }
    if any(len(row) not in (1, COLOURS) for row in rows.values()):
        raise ValueError(f"neither a number nor red, green and blue: {text}")
    return {name: np.broadcast_to(np.array(row), COLOURS) for name, row in rows.items()}


def pixels(channels: Sequence[str], materials: Mapping[str, Values]) -> Array:
    """(materials, 3 colours, channels): Rd is the same in the channels Rdx, Rdy and Rdz."""
    rows = [
        [values["Rd" if channel.startswith("Rd") else channel] for channel in channels]
        for values in materials.values()
    ]
    return np.swapaxes(np.array(rows), 1, 2)
