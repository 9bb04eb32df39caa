"""Syntax errors in human words: where, what was expected there, and what to do."""

from __future__ import annotations

import re
from collections.abc import Collection

from lark import Token
from lark.exceptions import UnexpectedCharacters, UnexpectedInput, UnexpectedToken

from brdfc.lang.words import CONTINUATIONS, KEYWORDS, STATEMENTS
from brdfc.source.diagnostics import Diagnostic, did_you_mean
from brdfc.source.span import Span

# Terminals of the grammar as a user would call them; a keyword is called by its word.
_WORDS = {
    "NAME": "a name",
    "NUMBER": "a number",
    "STRING": 'a "text"',
    "$END": "the end of the statement",
    "COMPARE": "a comparison",
    "ARROW": "'->'",
    "RANGE": "'..'",
    "ASSIGN": "'='",
    "PLUS": "'+'",
    "MINUS": "'-'",
    "TIMES": "'*'",
    "DIVIDE": "'/'",
    "POWER": "'^'",
    "COLON": "':'",
    "COMMA": "','",
    "DOT": "'.'",
    "OPEN": "'('",
    "CLOSE": "')'",
}

# What stands for several terminals at once: when all of the first are acceptable, the name is
# given in place of these and the others.
_GROUPS = (
    ({"NAME", "NUMBER", "OPEN", "MINUS"}, {"LET", "NOT"}, "an expression"),
    ({"NUMBER", "MINUS"}, set[str](), "a number"),
    (
        {"PLUS", "MINUS"},
        {"TIMES", "DIVIDE", "POWER", "COMPARE", "AND", "OR", "DOT", "WHERE"},
        "an operator",
    ),
)

_INDENT = "a line that continues the one above is indented"

# Characters that look right on paper.
_ON_PAPER = {
    "°": "write deg, as in 40deg",
    "π": "write pi",
    "×": "write *",
    "·": "write *",
    "÷": "write /",
    "−": "write -",
    "–": "write -",
    "²": "write ^2",
    "³": "write ^3",
    "√": "write sqrt(x)",
    "≤": "write <=",
    "≥": "write >=",
    "≠": "write !=",
    "“": 'write straight quotes, "text"',
    "”": 'write straight quotes, "text"',
    "'": 'write double quotes, "text"',
    "&": "write 'and'",
    "|": "write 'or'; a magnitude is abs(x)",
    "!": "write 'not'",
    "[": "vectors and calls are written with ( )",
    "{": "brackets are written ( )",
    ";": "a new line in the first column begins a statement",
    "/": "comments begin with #",
}


def first_word_error(span: Span) -> Diagnostic | None:
    """What is wrong with the beginning of a statement, or None."""
    if span.text[0].isspace():
        start = span.start + len(span.text) - len(span.text.lstrip())
        return Diagnostic(
            span.source.span(start, span.end),
            "this line is indented, but there is no statement above it to continue",
            hint="a statement begins in the first column",
        )
    match = re.match(r"[A-Za-z_]\w*|.", span.text)
    assert match is not None, "a statement's first character is no line end"
    word = match.group()
    if word in STATEMENTS:
        return None
    hint = did_you_mean(word, [keyword for keyword in STATEMENTS if keyword[0] == word[0].lower()])
    if word in CONTINUATIONS or not word[0].isalpha():
        hint = _INDENT
    elif re.match(r"\s*(\([^)]*\)\s*)?=(?!=)", span.text[match.end() :]):
        hint = hint or f"write: let {word} = ..."
    return Diagnostic(
        span.source.span(span.start, span.start + len(word)),
        f"no statement begins with '{word}'",
        expected=_listed([f"'{keyword}'" for keyword in STATEMENTS]),
        hint=hint or _INDENT,
    )


