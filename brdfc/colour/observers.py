"""Standard observers by name, or colour matching functions from a file."""

from __future__ import annotations

from dataclasses import dataclass

from brdfc.colour.illuminants import CUSTOM
from brdfc.colour.library import colour_science
from brdfc.colour.spectrum import Spectra, names_a_file, read_spectra
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import ValueGivenError

OBSERVERS = {
    "1931-2": "CIE 1931 2 Degree Standard Observer",
    "1964-10": "CIE 1964 10 Degree Standard Observer",
    "2015-2": "CIE 2015 2 Degree Standard Observer",
    "2015-10": "CIE 2015 10 Degree Standard Observer",
}
"""The names a user gives, and those of colour-science."""


@dataclass(frozen=True)
class Observer:
    """name: of OBSERVERS, or CUSTOM; matching: x, y, z."""

    name: str
    matching: Spectra


def observer(text: str) -> Observer:
    """The observer that a user means: "1931-2", "1964-10", or a file of wavelengths, x, y and z.

    Raises ValueGivenError for an unknown name, SpectrumError for a file that holds no functions.
    """
    named = text.strip()
    if names_a_file(named):
        return Observer(CUSTOM, read_spectra(named, 3, "observer"))
    if named not in OBSERVERS:
        hint = did_you_mean(named, OBSERVERS) or f"{', '.join(OBSERVERS)}, or a file FILE.csv"
        raise ValueGivenError(f"there is no observer '{named}'", hint=hint)
    return Observer(named, Spectra.of(colour_science().MSDS_CMFS[OBSERVERS[named]]))
