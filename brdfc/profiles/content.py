"""What every encoding of a compiled model puts into its profiles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from brdfc.calc.program import Element, Program
from brdfc.colour.conditions import ViewingConditions
from brdfc.colour.spectrum import Grid
from brdfc.icc.header import Header, SpectralRange
from brdfc.icc.signatures import NO_SPACE, counted_space
from brdfc.icc.types import Dictionary, LocalizedText, NumberArray, Pipeline, Tag
from brdfc.profiles.conditions import (
    condition_tags,
    header_white,
    matrix_element,
    spectral_range,
)

NO_METADATA = Dictionary(())
COPYRIGHT = "No copyright is claimed for this profile."


@dataclass(frozen=True)
class Content:
    """program: from channels to XYZ, or to reflectances where a grid is given. names and defaults:
    of its channels. conditions: of its colours; None for D50 and nothing more."""

    title: str
    program: Program
    names: tuple[str, ...]
    defaults: tuple[float, ...]
    meta: Dictionary = NO_METADATA
    conditions: ViewingConditions | None = None
    grid: Grid | None = None

    def header(
        self, device_class: str, colour_space: bytes = NO_SPACE, mcs: bytes = NO_SPACE
    ) -> Header:
        """The header of a profile that leads to these colours."""
        grid = self.grid
        return Header(
            device_class,
            colour_space=colour_space,
            mcs=mcs,
            pcs=b"XYZ ",
            illuminant=header_white(self.conditions),
            spectral_pcs=counted_space("rs", grid.steps) if grid else NO_SPACE,
            spectral_range=spectral_range(grid, "spectrum") if grid else SpectralRange(),
        )

    def texts(self, which: str) -> dict[str, Tag]:
        """Description, copyright and metadata; which: of the profiles of one model."""
        return {
            "desc": LocalizedText.english(f"{self.title} ({which})"),
            "cprt": LocalizedText.english(COPYRIGHT),
            "meta": self.meta,
        }

    def colours(self) -> dict[str, Tag]:
        """What the connection space is: white point, viewing conditions, spectral white point."""
        tags = condition_tags(self.conditions)
        if self.grid is not None:
            tags["swpt"] = NumberArray("fl32", (1.0,) * self.grid.steps)  # a perfect diffuser
        return tags

    def colorimetric(self, first: Sequence[Element] = ()) -> Pipeline:
        """The transform to XYZ; first: elements before the program."""
        elements: tuple[Element, ...] = (*first, self.program)
        if self.grid is not None:
            assert self.conditions is not None  # reflectances have no colour without a light
            elements += (matrix_element(self.conditions.reflectances_to_xyz(self.grid)),)
        return _pipeline(elements)

    def spectral(self, first: Sequence[Element] = ()) -> Pipeline:
        """The transform to reflectances, where there is a grid."""
        return _pipeline((*first, self.program))


def _pipeline(elements: tuple[Element, ...]) -> Pipeline:
    return Pipeline(elements[0].inputs, elements[-1].outputs, elements)
