"""The names of the reference's XML, as data (release 2.2.61; its misspellings too, for they are the
names that it reads)."""

from __future__ import annotations

from brdfc.icc.signatures import signature_bytes, space_text
from brdfc.icc.tags import TAGS

# --- tags ---------------------------------------------------------------------------------------

# Where the reference calls a tag otherwise than the specification does.
_OTHER_NAMES = {
    "meta": "metaData",
    "mcta": "materialTypeArray",
    "mdv ": "materialDefaultValues",
    "H2S2": "HTSB2",
    "CxF ": "Cxf",
    **{f"{c[0]}XYZ": f"{c}Colorant" for c in ("red", "green", "blue")},
    **{f"bAB{n}": f"BRDFAToB{n}" for n in "0123"},
    **{f"bDB{n}": f"BRDFDToB{n}" for n in "0123"},
}
_REFERENCE_LACKS = ("clin", "clio", "nmcl", "ciis")
"""colorantInfo has another signature there; the others no name."""

TAG_NAMES: dict[str, str] = {
    **{
        signature: _OTHER_NAMES.get(signature, kind.name) + "Tag"
        for signature, kind in TAGS.items()
        if signature not in _REFERENCE_LACKS
    },
}
"""The element of a tag, by signature; any other tag is a PrivateTag."""

TAG_SIGNATURES: dict[str, str] = {
    **{kind.name + "Tag": signature for signature, kind in TAGS.items()},
    **{name: signature for signature, name in TAG_NAMES.items()},
}
"""Signatures by the names of the reference and of the specification."""

# --- tag types ----------------------------------------------------------------------------------

TYPE_NAMES: dict[str, str] = {
    "mluc": "multiLocalizedUnicodeType",
    "utf8": "utf8Type",
    "tary": "tagArrayType",
    "dict": "dictType",
    "XYZ ": "XYZArrayType",
    "sig ": "signatureType",
    "mpet": "multiProcessElementType",
    "svcn": "spectralViewingConditionsType",
    "tstr": "tagStructType",
    "fl16": "float16ArrayType",
    "fl32": "float32ArrayType",
    "fl64": "float64ArrayType",
    "ui08": "uInt8ArrayType",
    "ui16": "uInt16ArrayType",
    "ui32": "uInt32ArrayType",
    "ui64": "uInt64ArrayType",
    "sf32": "s15Fixed16ArrayType",
    "uf32": "u16Fixed16ArrayType",
    "curv": "curveType",
    "para": "parametricCurveType",
    "text": "textType",
    "desc": "textDescriptionType",
    "zut8": "utf8ZipType",
    "zxml": "zipXmlType",
    "ZXML": "ZIPXmlType",
    "dtim": "dateTimeType",
    "cicp": "cicpType",
    "clro": "colorantOrderType",
    "data": "dataType",
}
"""The element of a tag type, by signature; any other type is a PrivateType of bytes."""

TYPE_SIGNATURES: dict[str, str] = {
    **{name: signature for signature, name in TYPE_NAMES.items()},
    **{
        name.replace("Array", "Number"): signature
        for signature, name in TYPE_NAMES.items()
        if name.endswith("ArrayType") and name != "tagArrayType"
    },
    "utf8TextType": "utf8",
    "zipUtf8TextType": "zut8",
    "XYZType": "XYZ ",
    "tagStructureType": "tstr",
}

STRUCTURES = {
    "brdfTransfromStructure": "brdf",
    "brdfTransformStructure": "brdf",
    "brfdfTransformStructure": "brdf",
}
"""Kinds of structure by their names."""

MEMBERS = {
    "brdfTypeMbr": "type",
    "brdfFunctionMbr": "func",
    "brdfParamsPerChannelMbr": "nump",
    "brdfTransformMbr": "xfrm",
}
"""Members of a `brdf` structure."""

# --- viewing conditions, in the order of their codes ----------------------------------------------

OBSERVERS = (
    "Unknown observer",
    "CIE 1931 (two degree) standard observer",
    "CIE 1964 (ten degree) standard observer",
)
OBSERVERS_READ = {"CIE 1931 standard colorimetric observer": 1}
"""Another name, from the ICC's samples."""

ILLUMINANTS = tuple(
    f"Illuminant {name}"
    for name in (
        *("Unknown", "D50", "D65", "D93", "F2", "D55", "A", "EquiPowerE", "F8"),
        *("Black Body", "Daylight", "B", "C", "F1", "F3", "F4", "F5", "F6", "F7"),
        *("F9", "F10", "F11", "F12"),
    )
)

# --- signatures -----------------------------------------------------------------------------------


def signature_name(data: bytes) -> str:
    """Four bytes as the XML writes them: "RGB ", "nc0005", "" for zeros; 8 hexadecimal digits and
    an h for what is no text."""
    if data == bytes(4):
        return ""
    counted = space_text(data)
    if len(counted) == 6:
        return counted
    text = data.decode("latin-1")
    plain = text.isascii() and text.isprintable() and text == text.lstrip() and text.strip()
    return text if plain else data.hex().upper() + "h"


def signature_of_name(text: str) -> bytes:
    """The inverse of signature_name; shorter names are padded. ProfileError for other lengths."""
    name = text.strip()
    if len(name) in (8, 9) and _is_hexadecimal(name[:8]) and name[8:] in ("", "h"):
        return bytes.fromhex(name[:8])
    if len(name) == 6 and _is_hexadecimal(name[2:]):
        return name[:2].encode("latin-1") + bytes.fromhex(name[2:])
    return signature_bytes(name.ljust(4) if name else "")


def signature_text_of(text: str) -> str:
    """As signature_of_name, as the four characters that tags and classes have."""
    data = signature_of_name(text)
    return data.decode("latin-1") if data != bytes(4) else ""


def _is_hexadecimal(text: str) -> bool:
    return all(character in "0123456789abcdefABCDEF" for character in text)


def unfit(text: str) -> bool:
    """Whether XML 1.0 has no way to hold a text: control characters, halves of surrogates."""
    return any(
        (c < " " and c not in "\t\n\r") or "\ud800" <= c <= "\udfff" or c in "\ufffe\uffff"
        for c in text
    )