def explained(error: UnexpectedInput, span: Span) -> Diagnostic:
    """The diagnostic for what the parser met in a statement."""
    if isinstance(error, UnexpectedCharacters):
        assert error.pos_in_stream is not None
        return _unexpected_character(span, error.pos_in_stream)
    assert isinstance(error, UnexpectedToken)
    token, source = error.token, span.source
    expected = _expected(error.accepts)
    if token.type == "$END":
        opened = _unclosed(span)
        if opened is not None:
            place = source.span(opened, opened + 1)
            return Diagnostic(place, "this '(' is never closed", hint=_end_hint(span))
        place = source.span(span.end, span.end + 1)
        return Diagnostic(place, "the statement ends too early", expected, _end_hint(span))
    place = source.span(token.start_pos, token.end_pos)
    message = f"unexpected '{token}'"
    if token in KEYWORDS and "NAME" in error.accepts:
        message = f"'{token}' is a word of the language and cannot be a name"
    return Diagnostic(place, message, expected, _token_hint(span, token, error.accepts))


def _unexpected_character(span: Span, position: int) -> Diagnostic:
    character = span.source.text[position]
    place = span.source.span(position, position + 1)
    if character == '"':
        return Diagnostic(
            place, 'this text has no closing "', hint="a text is closed on the line it begins on"
        )
    hint = _ON_PAPER.get(character)
    if hint is None and character.isalpha():
        hint = "names are made of the letters a to z, digits and _"
    shown = f"'{character}'" if character.isprintable() else f"U+{ord(character):04X}"
    return Diagnostic(place, f"the character {shown} has no meaning here", hint=hint)


def _token_hint(span: Span, token: Token, accepts: Collection[str]) -> str | None:
    """What the user most likely meant where this token stands."""
    text = span.source.text
    before = text[span.start : token.start_pos]
    if token in STATEMENTS and not before.rpartition("\n")[2].strip():
        return f"a statement begins in the first column: remove the spaces before '{token}'"
    if token == "*" and before.endswith("*"):
        return "write ^ for powers"
    if token == "/" and before.endswith("/"):
        return "comments begin with #"
    if token == "=" and "COMPARE" in accepts:
        return "to compare, write =="
    if token.type == "COMPARE" and "AND" in accepts:
        return "comparisons do not chain: write a < b and b < c"
    if token == "," and "RANGE" in accepts:
        return "a range is written LOW..HIGH"
    if token == ")" and before.count("(") <= before.count(")"):
        return "this ')' closes nothing"
    if token.type in ("NAME", "NUMBER", "OPEN") and "TIMES" in accepts:
        return "to multiply, write *"
    if token.type == "NAME":
        return did_you_mean(token, [t.lower() for t in accepts if t.lower() in KEYWORDS])
    return None


def _end_hint(span: Span) -> str | None:
    """The statement ended too early: perhaps the next line was meant to continue it."""
    following = re.compile(r"\s*\n(\w+|[^\s#])").match(span.source.text, span.end)
    if following and following.group(1) not in STATEMENTS:
        return _INDENT
    return None


def _unclosed(span: Span) -> int | None:
    """Where the last bracket that is never closed stands; texts and comments aside."""
    opened: list[int] = []
    for match in re.finditer(r'"[^"\n]*"|#[^\n]*|[()]', span.text):
        if match.group() == "(":
            opened.append(span.start + match.start())
        elif match.group() == ")" and opened:
            opened.pop()
    return opened[-1] if opened else None


def _expected(accepts: Collection[str]) -> str:
    """The acceptable terminals in words, in the order of the tables."""
    left, words = set(accepts), []
    for all_of, others, name in _GROUPS:
        if all_of <= left:
            left -= all_of | others
            words.append(name)
    words += [word for terminal, word in _WORDS.items() if terminal in left]
    words += sorted(f"'{terminal.lower()}'" for terminal in left - _WORDS.keys())
    return _listed(words)


def _listed(words: list[str]) -> str:
    return " or ".join([", ".join(words[:-1]), words[-1]]) if len(words) > 1 else words[0]
