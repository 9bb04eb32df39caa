"""The text of FPCore as nested lists of symbols and strings, each with its place."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import NoReturn

from brdfc.lang.limits import MAX_LEVELS, MAX_TEXT
from brdfc.source.diagnostics import Diagnostic
from brdfc.source.errors import ModelError
from brdfc.source.span import Source, Span

MAX_DEPTH = MAX_LEVELS + 20
"""Deepest nesting: what follows walks the lists by recursion."""

_TOKEN = re.compile(
    r'(?:\s|;[^\n]*)*(?:([(\[])|([)\]])|"((?:[^"\\]|\\.)*)"|([^\s()\[\]";]+)|(.)|$)'
)


@dataclass(frozen=True)
class Symbol:
    """A name, an operator or a number, as it is written."""

    text: str
    span: Span


@dataclass(frozen=True)
class Text:
    """A string, unescaped."""

    text: str
    span: Span


@dataclass(frozen=True)
class Items:
    """What stands between two brackets."""

    items: tuple[Node, ...]
    span: Span

    @property
    def head(self) -> str:
        """The symbol it begins with; empty where it begins with none."""
        first = self.items[0] if self.items else None
        return first.text if isinstance(first, Symbol) else ""


Node = Symbol | Text | Items


def fail(span: Span, message: str, hint: str | None = None) -> NoReturn:
    """The error for what is wrong at a place."""
    raise ModelError([Diagnostic(span, message, hint=hint)])


def read_nodes(source: Source) -> tuple[Node, ...]:
    """All lists, strings and symbols of a text; ModelError where brackets or strings do not end."""
    text = source.text
    if len(text) > MAX_TEXT:
        fail(Span(source, 0, 1), f"this text has more than {MAX_TEXT:,} characters")
    open_lists: list[tuple[int, list[Node]]] = [(0, [])]
    at = 0
    while at < len(text):
        found = _TOKEN.match(text, at)
        assert found is not None
        at = found.end()
        opening, closing, string, symbol, other = found.groups()
        inside = open_lists[-1][1]
        span = Span(source, found.start(found.lastindex or 0), at)
        if opening:
            if len(open_lists) > MAX_DEPTH:
                fail(span, f"brackets are nested more than {MAX_DEPTH} deep")
            open_lists.append((span.start, []))
        elif closing:
            if len(open_lists) == 1:
                fail(span, "this bracket closes none")
            start, items = open_lists.pop()
            open_lists[-1][1].append(Items(tuple(items), Span(source, start, at)))
        elif string is not None:
            inside.append(Text(re.sub(r"\\(.)", r"\1", string), span))
        elif symbol:
            inside.append(Symbol(symbol, span))
        elif other:
            fail(span, "this string does not end")
    if len(open_lists) > 1:
        start = open_lists[-1][0]
        fail(Span(source, start, start + 1), "this bracket is never closed")
    return tuple(open_lists[0][1])
