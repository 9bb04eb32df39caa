"""The light, the observer and the surround that a profile's colours are meant for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.colour.adaptation import adaptation_transform
from brdfc.colour.difference import D50
from brdfc.colour.illuminants import CUSTOM, Illuminant, illuminant, lamp
from brdfc.colour.observers import Observer, observer
from brdfc.colour.spectrum import Grid, Spectra, interpolation
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import SpectrumError, ValueGivenError

XYZ = tuple[float, float, float]

STANDARD_OBSERVER = "1931-2"
LUMINANCE = 500 / math.pi
"""cd/m2 of a perfect diffuser under 500 lx, as prints are judged at (ISO 3664:2009, P2)."""
SURROUNDS = {"average": 0.2, "dim": 0.1, "dark": 0.0}
"""The luminance of the surround by its name, over that of the white. For an average surround CIE
159:2004 asks for a fifth at least; below that it is dim, and dark at 0."""
SEEN = (400.0, 700.0)
"""Nanometres that every spectrum has to cover."""
_LUMINANCES = (1e-6, 1e9)
"""cd/m2, of a light that has a colour and can be looked at, generously."""
_SAME_WHITE = 1e-4
_FARTHEST = 1e3
"""How far X and Z may be from Y, as a factor; of no spectrum they are farther."""
_STEP = 5.0
"""Nanometres; spectra in wider steps are read between them, as observers change within a step."""
_ENDED = 1e-3
"""Colour matching functions this far below their greatest value, at their ends, are at an end."""


@dataclass(frozen=True)
class ViewingConditions:
    """White: X, Y, Z with Y = 1. power: (steps,) and matching: (3, steps) are on one grid.

    luminance: of the white in cd/m2; surround: X, Y, Z in cd/m2; adaptation: how colours come from
    this white to D50 (a name of adaptation.TRANSFORMS); lamp_made: the light's spectrum was made
    from its white.
    """

    white: XYZ
    illuminant: str
    temperature: float
    observer: str
    grid: Grid
    power: NDArray[np.float64]
    matching: NDArray[np.float64]
    luminance: float = LUMINANCE
    surround: XYZ = (0.0, 0.0, 0.0)
    adaptation: str = "bradford"
    lamp_made: bool = False

    @property
    def standard(self) -> bool:
        """Whether these are what profiles connect through: D50 and the 1931 observer."""
        return (self.illuminant, self.observer) == ("D50", STANDARD_OBSERVER) and self.white == D50

    def reflectances_to_xyz(self, grid: Grid) -> NDArray[np.float64]:
        """The matrix (3, steps) from reflectances on a grid to XYZ under this light.

        As the ICC's engine does it: reflectances are read at the light's wavelengths (see
        interpolation), weighted by its power and the colour matching functions, and scaled so that
        a perfect diffuser has this white.
        """
        weighted = (self.matching * self.power) @ interpolation(grid, self.grid.wavelengths)
        seen = weighted.sum(axis=1)
        if not (np.isfinite(seen).all() and seen.min() > 0):
            raise SpectrumError("the light has no power where the observer sees")
        scale = np.asarray(self.white) / seen
        return np.asarray(weighted * scale[:, None])

    def seen_with(self, light: str | None, observed_by: str | None) -> ViewingConditions:
        """The same with another light, another observer, or both; see viewing_conditions."""
        source = Illuminant(self.illuminant, Spectra(self.grid, self.power[None]), self.temperature)
        eye = Observer(self.observer, Spectra(self.grid, self.matching))
        return viewing_conditions(light or source, observed_by or eye)

    def __str__(self) -> str:
        kelvin = f" {self.temperature:g} K" if self.temperature else ""
        white = ", ".join(f"{v:.5g}" for v in self.white)
        return f"{self.illuminant}{kelvin}, observer {self.observer}, white ({white})"


def viewing_conditions(
    light: str | Illuminant | None = None,
    observed_by: str | Observer | None = None,
    white: Sequence[float] | None = None,
    surround: str | None = None,
    luminance: float | None = None,
    adaptation: str | None = None,
) -> ViewingConditions:
    """Viewing conditions from what a user says; what is not said is usual.

    light: see illuminants.illuminant (D50 where neither it nor a white is given); observed_by: see
    observers.observer (the 1931 2 degree observer). white: X, Y, Z of the light, in any unit: as
    measured; without a light, a smooth lamp that has it stands for its spectrum. surround:
    "average", "dim", "dark", or X,Y,Z in cd/m2. luminance: of the white, in cd/m2. adaptation: see
    adaptation.TRANSFORMS.

    Raises ValueGivenError for what cannot be, and SpectrumError for spectra that do not fit.
    """
    functions = (
        observed_by
        if isinstance(observed_by, Observer)
        else observer(observed_by or STANDARD_OBSERVER)
    )
    measured = None if white is None else normalised_white(white)
    if light is None and measured is not None:
        grid = _tabulated(functions)
        source = lamp(measured, functions.matching.at(grid.wavelengths), grid)
    else:
        source = light if isinstance(light, Illuminant) else illuminant(light or "D50")
    power = _observed(source, functions)
    matching = functions.matching.at(power.grid.wavelengths)
    summed = matching @ power.values[0]
    if not summed[1] > 0:
        raise SpectrumError("the light has no luminance for this observer")
    own: XYZ = (float(summed[0] / summed[1]), 1.0, float(summed[2] / summed[1]))
    if (source.name, functions.name) == ("D50", STANDARD_OBSERVER):
        own = D50  # by definition, whatever the table's fifth digit
    level = _luminance(LUMINANCE if luminance is None else luminance)
    found = measured or own
    # With another white than its own it is no longer the light that has the name.
    named = max(abs(a - b) for a, b in zip(found, own, strict=True)) < _SAME_WHITE
    conditions = ViewingConditions(
        white=found,
        illuminant=source.name if named else CUSTOM,
        temperature=source.temperature if named else 0.0,
        observer=functions.name,
        grid=power.grid,
        power=power.values[0],
        matching=matching,
        luminance=level,
        surround=_surround(surround or "average", found, level),
        adaptation=adaptation_transform(adaptation or "bradford"),
        lamp_made=light is None and measured is not None,
    )
    if adaptation is not None and conditions.standard:
        raise ValueGivenError(
            "an adaptation is asked for, and the light is D50: there is nothing to adapt",
            hint="say what the light is: --white or --illuminant",
        )
    return conditions


def normalised_white(white: Sequence[float]) -> XYZ:
    """X, Y, Z over Y; ValueGivenError for what no light has."""
    if len(white) != 3 or not all(map(math.isfinite, white)):
        shown = ",".join(f"{v:g}" for v in white)
        raise ValueGivenError(f"a white is three finite numbers X,Y,Z, not {shown}")
    x, y, z = white
    if y <= 0:
        raise ValueGivenError(
            f"the white's Y is {y:g}: a light has a luminance above 0", hint="the order is X,Y,Z"
        )
    if min(x, z) <= 0:
        raise ValueGivenError(f"the white {x:g},{y:g},{z:g} has a value that is not above 0")
    if not all(1 / _FARTHEST < v / y < _FARTHEST for v in (x, z)):
        raise ValueGivenError(f"the white {x:g},{y:g},{z:g} is no light's: X and Z are near Y")
    return (x / y, 1.0, z / y)


def _luminance(value: float) -> float:
    low, high = _LUMINANCES
    if not low <= value <= high:
        raise ValueGivenError(f"the luminance is {value:g}; it has to be {low:g}..{high:g} cd/m2")
    return value


def _tabulated(functions: Observer) -> Grid:
    """Where a lamp is made: in steps of 5 nm, as far as the observer sees, within 360..780 nm."""
    start = max(360.0, 5 * math.ceil(functions.matching.grid.start / 5))
    end = min(780.0, 5 * math.floor(functions.matching.grid.end / 5))
    return Grid(start, end, round((end - start) / 5) + 1)


def _observed(source: Illuminant, functions: Observer) -> Spectra:
    """The part of a light's spectrum that an observer sees."""
    light, eye = source.power.grid, functions.matching.grid
    for grid, what in ((light, "illuminant"), (eye, "observer")):
        if grid.start > SEEN[0] or grid.end < SEEN[1]:
            low, high = SEEN
            raise SpectrumError(
                f"the {what} covers {grid}; {low:g}..{high:g} nm at least are needed"
            )
    greatest = functions.matching.values.max()
    for beyond, values in (
        (light.start < eye.start, functions.matching.values[:, 0]),
        (light.end > eye.end, functions.matching.values[:, -1]),
    ):
        # The standard observers end where they are defined to.
        if functions.name == CUSTOM and beyond and values.max() > _ENDED * greatest:
            raise SpectrumError(
                f"the observer covers {eye}, the illuminant {light}, and the colour matching "
                "functions are not at an end there",
                hint="give functions that cover the light's spectrum",
            )
    return source.power.in_steps(_STEP).cut(eye.start, eye.end)


def _surround(text: str, white: XYZ, luminance: float) -> XYZ:
    share = SURROUNDS.get(text.strip().lower())
    if share is not None:
        x, y, z = (share * luminance * v for v in white)
        return (x, y, z)
    try:
        numbers = [float(word) for word in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != 3 or not all(math.isfinite(v) and v >= 0 for v in numbers):
        hint = did_you_mean(text, SURROUNDS) or "average, dim, dark, or X,Y,Z in cd/m2"
        raise ValueGivenError(f"'{text}' is no surround", hint=hint)
    return (numbers[0], numbers[1], numbers[2])
