"""A `.brdf` text to its statements, with every bad statement reported.

Layout: a line that starts in the first column begins a statement, an indented line continues it,
`#` begins a comment. The statements are parsed one by one, so that an error in one hides nothing
in the others.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, lru_cache

from lark import Lark, TextSlice, Token, Tree
from lark.exceptions import UnexpectedInput

from brdfc.data import data_dir
from brdfc.lang.build import Rejected, statement
from brdfc.lang.limits import MAX_FINDINGS, MAX_NESTING, MAX_TEXT
from brdfc.lang.syntax import explained, first_word_error
from brdfc.lang.tree import Statement
from brdfc.source.diagnostics import Diagnostic
from brdfc.source.span import Source, Span


@dataclass(frozen=True)
class Parsed:
    """The statements that could be read, what is wrong with the others, and the words in those.

    A word of an unreadable statement may be a name it meant to define: that it is missing then
    is no error of its own.
    """

    statements: tuple[Statement, ...]
    diagnostics: tuple[Diagnostic, ...]
    unread: frozenset[str]


@lru_cache(maxsize=128)  # models import the same few files again and again
def parse(source: Source) -> Parsed:
    """The statements of a text. Never raises for a bad text: see Parsed.diagnostics."""
    if len(source.text) > MAX_TEXT:
        message = f"a text of {len(source.text):,} characters is too long (at most {MAX_TEXT:,})"
        return Parsed((), (Diagnostic(source.span(0, 0), message),), frozenset())
    first = re.match(r"\s*(analytic)\b", source.text)
    if first:
        return Parsed((), (_brdf_explorer(source.span(*first.span(1))),), frozenset())

    statements: list[Statement] = []
    diagnostics: list[Diagnostic] = []
    unread: set[str] = set()
    for span in statement_spans(source):
        try:
            statements.append(_parsed(span))
        except Rejected as rejected:
            diagnostics.append(rejected.diagnostic)
            unread.update(re.findall(r"[A-Za-z_]\w*", span.text))
            if len(diagnostics) >= MAX_FINDINGS:
                break
    return Parsed(tuple(statements), tuple(diagnostics), frozenset(unread))


def statement_spans(source: Source) -> Iterator[Span]:
    """The places of the statements: from a line's first column to the last line that continues it.

    Lines that are blank or only a comment neither begin nor continue anything.
    """
    begin = end = None
    for line in re.finditer(r"[^\n]+", source.text):
        text = line.group()
        if not text.strip() or text.lstrip().startswith("#"):
            continue
        if begin is None or not text[0].isspace():
            if begin is not None and end is not None:
                yield source.span(begin, end)
            begin = line.start()
        end = line.start() + len(text.rstrip())
    if begin is not None and end is not None:
        yield source.span(begin, end)


def _parsed(span: Span) -> Statement:
    """One statement; raises Rejected."""
    wrong = first_word_error(span)
    if wrong:
        raise Rejected(wrong)
    try:
        tree = _parser().parse(TextSlice(span.source.text, span.start, span.end))
    except UnexpectedInput as error:
        raise Rejected(explained(error, span)) from None
    _refuse_deep(tree, span)
    return statement(tree, span.source)


def _refuse_deep(tree: Tree[Token], span: Span) -> None:
    """Raise Rejected for a tree that nests too deeply; without recursion, unlike all that follows.

    A long sum counts as deep: a + b + c is (a + b) + c.
    """
    level = [tree]
    for _ in range(MAX_NESTING):
        level = [child for node in level for child in node.children if isinstance(child, Tree)]
        if not level:
            return
    raise Rejected(
        Diagnostic(
            span.source.span(level[0].meta.start_pos, level[0].meta.end_pos),
            f"this expression nests more than {MAX_NESTING} levels deep",
            hint="name parts of it with 'let'",
        )
    )


@cache
def _parser() -> Lark:
    """The parser of one statement, built from the grammar file at first use."""
    grammar = (data_dir("grammars") / "brdf.lark").read_text(encoding="utf-8")
    # Keywords are reserved everywhere, so the basic lexer does; it tells a word from a keyword
    # that it only begins with ('inside' is not 'in'), which makes for better messages.
    return Lark(grammar, parser="lalr", lexer="basic", propagate_positions=True)


def _brdf_explorer(span: Span) -> Diagnostic:
    return Diagnostic(
        span,
        "this is a file of Disney's BRDF Explorer, which only shares the extension .brdf",
        expected="'model' or 'module'",
        hint="brdfc does not read its GLSL: write the formula as a brdfc model",
    )
