"""Colour appearance transforms (`XtoJ`, `JtoX`): the elements and their bytes.

They lead from X, Y, Z to the lightness J and the chroma's components a and b of CIECAM02, and back;
the equations stand in engine/appearance.py.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass

from brdfc.source.errors import ProgramError

FORWARD, BACKWARD = "XtoJ", "JtoX"
_LAYOUT = struct.Struct(">4sIHH8f")


@dataclass(frozen=True)
class AppearanceTransform:
    """signature: FORWARD, or BACKWARD. The numbers are float32.

    white: X, Y, Z in the unit of the colours, Y = 100 as a rule. luminance: of the adapting field,
    in cd/m2 (L_A). background: its Y (Y_b), in the unit of the white. impact, induction, degree:
    c, N_c and F, which stand for the surround.
    """

    signature: str
    white: tuple[float, float, float]
    luminance: float
    background: float
    impact: float
    induction: float
    degree: float

    @property
    def inputs(self) -> int:
        return 3

    @property
    def outputs(self) -> int:
        return 3

    @property
    def conditions(self) -> tuple[float, ...]:
        """What follows the white, in the order of the file."""
        return self.luminance, self.background, self.impact, self.induction, self.degree


def encode_appearance(transform: AppearanceTransform) -> bytes:
    """The element from its own signature on."""
    numbers = (*transform.white, *transform.conditions)
    _check(numbers, "an appearance transform")
    return _LAYOUT.pack(transform.signature.encode(), 0, 3, 3, *numbers)


def decode_appearance(data: bytes, inputs: int, outputs: int, where: str) -> AppearanceTransform:
    """The transform that `data` begins with, its header of 12 bytes included."""
    if (inputs, outputs) != (3, 3):
        raise ProgramError(
            f"an appearance transform takes 3 channels to 3, not {inputs} to {outputs}",
            where=where,
        )
    if len(data) < _LAYOUT.size:
        raise ProgramError("the appearance transform ends within its numbers", where=where)
    signature, *_, x, y, z, luminance, background, impact, induction, degree = _LAYOUT.unpack_from(
        data
    )
    numbers = (luminance, background, impact, induction, degree)
    _check((x, y, z, *numbers), where)
    return AppearanceTransform(signature.decode("ascii"), (x, y, z), *numbers)


def _check(numbers: tuple[float, ...], where: str) -> None:
    if not all(map(math.isfinite, numbers)):
        raise ProgramError("a viewing condition is NaN or infinite", where=where)
