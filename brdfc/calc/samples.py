"""The numbers of curves and tables, kept as a file holds them: big-endian, in a storage type."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from brdfc.source.errors import ProgramError


class Storage(Enum):
    """How a number is stored (ICC.2, valueEncodingType): its code, NumPy type, and what stands
    for 1."""

    FLOAT32 = (0, ">f4", 1)
    FLOAT16 = (1, ">f2", 1)
    UINT16 = (2, ">u2", 65535)
    UINT8 = (3, ">u1", 255)

    @property
    def code(self) -> int:
        return self.value[0]

    @property
    def dtype(self) -> np.dtype[np.generic]:
        return np.dtype(self.value[1])

    @property
    def one(self) -> int:
        return self.value[2]

    @staticmethod
    def of_code(code: int, where: str) -> Storage:
        for storage in Storage:
            if storage.code == code:
                return storage
        raise ProgramError(f"no storage type has the number {code}", where=where)


@dataclass(frozen=True)
class Samples:
    """Finite numbers. As bytes they compare and copy exactly, and a large table stays small."""

    storage: Storage
    data: bytes

    @staticmethod
    def of(values: ArrayLike, storage: Storage = Storage.FLOAT32) -> Samples:
        """The numbers rounded to a storage type; whole-number types hold 0 to 1."""
        array = np.asarray(values, dtype=np.float64).ravel()
        if storage.one > 1:
            if not ((array >= 0) & (array <= 1)).all():
                raise ProgramError(f"{storage.name} holds numbers from 0 to 1 only")
            array = np.floor(array * storage.one + 0.5)
        with np.errstate(over="ignore"):
            stored = array.astype(storage.dtype)
        if not np.isfinite(stored).all():
            raise ProgramError(f"a number is not finite as {storage.name}")
        return Samples(storage, stored.tobytes())

    @staticmethod
    def read(storage: Storage, count: int, data: bytes, offset: int, where: str) -> Samples:
        """count numbers from an offset on; nothing is copied before they are known to be there."""
        end = offset + count * storage.dtype.itemsize
        if end > len(data):
            raise ProgramError(
                f"{count} numbers ({storage.name}) are claimed, {max(0, len(data) - offset)} "
                "bytes are left",
                where=where,
            )
        # Looked at in place, so that a large table that is refused is not copied first.
        stored = np.frombuffer(data, dtype=storage.dtype, count=count, offset=offset)
        wrong = np.flatnonzero(~np.isfinite(stored))
        if len(wrong):
            raise ProgramError(f"sample {wrong[0]} is NaN or infinite", where=where)
        return Samples(storage, bytes(data[offset:end]))

    @property
    def count(self) -> int:
        return len(self.data) // self.storage.dtype.itemsize

    @cached_property
    def values(self) -> NDArray[np.float32]:
        """The numbers as the reference engine reads them; whole numbers divided in float64."""
        stored = np.frombuffer(self.data, dtype=self.storage.dtype)
        if self.storage.one > 1:
            stored = stored / np.float64(self.storage.one)
        values = stored.astype(np.float32)
        values.setflags(write=False)
        return values
