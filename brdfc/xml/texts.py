"""Tag types that hold text as XML, and back. What is written is None where XML has no way to hold
a text (names.unfit)."""

from __future__ import annotations

from brdfc.icc.signatures import signature_bytes
from brdfc.icc.texts import Dictionary, LocalizedText, Utf8Array, Utf8Text
from brdfc.xml.document import Node
from brdfc.xml.names import TYPE_NAMES, TYPE_SIGNATURES, signature_name, signature_text_of, unfit


def localized_nodes(tag: LocalizedText) -> list[Node] | None:
    """The text, once a language."""
    if any(unfit(text) for _, text in tag.records):
        return None
    return [
        Node("LocalizedText", {"LanguageCountry": signature_name(signature_bytes(lang))}, text=text)
        for lang, text in tag.records
    ]


def read_localized(node: Node) -> LocalizedText:
    """The text of a type's node."""
    return LocalizedText(
        tuple(
            (signature_text_of(child.attributes["LanguageCountry"]), child.text)
            for child in node.named("LocalizedText")
        )
    )


def utf8_nodes(tag: Utf8Text) -> list[Node] | None:
    """One text."""
    return None if unfit(tag.text) else [Node("TextData", text=tag.text)]


def read_utf8(node: Node) -> Utf8Text:
    """The text of a type's node."""
    return Utf8Text(node.only("TextData").text)


def names_nodes(tag: Utf8Array) -> list[Node] | None:
    """An array of texts."""
    texts = [utf8_nodes(Utf8Text(name)) for name in tag.names]
    if any(text is None for text in texts):
        return None
    entries = [Node(TYPE_NAMES["utf8"], {}, text) for text in texts if text is not None]
    return [Node("UTF8TextArray", {}, [Node("ArrayTags", {}, entries)])]


def read_names(node: Node) -> Utf8Array:
    """The array of a type's node; only arrays of utf8 are read."""
    array = node.child("UTF8TextArray")
    signature = node.child("ArraySignature")
    if array is None and (signature is None or signature.text.strip() != "utf8"):
        node.fail("only arrays of utf8 are read, <UTF8TextArray>; <PrivateType> takes others")
    entries = (array or node).only("ArrayTags").children
    for entry in entries:
        if TYPE_SIGNATURES.get(entry.tag) != "utf8":
            entry.fail(f"an array of utf8 holds <utf8Type>, not <{entry.tag}>")
    return Utf8Array(tuple(read_utf8(entry).text for entry in entries))


def dictionary_nodes(tag: Dictionary) -> list[Node] | None:
    """An element an entry."""
    if any(unfit(text) for entry in tag.entries for text in entry):
        return None
    return [Node("DictEntry", {"Name": name, "Value": value}) for name, value in tag.entries]


def read_dictionary(node: Node) -> Dictionary:
    """The dictionary of a type's node."""
    entries = node.named("DictEntry")
    return Dictionary(tuple((e.attributes["Name"], e.attributes.get("Value", "")) for e in entries))
