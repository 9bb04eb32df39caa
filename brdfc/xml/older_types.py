"""Types of versions 2 and 4 as XML, and back, one row a type.

A tag that was read from bytes that hold more than its fields (padding, reserved bytes) goes as
bytes, and so do lookup tables and the types without a row.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, NamedTuple

from brdfc.calc.samples import Samples, Storage
from brdfc.icc.curves import Curve, ParametricCurve
from brdfc.icc.numbers import FixedArray
from brdfc.icc.plain_texts import CompressedText, PlainText, TextDescription
from brdfc.icc.records import Record
from brdfc.icc.signatures import signature_bytes
from brdfc.icc.tag import Tag
from brdfc.xml.document import Node
from brdfc.xml.names import TYPE_SIGNATURES, signature_name, signature_text_of, unfit
from brdfc.xml.values import hexadecimal, integer, numbers
from brdfc.xml.writing import hexadecimal as hexadecimal_lines
from brdfc.xml.writing import rows


class OlderType(NamedTuple):
    """write: the child nodes of a tag; None where XML cannot hold it. read: a tag of its node."""

    write: Callable[[Any], list[Node] | None]
    read: Callable[[Node], Tag]


def older_nodes(tag: Tag) -> list[Node] | None:
    """The child nodes of a tag's type; None where it goes as bytes."""
    if tag.read_from is not None and tag.read_from != tag.encode():
        return None
    return OLDER_TYPES[tag.type_signature].write(tag)


# --- curves and numbers ---------------------------------------------------------------------------

FIXED_DIGITS = 12
"""As many as hold every s15Fixed16."""


def _curve(tag: Curve) -> list[Node]:
    """The 16-bit numbers of the file: none, a gamma in steps of 1/256, or the samples."""
    lines: list[str] = []
    if tag.gamma is not None:
        lines = [str(round(tag.gamma * 256))]
    elif tag.samples is not None:
        data = tag.samples.data
        codes = [str(int.from_bytes(data[i : i + 2], "big")) for i in range(0, len(data), 2)]
        lines = [" ".join(codes[i : i + 16]) for i in range(0, len(codes), 16)]
    return [Node("Curve", lines=lines)]


def _read_curve(node: Node) -> Curve:
    child = node.only("Curve")
    if "IdentitySize" in child.attributes:
        count = integer(child, "IdentitySize", high=0xFFFF)
        if count < 2:
            child.fail("IdentitySize is 2 or more")
        codes = [round(index * 65535 / (count - 1)) for index in range(count)]
    else:
        words = child.text.split()
        if not all(re.fullmatch("[0-9]{1,5}", word) and int(word) <= 0xFFFF for word in words):
            child.fail("a curve is of whole numbers from 0 to 65535")
        codes = list(map(int, words))
    if not codes:
        return Curve()
    if len(codes) == 1:
        return Curve(gamma=codes[0] / 256)
    data = b"".join(code.to_bytes(2, "big") for code in codes)
    return Curve(samples=Samples(Storage.UINT16, data))


def _parametric(tag: ParametricCurve) -> list[Node]:
    lines = rows(tag.parameters, len(tag.parameters), FIXED_DIGITS)
    return [Node("ParametricCurve", {"FunctionType": str(tag.function)}, lines=lines)]


def _read_parametric(node: Node) -> ParametricCurve:
    child = node.only("ParametricCurve")
    return ParametricCurve(integer(child, "FunctionType"), _fixed_numbers(child))


def _fixed(tag: FixedArray) -> list[Node]:
    return [Node("Array", lines=rows(tag.values, 8, FIXED_DIGITS))]


def _read_fixed(node: Node) -> FixedArray:
    return FixedArray(TYPE_SIGNATURES[node.tag], _fixed_numbers(node.only("Array")))


def _fixed_numbers(node: Node) -> tuple[float, ...]:
    return tuple(round(value * 65536) / 65536 for value in numbers(node).tolist())


# --- texts ----------------------------------------------------------------------------------------


def _text(tag: PlainText) -> list[Node] | None:
    return None if unfit(tag.text) else [Node("TextData", text=tag.text)]


