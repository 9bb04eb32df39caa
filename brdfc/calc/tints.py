"""Tint arrays (`tint`): the outputs at equal steps of one input, and their bytes."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from brdfc.calc.program import OpaqueElement
from brdfc.calc.samples import Samples, Storage
from brdfc.source.errors import ProgramError

HEADER = 20
"""Bytes before the numbers: those of the element, then signature and 0 of the array."""

_ARRAYS = {
    b"fl32": Storage.FLOAT32,
    b"fl16": Storage.FLOAT16,
    b"ui16": Storage.UINT16,
    b"ui08": Storage.UINT8,
}
"""The arrays of numbers that are run, by their signatures. Elements with other ones are carried."""
_SIGNATURES = {storage: signature for signature, storage in _ARRAYS.items()}


@dataclass(frozen=True)
class TintArray:
    """Outputs at equal steps over 0..1; the outputs of a step stand side by side. There are two
    steps at least."""

    outputs: int
    samples: Samples

    @property
    def inputs(self) -> int:
        return 1

    @property
    def signature(self) -> str:
        return "tint"


def encode_tint(tint: TintArray) -> bytes:
    """The element from its own signature on."""
    _check(tint, "a tint array")
    head = struct.pack(">4sIHH", b"tint", 0, 1, tint.outputs)
    return head + _SIGNATURES[tint.samples.storage] + bytes(4) + tint.samples.data


def decode_tint(data: bytes, inputs: int, outputs: int, where: str) -> TintArray | OpaqueElement:
    """The tint array that `data` is, its header of 12 bytes included; opaque where its numbers are
    of another type than those that are run."""
    storage = _ARRAYS.get(data[12:16])
    if storage is None:
        return OpaqueElement("tint", inputs, outputs, bytes(data))
    if inputs != 1:
        raise ProgramError(f"a tint array has 1 input, not {inputs}", where=where)
    count, rest = divmod(len(data) - HEADER, storage.dtype.itemsize)
    if rest or count < 0:
        raise ProgramError("the tint array ends within a number", where=where)
    tint = TintArray(outputs, Samples.read(storage, count, data, HEADER, where))
    _check(tint, where)
    return tint


def _check(tint: TintArray, where: str) -> None:
    count = tint.samples.count
    if tint.outputs < 1 or count % tint.outputs or count // tint.outputs < 2:
        raise ProgramError(
            f"a tint array needs two steps or more of {tint.outputs} outputs, and has {count} "
            "numbers",
            where=where,
        )
