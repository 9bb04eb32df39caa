"""Tag types as XML, and back, one row a type; what a row cannot hold goes as bytes.

The element of a type holds what is in the tag: `<signatureType><Signature>War0</Signature>...`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from brdfc.icc.numbers import NUMBER_FORMATS
from brdfc.icc.signatures import signature_bytes
from brdfc.icc.types import (
    MAX_DEPTH,
    Opaque,
    Pipeline,
    Signature,
    Structure,
    Tag,
    TagArray,
    XYZArray,
    decode_tag,
)
from brdfc.source.errors import ProfileError, ProgramError
from brdfc.xml.arrays import array_node, read_array
from brdfc.xml.conditions import conditions_nodes, read_conditions
from brdfc.xml.document import Node
from brdfc.xml.elements import ElementWriter, read_element
from brdfc.xml.folder import Folder
from brdfc.xml.names import (
    MEMBERS,
    STRUCTURES,
    TYPE_NAMES,
    TYPE_SIGNATURES,
    signature_name,
    signature_text_of,
)
from brdfc.xml.naming import NO_NAMES, Names
from brdfc.xml.older_types import OLDER_TYPES, OlderType, older_nodes
from brdfc.xml.texts import (
    dictionary_nodes,
    localized_nodes,
    names_nodes,
    read_dictionary,
    read_localized,
    read_names,
    read_utf8,
    utf8_nodes,
)
from brdfc.xml.values import channels, fixed_xyz, hexadecimal
from brdfc.xml.writing import hexadecimal as hexadecimal_lines
from brdfc.xml.writing import number


class TagType(NamedTuple):
    """write: the child nodes of a tag; None where XML cannot hold it. read: a tag of its node."""

    write: Callable[[Any, ElementWriter, Names], list[Node] | None]
    read: Callable[[Node, Folder], Tag]


def tag_node(tag: Tag, elements: ElementWriter, names: Names = NO_NAMES) -> Node:
    """The node of a tag's type. names: of the channels of a transform's first element."""
    row = _ROWS.get(tag.type_signature)
    typed = not isinstance(tag, (Opaque, TagArray)) and _can_be_made(tag)
    children = row.write(tag, elements, names) if row and typed else None
    if children is not None:
        return Node(TYPE_NAMES[tag.type_signature], {}, children)
    data = tag.to_bytes()
    attributes = {"type": signature_name(data[:4])}
    unknown = Node("UnknownData", lines=hexadecimal_lines(data[4:]))
    return Node("PrivateType", attributes, [unknown])


def _can_be_made(tag: Tag) -> bool:
    """Whether the tag's fields are such as brdfc writes. A file may hold others: longer texts."""
    try:
        tag.encode()
    except (ProfileError, ProgramError):
        return False
    return True


def read_tag(node: Node, folder: Folder) -> Tag:
    """The tag of a type's node; ProfileError or ProgramError shows the place of what is wrong."""
    if node.tag == "PrivateType":
        return _read_private(node)
    kind = TYPE_SIGNATURES.get(node.tag)
    if kind is None:
        read = ", ".join(TYPE_NAMES.values())
        node.fail(f"<{node.tag}> is not read here; <PrivateType> takes its bytes", f"read: {read}")
    tag = _ROWS[kind].read(node, folder)
    try:
        tag.encode()
    except (ProfileError, ProgramError) as error:
        node.fail(error.message)
    return tag


def _read_private(node: Node) -> Tag:
    data = node.child("UnknownData")
    kind = signature_bytes(signature_text_of(node.attributes["type"]))
    if data is None or len(kind) != 4:
        node.fail("a private type has four characters as its type, and <UnknownData>")
    try:
        return decode_tag(kind + hexadecimal(data), f"'{kind.decode('latin-1')}'")
    except ProfileError as error:
        if "\n" in error.message:
            raise
        node.fail(str(error))


# --- numbers --------------------------------------------------------------------------------------


def _colours(tag: XYZArray) -> list[Node]:
    # Twelve digits hold every s15Fixed16.
    return [
        Node("XYZNumber", {axis: number(v, 12) for axis, v in zip("XYZ", xyz, strict=True)})
        for xyz in tag.values
    ]


def _read_colours(node: Node) -> XYZArray:
    return XYZArray(tuple(fixed_xyz(child) for child in node.named("XYZNumber")))


def _signature(tag: Signature) -> list[Node]:
    return [Node("Signature", text=signature_name(signature_bytes(tag.value)))]


def _read_signature(node: Node) -> Signature:
    return Signature(signature_text_of(node.only("Signature").text))


# --- transforms and structures --------------------------------------------------------------------


