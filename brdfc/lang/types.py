"""The types of the language: what a declaration may say, and what an expression has.

A declared type (one row of TYPES) fixes a quantity's dimension, its components and the range it
may have. An expression's type is only what checking needs: a dimension and a width.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Dimension(Enum):
    """What a value measures. Angles are kept in radians; their unit is written in the text."""

    NUMBER = "a number"
    ANGLE = "an angle"
    TRUTH = "a condition"


@dataclass(frozen=True)
class ValueType:
    """The type of an expression: its dimension and how many components it has (1: a scalar)."""

    dimension: Dimension
    width: int = 1

    def __str__(self) -> str:
        if self.width == 1:
            return self.dimension.value
        angles = " angles" if self.dimension is Dimension.ANGLE else ""
        return f"a vector of {self.width}{angles}"


NUMBER = ValueType(Dimension.NUMBER)
ANGLE = ValueType(Dimension.ANGLE)
TRUTH = ValueType(Dimension.TRUTH)


@dataclass(frozen=True)
class DeclaredType:
    """A type a channel, env or constant may have.

    low and high bound the ranges it may be declared with; suffixes name its components
    (`Rd : XYZ` becomes the channels Rdx, Rdy, Rdz). grid: of a spectrum, its first and last
    wavelength and the step between, in nanometres.
    """

    name: str
    value: ValueType
    low: float = float("-inf")
    high: float = float("inf")
    suffixes: tuple[str, ...] = ("",)
    grid: tuple[int, int, int] | None = None

    @property
    def is_angle(self) -> bool:
        return self.value.dimension is Dimension.ANGLE

    @property
    def is_colour(self) -> bool:
        """Whether its components are X, Y, Z under a light."""
        return self.name == "XYZ"


_BY_NAME = (
    DeclaredType("number", NUMBER),
    DeclaredType("angle", ANGLE),
    DeclaredType("roughness", NUMBER, low=0.0),
    DeclaredType("reflectance", NUMBER, low=0.0, high=1.0),
    DeclaredType("XYZ", ValueType(Dimension.NUMBER, 3), suffixes=("x", "y", "z")),
    # A number for each component of a colour that is no colour itself: K/S, say.
    DeclaredType("bands", ValueType(Dimension.NUMBER, 3), suffixes=("x", "y", "z")),
)
TYPES: dict[str, DeclaredType] = {declared.name: declared for declared in _BY_NAME}


def spectrum(first: int, last: int, step: int) -> DeclaredType:
    """`spectrum(400nm..700nm, 10nm)`: one component a wavelength, named by it (`_400`, `_410`).

    first, last, step in whole nanometres, the last wavelength included.
    """
    grid = range(first, last + 1, step)
    return DeclaredType(
        f"spectrum({first}nm..{last}nm, {step}nm)",
        ValueType(Dimension.NUMBER, len(grid)),
        suffixes=tuple(f"_{wavelength}" for wavelength in grid),
        grid=(first, last, step),
    )


def in_bands_of(declared: DeclaredType, spectral: DeclaredType | None) -> DeclaredType:
    """A type when a model is read for a spectrum: one value a wavelength in place of X, Y, Z."""
    if spectral is not None and declared.name in ("XYZ", "bands"):
        return spectral
    return declared
