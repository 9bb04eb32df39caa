"""The header as XML, and back: one table of its fields."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, NamedTuple

from brdfc.icc.header import FIXED_DATE, Header, SpectralRange
from brdfc.icc.signatures import signature_bytes
from brdfc.source.errors import ProfileError
from brdfc.xml.document import Node
from brdfc.xml.names import signature_name, signature_of_name, signature_text_of
from brdfc.xml.values import fixed_xyz, hexadecimal, integer, real
from brdfc.xml.writing import number

INTENTS = (
    "Perceptual",
    "Relative Colorimetric",
    "Saturation",
    "Absolute Colorimetric",
)
_FLAGS = {"EmbeddedInFile": 1, "UseWithEmbeddedDataOnly": 2, "MCSNeedsSubset": 4}
_FLAGS |= {"ExtendedRangePCS": 8}
_ATTRIBUTES = {
    "ReflectiveOrTransparency": ("reflective", "transparency"),
    "GlossyOrMatte": ("glossy", "matte"),
    "MediaPolarity": ("positive", "negative"),
    "MediaColour": ("colour", "blackAndWhite"),
}
"""Bits 0 to 3: what 0 and 1 mean."""


class Field(NamedTuple):
    """An element of the header: the field it stands for, and both ways between their values."""

    tag: str
    field: str
    write: Callable[[Any], Node]
    read: Callable[[Node], Any]


def header_node(header: Header) -> Node:
    """The header; fields that are zero and may be left out are."""
    children = []
    for row in _FIELDS:
        value = getattr(header, row.field)
        if row.field in _OPTIONAL and repr(value) in _NOTHING:
            continue
        node = row.write(value)
        node.tag = row.tag
        children.append(node)
        if row.field == "version" and value & 0xFFFF:
            children.append(Node("ProfileSubClassVersion", text=_version_text(value << 16)))
    return Node("Header", {}, children)


def read_header(node: Node) -> Header:
    """The header of a node."""
    fields: dict[str, Any] = {"device_class": "", "illuminant": (0.0, 0.0, 0.0)}
    by_tag = {row.tag: row for row in _FIELDS}
    for child in node.children:
        if child.tag == "ProfileSubClassVersion":
            fields["version"] = fields.get("version", 0) | (_read_version(child) >> 16)
            continue
        row = by_tag[child.tag]
        try:
            fields[row.field] = row.read(child)
        except ProfileError as error:
            if "\n" in error.message:
                raise
            child.fail(error.message)
    header = Header(**fields)
    try:
        header.encode(0)
    except ProfileError as error:
        node.fail(error.message)
    return header


# --- values ---------------------------------------------------------------------------------------


def _text(value: str) -> Node:
    return Node("", text=signature_name(signature_bytes(value)))


def _space(value: bytes) -> Node:
    return Node("", text=signature_name(value))


def _version_text(version: int) -> str:
    return f"{version >> 24 & 0xFF:x}.{version >> 16 & 0xFF:02x}"


def _read_version(node: Node) -> int:
    """5.00 is 05 00; 5.1 and 5.10 are both 05 10, as people mean it."""
    found = re.fullmatch(
        r"\s*([0-9a-f]{1,2})(?:[.,]([0-9a-f]{1,2}))?(?:[.,][0-9.]*)?\s*", node.text
    )
    if found is None:
        node.fail(f"a version is written 5.00, not '{node.text}'")
    return int(found[1], 16) << 24 | int((found[2] or "").ljust(2, "0"), 16) << 16


def _date(value: tuple[int, ...]) -> Node:
    year, *rest = value
    return Node("", text="{:04}-{:02}-{:02}T{:02}:{:02}:{:02}".format(year, *rest))


def _read_date(node: Node) -> tuple[int, ...]:
    """ "now" is the fixed date: the same text gives the same bytes on any day."""
    text = node.text.strip()
    if text in ("now", ""):
        return FIXED_DATE
    numbers = re.fullmatch(r"(\d{1,5})-(\d\d?\d*)-(\d+)[T ](\d+):(\d+):(\d+)Z?", text)
    if numbers is None or any(int(n) > 0xFFFF for n in numbers.groups()):
        node.fail(f"a date is written 2020-01-31T12:00:00, or now, not '{text}'")
    return tuple(map(int, numbers.groups()))


def _flags(value: int) -> Node:
    attributes = {name: str(bool(value & bit)).lower() for name, bit in _FLAGS.items()}
    rest = value & ~sum(_FLAGS.values())
    return Node("", attributes | ({"VendorFlags": f"{rest:08x}"} if rest else {}))


def _read_flags(node: Node) -> int:
    bits = sum(bit for name, bit in _FLAGS.items() if node.attributes.get(name) == "true")
    return bits | _hexadecimal(node, "VendorFlags", 8)


def _attributes(value: int) -> Node:
    attributes = {
        name: words[value >> bit & 1] for bit, (name, words) in enumerate(_ATTRIBUTES.items())
    }
    rest = value & ~0xF
    return Node("", attributes | ({"VendorSpecific": f"{rest:016x}"} if rest else {}))


def _read_attributes(node: Node) -> int:
    bits = 0
    for bit, (name, words) in enumerate(_ATTRIBUTES.items()):
        text = node.attributes.get(name, words[0]).lower()
        if text not in (words[0].lower(), words[1].lower()):
            node.fail(f"{name} is {words[0]} or {words[1]}, not '{text}'")
        bits |= (text == words[1].lower()) << bit
    return bits | _hexadecimal(node, "VendorSpecific", 16)


def _hexadecimal(node: Node, name: str, most: int) -> int:
    text = node.attributes.get(name, "0")
    if not re.fullmatch(f"(0x)?[0-9A-Fa-f]{{1,{most}}}", text):
        node.fail(f"{name} is up to {most} hexadecimal digits, not '{text}'")
    return int(text, 16)


def _intent(value: int) -> Node:
    return Node("", text=INTENTS[value] if value < len(INTENTS) else str(value))


def _read_intent(node: Node) -> int:
    text = node.text.strip()
    for code, name in enumerate(INTENTS):
        if text in (name, name.split()[0]):
            return code
    if not re.fullmatch("[0-9]{1,10}", text):
        node.fail(f"an intent is {', '.join(INTENTS)}, not '{text}'")
    return int(text)


def _illuminant(value: tuple[float, ...]) -> Node:
    xyz = {axis: number(v, 12) for axis, v in zip("XYZ", value, strict=True)}
    return Node("", {}, [Node("XYZNumber", xyz)])


def _read_illuminant(node: Node) -> tuple[float, ...]:
    if len(node.children) != 1:
        node.fail("one <XYZNumber> stands here")
    return fixed_xyz(node.children[0])


def _range(value: SpectralRange) -> Node:
    ends = {"start": number(value.start), "end": number(value.end), "steps": str(value.steps)}
    return Node("", {}, [Node("Wavelengths", ends)])


def _read_range(node: Node) -> SpectralRange:
    if len(node.children) != 1:
        node.fail("one <Wavelengths> stands here")
    inner = node.children[0]
    return SpectralRange(real(inner, "start"), real(inner, "end"), integer(inner, "steps"))


def _read_text(node: Node) -> str:
    return signature_text_of(node.text)


def _read_space(node: Node) -> bytes:
    return signature_of_name(node.text)


def _read_identity(node: Node) -> bytes:
    """Any text that is not zero asks for the identity to be computed."""
    return bytes(16) if not node.text.strip(" \t\r\n0") else b"\1" * 16


_FIELDS = (
    Field("PreferredCMMType", "cmm", _text, _read_text),
    Field("ProfileVersion", "version", lambda v: Node("", text=_version_text(v)), _read_version),
    Field("ProfileDeviceClass", "device_class", _text, _read_text),
    Field("ProfileDeviceSubClass", "device_subclass", _text, _read_text),
    Field("DataColourSpace", "colour_space", _space, _read_space),
    Field("PCS", "pcs", _space, _read_space),
    Field("CreationDateTime", "creation_date", _date, _read_date),
    Field("PrimaryPlatform", "platform", _text, _read_text),
    Field("ProfileFlags", "flags", _flags, _read_flags),
    Field("DeviceManufacturer", "manufacturer", _text, _read_text),
    Field("DeviceModel", "model", _text, _read_text),
    Field("DeviceAttributes", "attributes", _attributes, _read_attributes),
    Field("RenderingIntent", "rendering_intent", _intent, _read_intent),
    Field("PCSIlluminant", "illuminant", _illuminant, _read_illuminant),
    Field("ProfileCreator", "creator", _text, _read_text),
    Field("ProfileID", "profile_id", lambda v: Node("", text=v.hex().upper()), _read_identity),
    Field("SpectralPCS", "spectral_pcs", _space, _read_space),
    Field("SpectralRange", "spectral_range", _range, _read_range),
    Field("BiSpectralRange", "bispectral_range", _range, _read_range),
    Field("MCS", "mcs", _space, _read_space),
    Field(
        "Reserved",
        "reserved",
        lambda v: Node("", text=f"{v:08X}"),
        lambda node: int.from_bytes(hexadecimal(node)[:4], "big"),
    ),
)
_NOTHING = set(map(repr, (0, "", bytes(4), bytes(16), SpectralRange())))
"""By how they are written: a range that ends at -0 is not one of nothing but zeros."""
_OPTIONAL = {
    *("device_subclass", "platform", "manufacturer", "model", "creator", "profile_id"),
    *("spectral_pcs", "spectral_range", "bispectral_range", "mcs", "reserved"),
}