def _pipeline(tag: Pipeline, elements: ElementWriter, names: Names) -> list[Node]:
    attributes = {"InputChannels": str(tag.inputs), "OutputChannels": str(tag.outputs)}
    inside = [
        elements.node(
            element,
            Names(
                names.inputs if index == 0 else {},
                names.outputs if index == len(tag.elements) - 1 else {},
            ),
        )
        for index, element in enumerate(tag.elements)
    ]
    return [Node("MultiProcessElements", attributes, inside)]


def _read_pipeline(node: Node, folder: Folder) -> Pipeline:
    inner = node.only("MultiProcessElements")
    inputs, outputs = channels(inner)
    return Pipeline(inputs, outputs, tuple(read_element(e, folder) for e in inner.children))


_MEMBER_NAMES = {signature: name for name, signature in MEMBERS.items()}


def _structure(tag: Structure, elements: ElementWriter, _n: Names) -> list[Node]:
    first: dict[int, str] = {}
    members = []
    for signature, member in tag.members.items():
        attributes = {"TagSignature": signature_name(signature_bytes(signature))}
        name = _MEMBER_NAMES.get(signature) if tag.kind == "brdf" else None
        same = first.setdefault(id(member), signature)
        if same != signature:
            also = signature_name(signature_bytes(same))
            attributes |= {"SameAs": "PrivateSubTag", "SameAsSignature": also}
            members.append(Node("PrivateSubTag", attributes))
        else:
            inside = [tag_node(member, elements)]
            members.append(
                Node(name, {}, inside) if name else Node("PrivateSubTag", attributes, inside)
            )
    kind = Node("StructureSignature", text=signature_name(signature_bytes(tag.kind)))
    return [kind, Node("MemberTags", {}, members)]


def _read_structure(node: Node, folder: Folder, depth: int = 1) -> Structure:
    if depth > MAX_DEPTH:
        node.fail(f"structures more than {MAX_DEPTH} deep in another")
    named = next((child for child in node.children if child.tag in STRUCTURES), None)
    if named is not None:
        kind, group = STRUCTURES[named.tag], named.only("MemberTags")
    else:
        kind = signature_text_of(node.only("StructureSignature").text)
        group = node.only("MemberTags")
    members: dict[str, Tag] = {}
    for child in group.children:
        name = MEMBERS.get(child.tag) or _private_signature(child, "PrivateSubTag")
        if name in members:
            child.fail(f"the member '{name}' stands here twice")
        same = child.attributes.get("SameAsSignature")
        if same is not None:
            if signature_text_of(same) not in members:
                child.fail(f"no member '{same}' stands before this one")
            members[name] = members[signature_text_of(same)]
            continue
        if len(child.children) != 1:
            child.fail("one type stands in a member")
        inner = child.children[0]
        nested = TYPE_SIGNATURES.get(inner.tag) == "tstr"
        members[name] = (
            _read_structure(inner, folder, depth + 1) if nested else read_tag(inner, folder)
        )
    return Structure(kind, members)


def _private_signature(node: Node, expected: str) -> str:
    if node.tag != expected or "TagSignature" not in node.attributes:
        node.fail(f"<{node.tag}> is not known here; <{expected} TagSignature=...> takes any")
    return signature_text_of(node.attributes["TagSignature"])


def _older(row: OlderType) -> TagType:
    return TagType(lambda tag, _e, _n: older_nodes(tag), lambda node, _f: row.read(node))


_ROWS: dict[str, TagType] = {
    "mluc": TagType(lambda tag, _e, _n: localized_nodes(tag), lambda n, _f: read_localized(n)),
    "utf8": TagType(lambda tag, _e, _n: utf8_nodes(tag), lambda n, _f: read_utf8(n)),
    "tary": TagType(lambda tag, _e, _n: names_nodes(tag), lambda n, _f: read_names(n)),
    "dict": TagType(lambda tag, _e, _n: dictionary_nodes(tag), lambda n, _f: read_dictionary(n)),
    "XYZ ": TagType(lambda tag, _e, _n: _colours(tag), lambda n, _f: _read_colours(n)),
    "sig ": TagType(lambda tag, _e, _n: _signature(tag), lambda n, _f: _read_signature(n)),
    "svcn": TagType(lambda tag, _e, _n: conditions_nodes(tag), lambda n, _f: read_conditions(n)),
    "mpet": TagType(_pipeline, _read_pipeline),
    "tstr": TagType(_structure, _read_structure),
    **{kind: _older(row) for kind, row in OLDER_TYPES.items()},
    **{kind: TagType(lambda t, _e, _n: [array_node(t)], read_array) for kind in NUMBER_FORMATS},
}
