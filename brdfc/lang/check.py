"""Statements to a checked Model or Module: every name known, every type agreeing.

All independent errors are reported. What rests on something that is already reported stays silent.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from graphlib import CycleError, TopologicalSorter

from brdfc.lang import facts, tree
from brdfc.lang.borrow import Borrower, Imported
from brdfc.lang.declarations import check_unique, quantity
from brdfc.lang.model import HIGHLIGHTS, Definition, Law, Model, Module, Quantity
from brdfc.lang.names import check_names, quantities_used, taken_word, used_names
from brdfc.lang.parse import Parsed
from brdfc.lang.report import Report
from brdfc.lang.scope import FileScope
from brdfc.lang.typecheck import TypeChecker
from brdfc.lang.types import TRUTH, DeclaredType, Dimension
from brdfc.source.span import Span

_FACTS = tree.Law | tree.Breaks | tree.Example


def check(
    parsed: Parsed,
    origin: str,
    report: Report,
    imported: Imported,
    spectral: DeclaredType | None = None,
) -> Model | Module | None:
    """The checked file, or None where something is wrong with it.

    imported: gives the file an import statement names, or None after reporting why there is none.
    spectral: the spectrum that stands for X, Y, Z (see types.in_bands_of); the facts, which the
    file states in X, Y, Z, are then left out.
    """
    for diagnostic in parsed.diagnostics:
        report.add(diagnostic)
    report.broken |= parsed.unread
    checked = _File(parsed, report, spectral).checked(origin, imported)
    return checked if report.clean else None


class _File:
    """One file on its way from statements to what they mean."""

    def __init__(self, parsed: Parsed, report: Report, spectral: DeclaredType | None) -> None:
        self._report = report
        self._spectral = spectral
        self._statements = tuple(
            s for s in parsed.statements if spectral is None or not isinstance(s, _FACTS)
        )
        # A statement that could not be read may be the one that is missing.
        self._complete = not parsed.diagnostics
        self._scope = FileScope(report)
        self._borrower = Borrower(self._scope)
        self._definitions: list[Definition] = []

    def checked(self, origin: str, imported: Imported) -> Model | Module | None:
        """Everything, in the order in which one thing needs the other."""
        header = self._header()
        self._declare()
        self._borrower.bring([s for s in self._statements if isinstance(s, tree.Import)], imported)
        check_unique(list(self._scope.quantities.values()), self._report)
        self._define()
        radiance = self._radiance(header)
        everything = [*self._definitions, *([radiance] if radiance else [])]
        for definition in everything:
            if not self._report.full:
                check_names(definition, self._report)
        types = TypeChecker(self._report)
        self._borrower.check_bindings(types)
        for definition in self._in_order():
            types.check(definition)
        self._check_simpler(types)
        width = self._radiance_width(radiance, types)
        quantities = self._quantities(radiance)
        laws = tuple(self._laws(quantities, types))
        stated = facts.Facts(quantities, self._borrower.geometry, self._report)
        examples = stated.examples(self._statements, width)
        breaches = stated.breaches(self._statements)
        if header is None:
            return None
        about = (header.name, header.title, header.citations, header.notes)
        if radiance is None:
            return Module(
                *about,
                tuple(self._definitions),
                origin,
                tuple(self._scope.quantities.values()),
                self._borrower.geometry,
            )
        return Model(
            *about,
            quantities=tuple(quantities.values()),
            radiance=radiance,
            definitions=tuple(self._definitions),
            laws=laws,
            breaches=breaches,
            examples=examples,
            origin=origin,
            geometry=self._borrower.geometry,
            highlight=header.highlight or HIGHLIGHTS[0],
        )

    def _quantities(self, radiance: Definition | None) -> dict[str, Quantity]:
        """The file's quantities: its own, then those that came with imported names and are needed
        after all, in the order of the file they came from."""
        needed = quantities_used(radiance) if radiance else {}
        borrowed = {n: self._scope.quantities[n] for n in self._scope.borrowed & needed.keys()}
        in_order = sorted(borrowed.values(), key=lambda q: (q.span.source.name, q.span.start))
        own = [q for n, q in self._scope.quantities.items() if n not in self._scope.borrowed]
        return {q.name: q for q in (*own, *in_order)}

    # ------------------------------------------------------------ the header

    def _header(self) -> tree.Header | None:
        """The one header, which comes first and says what else there may be."""
        headers = [s for s in self._statements if isinstance(s, tree.Header)]
        if not headers:
            if self._complete:
                message = "there is no header"
                hint = 'the first statement is: model NAME "title", or: module NAME "title"'
                self._report.error(self._report.source.span(0, 0), message, hint=hint)
            return None
        header = headers[0]
        word = taken_word(header.name)
        if word:
            self._report.error(header.span, word)
        if self._statements[0] is not header and self._complete:
            self._report.error(header.span, "the header comes first")
        for other in headers[1:]:
            note = ((header.span, "the first header is here"),)
            self._report.error(other.span, "this is a second header", notes=note)
        if header.highlight and header.highlight not in HIGHLIGHTS:
            near = self._report.suggestion(header.highlight, HIGHLIGHTS)
            message = f"highlights are not '{header.highlight}'"
            self._report.error(header.span, message, expected=" or ".join(HIGHLIGHTS), hint=near)
        if header.kind == "module":
            if header.highlight:
                message = "a module has no highlights: that is for its models to say"
                self._report.error(header.span, message)
            for statement in self._statements:
                allowed = tree.Header | tree.Import | tree.Let | tree.Declaration
                if not isinstance(statement, allowed):
                    word = statement.span.text.split(None, 1)[0]
                    message = f"a module has only quantities, 'import' and 'let', not '{word}'"
                    hint = "make it a model, whose header begins: model"
                    self._report.error(statement.span, message, hint=hint)
        return header

    # ------------------------------------------------------------ names

    def _declare(self) -> None:
        for statement in self._statements:
            if isinstance(statement, tree.Declaration):
                found = quantity(statement, self._report, self._spectral)
                if found is None:
                    self._report.broken.add(statement.name)
                else:
                    self._scope.claim(found.name, found, found.span)

    def _define(self) -> None:
        for statement in self._statements:
            if isinstance(statement, tree.Let):
                definition = Definition(
                    statement.name,
                    statement.parameters,
                    statement.body,
                    statement.description,
                    statement.name_span,
                    self._scope.symbols,
                    tuple(other.name for other in statement.simpler),
                )
                self._scope.claim(definition.name, definition, definition.span)
                self._definitions.append(definition)

    # ------------------------------------------------------------ expressions

    def _in_order(self) -> list[Definition]:
        """The file's definitions, each after those it uses; reports those that use themselves."""
        symbols = self._scope.symbols
        own = {d.name: d for d in self._definitions if symbols.get(d.name) is d}
        graph = {name: sorted(used_names(d) & own.keys()) for name, d in own.items()}
        while not self._report.full:
            try:
                order = list(TopologicalSorter(graph).static_order())
            except CycleError as error:
                # graphlib gives the cycle as a list whose first and last names are the same.
                cycle = error.args[1][::-1]
                start = min(cycle, key=lambda name: own[name].span.start)
                first = cycle.index(start)
                members = [*cycle[first:-1], *cycle[:first]]
                shown = members if len(members) <= 8 else [*members[:6], "...", members[-1]]
                chain = " -> ".join([*shown, start])
                message = f"'{start}' is defined by itself: {chain}"
                self._report.error(own[start].span, message, hint="there is no recursion")
                # Out of the scope, so that nothing follows them round; who uses them is silent.
                for name in set(cycle):
                    del symbols[name], graph[name]
                graph = {n: [u for u in uses if u in graph] for n, uses in graph.items()}
            else:
                return [own[name] for name in order]
        return []

    def _check_simpler(self, types: TypeChecker) -> None:
        """What may stand for a definition takes the same arguments, and gives the same kind."""
        for statement in (s for s in self._statements if isinstance(s, tree.Let)):
            for other in statement.simpler:
                own, found = (self._scope.symbols.get(n) for n in (statement.name, other.name))
                if not isinstance(own, Definition):  # which is reported elsewhere
                    continue
                if not isinstance(found, Definition) or found is own:
                    others = self._scope.symbols.keys() - {other.name}
                    near = self._report.suggestion(other.name, others)
                    message = f"there is no other 'let' of the name '{other.name}'"
                    self._report.error(other.span, message, hint=near)
                    continue
                counts = [len(d.parameters) if d.parameters else 0 for d in (own, found)]
                kinds = [types.check(d) for d in (own, found)]
                if counts[0] != counts[1] or (None not in kinds and kinds[0] != kinds[1]):
                    message = f"'{other.name}' cannot stand for '{own.name}'"
                    notes = ((found.span, "it takes other arguments, or gives another type"),)
                    self._report.error(other.span, message, notes=notes)

    def _radiance(self, header: tree.Header | None) -> Definition | None:
        """The one radiance of a model."""
        found = [s for s in self._statements if isinstance(s, tree.Radiance)]
        for other in found[1:]:
            note = ((found[0].span, "the first is here"),)
            self._report.error(other.span, "this is a second radiance", notes=note)
        if not found:
            if header is not None and header.kind == "model" and self._complete:
                hint = "write what it computes: radiance = ..."
                self._report.error(header.span, "this model has no radiance", hint=hint)
            return None
        body, span = found[0].body, found[0].span
        return Definition("radiance", None, body, "", span, self._scope.symbols)

    def _radiance_width(self, radiance: Definition | None, types: TypeChecker) -> int | None:
        found = None if radiance is None else types.check(radiance)
        if radiance is None or found is None:
            return None
        if found.dimension is not Dimension.NUMBER:
            message = f"the radiance is one number or several, and this is {found}"
            self._report.error(radiance.body.span, message)
            return None
        return found.width

    def _laws(self, quantities: Mapping[str, Quantity], types: TypeChecker) -> Iterator[Law]:
        """The laws claimed, each once."""
        seen: dict[str, Span] = {}
        for statement in self._statements:
            if not isinstance(statement, tree.Law):
                continue
            if statement.name in seen:
                note = ((seen[statement.name], "it is claimed here"),)
                self._report.error(statement.span, "this law is claimed twice", notes=note)
            seen.setdefault(statement.name, statement.span)
            law = facts.law(statement, quantities, self._report)
            if law is not None and law.condition is not None:
                check_names(law.condition, self._report)
                found = types.check(law.condition)
                if found is not None and found != TRUTH:
                    message = f"a law holds where a condition does, and this is {found}"
                    self._report.error(law.condition.span, message)
            if law is not None:
                yield law