def _description(tag: TextDescription) -> list[Node] | None:
    if unfit(tag.text) or unfit(tag.unicode) or (tag.language and not tag.unicode):
        return None
    nodes = [Node("TextData", text=tag.text)]
    if tag.unicode:
        language = signature_name(tag.language.to_bytes(4, "big")) if tag.language else ""
        attributes = {"LanguageCode": language} if language else {}
        nodes.append(Node("Unicode", attributes, text=tag.unicode))
    if tag.script or tag.script_code:
        attributes = {
            "ScriptCode": f"{tag.script_code:x}"
        }  # hexadecimal, as the reference reads it
        nodes.append(Node("MacScript", attributes, text=tag.script.hex().upper()))
    return nodes


def _read_description(node: Node) -> TextDescription:
    wide, script = node.child("Unicode"), node.child("MacScript")
    language = wide.attributes.get("LanguageCode", "") if wide else ""
    code = script.attributes.get("ScriptCode", "0") if script else "0"
    if not re.fullmatch("[0-9A-Fa-f]{1,4}", code):
        node.fail(f"ScriptCode is up to four hexadecimal digits, not '{code}'")
    return TextDescription(
        node.only("TextData").text,
        wide.text if wide else "",
        int.from_bytes(signature_bytes(signature_text_of(language)), "big") if language else 0,
        hexadecimal(script) if script else b"",
        int(code, 16),
    )


def _compressed(tag: CompressedText) -> list[Node]:
    return [Node("HexCompressedData", lines=hexadecimal_lines(tag.data))]


def _read_compressed(node: Node) -> CompressedText:
    return CompressedText(TYPE_SIGNATURES[node.tag], hexadecimal(node.only("HexCompressedData")))


# --- records --------------------------------------------------------------------------------------

_DATE = re.compile(r"\s*(\d+)-(\d+)-(\d+)T(\d+):(\d+):(\d+)\s*", re.ASCII)
_DATE_FIELDS = ("year", "month", "day", "hour", "minute", "second")
_CICP = {
    "ColorPrimaries": "primaries",
    "TransferCharacteristics": "transfer",
    "MatrixCoefficients": "matrix",
    "VideoFullRangeFlag": "full_range",
}


def _date(tag: Record) -> list[Node]:
    year, month, day, hour, minute, second = (tag.values[name] for name in _DATE_FIELDS)
    text = f"{year}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}"
    return [Node("DateTime", text=text)]


def _read_date(node: Node) -> Record:
    child = node.only("DateTime")
    found = _DATE.fullmatch(child.text)
    if found is None or len(child.text) > 60:
        child.fail("a date and time is written 2024-02-29T23:59:59")
    return Record("dtim", dict(zip(_DATE_FIELDS, map(int, found.groups()), strict=True)))


def _cicp(tag: Record) -> list[Node]:
    return [Node("cicpFields", {name: str(tag.values[field]) for name, field in _CICP.items()})]


def _read_cicp(node: Node) -> Record:
    child = node.only("cicpFields")
    return Record("cicp", {field: integer(child, name, 0, 255) for name, field in _CICP.items()})


def _order(tag: Record) -> list[Node]:
    return [Node("ColorantOrder", {}, [Node("n", text=str(index)) for (index,) in tag.rows])]


def _read_order(node: Node) -> Record:
    values = (numbers(child, 1)[0] for child in node.only("ColorantOrder").named("n"))
    return Record("clro", {}, tuple((int(value),) for value in values))


def _data(tag: Record) -> list[Node] | None:
    flags = {0: "ASCII", 1: "binary"}
    flag = flags.get(int(str(tag.values["flag"])))
    lines = hexadecimal_lines(tag.payload)
    return [Node("Data", {"Flag": flag}, lines=lines)] if flag else None


def _read_data(node: Node) -> Record:
    child = node.only("Data")
    binary = child.attributes.get("Flag") == "binary"
    return Record("data", {"flag": int(binary)}, payload=hexadecimal(child))


OLDER_TYPES: dict[str, OlderType] = {
    "curv": OlderType(_curve, _read_curve),
    "para": OlderType(_parametric, _read_parametric),
    **dict.fromkeys(("sf32", "uf32"), OlderType(_fixed, _read_fixed)),
    "text": OlderType(_text, lambda node: PlainText(node.only("TextData").text)),
    "desc": OlderType(_description, _read_description),
    **dict.fromkeys(("zut8", "zxml", "ZXML"), OlderType(_compressed, _read_compressed)),
    "dtim": OlderType(_date, _read_date),
    "cicp": OlderType(_cicp, _read_cicp),
    "clro": OlderType(_order, _read_order),
    "data": OlderType(_data, _read_data),
}
