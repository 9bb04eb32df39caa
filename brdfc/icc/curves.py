"""Curves of one channel, as tags and inside lookup tables: `curv` and `para` (ICC.1)."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import ClassVar

from brdfc.calc.samples import Samples, Storage
from brdfc.icc.layout import profile_errors, unpack
from brdfc.icc.numbers import fixed_bytes, unpack_fixed
from brdfc.icc.tag import Tag
from brdfc.source.errors import ProfileError

PARAMETERS = {0: 1, 1: 3, 2: 4, 3: 5, 4: 7}
"""How many parameters each function type of `para` has."""


@dataclass(frozen=True)
class Curve(Tag):
    """`curv`: over 0..1, the identity, a power (gamma), or samples at equal steps.

    gamma: the exponent, u8Fixed8, that is 0 to just under 256 in steps of 1/256. samples: 2 or
    more of UINT16, linear between. At most one of the two is given; neither is the identity.
    """

    type_signature: ClassVar[str] = "curv"
    gamma: float | None = None
    samples: Samples | None = None

    def encode(self) -> bytes:
        if self.gamma is not None and self.samples is not None:
            raise ProfileError("a curve has a gamma or samples, not both")
        if self.gamma is not None:
            try:
                return struct.pack(">4sIIH", b"curv", 0, 1, round(self.gamma * 256))
            except (struct.error, OverflowError, ValueError) as error:
                raise ProfileError(f"a gamma is from 0 to 255.996, not {self.gamma}") from error
        if self.samples is None:
            return struct.pack(">4sII", b"curv", 0, 0)
        count = self.samples.count
        if self.samples.storage is not Storage.UINT16 or count < 2:
            raise ProfileError("the samples of a curve are 2 or more of UINT16")
        return struct.pack(">4sII", b"curv", 0, count) + self.samples.data

    @staticmethod
    def decode(data: bytes, where: str) -> Curve:
        return _read_sampled(data, 0, where)[0]


@dataclass(frozen=True)
class ParametricCurve(Tag):
    """`para`: a formula, by the type of its function and the parameters g a b c d e f.

    | type | parameters    | Y for X at or above the break      | below | break |
    |-----:|---------------|------------------------------------|-------|-------|
    | 0    | g             | X^g                                |       |       |
    | 1    | g a b         | (a X + b)^g                        | 0     | -b/a  |
    | 2    | g a b c       | (a X + b)^g + c                    | c     | -b/a  |
    | 3    | g a b c d     | (a X + b)^g                        | c X   | d     |
    | 4    | g a b c d e f | (a X + b)^g + e                    | c X + f | d   |

    The parameters are s15Fixed16.
    """

    type_signature: ClassVar[str] = "para"
    function: int
    parameters: tuple[float, ...]

    def encode(self) -> bytes:
        if PARAMETERS.get(self.function) != len(self.parameters):
            raise ProfileError(
                f"no parametric curve has type {self.function} and {len(self.parameters)} "
                "parameters"
            )
        head = struct.pack(">4sIHH", b"para", 0, self.function, 0)
        return head + fixed_bytes(self.parameters, "'para'")

    @staticmethod
    def decode(data: bytes, where: str) -> ParametricCurve:
        return _read_parametric(data, 0, where)[0]


AnyCurve = Curve | ParametricCurve


def _read_sampled(data: bytes, offset: int, where: str) -> tuple[Curve, int]:
    """The curve at an offset, and where it ends."""
    (count,) = unpack("I", data, offset + 8, where)
    start = offset + 12
    if count == 0:
        return Curve(), start
    if count == 1:
        return Curve(gamma=unpack("H", data, start, where)[0] / 256), start + 2
    with profile_errors():
        samples = Samples.read(Storage.UINT16, count, data, start, where)
    return Curve(samples=samples), start + len(samples.data)


def _read_parametric(data: bytes, offset: int, where: str) -> tuple[ParametricCurve, int]:
    (function,) = unpack("H", data, offset + 8, where)
    if function not in PARAMETERS:
        raise ProfileError(f"a parametric curve of type {function}, not 0 to 4", where=where)
    count = PARAMETERS[function]
    parameters = unpack_fixed(count, data, offset + 12, where)
    return ParametricCurve(function, parameters), offset + 12 + 4 * count


def read_curves(
    data: bytes, offset: int, count: int, where: str
) -> tuple[tuple[AnyCurve, ...], int]:
    """count curves one after the other, each padded to 4 bytes, and where the last one ends."""
    curves: list[AnyCurve] = []
    end = offset
    for index in range(count):
        start = end + (offset - end) % 4
        place = f"{where}, curve {index} at byte {start}"
        (kind,) = unpack("4s", data, start, place)
        curve: AnyCurve
        if kind == b"curv":
            curve, end = _read_sampled(data, start, place)
        elif kind == b"para":
            curve, end = _read_parametric(data, start, place)
        else:
            raise ProfileError(f"{kind!r} where 'curv' or 'para' is expected", where=place)
        curves.append(curve)
    return tuple(curves), end


def curves_bytes(curves: tuple[AnyCurve, ...]) -> bytes:
    """The curves one after the other, each padded to 4 bytes."""
    encoded = (curve.encode() for curve in curves)
    return b"".join(data + bytes(-len(data) % 4) for data in encoded)
