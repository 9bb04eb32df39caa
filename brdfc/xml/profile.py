"""A profile as the XML of the ICC's reference implementation, and back."""

from __future__ import annotations

from pathlib import Path

from brdfc.files import read_file
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import signature_bytes
from brdfc.icc.tags import TAGS
from brdfc.icc.types import Pipeline, Tag, Utf8Array
from brdfc.profiles.metadata import describe
from brdfc.source.errors import ProfileError, ProgramError
from brdfc.xml.document import SIZE_LIMIT, Node, read_document
from brdfc.xml.elements import ElementWriter
from brdfc.xml.folder import Folder
from brdfc.xml.header import header_node, read_header
from brdfc.xml.names import TAG_NAMES, TAG_SIGNATURES, signature_name, signature_text_of
from brdfc.xml.naming import NO_NAMES, Names, group
from brdfc.xml.schema import check
from brdfc.xml.tagtypes import read_tag, tag_node
from brdfc.xml.writing import COMMENT, document_text

_PRIVATE = "PrivateTag"


def to_xml(profile: Profile) -> str:
    """The text of a profile's XML; ProfileError when it would be too large to be read again.

    from_xml gives back the same profile, and for a profile that brdfc wrote the same bytes.
    """
    elements = ElementWriter()
    first: dict[int, str] = {}
    tags: list[Node] = []
    for signature, tag in profile.tags.items():
        same = first.setdefault(id(tag), signature)
        node = _named(signature)
        if same != signature:
            other = _named(same)
            node.attributes["SameAs"] = other.tag
            if other.tag == _PRIVATE:
                node.attributes["SameAsSignature"] = other.attributes["TagSignature"]
        else:
            tags += _comments(profile, tag)
            node.children.append(_type_node(profile, signature, tag, elements))
        tags.append(node)
    header = header_node(profile.header)
    return document_text(Node("IccProfile", {}, [header, Node("Tags", {}, tags)]))


def _type_node(profile: Profile, signature: str, tag: Tag, elements: ElementWriter) -> Node:
    try:
        return tag_node(tag, elements, _channel_names(profile, signature))
    except (ProfileError, ProgramError) as error:
        raise ProfileError(error.message, where=f"tag '{signature}'", hint=error.hint) from error


def _named(signature: str) -> Node:
    if signature in TAG_NAMES:
        return Node(TAG_NAMES[signature])
    name = signature_name(signature_bytes(signature)) or "00000000h"
    return Node(_PRIVATE, {"TagSignature": name})


def _channel_names(profile: Profile, signature: str) -> Names:
    """The names of a transform's channels, of those that lead to or from the multiplex space."""
    sides = TAGS[signature].channels if signature in TAGS else None
    names = profile.tags.get("mcta")
    if sides is None or not isinstance(names, Utf8Array):
        return NO_NAMES
    multiplex = group(names.names)
    known = {"mcs": multiplex, "pcs": {"XYZ": (0, 3)} if profile.header.pcs == b"XYZ " else {}}
    if profile.header.device_class == "mid ":
        known["device"] = multiplex  # a MID of brdfc names the samples of an image
    source = profile.tags[signature]
    fits = isinstance(source, Pipeline) and source.inputs == len(names.names)
    return Names(known.get(sides[0], {}) if fits else {}, known.get(sides[1], {}))


def _comments(profile: Profile, tag: Tag) -> list[Node]:
    """What a profile says of the variables its transforms read."""
    if not isinstance(tag, Pipeline):
        return []
    return [
        Node(COMMENT, text=f"env({d.signature}): {d.name} in {d.range_text}, {d.description}")
        for d in describe(profile, "env")
    ]


def from_xml(data: bytes, path: str | Path) -> Profile:
    """The profile that an XML document describes.

    path: where it stands; files that it names stand beside it or below. Raises ProfileError or
    ProgramError, which show the line of what is wrong.
    """
    name = str(path)
    root = read_document(data, name)
    if root.tag != "IccProfile":
        root.fail(f"a profile is an <IccProfile>, not a <{root.tag}>")
    check(root)
    header, tags = root.child("Header"), root.child("Tags")
    if header is None or tags is None:
        root.fail("an <IccProfile> holds <Header> and <Tags>")
    folder = Folder(Path(path).parent)
    found: dict[str, Tag] = {}
    for node in tags.children:
        signatures, tag = _read(node, folder, found)
        for signature in signatures:
            if signature in found:
                node.fail(f"the tag '{signature}' stands here twice")
            found[signature] = tag
    return Profile(read_header(header), found)


def load_xml(path: str | Path) -> Profile:
    """The profile of an XML file; see from_xml."""
    return from_xml(read_file(path, limit=SIZE_LIMIT), path)


def encoded(profile: Profile) -> bytes:
    """The bytes of a profile that was read from XML, with an identity if it asks for one."""
    return profile.to_bytes(profile_id=any(profile.header.profile_id))


def _read(node: Node, folder: Folder, found: dict[str, Tag]) -> tuple[list[str], Tag]:
    """The signatures of a tag, and the tag: named by its element, or by <TagSignature> inside."""
    if node.tag != _PRIVATE and node.tag not in TAG_SIGNATURES:
        tag = read_tag(node, folder)
        signatures = [signature_text_of(child.text) for child in node.named("TagSignature")]
        if not signatures:
            node.fail(f"<{node.tag}> is no tag, and a type needs a <TagSignature>")
        return signatures, tag
    signature = _signature(node.tag, node.attributes.get("TagSignature"), node)
    if "SameAs" in node.attributes:
        other = node.attributes["SameAs"]
        same = _signature(other, node.attributes.get("SameAsSignature"), node)
        if same not in found:
            node.fail(f"no tag '{same}' stands before this one")
        return [signature], found[same]
    if len(node.children) != 1:
        node.fail(f"one type stands in a tag, not {len(node.children)}")
    return [signature], read_tag(node.children[0], folder)


def _signature(name: str, stated: str | None, node: Node) -> str:
    if name in TAG_SIGNATURES:
        return TAG_SIGNATURES[name]
    if not stated:
        node.fail(f"'{name}' needs a signature of four characters")
    try:
        return signature_text_of(stated)
    except ProfileError as error:
        node.fail(error.message)
