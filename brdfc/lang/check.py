"""Statements to a checked Model or Module: every name known, every type agreeing.

All independent errors are reported. What rests on something that is already reported stays silent.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from graphlib import CycleError, TopologicalSorter

from brdfc.lang import facts, tree
from brdfc.lang.declarations import check_unique, quantity
from brdfc.lang.imports import standing_for
from brdfc.lang.model import Definition, Law, Model, Module, Quantity, Symbol
from brdfc.lang.names import check_names, quantities_used, taken_word, used_names
from brdfc.lang.parse import Parsed
from brdfc.lang.report import Report
from brdfc.lang.typecheck import TypeChecker
from brdfc.lang.types import Dimension
from brdfc.source.span import Span

Imported = Callable[[tree.Import], Model | Module | None]


def check(parsed: Parsed, origin: str, report: Report, imported: Imported) -> Model | Module | None:
    """The checked file, or None where something is wrong with it.

    imported: gives the file an import statement names, or None after reporting why there is none.
    """
    for diagnostic in parsed.diagnostics:
        report.add(diagnostic)
    report.broken |= parsed.unread
    checked = _File(parsed, report).checked(origin, imported)
    return checked if report.clean else None


class _File:
    """One file on its way from statements to what they mean."""

    def __init__(self, parsed: Parsed, report: Report) -> None:
        self._report = report
        self._statements = parsed.statements
        # A statement that could not be read may be the one that is missing.
        self._complete = not parsed.diagnostics
        self._scope: dict[str, Symbol] = {}
        self._places: dict[str, Span] = {}
        self._quantities: dict[str, Quantity] = {}
        self._definitions: list[Definition] = []

    def checked(self, origin: str, imported: Imported) -> Model | Module | None:
        """Everything, in the order in which one thing needs the other."""
        header = self._header()
        self._declare()
        self._import(imported)
        check_unique(list(self._quantities.values()), self._report)
        self._define()
        radiance = self._radiance(header)
        everything = [*self._definitions, *([radiance] if radiance else [])]
        for definition in everything:
            if not self._report.full:
                check_names(definition, self._report)
        types = TypeChecker(self._report)
        for definition in self._in_order():
            types.check(definition)
        width = self._radiance_width(radiance, types)
        laws = tuple(self._laws())
        examples = [
            facts.example(s, self._quantities, width, self._report)
            for s in self._statements
            if isinstance(s, tree.Example)
        ]
        if header is None:
            return None
        about = (header.name, header.title, header.citations, header.notes)
        if radiance is None:
            return Module(*about, tuple(self._definitions), origin)
        return Model(
            *about,
            quantities=tuple(self._quantities.values()),
            radiance=radiance,
            definitions=tuple(self._definitions),
            laws=laws,
            examples=tuple(example for example in examples if example is not None),
            origin=origin,
        )

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
        if header.kind == "module":
            for statement in self._statements:
                if not isinstance(statement, tree.Header | tree.Import | tree.Let):
                    word = statement.span.text.split(None, 1)[0]
                    message = f"a module has only 'import' and 'let', not '{word}'"
                    hint = "give its functions parameters, or make it a model"
                    self._report.error(statement.span, message, hint=hint)
        return header

    # ------------------------------------------------------------ names

    def _claim(self, name: str, symbol: Symbol, span: Span) -> bool:
        """Put a name in the scope; False where it is not free, which is reported."""
        taken = taken_word(name)
        if taken:
            self._report.error(span, taken, hint="choose another name")
            self._report.broken.add(name)
            return False
        if name in self._scope:
            note = ((self._places[name], f"'{name}' is declared here"),)
            self._report.error(span, f"'{name}' is declared twice", notes=note)
            return False
        self._scope[name] = symbol
        self._places[name] = span
        return True

    def _declare(self) -> None:
        for statement in self._statements:
            if isinstance(statement, tree.Declaration):
                found = quantity(statement, self._report)
                if found is None:
                    self._report.broken.add(statement.name)
                elif self._claim(found.name, found, found.span):
                    self._quantities[found.name] = found

    def _define(self) -> None:
        for statement in self._statements:
            if isinstance(statement, tree.Let):
                definition = Definition(
                    statement.name,
                    statement.parameters,
                    statement.body,
                    statement.description,
                    statement.name_span,
                    self._scope,
                )
                self._claim(definition.name, definition, definition.span)
                self._definitions.append(definition)

    # ------------------------------------------------------------ imports

    def _import(self, imported: Imported) -> None:
        """Whole models first: their quantities can be what an imported definition needs."""
        statements = [s for s in self._statements if isinstance(s, tree.Import)]
        for statement in sorted(statements, key=lambda s: bool(s.names)):
            found = imported(statement)
            if found is None:
                self._report.broken |= {name.alias for name in statement.names}
                self._report.anything_goes |= not statement.names
            elif statement.names:
                for name in statement.names:
                    self._import_name(name, found)
            else:
                self._import_model(statement, found)

    def _import_name(self, item: tree.ImportName, found: Model | Module) -> None:
        definitions = {definition.name: definition for definition in found.definitions}
        definition = definitions.get(item.name)
        if definition is None:
            hint = self._report.suggestion(item.name, definitions)
            if isinstance(found, Model) and found.quantity(item.name):
                hint = f"'{item.name}' is a quantity of that model: declare your own"
            message = f"'{found.name}' does not define '{item.name}'"
            listed = ", ".join(definitions) or None
            self._report.error(item.span, message, expected=listed, hint=hint)
            self._report.broken.add(item.alias)
            return
        needed = quantities_used(definition)
        missing = [n for n in sorted(needed) if not self._stands_for(n, needed[n], item)]
        if missing:
            self._report.broken.add(item.alias)
            return
        own = replace(standing_for(definition, self._quantities), name=item.alias)
        self._claim(item.alias, own, item.span)

    def _stands_for(self, name: str, needed: Quantity, item: tree.ImportName) -> bool:
        """Whether this file's quantity can stand for one that an imported definition uses."""
        own = self._quantities.get(name)
        if own is not None and own.type == needed.type:
            return True
        if own is not None or not self._report.excuses(name):
            what = f"of type {own.type.name} here" if own else "not declared here"
            message = f"'{item.name}' uses '{name}', which is {what}"
            hint = f"declare it: {needed.role.value} {name} : {needed.type.name} in ..."
            notes = ((needed.span, "it is declared there"),)
            self._report.error(item.span, message, hint=hint, notes=notes)
        return False

    def _import_model(self, statement: tree.Import, found: Model | Module) -> None:
        """A whole model: its quantities are added, and its radiance gets its name."""
        name = found.name if statement.is_path else statement.target
        if isinstance(found, Module):
            has = ", ".join(definition.name for definition in found.definitions)
            message = f"'{name}' is a module, which has no radiance to import"
            hint = f"name what you need of it: import {statement.target} ({has})"
            self._report.error(statement.span, message, hint=hint)
            self._report.anything_goes = True
            return
        for other in found.quantities:
            own = self._quantities.get(other.name)
            if own is None:
                if self._claim(other.name, other, statement.span):
                    self._quantities[other.name] = other
            elif own.type != other.type:
                message = f"'{other.name}' of '{name}' is of type {other.type.name}"
                notes = ((own.span, f"here it is of type {own.type.name}"),)
                self._report.error(statement.span, message, notes=notes)
        radiance = standing_for(found.radiance, self._quantities)
        own_radiance = replace(radiance, name=name, description=found.title)
        self._claim(name, own_radiance, statement.span)

    # ------------------------------------------------------------ expressions

    def _in_order(self) -> list[Definition]:
        """The file's definitions, each after those it uses; reports those that use themselves."""
        own = {d.name: d for d in self._definitions if self._scope.get(d.name) is d}
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
                    del self._scope[name], graph[name]
                graph = {n: [u for u in uses if u in graph] for n, uses in graph.items()}
            else:
                return [own[name] for name in order]
        return []

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
        return Definition("radiance", None, found[0].body, "", found[0].span, self._scope)

    def _radiance_width(self, radiance: Definition | None, types: TypeChecker) -> int | None:
        found = None if radiance is None else types.check(radiance)
        if radiance is None or found is None:
            return None
        if found.dimension is not Dimension.NUMBER:
            message = f"the radiance is one number or several, and this is {found}"
            self._report.error(radiance.body.span, message)
            return None
        return found.width

    def _laws(self) -> Iterator[Law]:
        """The laws claimed, each once."""
        seen: dict[str, Span] = {}
        for statement in self._statements:
            if isinstance(statement, tree.Law):
                if statement.name in seen:
                    note = ((seen[statement.name], "it is claimed here"),)
                    self._report.error(statement.span, "this law is claimed twice", notes=note)
                seen.setdefault(statement.name, statement.span)
                law = facts.law(statement, self._report)
                if law is not None:
                    yield law
