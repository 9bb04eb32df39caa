"""Light sources by name, by temperature or from a file; and a lamp that has a given white."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.colour.library import colour_science
from brdfc.colour.spectrum import Grid, Spectra, names_a_file, read_spectra
from brdfc.source.diagnostics import nearest
from brdfc.source.errors import ValueGivenError

VISIBLE = Grid(360.0, 780.0, 85)
"""Where spectra that are made here are tabulated."""

CUSTOM = "custom"
"""The name of a light, or of an observer, that has no other."""
_TEMPERATURE = re.compile(r"(blackbody|daylight):(\d+(?:\.\d*)?)K?", re.IGNORECASE)
_LOWEST, _HIGHEST = {"blackbody": 1000.0, "daylight": 4000.0}, {"blackbody": 1e5, "daylight": 25e3}


@dataclass(frozen=True)
class Illuminant:
    """name: as the user gave it, or CUSTOM; temperature: kelvin, 0 where there is none; power:
    one spectrum, relative."""

    name: str
    power: Spectra
    temperature: float = 0.0


def illuminant(text: str) -> Illuminant:
    """The light that a user means: "A", "D65", "FL2" (or "F2"), "blackbody:2856K",
    "daylight:6500K", or a file of wavelengths and powers.

    Raises ValueGivenError for an unknown name, with the nearest, or for a temperature out of
    range; SpectrumError for a file that holds no spectrum.
    """
    named = text.strip()
    found = _TEMPERATURE.fullmatch(named)
    if found:
        return _of_temperature(found[1].lower(), float(found[2]))
    if names_a_file(named):
        read = read_spectra(named, 1, "illuminant")
        return Illuminant(CUSTOM, Spectra(read.grid, read.values / read.values.max() * 100))
    spectra = colour_science().SDS_ILLUMINANTS
    known = {name.upper(): name for name in spectra}
    name = known.get(named.upper()) or known.get(re.sub("^F(?=[0-9])", "FL", named.upper()))
    if name is None:
        near = nearest(named, known) or nearest(named.upper(), known)
        hint = f"did you mean '{known[near]}'?" if near else _HINT
        raise ValueGivenError(f"there is no illuminant '{named}'", hint=hint)
    return Illuminant(name, Spectra.of(spectra[name]))


_HINT = "A, D50, D65, FL2, ..., blackbody:2856K, daylight:6500K, or a file FILE.csv"


def _of_temperature(kind: str, kelvin: float) -> Illuminant:
    low, high = _LOWEST[kind], _HIGHEST[kind]
    if not low <= kelvin <= high:
        raise ValueGivenError(f"{kind}:{kelvin:g}K is outside {low:g}K..{high:g}K")
    colour = colour_science()
    shape = colour.SpectralShape(VISIBLE.start, VISIBLE.end, 5)
    if kind == "blackbody":
        # Planck's law as CIE 15 states illuminant A, with c2 = 1.4388e-2 m K.
        power = colour.sd_blackbody(kelvin, shape)
    else:
        xy = colour.temperature.CCT_to_xy_CIE_D(kelvin)
        power = colour.sd_CIE_illuminant_D_series(xy, shape=shape)
    values = np.asarray(power.values, dtype=np.float64)
    at_560 = values[np.argmin(np.abs(VISIBLE.wavelengths - 560))]
    return Illuminant(kind, Spectra(VISIBLE, values[None] / at_560 * 100), kelvin)


def lamp(white: Sequence[float], matching: NDArray[np.float64], grid: Grid) -> Illuminant:
    """A smooth lamp that has a given white: the exponential of a parabola over wavelength.

    Many spectra have one white; this one is nowhere negative, has one maximum where it can, and is
    near a black body's for whites near one's. white: X, Y, Z; matching: (3, steps) on the grid.
    Raises ValueGivenError where no such lamp exists: a white that no light has.
    """
    u = (grid.wavelengths - 580) / 200
    powers = np.stack([np.ones_like(u), u, u * u])
    target = np.asarray(white, dtype=np.float64)
    weights = matching / matching[1].sum()
    parameters = np.zeros(3)
    for _ in range(200):
        with np.errstate(over="ignore", invalid="ignore"):
            power = np.exp(parameters @ powers)
            missing = weights @ power - target
            slope = (weights * power) @ powers.T
        try:
            change = np.linalg.solve(slope, missing)
        except np.linalg.LinAlgError:
            break
        if not np.isfinite(change).all():
            break
        parameters = parameters - change * min(1.0, 1 / max(float(np.abs(change).max()), 1e-300))
        if np.abs(change).max() < 1e-12:
            return Illuminant(CUSTOM, Spectra(grid, power[None] / power.max() * 100))
    shown = ",".join(f"{v:g}" for v in white)
    raise ValueGivenError(
        f"no lamp has the white {shown}",
        hint="check the order X,Y,Z and that Y is the luminance; or give its --illuminant FILE.csv",
    )
