"""One tag of every type that versions 2 and 4 have, generated for the tests."""

import struct
import zlib

from brdfc.calc.samples import Samples
from brdfc.icc.colorants import NamedColour
from brdfc.icc.sequences import ProfileDescription
from brdfc.icc.types import (
    CompressedText,
    FixedArray,
    GamutBoundary,
    LocalizedText,
    NamedColours,
    NumberArray,
    PlainText,
    ProfileIdentifiers,
    ProfileSequence,
    Record,
    Signature,
    Structure,
    Tag,
    TagArray,
    TextDescription,
    Utf8Text,
)

TEXT = LocalizedText((("enUS", "maker"), ("deDE", "Hersteller")))
ODD = LocalizedText.english("odd")  # 34 bytes, which takes padding
COLORANT = Structure("cinf", {"name": Utf8Text("cyan"), "pcs ": NumberArray("fl32", (50.0, 0, 1))})

TYPES: dict[str, Tag] = {
    "sf32": FixedArray("sf32", (1.0, -0.5, 1 / 65536, -32768.0)),
    "uf32": FixedArray("uf32", (0.0, 65535.5)),
    "text": PlainText("targets: é"),
    "desc": TextDescription("Ward", "Wärd 𝛾", 7, b"W\x8ard\0", 3),
    "desc short": TextDescription(""),
    "zut8": CompressedText("zut8", zlib.compress("spectra ρ".encode())),
    "zxml": CompressedText("zxml", b"not compressed at all"),
    "dtim": Record(
        "dtim",
        {"year": 2024, "month": 2, "day": 29, "hour": 23, "minute": 59, "second": 60},
    ),
    "meas": Record(
        "meas",
        {
            "observer": 1,
            "backing": (0.5, 1.0, -0.25),
            "geometry": 2,
            "flare": 1 / 65536,
            "illuminant": 8,
        },
    ),
    "view": Record(
        "view",
        {"illuminant": (96.5, 100.0, 82.5), "surround": (20.0, 20.5, 0.0), "illuminant_type": 1},
    ),
    "cicp": Record("cicp", {"primaries": 9, "transfer": 16, "matrix": 0, "full_range": 1}),
    "chrm": Record("chrm", {"colorant": 1}, ((0.625, 0.25), (1 / 65536, 0.5))),
    "clro": Record("clro", {}, ((2,), (0,), (255,))),
    "clrt": Record("clrt", {}, (("Cyan", (1, 2, 65535)), ("Orange", (0, 0, 0)))),
    "data": Record("data", {"flag": 1}, payload=b"\0\1binary"),
    "ehim": Record(
        "ehim",
        {"seamless": 1, "format": 0, "minimum": -0.5, "maximum": 0.25},
        payload=b"\x89PNG",
    ),
    "enim": Record("enim", {"seamless": 0, "format": 1}, payload=b"II*\0"),
    "ncl2": NamedColours(
        (
            NamedColour("Orange", (1, 2, 3), (4, 5, 6, 65535)),
            NamedColour("Green", (0, 0, 0), (0, 0, 0, 0)),
        ),
        4,
        "PX ",
        " C",
        0x80000001,
    ),
    "ncl2 without device": NamedColours((NamedColour("Red", (1, 2, 3), ()),), 0),
    "pseq": ProfileSequence(
        (
            ProfileDescription("APPL", "", 2**63, "vidm", TEXT, ODD),
            ProfileDescription("", "modl", 1, "", ODD, TEXT),
        )
    ),
    "pseq of version 2": ProfileSequence(
        (ProfileDescription("aaaa", "", 0, "", TextDescription("x"), TextDescription("yz")),) * 2
    ),
    "psid": ProfileIdentifiers(((bytes(range(16)), TEXT), (bytes(16), ODD))),
    "gbd ": GamutBoundary(
        3,
        1,
        4,
        struct.pack(">6I", 0, 1, 2, 1, 2, 3),
        Samples.of(range(12)),
        Samples.of((0.0, 0.25, 0.5, -1.0)),
    ),
    "gbd  without device": GamutBoundary(3, 0, 0, b"", Samples.of(()), Samples.of(())),
    "tary": TagArray("cinf", (COLORANT, None, COLORANT, Structure("cinf", {}))),
    "tary of arrays": TagArray(
        "nmcl", (TagArray("cinf", ()), TagArray("sig ", (Signature("what"),)))
    ),
}
