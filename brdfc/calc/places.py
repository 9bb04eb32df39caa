"""Tables of (offset, size): where an element's parts stand in its bytes.

A part that several entries name is one part, written and decoded once. What is read is not
trusted: no part may lie outside the element, and none may overlap another, which would let a small
file stand for far more than its bytes.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import TypeVar

from brdfc.source.errors import ProgramError

Part = TypeVar("Part")
Place = tuple[int, int]
"""Offset from the start of the element, and size."""
ENTRY = 8


def encode_parts(
    parts: Sequence[Part], encode: Callable[[Part], bytes], start: int
) -> tuple[bytes, bytes]:
    """The entries for parts that begin at start, and the parts' bytes, each padded to 4."""
    data = bytearray()
    placed: dict[int, bytes] = {}
    for part in parts:  # one object in two places is written once
        if id(part) not in placed:
            encoded = encode(part)
            placed[id(part)] = struct.pack(">II", start + len(data), len(encoded))
            data += encoded + bytes(-len(encoded) % 4)
    return b"".join(placed[id(part)] for part in parts), bytes(data)


def decode_places(data: bytes, at: int, count: int, where: str) -> list[Place]:
    """count entries from byte `at` on, which the caller knows to be there; each inside `data`."""
    first_free = at + ENTRY * count
    places = list(struct.iter_unpack(">II", data[at:first_free]))
    for index, (offset, size) in enumerate(places):
        # An offset inside the header would let an element contain itself.
        if offset < first_free or offset + size > len(data):
            raise ProgramError(
                f"part {index} at {offset}, {size} bytes, lies outside the element", where=where
            )
    return places


def decode_parts(
    data: bytes,
    places: Sequence[Place],
    decode: Callable[[bytes, str], Part],
    name: str,
    where: str,
) -> tuple[Part, ...]:
    """Each place's part, decoded once; name is what messages call a part."""
    for (offset, size), (following, _) in pairwise(sorted(set(places))):
        if offset + size > following:
            raise ProgramError(f"{name}s at {offset} and {following} overlap", where=where)
    decoded: dict[Place, Part] = {}
    for index, (offset, size) in enumerate(places):
        if (offset, size) not in decoded:
            part = data[offset : offset + size]
            decoded[offset, size] = decode(part, f"{where}, {name} {index}")
    return tuple(decoded[place] for place in places)
