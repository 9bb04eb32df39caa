"""What is wrong, where, and what to do: one message drawn as good compilers draw it.

ward.brdf:9:21: error: nothing here is called 'incidnt'
    9 | let delta = (incidnt - reflection)/2
      |              ^^^^^^^ expected a channel, env, constant, let or parameter
      hint: did you mean 'incident'?
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass

from brdfc.source.span import Span


@dataclass(frozen=True)
class Diagnostic:
    """One finding in a source text.

    message says what is wrong, expected (optional) what would be right there, hint (optional)
    what to do, and notes point to other places that matter ("first declared here").
    """

    span: Span
    message: str
    expected: str | None = None
    hint: str | None = None
    notes: tuple[tuple[Span, str], ...] = ()

    def __str__(self) -> str:
        message = self.message if len(self.message) <= _SAID else self.message[:_SAID] + "..."
        parts = [f"{self.span}: error: {message}"]
        parts += _drawn(self.span, f"expected {self.expected}" if self.expected else "")
        for span, note in self.notes:
            parts += [f"  {span}: {note}", *_drawn(span, "")]
        if self.hint:
            parts.append(f"          hint: {self.hint}")
        return "\n".join(parts)


_SAID = 600
"""Characters that a message has at most: it may quote a text from outside."""
_DRAWN = 160
"""Characters that are shown of a line; of a longer one, those around the span."""


def _drawn(span: Span, label: str) -> list[str]:
    """The line with a caret under the span, at most to the end of the first line."""
    line = span.line_text
    before = line[: span.column - 1]
    if len(line) > _DRAWN:
        first = max(0, len(before) - _DRAWN // 2)
        line, before = line[first : first + _DRAWN], before[first:]
    width = max(1, min(span.end - span.start, len(line) - len(before)))
    # Tabs are kept in front of the carets, so that they stand under the text at any tab width.
    indent = "".join("\t" if character == "\t" else " " for character in before)
    carets = f"{indent}{'^' * width} {label}".rstrip()
    return [f"{span.line:>5} | {line}", f"      | {carets}"]


_LONGEST_NAME = 100
"""Of longer ones no likeness is sought: it takes time that grows with the square."""


def nearest(name: str, known: Iterable[str]) -> str | None:
    """The known name a mistyped one most resembles, or None; for hints."""
    if len(name) > _LONGEST_NAME:
        return None
    known = sorted(set(known))
    exact = [k for k in known if k.lower() == name.lower()]
    close = exact or difflib.get_close_matches(name, known, n=9, cutoff=0.6)
    # Of those that are as near, the one that begins alike: D55, not D75, for D56.
    return max(close, key=lambda k: (_likeness(name, k), _common_start(name, k)), default=None)


def _likeness(name: str, other: str) -> float:
    return difflib.SequenceMatcher(None, other, name).ratio()


def _common_start(name: str, other: str) -> int:
    return next((i for i, (a, b) in enumerate(zip(name, other, strict=False)) if a != b), 0)


def did_you_mean(name: str, known: Iterable[str]) -> str | None:
    """A hint for a mistyped name, or None when nothing is near."""
    found = nearest(name, known)
    return f"did you mean '{found}'?" if found else None
