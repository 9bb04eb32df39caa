"""Import statements: names of other files made names of this one.

A quantity that an imported formula rests on is this file's quantity of the same name, or what the
import binds it to. Where this file has none of that name, the other file's own comes along; only a
model from which single names are taken keeps its channels, as nobody asked for those.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

from brdfc.lang import tree
from brdfc.lang.declarations import component_values
from brdfc.lang.imports import standing_for
from brdfc.lang.model import Definition, Model, Module, Quantity, Role, Symbol
from brdfc.lang.names import check_names, names_in, quantities_used
from brdfc.lang.report import Report
from brdfc.lang.scope import FileScope
from brdfc.lang.typecheck import TypeChecker

Imported = Callable[[tree.Import], Model | Module | None]

Bound = dict[str, tuple[tree.Binding, Quantity, Definition]]
"""By the name of the other file's quantity: the statement, that quantity, what stands for it."""


class Borrower:
    """The import statements of one file."""

    def __init__(self, scope: FileScope) -> None:
        self._scope = scope
        self._report: Report = scope.report
        self._bound: list[Bound] = []
        self.geometry = ""

    def bring(self, statements: Iterable[tree.Import], imported: Imported) -> None:
        """All of them; whole models first: their quantities can be what an imported name needs."""
        for statement in sorted(statements, key=lambda s: bool(s.names)):
            found = imported(statement)
            if found is None:
                # Names that nobody can list: of the other file, or of quantities that come along.
                self._report.anything_goes = True
                continue
            self.geometry = self.geometry or found.geometry
            bound = self._bindings(statement, found)
            if statement.names:
                for name in statement.names:
                    self._name(name, found, bound)
            else:
                self._model(statement, found, bound)

    def check_bindings(self, types: TypeChecker) -> None:
        """What stands for a quantity has its type, and uses nothing but quantities."""
        for binding, quantity, definition in (b for bound in self._bound for b in bound.values()):
            lets = self._scope.symbols.keys() - self._scope.quantities.keys()
            used = sorted(names_in(definition) & lets)
            if _literals(binding.value):
                continue
            if used:
                message = f"'{used[0]}' is no quantity: only those can stand for one"
                self._report.error(binding.value.span, message, hint="write out what it is")
                continue
            check_names(definition, self._report)
            found = types.check(definition)
            if found is not None and found != quantity.type.value:
                message = f"'{quantity.name}' is {quantity.type.value}, and this is {found}"
                notes = ((quantity.span, "it is declared there"),)
                self._report.error(binding.value.span, message, notes=notes)

    # ------------------------------------------------------------ one name

    def _name(self, item: tree.ImportName, found: Model | Module, bound: Bound) -> None:
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
        used = quantities_used(definition)
        needed = [q for q in found.quantities if q.name in used and q.name not in bound]
        for quantity in needed:
            unasked = isinstance(found, Model) and quantity.role is Role.CHANNEL
            if not unasked and quantity.name not in self._scope.symbols:
                self._scope.claim(quantity.name, quantity, item.span)
                self._scope.borrowed.add(quantity.name)
        good = [self._stands_for(quantity, item) for quantity in needed]
        if not all(good):
            self._report.broken.add(item.alias)
            return
        own = standing_for(definition, self._standing(bound))
        self._scope.claim(item.alias, replace(own, name=item.alias), item.span)

    def _stands_for(self, needed: Quantity, item: tree.ImportName) -> bool:
        """Whether this file's quantity can stand for one that an imported definition uses."""
        own = self._scope.quantities.get(needed.name)
        if own is not None and own.type == needed.type:
            return True
        if own is not None or not self._report.excuses(needed.name):
            what = f"of type {own.type.name} here" if own else "not declared here"
            message = f"'{item.name}' uses '{needed.name}', which is {what}"
            hint = f"declare it: {needed.role.value} {needed.name} : {needed.type.name} in ..."
            notes = ((needed.span, "it is declared there"),)
            self._report.error(item.span, message, hint=hint, notes=notes)
        return False

    # ------------------------------------------------------------ a whole model

    def _model(self, statement: tree.Import, found: Model | Module, bound: Bound) -> None:
        """Its quantities are added, and its radiance gets its name, or the one given."""
        name = found.name if statement.is_path else statement.target
        if isinstance(found, Module):
            has = ", ".join(definition.name for definition in found.definitions)
            message = f"'{name}' is a module, which has no radiance to import"
            hint = f"name what you need of it: import {statement.target} ({has})"
            self._report.error(statement.span, message, hint=hint)
            self._report.anything_goes = True
            return
        for other in found.quantities:
            own = self._scope.quantities.get(other.name)
            if other.name in bound:
                continue
            if own is None:
                self._scope.claim(other.name, other, statement.span)
            elif own.type != other.type:
                message = f"'{other.name}' of '{name}' is of type {other.type.name}"
                notes = ((own.span, f"here it is of type {own.type.name}"),)
                self._report.error(statement.span, message, notes=notes)
        radiance = standing_for(found.radiance, self._standing(bound))
        called = statement.alias or name
        own_radiance = replace(radiance, name=called, description=found.title)
        self._scope.claim(called, own_radiance, statement.span)

    # ------------------------------------------------------------ bindings

    def _standing(self, bound: Bound) -> dict[str, Symbol]:
        """What the quantities of an imported file are here."""
        given: dict[str, Symbol] = {name: definition for name, (_, _, definition) in bound.items()}
        return {**self._scope.quantities, **given}

    def _bindings(self, statement: tree.Import, found: Model | Module) -> Bound:
        """What an import binds, each once, of the quantities that the other file has."""
        theirs = {quantity.name: quantity for quantity in found.quantities}
        bound: Bound = {}
        for binding in statement.bindings:
            quantity = theirs.get(binding.name)
            if quantity is None:
                hint = self._report.suggestion(binding.name, theirs)
                message = f"'{found.name}' has no quantity '{binding.name}'"
                listed = ", ".join(theirs) or None
                self._report.error(binding.span, message, expected=listed, hint=hint)
            elif binding.name in bound:
                self._report.error(binding.span, f"'{binding.name}' is bound twice")
            else:
                # Quantities only, so that nothing can come to stand for what it rests on.
                definition = Definition(
                    name=binding.name,
                    parameters=None,
                    body=self._value(binding.value, quantity),
                    description="",
                    span=binding.value.span,
                    scope=self._scope.quantities,
                )
                bound[binding.name] = (binding, quantity, definition)
        self._bound.append(bound)
        return bound

    def _value(self, value: tree.Expr, quantity: Quantity) -> tree.Expr:
        """What a binding says; of a plain value, that it lies within the quantity's range."""
        plain = _literals(value)
        if plain:
            limits, what = (quantity.low, quantity.high), f"'{quantity.name}'"
            component_values(plain, quantity.type, limits, what, self._report)
        width = quantity.type.value.width
        return tree.Vector(value.span, (value,) * width) if len(plain) == 1 < width else value


def _literals(value: tree.Expr) -> tuple[tree.Number, ...]:
    """The numbers of a plain value, `0.5` or `-10deg` or `(0.1, 0.2, 0.3)`; none of any other."""
    match value:
        case tree.Number():
            return (value,)
        case tree.Unary(operator="-", operand=tree.Number() as number):
            return (replace(number, span=value.span, value=-number.value),)
        case tree.Vector(components=components):
            each = [_literals(part) for part in components]
            return tuple(number for part in each for number in part) if all(each) else ()
    return ()
