"""A rule's side, written in the language of the models, as a pattern."""

from __future__ import annotations

from collections import defaultdict

from brdfc.lang.model import Definition, Quantity, Role, Symbol
from brdfc.lang.parse import parse
from brdfc.lang.tree import Let
from brdfc.lang.types import TYPES
from brdfc.source.span import Source, Span
from brdfc.symbolic.build import build
from brdfc.symbolic.expression import Expression


class _Variables(defaultdict[str, Symbol]):
    """A scope in which every name is a variable."""

    def __init__(self, span: Span) -> None:
        super().__init__()
        self.span = span

    def __missing__(self, name: str) -> Quantity:
        number = TYPES["number"]
        return Quantity(name, Role.CHANNEL, number, 0.0, 1.0, (0.0,), "", "", self.span)

    def get(self, name: str, default: object = None) -> None:  # type: ignore[override]
        """No function is the user's own."""
        return


def pattern(text: str) -> Expression:
    """The expression of a text whose names are variables."""
    parsed = parse(Source("rule", f"let side = {' '.join(text.split())}\n"))
    assert not parsed.diagnostics, str(parsed.diagnostics[0])
    (statement,) = parsed.statements
    assert isinstance(statement, Let)
    scope = _Variables(statement.span)
    return build(Definition("side", None, statement.body, "", statement.span, scope), {})
