"""Lark's tree of one statement to the syntax tree of tree.py: one method a rule of the grammar."""

from __future__ import annotations

from typing import Any

from lark import Token, Tree

from brdfc.lang import tree as ast
from brdfc.lang.values import BadValue, split_number
from brdfc.source.diagnostics import Diagnostic
from brdfc.source.span import Source, Span

_COMPONENTS = {"x": 0, "y": 1, "z": 2}


class Rejected(Exception):
    """A statement that cannot be read, and why."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


def statement(tree: Tree[Token], source: Source) -> ast.Statement:
    """The statement a parse tree stands for; raises Rejected for what only looks like one."""
    built: ast.Statement = _Builder(source).built(tree)
    return built


class _Builder:
    """The methods are named after the rules and take the rule's children, tokens or trees.

    A child is None where an optional part is absent.
    """

    def __init__(self, source: Source) -> None:
        self._source = source

    def built(self, tree: Any) -> Any:
        """What a subtree stands for; None for None."""
        if tree is None:
            return None
        span = self._source.span(tree.meta.start_pos, tree.meta.end_pos)
        return getattr(self, f"_{tree.data}")(span, *tree.children)

    def _all(self, trees: tuple[Any, ...]) -> tuple[Any, ...]:
        return tuple(self.built(tree) for tree in trees if tree is not None)

    def _place(self, token: Token) -> Span:
        assert token.start_pos is not None
        assert token.end_pos is not None
        return self._source.span(token.start_pos, token.end_pos)

    # ------------------------------------------------------------ statements

    def _header(self, span: Span, kind: Token, name: Token, title: Token, *clauses: Any) -> Any:
        texts = [(clause.data, _text(clause.children[0])) for clause in clauses]
        cites, notes = (tuple(t for k, t in texts if k == key) for key in ("cite", "note"))
        highlights = [text for clause, text in texts if clause == "highlight"]
        if len(highlights) > 1:
            raise Rejected(Diagnostic(span, "a header says once what highlights look like"))
        highlight = "".join(highlights)
        return ast.Header(span, str(kind), str(name), _text(title), cites, notes, highlight)

    def _declaration(
        self, span: Span, role: Token, name: Token, type_: Any, range_: Any, default: Any,
        signature: Any, description: Token | None,
    ) -> ast.Declaration:  # fmt: skip
        type_name, *arguments = type_.children
        low, high = self._all(tuple(range_.children)) if range_ else (None, None)
        signed = signature.children[0] if signature else None
        return ast.Declaration(
            span=span,
            role=str(role),
            name=str(name),
            name_span=self._place(name),
            type_name=str(type_name),
            type_span=self._source.span(type_.meta.start_pos, type_.meta.end_pos),
            type_arguments=self._all(tuple(arguments)),
            low=low,
            high=high,
            default=self.built(default),
            signature=_text(signed) if signed else None,
            signature_span=self._place(signed) if signed else None,
            description=_text(description),
        )

    def _import(
        self, span: Span, target: Token, alias: Token | None, names: Any, bindings: Any
    ) -> ast.Import:
        taken = self._all(tuple(names.children)) if names else ()
        bound = self._all(tuple(bindings.children)) if bindings else ()
        if alias is not None and taken:
            message = "'as' before a list of names renames nothing"
            raise Rejected(Diagnostic(self._place(alias), message, hint="write: (name as other)"))
        is_path, called = target.type == "STRING", str(alias) if alias else None
        return ast.Import(span, _text(target), is_path, called, taken, bound)

    def _binding(self, span: Span, name: Token, value: Any) -> ast.Binding:
        return ast.Binding(span, str(name), self.built(value))

    def _import_name(self, span: Span, name: Token, alias: Token | None) -> ast.ImportName:
        return ast.ImportName(span, str(name), str(alias or name))

    def _let(
        self, span: Span, name: Token, parameters: Any, body: Any, description: Token | None,
        simpler: Any,
    ) -> ast.Let:  # fmt: skip
        taken = self._all(tuple(parameters.children)) if parameters else None
        place = self._place(name)
        others = tuple(
            ast.Name(self._place(token), str(token))
            for token in (simpler.children if simpler else ())
        )
        return ast.Let(span, str(name), place, taken, self.built(body), _text(description), others)

    def _parameter(self, span: Span, name: Token, type_name: Token | None) -> ast.Parameter:
        return ast.Parameter(span, str(name), str(type_name) if type_name else None)

    def _radiance(self, span: Span, body: Any) -> ast.Radiance:
        return ast.Radiance(span, self.built(body))

    def _law(
        self, span: Span, name: Token, names: Any, comparison: Token | None, bound: Any,
        condition: Any,
    ) -> ast.Law:  # fmt: skip
        self._refuse_lower(comparison)
        tokens = names.children if names else ()
        of = tuple(ast.Name(self._place(token), str(token)) for token in tokens)
        return ast.Law(span, str(name), of, self.built(bound), self.built(condition))

    def _breaks(
        self, span: Span, name: Token, comparison: Token | None, bound: Any, geometry: Any,
        *parts: Any,
    ) -> ast.Breaks:  # fmt: skip
        self._refuse_lower(comparison)
        *given, figure, within, note = parts
        return ast.Breaks(
            span=span,
            name=str(name),
            bound=self.built(bound),
            geometry=_geometry(geometry),
            given=self._all(tuple(given)),
            figure=self.built(figure),
            within=self.built(within),
            note=_text(note),
        )

    def _refuse_lower(self, comparison: Token | None) -> None:
        if comparison is not None and comparison != "<=":
            message = f"a law's bound is an upper one, not '{comparison}'"
            raise Rejected(Diagnostic(self._place(comparison), message, expected="'<='"))

    def _example(self, span: Span, geometry: Any, *parts: Any) -> ast.Example:
        *given, result, within = parts
        taken = self._all(tuple(given))
        return ast.Example(span, _geometry(geometry), taken, self.built(result), self.built(within))

    def _given(self, span: Span, name: Token, values: Any) -> ast.Given:
        return ast.Given(span, str(name), self.built(values))

    def _values(self, _span: Span, *literals: Any) -> tuple[ast.Number, ...]:
        return self._all(literals)

    def _literal(self, span: Span, minus: Token | None, number: Token) -> ast.Number:
        written = self._number(span, number)
        return ast.Number(span, -written.value, written.unit) if minus else written

    # ------------------------------------------------------------ expressions

    def _number(self, span: Span, token: Token) -> ast.Number:
        try:
            return ast.Number(span, *split_number(token))
        except BadValue as bad:
            raise Rejected(Diagnostic(self._place(token), bad.message, hint=bad.hint)) from None

    def _name(self, span: Span, name: Token) -> ast.Name:
        return ast.Name(span, str(name))

    def _call(self, span: Span, function: Token, *arguments: Any) -> ast.Call:
        return ast.Call(span, str(function), self._all(arguments))

    def _unary(self, span: Span, operator: Token, operand: Any) -> ast.Unary:
        return ast.Unary(span, str(operator), self.built(operand))

    def _binary(self, span: Span, left: Any, operator: Token, right: Any) -> ast.Binary:
        return ast.Binary(span, str(operator), self.built(left), self.built(right))

    def _where(self, span: Span, value: Any, condition: Any, otherwise: Any) -> ast.Where:
        return ast.Where(span, self.built(value), self.built(condition), self.built(otherwise))

    def _vector(self, span: Span, *components: Any) -> ast.Vector:
        return ast.Vector(span, self._all(components))

    def _component(self, span: Span, vector: Any, letter: Token) -> ast.Component:
        index = _COMPONENTS.get(str(letter))
        if index is None:
            message = f"'{letter}' is no component of a vector"
            raise Rejected(Diagnostic(self._place(letter), message, expected="'x', 'y' or 'z'"))
        return ast.Component(span, self.built(vector), index)

    def _let_in(self, span: Span, name: Token, value: Any, body: Any) -> ast.LetIn:
        return ast.LetIn(span, str(name), self.built(value), self.built(body))


def _geometry(tree: Any) -> str | None:
    """The geometry that `in NAME` names."""
    return str(tree.children[0]) if tree else None


def _text(token: Token | None) -> str:
    """A text without its quotes, or a name as it is."""
    return "" if token is None else str(token).strip('"')
