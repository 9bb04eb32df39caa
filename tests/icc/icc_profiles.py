"""Profiles of versions 2 and 4, generated for the tests."""

from icc_luts import CURVES, staged_lut, table_lut
from icc_types import TYPES

from brdfc.icc.colorants import NamedColour
from brdfc.icc.curves import Curve
from brdfc.icc.header import D50, Header
from brdfc.icc.profile import Profile
from brdfc.icc.sequences import ProfileDescription
from brdfc.icc.types import (
    FixedArray,
    LocalizedText,
    NamedColours,
    PlainText,
    ProfileSequence,
    Record,
    Signature,
    Tag,
    TextDescription,
    Utf8Text,
    XYZArray,
)

V2, V4, V5 = 0x02400000, 0x04400000, 0x05000000


def texts(version: int) -> dict[str, Tag]:
    if version < V4:
        return {"desc": TextDescription("generated"), "cprt": PlainText("no copyright")}
    return dict.fromkeys(("desc", "cprt"), LocalizedText.english("generated"))


def made(kind: str, space: bytes, pcs: bytes, version: int, tags: dict[str, Tag | None]) -> Profile:
    white = {} if kind == "link" else {"wtpt": XYZArray((D50,))}
    every = {**texts(version), **white, **tags}
    header = Header(kind, space, pcs, version=version)
    return Profile(header, {name: tag for name, tag in every.items() if tag is not None})


def display(version: int = V4, **changes: Tag | None) -> Profile:
    """Three curves and three colorants."""
    colorants = dict.fromkeys(("rXYZ", "gXYZ", "bXYZ"), XYZArray(((0.25, 0.5, 0.125),)))
    curves = dict.fromkeys(("rTRC", "gTRC", "bTRC"), Curve(gamma=2.5))
    chad = FixedArray("sf32", (1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0))
    return made("mntr", b"RGB ", b"XYZ ", version, {**colorants, **curves, "chad": chad, **changes})


def printer(version: int = V4, **changes: Tag | None) -> Profile:
    """Tables in both directions; from version 4 on in stages."""
    if version < V4:
        forward, back = table_lut(8, 4, 3, 3), table_lut(16, 3, 4, 3, 17)
    else:
        forward, back = staged_lut("mAB ", 4), staged_lut("mBA ", 4)
    tags: dict[str, Tag | None] = {
        "A2B0": forward,
        "A2B1": forward,
        "A2B2": forward,
        "B2A0": back,
        "B2A1": back,
        "B2A2": back,
        "gamt": table_lut(8, 3, 1, 2),
        "tech": Signature("offs"),
        "calt": TYPES["dtim"],
        "targ": Utf8Text("targets") if version >= V5 else PlainText("targets"),
        "view": TYPES["view"],
        "meas": TYPES["meas"],
        "lumi": XYZArray(((0.0, 80.0, 0.0),)),
    }
    return made("prtr", b"CMYK", b"Lab ", version, {**tags, **changes})


def gray(version: int = V4, **changes: Tag | None) -> Profile:
    return made("mntr", b"GRAY", b"XYZ ", version, {"kTRC": CURVES[2], **changes})


def named(version: int = V4, **changes: Tag | None) -> Profile:
    colours = tuple(NamedColour(n, (1, 2, 3), (4, 5, 6, 7)) for n in ("Orange", "Green"))
    tags = {"ncl2": NamedColours(colours, 4, "", ""), **changes}
    return made("nmcl", b"CMYK", b"Lab ", version, tags)


def link(version: int = V4, **changes: Tag | None) -> Profile:
    """From one printer to another of three inks, all of whose colorants are named."""
    # Of a size that needs no padding, about which releases of the reference disagree.
    text = LocalizedText.english("even") if version >= V4 else TextDescription("even")
    sequence = ProfileSequence((ProfileDescription("", "", 0, "", text, text),) * 2)
    inks = Record("clrt", {}, tuple((name, (0, 0, 0)) for name in ("a", "b", "c")))
    tags = {"A2B0": table_lut(16, 4, 3, 3, 17), "pseq": sequence, "clot": inks, **changes}
    return made("link", b"CMYK", b"3CLR", version, tags)


GOOD = {
    f"{make.__name__} {version >> 24}": make(version)
    for make in (display, printer, gray, named, link)
    for version in (V2, V4)
} | {"display 5": display(V5), "printer 5": printer(V5), "link 5": link(V5)}

BAD: dict[str, tuple[Profile, str, str]] = {
    "no curve": (display(gTRC=None), "A2B0", "required: A2B0 with B2A0 or rXYZ"),
    "one way": (display(rTRC=None, A2B0=table_lut(16, 3, 3, 2, 4)), "A2B0", "required: A2B0 with"),
    "no gamut": (printer(gamt=None), "gamt", "required: gamt or kTRC"),
    "one intent": (printer(A2B1=None), "A2B1", "required: A2B1 or kTRC"),
    "no sequence": (link(pseq=None), "pseq", "required: pseq"),
    "inks without names": (link(clot=None), "clot", "required: clot"),
    "no colours": (named(ncl2=None), "ncl2", "required: ncl2"),
    "stages in version 2": (
        printer(V2, A2B0=staged_lut("mAB ", 4)),
        "A2B0",
        "of type 'mAB ', not mft1 or mft2",
    ),
    "text of version 4 in 2": (
        display(V2, desc=LocalizedText.english("x")),
        "desc",
        "of type 'mluc', not desc",
    ),
    "text of version 2 in 4": (display(cprt=PlainText("x")), "cprt", "of type 'text', not mluc"),
    "back to front": (printer(B2A0=staged_lut("mAB ", 4)), "B2A0", "of type 'mAB '"),
    "a colour as curve": (display(rTRC=XYZArray((D50,))), "rTRC", "of type 'XYZ '"),
    "too few inks": (printer(A2B0=staged_lut("mAB ", 2)), "A2B0", "2 channels in, the header says"),
    "too few coordinates": (
        named(ncl2=NamedColours((NamedColour("a", (0, 0, 0), (1,)),), 1)),
        "ncl2",
        "1 device coordinates, not 4",
    ),
    "too few names": (
        link(clot=Record("clrt", {}, (("a", (0, 0, 0)),))),
        "clot",
        "1 colorants, not 3",
    ),
}
"""Profiles with an error, its tag, and what is said of it."""
