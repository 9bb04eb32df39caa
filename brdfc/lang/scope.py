"""The names of one file and what they stand for."""

from __future__ import annotations

from brdfc.lang.model import Quantity, Symbol
from brdfc.lang.names import taken_word
from brdfc.lang.report import Report
from brdfc.source.span import Span


class FileScope:
    """symbols: every name at the top of the file; quantities: those of them that are quantities,
    in order; borrowed: the quantities that came with imported functions, not asked for by name."""

    def __init__(self, report: Report) -> None:
        self.report = report
        self.symbols: dict[str, Symbol] = {}
        self.quantities: dict[str, Quantity] = {}
        self.borrowed: set[str] = set()
        self._places: dict[str, Span] = {}

    def claim(self, name: str, symbol: Symbol, span: Span) -> bool:
        """Give a name its meaning; False where it is not free, which is reported."""
        taken = taken_word(name)
        if taken:
            self.report.error(span, taken, hint="choose another name")
            self.report.broken.add(name)
            return False
        if name in self.symbols:
            note = ((self._places[name], f"'{name}' is declared here"),)
            self.report.error(span, f"'{name}' is declared twice", notes=note)
            return False
        self.symbols[name] = symbol
        self._places[name] = span
        if isinstance(symbol, Quantity):
            self.quantities[name] = symbol
        return True
