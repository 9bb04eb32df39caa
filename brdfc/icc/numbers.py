"""Tag types that hold numbers: `XYZ `, the number arrays, and `sig `."""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from brdfc.icc.layout import check_count, unpack
from brdfc.icc.signatures import signature_bytes, signature_text
from brdfc.icc.tag import Tag
from brdfc.source.errors import ProfileError

NUMBER_FORMATS = {
    "fl16": "e",
    "fl32": "f",
    "fl64": "d",
    "ui08": "B",
    "ui16": "H",
    "ui32": "I",
    "ui64": "Q",
}


_GREATEST = {"ui08": 255, "ui16": 65535}


@dataclass(frozen=True)
class NumberArray(Tag):
    """`fl32` and its kin: kind is the type signature, the values as they are in the file.

    No value may be NaN or infinite.
    """

    kind: str
    values: tuple[float, ...]

    @property
    def type_signature(self) -> str:
        return self.kind

    @property
    def scaled(self) -> tuple[float, ...]:
        """The values, those of 8 and 16 bits as parts of the greatest, as defaults of channels are
        meant."""
        one = _GREATEST.get(self.kind, 1)
        return tuple(value / one for value in self.values)

    def encode(self) -> bytes:
        try:
            values = struct.pack(f">{len(self.values)}{NUMBER_FORMATS[self.kind]}", *self.values)
        except (struct.error, OverflowError) as error:
            raise ProfileError(f"'{self.kind}' cannot hold a value: {error}") from error
        _refuse_not_finite(self.values, f"'{self.kind}' array")
        return signature_bytes(self.kind) + bytes(4) + values

    @staticmethod
    def decode(data: bytes, where: str) -> NumberArray:
        kind = signature_text(data[:4])
        form = NUMBER_FORMATS[kind]
        count, rest = divmod(len(data) - 8, struct.calcsize(f">{form}"))
        if rest:
            raise ProfileError(f"{len(data) - 8} bytes are no whole count of '{kind}'", where=where)
        check_count(count, where)
        values = unpack(f"{count}{form}", data, 8, where)
        _refuse_not_finite(values, where)
        return NumberArray(kind, values)


def _refuse_not_finite(values: tuple[float, ...], where: str) -> None:
    for index, value in enumerate(values):
        if not math.isfinite(value):
            raise ProfileError(f"value {index} is {value}, not a finite number", where=where)


def fixed_bytes(values: Sequence[float], what: str) -> bytes:
    """Numbers as s15Fixed16: from -32768 to just under 32768 in steps of 2^-16."""
    try:
        return struct.pack(f">{len(values)}i", *(round(value * 65536) for value in values))
    except (struct.error, OverflowError, ValueError) as error:
        raise ProfileError(f"{what} cannot hold {tuple(values)}") from error


def unpack_fixed(count: int, data: bytes, offset: int, where: str) -> tuple[float, ...]:
    """count s15Fixed16 from an offset on."""
    return tuple(number / 65536 for number in unpack(f"{count}i", data, offset, where))


@dataclass(frozen=True)
class FixedArray(Tag):
    """`sf32`, of s15Fixed16 (-32768 to just under 32768), or `uf32`, of u16Fixed16 (0 to just
    under 65536), both in steps of 2^-16."""

    kind: str
    values: tuple[float, ...]

    @property
    def type_signature(self) -> str:
        return self.kind

    def encode(self) -> bytes:
        form = _FIXED_FORMATS[self.kind]
        try:
            fixed = struct.pack(
                f">{len(self.values)}{form}", *(round(value * 65536) for value in self.values)
            )
        except (struct.error, OverflowError, ValueError) as error:
            raise ProfileError(f"'{self.kind}' cannot hold a value: {error}") from error
        return signature_bytes(self.kind) + bytes(4) + fixed

    @staticmethod
    def decode(data: bytes, where: str) -> FixedArray:
        kind = signature_text(data[:4])
        count, rest = divmod(len(data) - 8, 4)
        if rest:
            raise ProfileError(f"{len(data) - 8} bytes are no whole count of '{kind}'", where=where)
        check_count(count, where)
        fixed = unpack(f"{count}{_FIXED_FORMATS[kind]}", data, 8, where)
        return FixedArray(kind, tuple(number / 65536 for number in fixed))


_FIXED_FORMATS = {"sf32": "i", "uf32": "I"}


@dataclass(frozen=True)
class XYZArray(Tag):
    """`XYZ `: colours as s15Fixed16, see fixed_bytes."""

    type_signature: ClassVar[str] = "XYZ "
    values: tuple[tuple[float, float, float], ...]

    def encode(self) -> bytes:
        numbers = [value for colour in self.values for value in colour]
        return b"XYZ " + bytes(4) + fixed_bytes(numbers, "'XYZ '")

    @staticmethod
    def decode(data: bytes, where: str) -> XYZArray:
        count, rest = divmod(len(data) - 8, 12)
        if rest:
            raise ProfileError(f"{len(data) - 8} bytes are no whole count of XYZ", where=where)
        check_count(count, where)
        fixed = unpack_fixed(3 * count, data, 8, where)
        return XYZArray(tuple(zip(fixed[::3], fixed[1::3], fixed[2::3], strict=True)))


@dataclass(frozen=True)
class Signature(Tag):
    """`sig `: one signature."""

    type_signature: ClassVar[str] = "sig "
    value: str

    def encode(self) -> bytes:
        return b"sig " + bytes(4) + signature_bytes(self.value)

    @staticmethod
    def decode(data: bytes, where: str) -> Signature:
        return Signature(signature_text(unpack("4s", data, 8, where)[0]))
