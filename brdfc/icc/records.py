"""Types of fixed fields, then rows of fixed fields or bytes of another format: one table of them.

`dtim`, `meas`, `view`, `cicp`, `chrm`, `clro`, `clrt`, `data`, `ehim` and `enim`.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, cast

from brdfc.icc.layout import check_count, unpack
from brdfc.icc.signatures import signature_bytes
from brdfc.icc.tag import Tag
from brdfc.source.errors import ProfileError

Value = int | float | str | tuple[int, ...] | tuple[float, ...]


class Form(NamedTuple):
    """How a value is stored: struct's format, and what a number of the file is divided by."""

    packed: str
    unit: int = 1


FORMS = {
    "u8": Form("B"),
    "u16": Form("H"),
    "u32": Form("I"),
    "f32": Form("f"),
    "u16Fixed16": Form("I", 65536),
    "XYZ": Form("3i", 65536),
    "3 u16": Form("3H"),
    "name": Form("32s"),
}
"""XYZ: three s15Fixed16. name: up to 31 Latin-1 characters, ended by a NUL."""


class Layout(NamedTuple):
    """The fields, each (name, key of FORMS); counted: the field that says how many rows follow,
    which is not kept as it follows from the rows; payload: bytes up to the end follow instead."""

    fields: tuple[tuple[str, str], ...]
    row: tuple[tuple[str, str], ...] = ()
    counted: str = ""
    payload: bool = False


def _fields(form: str, names: str) -> tuple[tuple[str, str], ...]:
    return tuple((name, form) for name in names.split())


_TEXTURE = _fields("u32", "seamless format")

RECORDS: dict[str, Layout] = {
    "dtim": Layout(_fields("u16", "year month day hour minute second")),
    "meas": Layout(
        (
            ("observer", "u32"),
            ("backing", "XYZ"),
            ("geometry", "u32"),
            ("flare", "u16Fixed16"),
            ("illuminant", "u32"),
        )
    ),
    "view": Layout((*_fields("XYZ", "illuminant surround"), ("illuminant_type", "u32"))),
    "cicp": Layout(_fields("u8", "primaries transfer matrix full_range")),
    "chrm": Layout(_fields("u16", "channels colorant"), _fields("u16Fixed16", "x y"), "channels"),
    "clro": Layout(_fields("u32", "colorants"), _fields("u8", "index"), "colorants"),
    "clrt": Layout(_fields("u32", "colorants"), (("name", "name"), ("pcs", "3 u16")), "colorants"),
    "data": Layout(_fields("u32", "flag"), payload=True),
    "ehim": Layout((*_TEXTURE, *_fields("f32", "minimum maximum")), payload=True),
    "enim": Layout(_TEXTURE, payload=True),
}
"""By type signature. meas: the codes of the standard observer, geometry and illuminant, flare 0 to
1. chrm: chromaticities of phosphors or colorants. clrt: PCS as 16-bit codes. data: flag 0 for
ASCII, 1 for binary. ehim, enim: format 0 for PNG, 1 for TIFF; heights in metres."""


@dataclass(frozen=True)
class Record(Tag):
    """kind: the type signature; values, rows and payload: what RECORDS has for it, by name."""

    kind: str
    values: Mapping[str, Value]
    rows: tuple[tuple[Value, ...], ...] = ()
    payload: bytes = b""

    @property
    def type_signature(self) -> str:
        return self.kind

    def encode(self) -> bytes:
        layout = RECORDS[self.kind]
        values = {**self.values, layout.counted: len(self.rows)} if layout.counted else self.values
        names = [name for name, _ in layout.fields]
        if set(names) != set(values) or (self.rows and not layout.row):
            raise ProfileError(f"'{self.kind}' has the fields {', '.join(names)}")
        if self.payload and not layout.payload:
            raise ProfileError(f"'{self.kind}' takes no bytes after its fields")
        head = _pack_fields(layout.fields, [values[name] for name in names], self.kind)
        rows = (_pack_fields(layout.row, row, self.kind) for row in self.rows)
        return signature_bytes(self.kind) + bytes(4) + head + b"".join(rows) + self.payload

    @staticmethod
    def decode(data: bytes, where: str) -> Record:
        kind = data[:4].decode("latin-1")
        layout = RECORDS[kind]
        head, offset = _unpack_fields(layout.fields, data, 8, where)
        values = dict(zip((name for name, _ in layout.fields), head, strict=True))
        rows: list[tuple[Value, ...]] = []
        if layout.counted:
            count = values.pop(layout.counted)
            rows = _unpack_rows(layout.row, cast(int, count), data, offset, where)
        return Record(kind, values, tuple(rows), data[offset:] if layout.payload else b"")


