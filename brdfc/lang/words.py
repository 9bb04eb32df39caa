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
    "breaks",
    "example",
)
"""The words that begin a statement."""

CONTINUATIONS = (
    "cite", "note", "highlight", "in", "as", "with", "where", "else", "and", "or", "not", "within",
    "simpler",
)  # fmt: skip
"""The words that stand within one."""

KEYWORDS = frozenset(STATEMENTS + CONTINUATIONS)
