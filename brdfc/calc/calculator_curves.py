"""Curves sampled from a calculator (`clcf`), and their bytes.

An engine samples the calculator at equal steps when a run starts, with the run's variables, and
interpolates from then on.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from dataclasses import dataclass

from brdfc.calc.program import Element, Program
from brdfc.source.errors import ProgramError

MOST_POINTS = 16384
"""How many samples the reference engine takes, where a curve desires more."""

_HEAD = struct.Struct(">4sIIffHH")
"""Signature, 0, desired size, first, last, extension, 0; the calculator follows."""


@dataclass(frozen=True)
class CalculatorCurve:
    """Values of a calculator of one channel at `size` equal steps from first to last. Beyond, the
    end values hold (clip), or the end lines go on (extend)."""

    size: int
    first: float
    last: float
    calculator: Program
    extend: bool = False

    @property
    def points(self) -> int:
        """How many samples are taken."""
        return min(self.size, MOST_POINTS)


def encode_calculator_curve(curve: CalculatorCurve, encode: Callable[[Element], bytes]) -> bytes:
    """The curve from its own signature on. encode: the bytes of its calculator."""
    _check(curve, "a calculator curve")
    head = _HEAD.pack(b"clcf", 0, curve.size, curve.first, curve.last, curve.extend, 0)
    return head + encode(curve.calculator)


def decode_calculator_curve(
    data: bytes, where: str, decode: Callable[[bytes, str], Element]
) -> CalculatorCurve:
    """The curve that `data` begins with. decode: the element of its bytes, named for errors."""
    if len(data) < _HEAD.size:
        raise ProgramError("the calculator curve ends within its header", where=where)
    _, _, size, first, last, extension, _ = _HEAD.unpack_from(data)
    if extension > 1:
        raise ProgramError(f"no extension has the number {extension}", where=where)
    element = decode(data[_HEAD.size :], f"{where}, calculator")
    if not isinstance(element, Program):
        raise ProgramError(
            f"a curve is sampled from a calculator, not from a '{element.signature}'", where=where
        )
    curve = CalculatorCurve(size, first, last, element, bool(extension))
    _check(curve, where)
    return curve


def _check(curve: CalculatorCurve, where: str) -> None:
    channels = curve.calculator.inputs, curve.calculator.outputs
    if channels != (1, 1):
        raise ProgramError(
            f"a curve's calculator takes 1 channel to 1, not {channels[0]} to {channels[1]}",
            where=where,
        )
    if curve.size < 2:
        raise ProgramError(f"a calculator curve of {curve.size} points", where=where)
    if not (math.isfinite(curve.first) and math.isfinite(curve.last) and curve.first < curve.last):
        raise ProgramError(
            f"a calculator curve from {curve.first:g} to {curve.last:g}", where=where
        )
