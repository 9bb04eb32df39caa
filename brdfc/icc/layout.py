"""Parts at given places: the tables of (offset, size) that tags, pipelines and texts share.

What is read is not trusted: every place is checked before a byte of it is touched. Places may
be the same (the parts are then one part, decoded once), but must not overlap otherwise: a few
kilobytes of overlapping places could stand for gigabytes.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeVar

from brdfc.source.errors import ProfileError, ProgramError

Part = TypeVar("Part")
Place = tuple[int, int]
"""Offset from the start of the enclosing bytes, and size."""

MAX_ENTRIES = 65536
"""How many entries any table or array may have: channels and wavelengths are counted in 16 bits."""


def unpack(form: str, data: bytes, offset: int, where: str) -> tuple[Any, ...]:
    """struct.unpack_from of big-endian fields, ProfileError where the data end before them."""
    try:
        return struct.unpack_from(f">{form}", data, offset)
    except struct.error:
        needed = offset + struct.calcsize(f">{form}")
        raise ProfileError(f"{len(data)} bytes where {needed} are needed", where=where) from None


@contextmanager
def profile_errors() -> Iterator[None]:
    """What is wrong with a program or table inside is wrong with the profile."""
    try:
        yield
    except ProgramError as error:
        raise ProfileError(error.message, where=error.where, hint=error.hint) from error


def check_count(count: int, where: str) -> None:
    """Refuse counts over MAX_ENTRIES."""
    if count > MAX_ENTRIES:
        raise ProfileError(f"{count} entries, more than {MAX_ENTRIES}", where=where)


def unpack_records(
    form: str, count: int, data: bytes, offset: int, where: str
) -> list[tuple[Any, ...]]:
    """count records of the same fields, one after the other; the count is checked first."""
    check_count(count, where)
    size = struct.calcsize(f">{form}")
    if count * size > len(data) - offset:
        raise ProfileError(
            f"{count} entries of {size} bytes from byte {offset} on, in {len(data)} bytes",
            where=where,
        )
    return list(struct.iter_unpack(f">{form}", data[offset : offset + count * size]))


def read_parts(
    data: bytes,
    places: Sequence[Place],
    labels: Sequence[str],
    first: int,
    where: str,
    decode: Callable[[bytes, str], Part],
) -> list[Part]:
    """Each place's part, decoded once per distinct place.

    labels name the parts in messages; first is where parts may begin at the earliest. A place of
    size 0 is read as no bytes, wherever it points.
    """
    named = dict(zip(reversed(places), reversed(labels), strict=True))  # the first to name a place
    _check(named, first, len(data), where)
    decoded = {
        (offset, size): decode(
            data[offset : offset + size] if size else b"", f"{where}, {label} at byte {offset}"
        )
        for (offset, size), label in named.items()
    }
    return [decoded[place] for place in places]


def _check(named: dict[Place, str], first: int, end: int, where: str) -> None:
    last_end, last_label = first, "the table of entries"
    for offset, size in sorted(place for place in named if place[1]):
        label = named[offset, size]
        if offset + size > end:
            raise ProfileError(
                f"{label} takes bytes {offset} to {offset + size}, past the end at {end}",
                where=where,
            )
        if offset < last_end:
            raise ProfileError(f"{label} at byte {offset} overlaps {last_label}", where=where)
        last_end, last_label = offset + size, label


def write_parts(
    parts: Iterable[Part],
    encode: Callable[[Part], bytes],
    key: Callable[[Part], Hashable],
    start: int,
    align: int = 4,
) -> tuple[list[Place], bytes]:
    """The places of the parts, and their bytes, which begin at start; each padded with zeros.

    Parts with the same key are written once.
    """
    placed: dict[Hashable, Place] = {}
    places = []
    body = bytearray()
    for part in parts:
        if key(part) not in placed:
            data = encode(part)
            placed[key(part)] = (start + len(body), len(data))
            body += data + bytes(-len(data) % align)
        places.append(placed[key(part)])
    return places, bytes(body)
