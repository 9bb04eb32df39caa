"""A source text and places in it."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Source:
    """A text and the name it is shown under (a path as the user wrote it)."""

    name: str
    text: str = field(repr=False)

    def span(self, start: int, end: int) -> Span:
        """The characters start..end (end not included)."""
        return Span(self, start, end)


@dataclass(frozen=True)
class Span:
    """Characters start..end of a source; every node of a parsed model carries one."""

    source: Source
    start: int
    end: int

    @property
    def line(self) -> int:
        """Line number, counted from 1."""
        return self.source.text.count("\n", 0, self.start) + 1

    @property
    def column(self) -> int:
        """Column in characters, counted from 1."""
        return self.start - self.source.text.rfind("\n", 0, self.start)

    @property
    def text(self) -> str:
        """The characters themselves."""
        return self.source.text[self.start : self.end]

    @property
    def line_text(self) -> str:
        """The whole line the span starts in."""
        begin = self.source.text.rfind("\n", 0, self.start) + 1
        end = self.source.text.find("\n", self.start)
        return self.source.text[begin : end if end >= 0 else None].rstrip("\r")

    def __str__(self) -> str:
        return f"{self.source.name}:{self.line}:{self.column}"
