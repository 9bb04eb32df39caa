"""What the names in an expression refer to: unknown ones, misused ones, and shadowing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from brdfc.lang.functions import FUNCTIONS, MISSING, PI
from brdfc.lang.model import Definition, Quantity, Symbol
from brdfc.lang.report import Report
from brdfc.lang.tree import (
    Binary,
    Call,
    Component,
    Expr,
    LetIn,
    Name,
    Number,
    Parameter,
    Unary,
    Vector,
    Where,
)
from brdfc.lang.words import KEYWORDS
from brdfc.source.span import Span

Scope = Mapping[str, Symbol]


def parameter_names(definition: Definition) -> frozenset[str]:
    """The names of a definition's parameters, none for a plain one."""
    return frozenset(parameter.name for parameter in definition.parameters or ())


def names_in(definition: Definition) -> set[str]:
    """The names that a definition's body uses, functions included, local names not."""
    return {
        node.function if isinstance(node, Call) else node.name
        for node, bound in _references(definition.body, parameter_names(definition))
        if isinstance(node, Call) or (isinstance(node, Name) and node.name not in bound)
    }


def used_names(definition: Definition) -> set[str]:
    """The names of its scope that a definition's body uses, functions included."""
    return names_in(definition) & definition.scope.keys()


def quantities_used(definition: Definition) -> dict[str, Quantity]:
    """The quantities a definition rests on, through whatever it uses, by name."""
    found: dict[str, Quantity] = {}
    # By identity: what was imported twice, with other quantities, stands at one place of a text.
    seen: set[int] = set()
    waiting = [definition]
    while waiting:
        current = waiting.pop()
        for symbol in (current.scope[name] for name in sorted(used_names(current))):
            if isinstance(symbol, Quantity):
                found[symbol.name] = symbol
            elif id(symbol) not in seen:
                seen.add(id(symbol))
                waiting.append(symbol)
    return found


def check_names(definition: Definition, report: Report) -> None:
    """Report the names of a definition's parameters and body that are wrong."""
    scope = definition.scope
    seen: set[str] = set()
    for parameter in definition.parameters or ():
        if parameter.name in seen:
            report.error(parameter.span, f"a second parameter is called '{parameter.name}'")
        else:
            _check_local(parameter, scope, seen, report)
        seen.add(parameter.name)
    for node, bound in _references(definition.body, parameter_names(definition)):
        if isinstance(node, LetIn):
            _check_local(node, scope, bound, report)
        elif isinstance(node, Call):
            _check_call(node, scope, bound, report)
        elif node.name not in bound and node.name != PI:
            _check_name(node, scope, bound, report)


def taken_word(name: str) -> str | None:
    """Why nothing may have that name, or None."""
    if name in KEYWORDS:
        return f"'{name}' is a word of the language and cannot be a name"
    if name in FUNCTIONS:
        return f"'{name}' is a built-in function and cannot be redefined"
    return f"'{PI}' is built in and cannot be redefined" if name == PI else None


def _check_local(
    local: LetIn | Parameter, scope: Scope, bound: frozenset[str] | set[str], report: Report
) -> None:
    """A local name may not hide another: which of them is meant would be a guess."""
    message = taken_word(local.name)
    notes: tuple[tuple[Span, str], ...] = ()
    symbol = scope.get(local.name)
    if symbol is not None:
        message = f"'{local.name}' would hide what has that name already"
        notes = ((symbol.span, "which is declared here"),)
    elif local.name in bound:
        message = f"'{local.name}' would hide the local name around it"
    if message:
        report.error(local.span, message, hint="choose another name", notes=notes)


def _check_call(call: Call, scope: Scope, bound: frozenset[str], report: Report) -> None:
    name, count = call.function, len(call.arguments)
    built_in, symbol = FUNCTIONS.get(name), scope.get(name)
    if built_in is not None:
        if not built_in.accepts_count(count):
            _wrong_count(call, built_in.signature, report)
    elif isinstance(symbol, Definition) and symbol.parameters is not None:
        if count != len(symbol.parameters):
            notes = ((symbol.span, "it is defined here"),)
            _wrong_count(call, _signature(name, symbol), report, notes)
    elif symbol is not None or name in bound or name == PI:
        hint: str | None = f"to multiply, write {name}*(...)"
        report.error(call.span, f"'{name}' is not a function", hint=hint)
    elif not report.excuses(name):
        functions = {n for n, s in scope.items() if isinstance(s, Definition) and s.parameters}
        hint = MISSING.get(name) or report.suggestion(name, functions | FUNCTIONS.keys())
        place = call.span.source.span(call.span.start, call.span.start + len(name))
        report.error(place, f"there is no function '{name}'", hint=hint)


def _signature(name: str, function: Definition) -> str:
    """How a user function is called."""
    return f"{name}({', '.join(parameter.name for parameter in function.parameters or ())})"


def _wrong_count(
    call: Call, signature: str, report: Report, notes: tuple[tuple[Span, str], ...] = ()
) -> None:
    count = len(call.arguments)
    given = f"{count} argument{'s' if count > 1 else ''}"
    message = f"'{call.function}' cannot take {given}"
    report.error(call.span, message, expected=signature, notes=notes)


def _check_name(node: Name, scope: Scope, bound: frozenset[str], report: Report) -> None:
    symbol = scope.get(node.name)
    function = FUNCTIONS.get(node.name)
    if isinstance(symbol, Definition) and symbol.parameters is not None:
        signature = _signature(node.name, symbol)
        report.error(node.span, f"'{node.name}' is a function", expected=signature)
    elif symbol is None and function is not None:
        report.error(node.span, f"'{node.name}' is a function", expected=function.signature)
    elif symbol is None and not report.excuses(node.name):
        report.error(
            node.span,
            f"nothing here is called '{node.name}'",
            expected="a channel, env, constant, let or parameter",
            hint=report.suggestion(node.name, {*scope, *bound, PI}),
        )


def _references(
    expr: Expr, bound: frozenset[str]
) -> Iterator[tuple[Name | Call | LetIn, frozenset[str]]]:
    """Every name, call and local definition, with the local names that can be used there."""
    match expr:
        case Name():
            yield expr, bound
        case LetIn():
            yield expr, bound
            yield from _references(expr.value, bound)
            yield from _references(expr.body, bound | {expr.name})
        case Call():
            yield expr, bound
            for argument in expr.arguments:
                yield from _references(argument, bound)
        case Unary():
            yield from _references(expr.operand, bound)
        case Binary():
            yield from _references(expr.left, bound)
            yield from _references(expr.right, bound)
        case Where():
            for part in (expr.value, expr.condition, expr.otherwise):
                yield from _references(part, bound)
        case Vector():
            for component in expr.components:
                yield from _references(component, bound)
        case Component():
            yield from _references(expr.vector, bound)
        case Number():
            pass
