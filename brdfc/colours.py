"""What a model's values are: colours under a light, or reflectances at wavelengths."""

from __future__ import annotations

from dataclasses import dataclass

from brdfc.colour.colorimetry import Colorimetry
from brdfc.colour.conditions import SEEN, ViewingConditions, viewing_conditions
from brdfc.colour.difference import D50
from brdfc.colour.spectrum import Grid
from brdfc.lang.model import HIGHLIGHTS, Model
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import ValueGivenError
from brdfc.symbolic.formula import NO_WHITE

XYZ = tuple[float, float, float]


@dataclass(frozen=True)
class Colours:
    """conditions: as a profile states them; None for D50 and no more. grid: of the model's spectra,
    if it has some. highlight: of HIGHLIGHTS. colorimetry: what the values look like."""

    conditions: ViewingConditions | None
    grid: Grid | None
    highlight: str
    colorimetry: Colorimetry

    @property
    def formula_white(self) -> XYZ:
        """The white that the formula is taken under: none for reflectances."""
        wanted = self.grid is None and self.highlight == "light"
        return self.colorimetry.white if wanted else NO_WHITE

    def facts(self) -> dict[str, str]:
        """What a profile's metadata says of its colours."""
        facts = {} if self.grid else {"highlight": self.highlight}
        if self.conditions is not None:
            facts["light"] = str(self.conditions)
            facts["adaptation"] = self.conditions.adaptation
            if self.conditions.lamp_made:
                facts["light.spectrum"] = "made from the white: not measured"
        return facts


def spectral_grid(model: Model) -> Grid | None:
    """The wavelengths of a model's spectra; None where it has none.

    Raises ValueGivenError where they have different ones.
    """
    grids = {q.type.grid: q.name for q in model.quantities if q.type.grid is not None}
    if len(grids) > 1:
        listed = " and ".join(f"'{name}'" for name in grids.values())
        raise ValueGivenError(f"the spectra of {listed} have different wavelengths")
    if not grids:
        return None
    (first, last, step) = next(iter(grids))
    low, high = SEEN
    if first > low or last < high:
        raise ValueGivenError(
            f"the spectra of '{grids[first, last, step]}' cover {first}..{last} nm; colours need "
            f"{low:g}..{high:g} nm"
        )
    return Grid(float(first), float(last), (last - first) // step + 1)


def bands(model: Model) -> int:
    """Components that a model's radiance has to have: X, Y, Z, or one a wavelength."""
    grid = spectral_grid(model)
    return grid.steps if grid else 3


def colours_of(
    model: Model, conditions: ViewingConditions | None = None, highlight: str | None = None
) -> Colours:
    """What a model's values are under these conditions; highlight: of HIGHLIGHTS, the model's own
    where None.

    Spectra have no colour without a light: D50 and the 1931 observer where none is given.
    """
    grid = spectral_grid(model)
    if grid is not None and highlight is not None:
        raise ValueGivenError(
            "reflectances of a highlight are what the model says; only X, Y, Z have a choice"
        )
    highlight = model.highlight if highlight is None else highlight
    if highlight not in HIGHLIGHTS:
        hint = did_you_mean(highlight, HIGHLIGHTS) or "light or equal"
        raise ValueGivenError(f"'{highlight}' is no colour of highlights", hint=hint)
    if grid is None:
        white = conditions.white if conditions is not None else D50
        return Colours(conditions, None, highlight, Colorimetry(white))
    stated = conditions if conditions is not None else viewing_conditions()
    rows = tuple(tuple(row) for row in stated.reflectances_to_xyz(grid).tolist())
    return Colours(stated, grid, highlight, Colorimetry(stated.white, rows))
