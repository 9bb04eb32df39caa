"""The words of the language, all reserved: none can be a name."""

from __future__ import annotations

STATEMENTS = (
    "model",
    "module",
    "channel",
    "env",
    "constant",
    "import",
    "let",
    "radiance",
    "law",
    "example",
)
"""The words that begin a statement."""

CONTINUATIONS = ("cite", "note", "in", "as", "where", "else", "and", "or", "not", "within")
"""The words that stand within one."""

KEYWORDS = frozenset(STATEMENTS + CONTINUATIONS)
