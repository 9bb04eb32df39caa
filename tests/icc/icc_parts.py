"""Profiles put together byte by byte, so that any one thing in them can be made wrong."""

from __future__ import annotations

import struct

from icc_samples import META, NAMES, entry_of, patched, tag_start

from brdfc.calc.program import OpaqueElement
from brdfc.icc.header import D50, Header
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import n_channel_space
from brdfc.icc.types import LocalizedText, NumberArray, Opaque, Pipeline, XYZArray


def profile(*elements: bytes, **tags: bytes) -> bytes:
    """A profile of three device values with these elements in A2B0, and more tags."""
    carried = tuple(OpaqueElement("", 3, 3, data) for data in elements)
    return Profile(
        Header("scnr", colour_space=n_channel_space(3), pcs=b"XYZ "),
        {
            "desc": LocalizedText.english("Ward, device to XYZ"),
            "cprt": LocalizedText.english("No copyright, use freely"),
            "wtpt": XYZArray((D50,)),
            "A2B0": Pipeline(3, 3, carried),
            "mcta": NAMES,
            "mdv ": NumberArray("fl32", (0.5, 0.25, 0.125)),
            "meta": META,
            **{name: Opaque(data) for name, data in tags.items()},
        },
    ).to_bytes()


def header(kind: str, inputs: int = 3, outputs: int = 3) -> bytes:
    """What every element begins with."""
    return struct.pack(">4sIHH", kind.encode(), 0, inputs, outputs)


def op(name: str, first: int = 0, second: int = 0) -> bytes:
    return struct.pack(">4sHH", name.ljust(4).encode(), first, second)


def jump(name: str, length: int = 0) -> bytes:
    return struct.pack(">4sI", name.ljust(4).encode(), length)


IN, OUT = op("in", 0, 2), op("out", 0, 2)


def calc(*words: bytes, parts: tuple[bytes, ...] = ()) -> bytes:
    """A calculator of these operations that calls these parts."""
    main = b"func" + struct.pack(">II", 0, len(words)) + b"".join(words)
    at = 16 + 8 * (len(parts) + 1)
    places, body = struct.pack(">II", at, len(main)), main
    for part in parts:
        places += struct.pack(">II", at + len(body), len(part))
        body += part
    return header("calc") + struct.pack(">I", len(parts)) + places + body


def curves(*, count: int = 2, first: float = 0, last: float = 1, low: float = 0) -> bytes:
    """A curve set of one sampled curve for all channels."""
    curve = struct.pack(">4sIIffHH2f", b"sngf", 0, count, first, last, 0, 0, low, 1)
    return header("cvst") + struct.pack(">II", 36, len(curve)) * 3 + curve


def segments(breaks: tuple[float, ...], parameters: tuple[float, ...] = (1, 1, 0, 0)) -> bytes:
    """A curve set of one segmented curve for all channels: formulas between breaks."""
    curve = struct.pack(f">4sIHH{len(breaks)}f", b"curf", 0, len(breaks) + 1, 0, *breaks)
    curve += struct.pack(">4sIHH4f", b"parf", 0, 0, 0, *parameters) * (len(breaks) + 1)
    return header("cvst") + struct.pack(">II", 36, len(curve)) * 3 + curve


def table(grid: tuple[int, ...] = (2, 2, 2), numbers: int = 24, low: float = 0) -> bytes:
    """A lookup table with as many numbers as it is given."""
    head = header("clut", len(grid)) + bytes(grid[:16]).ljust(16, b"\0")
    return head + struct.pack(f">{numbers}f", *[low] * numbers)


def array(*names: bytes) -> bytes:
    """Names of channels, their bytes as given."""
    entries = [b"utf8" + bytes(4) + name for name in names]
    at, places = 16 + 8 * len(names), b""
    for entry in entries:
        places += struct.pack(">II", at, len(entry))
        at += len(entry)
    head = struct.pack(">4sI4sI", b"tary", 0, b"utf8", len(names))
    return head + places + b"".join(entries)


def structure(member: bytes, count: int = 1, offset: int = 28) -> bytes:
    head = struct.pack(">4sI4sI", b"tstr", 0, b"brdf", count)
    return head + struct.pack(">4sII", b"type", offset, len(member)) + member


def conditions(*, start: float = 400, steps: int = 2, value: float = 1) -> bytes:
    """Viewing conditions of so many wavelengths."""
    spectral = struct.pack(">eeHH", start, 700, steps, 0)
    observer = struct.pack(">4sII", b"svcn", 0, 0) + spectral + struct.pack(">6f", *[value] * 6)
    light = struct.pack(">If", 0, 0) + spectral + struct.pack(">2f", value, value)
    return observer + light + struct.pack(">6f", *[1] * 6)


GOOD = profile(calc(IN, OUT), curves(), segments((0.5,)), table())


def put(data: bytes, tag: str, offset: int, form: str, *values: object) -> bytes:
    """Fields put over the bytes of one tag."""
    return patched(data, tag_start(data, tag) + offset, form, *values)


def entry(tag: str, form: str, *values: object) -> bytes:
    """The offset and size of one tag put over."""
    return patched(GOOD, entry_of(GOOD, tag) + 4, form, *values)


def nested(levels: int, calls: int = 1) -> bytes:
    """Calculators in calculators; each calls the next so many times, by as many entries."""
    inner = calc(IN, OUT)
    for _ in range(levels):
        words = [IN, *(op("calc", i) for i in range(calls)), OUT]
        outer = bytearray(calc(*words, parts=(inner, *(b"",) * (calls - 1))))
        for i in range(1, calls):  # the same place again
            outer[24 + 8 * i + 8 :][:8] = outer[24:32]
            outer[24 + 8 * i : 32 + 8 * i] = outer[24:32]
        inner = bytes(outer)
    return inner


def within(levels: int) -> bytes:
    inner = b"sig " + bytes(4) + b"Ward"
    for _ in range(levels):
        inner = structure(inner)
    return inner
