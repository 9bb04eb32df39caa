"""The findings of one file's check, gathered."""

from __future__ import annotations

from collections.abc import Iterable

from brdfc.lang.limits import MAX_FINDINGS
from brdfc.source.diagnostics import Diagnostic, did_you_mean
from brdfc.source.span import Source, Span

# Names among which a mistyped one is looked for.
_LONGEST_NAME = 60
_MOST_NAMES = 500


class Report:
    """The diagnostics of one file.

    broken holds names whose definition was found to be wrong: that they are unknown later is no
    error of its own. Where anything_goes, names are missing that nobody can list (of an import
    that failed), so no name is reported as unknown.
    """

    def __init__(self, source: Source) -> None:
        self.source = source
        self.broken: set[str] = set()
        self.anything_goes = False
        self._found: dict[tuple[Span, str], Diagnostic] = {}

    def error(
        self,
        span: Span,
        message: str,
        *,
        expected: str | None = None,
        hint: str | None = None,
        notes: tuple[tuple[Span, str], ...] = (),
    ) -> None:
        """Add a finding, unless the same was found at the same place before."""
        self.add(Diagnostic(span, message, expected, hint, notes))

    def add(self, diagnostic: Diagnostic) -> None:
        """Add a finding made elsewhere."""
        if not self.full:
            self._found.setdefault((diagnostic.span, diagnostic.message), diagnostic)

    @property
    def clean(self) -> bool:
        """Whether nothing is wrong, here or in what is imported."""
        return not (self._found or self.broken or self.anything_goes)

    @property
    def full(self) -> bool:
        """Whether there are so many findings that no more are kept."""
        return len(self._found) >= MAX_FINDINGS

    def suggestion(self, name: str, known: Iterable[str]) -> str | None:
        """did_you_mean, where looking is affordable: not for the names a machine would write."""
        candidates = [other for other in known if len(other) <= _LONGEST_NAME]
        if self.full or len(name) > _LONGEST_NAME or len(candidates) > _MOST_NAMES:
            return None
        return did_you_mean(name, candidates)

    def excuses(self, name: str) -> bool:
        """Whether an unknown name is accounted for by another finding."""
        return self.anything_goes or name in self.broken

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """In the order of the text; a finding in another file stands where this one led to it."""
        return sorted(self._found.values(), key=self._position)

    def _position(self, diagnostic: Diagnostic) -> int:
        places = [diagnostic.span, *(span for span, _ in diagnostic.notes)]
        return next((span.start for span in places if span.source is self.source), 0)
