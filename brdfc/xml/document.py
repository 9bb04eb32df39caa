"""An XML document as a tree whose nodes know where they stand.

The standard library's expat reads it, because it alone tells places. A document type declaration
is refused, and with it every entity, expanded or external; size, depth and the number of elements
have limits, so that a document cannot cost more than its bytes.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pyexpat import ExpatError
from typing import NoReturn
from xml.parsers.expat import ErrorString, ParserCreate

from brdfc.source.diagnostics import Diagnostic
from brdfc.source.errors import ProfileError
from brdfc.source.span import Source, Span

SIZE_LIMIT = 8 << 20
"""Bytes of a document, read or written."""
_MAX_DEPTH = 200
"""Calculators may stand 64 deep in calculators, two elements each."""
_MAX_NODES = 150_000
_MAX_ATTRIBUTES = 100
_MAX_NAME = 200


@dataclass(slots=True, eq=False)
class Node:
    """An element: its name, attributes, child elements, and the text directly inside it.

    source and start say where its tag begins; a node that is to be written has none. lines: text
    to be written that is indented with its element (writing.py).
    """

    tag: str
    attributes: dict[str, str] = field(default_factory=dict)
    children: list[Node] = field(default_factory=list)
    text: str = ""
    lines: Sequence[str] = ()
    source: Source | None = None
    start: int = 0

    def child(self, tag: str) -> Node | None:
        """The first child of this name."""
        return next((child for child in self.children if child.tag == tag), None)

    def named(self, tag: str) -> list[Node]:
        """All children of this name."""
        return [child for child in self.children if child.tag == tag]

    def only(self, tag: str) -> Node:
        """The one child of a name that must be there."""
        found = self.named(tag)
        if len(found) != 1:
            self.fail(f"one <{tag}> stands in <{self.tag}>, not {len(found)}")
        return found[0]

    @property
    def span(self) -> Span:
        """Its start tag, at most to the end of the line."""
        assert self.source is not None
        return self.source.span(self.start, _tag_end(self.source.text, self.start))

    def fail(self, message: str, hint: str | None = None) -> NoReturn:
        """Raise the ProfileError that shows this node."""
        raise ProfileError(str(Diagnostic(self.span, message, hint=hint)))

    def content(self) -> tuple[int, str]:
        """Where the text inside begins in the source, and that text as long as it is there:
        comments are blank, so that places in it are places in the file."""
        assert self.source is not None
        text = self.source.text
        begin = _tag_end(text, self.start)
        if text[begin - 2] == "/":
            return begin, ""
        inside = text[begin : text.find("</" + self.tag, begin)]
        if "<" not in inside or len(inside) > _LONG:
            return begin, inside
        return begin, _MARKUP.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), inside)


_LONG = 1 << 20
"""Longer texts with comments are not searched for them, which takes long."""
_START_TAG = re.compile(r"""<(?:[^"'>]++|"[^"]*+"|'[^']*+')*+>""")
_MARKUP = re.compile(r"<!--.*?-->|<!\[CDATA\[|\]\]>|<\?.*?\?>", re.DOTALL)


def _tag_end(text: str, start: int) -> int:
    found = _START_TAG.match(text, start)
    return found.end() if found else start + 1


def read_document(data: bytes, name: str) -> Node:
    """The root of an XML document; ProfileError shows the place of what is wrong.

    name: what messages call the file.
    """
    if len(data) > SIZE_LIMIT:
        raise ProfileError(f"{len(data):,} bytes are more than {SIZE_LIMIT:,}", where=name)
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise ProfileError(f"not UTF-8: {error.reason}", where=f"{name}:{line}") from error
    return _Reader(data, Source(name, text)).read()


class _Reader:
    """Builds the tree; character by character it follows where in the text expat's bytes are."""

    def __init__(self, data: bytes, source: Source) -> None:
        self.data, self.source, self.ascii = data, source, data.isascii()
        self.byte = self.character = self.nodes = 0
        self.open: list[Node] = [Node("")]
        self.texts: list[list[str]] = [[]]
        self.parser = ParserCreate("utf-8")
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.CharacterDataHandler = self.characters
        self.parser.StartDoctypeDeclHandler = self.doctype

    def read(self) -> Node:
        try:
            self.parser.Parse(self.data, True)
        except ExpatError as error:
            place = self.place(self.parser.ErrorByteIndex)
            span = self.source.span(place, place + 1)
            message = f"not well-formed XML: {ErrorString(error.code)}"
            raise ProfileError(str(Diagnostic(span, message))) from None
        return self.open[0].children[0]

    def place(self, byte: int) -> int:
        """The character that begins at a byte, none before the last one asked for."""
        if self.ascii:
            return byte
        byte = max(byte, self.byte)
        self.character += len(self.data[self.byte : byte].decode("utf-8", "ignore"))
        self.byte = byte
        return self.character

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self.nodes += 1
        place = self.place(self.parser.CurrentByteIndex)
        node = Node(tag, attributes, source=self.source, start=place)
        longest = max(map(len, (tag, *attributes)))
        if longest > _MAX_NAME:
            node.fail(f"a name of {longest:,} characters")
        if len(attributes) > _MAX_ATTRIBUTES:
            node.fail(f"more than {_MAX_ATTRIBUTES} attributes")
        if len(self.open) > _MAX_DEPTH:
            node.fail(f"elements nest deeper than {_MAX_DEPTH}")
        if self.nodes > _MAX_NODES:
            node.fail(f"more than {_MAX_NODES:,} elements")
        self.open[-1].children.append(node)
        self.open.append(node)
        self.texts.append([])

    def end(self, _tag: str) -> None:
        self.open.pop().text = "".join(self.texts.pop())

    def characters(self, text: str) -> None:
        self.texts[-1].append(text)

    def doctype(self, *_: object) -> None:
        place = self.source.text.find("<!DOCTYPE")
        span = self.source.span(place, place + len("<!DOCTYPE"))
        message = "a document type is not read, because it may declare entities"
        hint = "remove it; the XML of a profile needs none"
        raise ProfileError(str(Diagnostic(span, message, hint=hint)))