Fields = tuple[tuple[str, str], ...]


def _size_of(fields: Fields) -> int:
    """The bytes that fields take."""
    return sum(struct.calcsize(f">{FORMS[form].packed}") for _, form in fields)


def _unpack_rows(
    row: Fields, count: int, data: bytes, offset: int, where: str
) -> list[tuple[Value, ...]]:
    """count rows from an offset on; that the bytes are there is checked first."""
    check_count(count, where)
    size = _size_of(row)
    if offset + count * size > len(data):
        raise ProfileError(
            f"{count} rows of {size} bytes from byte {offset} on, in {len(data)} bytes", where=where
        )
    return [
        _unpack_fields(row, data, offset + index * size, f"{where}, row {index}")[0]
        for index in range(count)
    ]


def _unpack_fields(
    fields: Fields, data: bytes, offset: int, where: str
) -> tuple[tuple[Value, ...], int]:
    """The values at an offset, and where they end."""
    values = []
    for name, form in fields:
        packed, unit = FORMS[form]
        numbers = unpack(packed, data, offset, where)
        values.append(_value(numbers, unit, f"{where}, {name}"))
        offset += struct.calcsize(f">{packed}")
    return tuple(values), offset


def _value(numbers: tuple[Any, ...], unit: int, where: str) -> Value:
    if isinstance(numbers[0], bytes):
        return read_name(numbers[0], where)
    if not all(map(math.isfinite, numbers)):
        raise ProfileError("a value is not a finite number", where=where)
    scaled = tuple(number / unit for number in numbers) if unit > 1 else numbers
    return scaled if len(scaled) > 1 else scaled[0]


def _pack_fields(fields: Fields, values: tuple[Value, ...] | list[Value], kind: str) -> bytes:
    """The bytes of values in the order of fields; ProfileError for what a form cannot hold."""
    try:
        return b"".join(
            struct.pack(f">{FORMS[form].packed}", *_numbers(value, FORMS[form].unit))
            for (_, form), value in zip(fields, values, strict=True)
        )
    except (struct.error, OverflowError, ValueError) as error:
        raise ProfileError(f"'{kind}' cannot hold a value: {error}") from error


def _numbers(value: Value, unit: int) -> list[Any]:
    if isinstance(value, str):
        return [name_bytes(value)]
    numbers = value if isinstance(value, tuple) else (value,)
    if not all(map(math.isfinite, numbers)):
        raise ValueError(f"{value} is not finite")
    return [round(number * unit) for number in numbers] if unit > 1 else list(numbers)


NAME_BYTES = 32


def read_name(data: bytes, where: str) -> str:
    """A name in 32 bytes, up to its NUL."""
    text, terminator, _ = data.partition(b"\0")
    if not terminator:
        raise ProfileError("a name without a terminating NUL", where=where)
    return text.decode("latin-1")


def name_bytes(name: str) -> bytes:
    """A name without the zeros that fill it up."""
    try:
        data = name.encode("latin-1")
    except UnicodeEncodeError:
        data = b"\0"
    if len(data) >= NAME_BYTES or b"\0" in data:
        raise ProfileError(f"a name is up to {NAME_BYTES - 1} Latin-1 characters, not {name!r}")
    return data
