"""Profiles for the tests of the container."""

import struct

from brdfc.calc.program import Op, Program
from brdfc.icc.header import D50, Header
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import multiplex_space, n_channel_space
from brdfc.icc.types import (
    Dictionary,
    LocalizedText,
    NumberArray,
    Pipeline,
    Tag,
    Utf8Array,
    XYZArray,
)

# { in[0,3] out[0,3] }
COPY = Pipeline(3, 3, (Program(3, 3, (Op("in", 0, 3), Op("out", 0, 3))),))
NAMES = Utf8Array(("Rdx", "Rdy", "ρdz"))
META = Dictionary((("model", "ward"), ("empty", ""), ("Größe", "α < β & 𝛾"), ("again", "ward")))


def mid(**changes: Tag | None) -> Profile:
    """A MID of three channels with the tags that brdfc writes; None takes a tag away."""
    tags = {
        "desc": LocalizedText.english("Ward, device to multiplex"),
        "cprt": LocalizedText.english("No copyright, use freely"),
        "A2M0": COPY,
        "mcta": NAMES,
        "meta": META,
    }
    header = Header("mid ", colour_space=n_channel_space(3), mcs=multiplex_space(3))
    return Profile(header, _changed(tags, changes))


def mvis(**changes: Tag | None) -> Profile:
    """An MVIS that takes the same channels for XYZ."""
    tags = {
        "desc": LocalizedText.english("Ward, multiplex to XYZ"),
        "cprt": LocalizedText.english("No copyright, use freely"),
        "wtpt": XYZArray((D50,)),
        "M2B0": COPY,
        "mcta": NAMES,
        "mdv ": NumberArray("fl32", (0.5, 0.25, 0.125)),
        "meta": META,
    }
    return Profile(Header("mvis", pcs=b"XYZ ", mcs=multiplex_space(3)), _changed(tags, changes))


def _changed(tags: dict[str, Tag], changes: dict[str, Tag | None]) -> dict[str, Tag]:
    # Keywords cannot end in a space: mdv stands for 'mdv '.
    changed = tags | {name.ljust(4): tag for name, tag in changes.items()}
    return {name: tag for name, tag in changed.items() if tag is not None}


# 1 device channel, 1 multiplex channel called "A", { in(0) 0.5 mul out(0) }; from a profile that
# both known releases of the reference accept.
_TEXT = "6d6c7563 00000000 00000001 0000000c 656e5553 00000002 0000001c 0078 0000"
MINIMAL_MID = bytes.fromhex(
    "00000174 00000000 05000000 6d696420 6e630001 00000000 07e9 0001 0002 0003 0004 0005"
    "61637370 00000000 00000000 00000000 00000000 0000000000000000 00000000"
    "0000f6d6 00010000 0000d32d 00000000 00000000000000000000000000000000"
    "00000000 000000000000 000000000000 6d630001 00000000 00000000"
    "00000004"
    "64657363 000000b4 0000001e  63707274 000000d4 0000001e"
    "41324d30 000000f4 0000005c  6d637461 00000150 00000024"
    + _TEXT
    + _TEXT
    + "6d706574 00000000 0001 0001 00000001 00000018 00000044"
    "63616c63 00000000 0001 0001 00000000 00000018 0000002c"
    "66756e63 00000000 00000004"
    "696e2020 0000 0000  64617461 3f000000  6d756c20 0000 0000  6f757420 0000 0000"
    "74617279 00000000 75746638 00000001 00000018 0000000a 75746638 00000000 41 00 0000"
)


def patched(data: bytes, offset: int, form: str, *values: object) -> bytes:
    """The bytes with big-endian fields put over them."""
    changed = bytearray(data)
    struct.pack_into(f">{form}", changed, offset, *values)
    return bytes(changed)


def entry_of(data: bytes, signature: str) -> int:
    """Where the tag table has this signature."""
    return data.index(signature.encode("latin-1"), 128)


def tag_start(data: bytes, signature: str) -> int:
    """Where this tag's bytes begin."""
    return int(struct.unpack_from(">I", data, entry_of(data, signature) + 4)[0])
