"""A tree of nodes as XML text, of a size that can be read again."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from xml.sax.saxutils import escape

from brdfc.source.errors import ProfileError
from brdfc.xml.document import SIZE_LIMIT, Node
from brdfc.xml.names import unfit

COMMENT = "#comment"
"""The tag of a node that is written as a comment."""


def document_text(root: Node) -> str:
    """The document, indented; ProfileError when it is too large.

    A node that stands in several places is written in each: a few shared elements could make
    any amount of text, so the size is counted while it grows.
    """
    lines, size = ['<?xml version="1.0" encoding="UTF-8"?>\n'], 0
    for line in _lines(root, ""):
        size += len(line)
        if size > SIZE_LIMIT:
            raise ProfileError(f"as XML this profile is over {SIZE_LIMIT:,} characters")
        lines.append(line)
    return "".join(lines)


def _lines(node: Node, indent: str) -> Iterator[str]:
    if node.tag == COMMENT:
        text = "".join("?" if unfit(c) else c for c in node.text)
        yield f"{indent}<!-- {text.replace('--', '- -')} -->\n"
        return
    attributes = "".join(
        f' {name}="{escape(value, _IN_ATTRIBUTE)}"' for name, value in node.attributes.items()
    )
    opening = f"{indent}<{node.tag}{attributes}"
    if not (node.text or node.lines or node.children):
        yield opening + "/>\n"
        return
    if node.text:
        yield f"{opening}>{escape(node.text, _IN_TEXT)}</{node.tag}>\n"
        return
    yield opening + ">\n"
    for line in node.lines:
        yield f"{indent}  {escape(line)}\n"
    for child in node.children:
        yield from _lines(child, indent + "  ")
    yield f"{indent}</{node.tag}>\n"


# A parser turns what stands here unescaped into other white space.
_IN_TEXT = {"\r": "&#13;"}
_IN_ATTRIBUTE = {'"': "&quot;", "\n": "&#10;", "\t": "&#9;", "\r": "&#13;"}


def number(value: float, digits: int = 9) -> str:
    """A number with at most so many digits; of nine, which a float32 needs at most, no more than
    give back the same float32."""
    if digits == 9:
        for fewer in (6, 7, 8):
            text = f"{value:.{fewer}g}"
            if struct.pack("f", float(text)) == struct.pack("f", value):
                return text
    return f"{value:.{digits}g}"


def rows(values: Sequence[float], width: int, digits: int = 9) -> list[str]:
    """Numbers as lines of so many."""
    width = max(1, width)
    return [
        " ".join(number(v, digits) for v in values[start : start + width])
        for start in range(0, len(values), width)
    ]


def hexadecimal(data: bytes) -> list[str]:
    """Bytes as lines of 32."""
    return [data[start : start + 32].hex() for start in range(0, len(data), 32)]
