"""Changes to a profile's bytes that keep most of its structure, so that the rest is still reached.

What a profile holds lies in words of four bytes: signatures, counts, offsets, sizes, operands and
numbers. A change takes a word for what it looks like and puts another of the same kind there, or
moves words about, or changes a program's operations and makes the sizes around them right.
"""

from __future__ import annotations

import random
import struct
from collections.abc import Callable

from fuzz_programs import with_another_program

from brdfc.calc.operators import BY_SIGNATURE, CASE, DEFAULT, ELSE, IF, SELECT
from brdfc.icc.tags import TAGS
from brdfc.icc.types import DECODERS

Change = Callable[[bytearray, random.Random], None]

WORD = 4
HEADER = 128
OPERATIONS = (*BY_SIGNATURE, IF, ELSE, SELECT, CASE, DEFAULT)
ELEMENTS = (b"calc", b"func", b"matf", b"cvst", b"clut", b"xclt", b"tint", b"XtoJ", b"clmt")
CURVES = (b"sngf", b"curf", b"parf", b"samf", b"clcf")
TYPES = (*DECODERS, b"tstr", b"text")
SIGNATURES = (
    *(set(OPERATIONS), set(ELEMENTS), set(CURVES), set(TYPES)),
    {signature.encode("latin-1") for signature in TAGS},
)
"""Words that may stand for each other."""
NOT_FINITE = (0x7FC00000, 0xFFC00000, 0x7F800000, 0xFF800000)
NUMBERS = (0x00000000, 0x80000000, 0x3F800000, 0xBF800000, 1, 0x7F7FFFFF, 0xFF7FFFFF)
TOP = 0xFFFFFFFF


def mutated(data: bytes, generator: random.Random, others: tuple[bytes, ...]) -> bytes:
    """The bytes after one change or a few; others: files that parts may come from."""
    if generator.random() < 0.3:
        data = with_another_program(data, generator)
        if generator.random() < 0.7:
            return data
    changed = bytearray(data)
    for _ in range(generator.choice((1, 1, 1, 2, 3, 6))):
        if generator.random() < 0.02:
            splice(changed, generator, generator.choice(others))
        else:
            generator.choice(CHANGES)(changed, generator)
    if len(changed) >= WORD and generator.random() < 0.9:  # else nearly all end at the size
        struct.pack_into(">I", changed, 0, len(changed))
    return bytes(changed)


def place(data: bytearray, generator: random.Random) -> int:
    """Where a word begins: in the header, the table of tags, or the beginning of a tag or all of
    it, each as often as the other."""
    tags = min(struct.unpack_from(">I", data, HEADER)[0], 40) if len(data) > HEADER + WORD else 0
    chosen = generator.randrange(8)
    start, end = 0, len(data)
    if chosen == 0:
        end = HEADER
    elif chosen == 1:
        start, end = HEADER, HEADER + WORD + 12 * tags
    elif chosen < 7 and tags:
        entry = HEADER + WORD + 12 * generator.randrange(tags)
        if entry + 12 <= len(data):
            start, size = struct.unpack_from(">II", data, entry + WORD)
            end = start + (min(size, 96) if chosen < 5 else size)
    end = min(end, len(data)) - WORD
    start = min(start, max(end, 0))
    return generator.randrange(start, max(end, start) + 1) // WORD * WORD


def change_word(data: bytearray, generator: random.Random) -> None:
    """A word for another of its kind."""
    at = place(data, generator)
    word = bytes(data[at : at + WORD])
    if len(word) < WORD:
        return
    (number,) = struct.unpack(">I", word)
    kinds = [kind for kind in SIGNATURES if word in kind]
    if kinds and generator.random() < 0.9:
        new = generator.choice(sorted(kinds[0]))
    elif number <= max(len(data), 0x1000):
        new = struct.pack(">I", near(number, len(data), generator) & TOP)
    elif number >> 16 <= 0x40 and number & 0xFFFF <= 0x40:
        new = struct.pack(
            ">HH", *(near(h, 16, generator) & 0xFFFF for h in struct.unpack(">HH", word))
        )
    else:
        new = struct.pack(">I", generator.choice((*NOT_FINITE, *NUMBERS, number ^ 0x80000000)))
    data[at : at + WORD] = new


def near(number: int, size: int, generator: random.Random) -> int:
    """A count, an offset or a size that might just pass, or overflow."""
    steps = (1, -1, 2, -2, 4, -4, 8, -8, 12, 28, -28)
    extremes = (0, 1, 2, 3, 64, 255, 256, 0x7FFF, 0x8000, 0xFFFF, 0x10000, 0x10001, 1 << 20)
    huge = (0x7FFFFFFF, 0x80000000, TOP - 3, TOP, (1 << 29) + 1, (1 << 30) + 1, -size)
    return generator.choice(
        (
            number + generator.choice(steps),
            generator.choice(extremes),
            generator.choice(huge),
            2 * number,
            number // 2,
            generator.randrange(size + 1),
        )
    )


def change_half(data: bytearray, generator: random.Random) -> None:
    """Two bytes, such as a number of channels."""
    at = place(data, generator) + generator.choice((0, 2))
    if at + 2 <= len(data):
        (number,) = struct.unpack_from(">H", data, at)
        struct.pack_into(">H", data, at, near(number, 16, generator) & 0xFFFF)


def change_byte(data: bytearray, generator: random.Random) -> None:
    """A byte, such as a number of grid points."""
    if data:
        at = min(place(data, generator) + generator.randrange(WORD), len(data) - 1)
        data[at] = generator.choice(
            (0, 1, 2, 0x7F, 0x80, 0xFF, data[at] ^ 1 << generator.randrange(8))
        )


def exchange(data: bytearray, generator: random.Random) -> None:
    """Two runs of words for each other."""
    one, other = place(data, generator), place(data, generator)
    size = WORD * generator.choice((1, 1, 2, 3))
    a, b = bytes(data[one : one + size]), bytes(data[other : other + size])
    if len(a) == len(b) == size:
        data[one : one + size], data[other : other + size] = b, a


def repeat(data: bytearray, generator: random.Random) -> None:
    """A run of words put over another place: two entries then lead to one, or into each other."""
    one, other = place(data, generator), place(data, generator)
    size = WORD * generator.choice((1, 2, 3, 6))
    part = bytes(data[one : one + size])
    data[other : other + len(part)] = part


def remove(data: bytearray, generator: random.Random) -> None:
    """Words left out, or the end cut off."""
    at = place(data, generator)
    length = WORD * generator.choice((1, 2, 3)) if generator.random() < 0.7 else len(data)
    del data[max(at, WORD) : at + length]


def insert(data: bytearray, generator: random.Random) -> None:
    """Words put in."""
    at = place(data, generator)
    data[at:at] = bytes(WORD * generator.choice((1, 2, 4)))


def splice(data: bytearray, generator: random.Random, other: bytes) -> None:
    """The rest of another file from some word on."""
    at = place(data, generator)
    data[at:] = other[at:]


CHANGES: tuple[Change, ...] = (
    *(change_word,) * 8,
    *(change_half, change_byte) * 2,
    *(exchange, repeat, remove, insert),
)
