"""The calculator's text form: assembler; the disassembler is disassembly.py.

`assemble(disassemble(block))` gives the block back, constants bit for bit (9 significant digits).
Only a `data` constant that is infinite or not a number has no text: it comes back as the operator
+INF, -INF or NaN. The grammar is grammars/calc.lark.
"""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from brdfc.calc.disassembly import disassemble, text_of
from brdfc.calc.operators import ARGUMENTS, DEFAULTS, HALVES, OPERATORS, Operand
from brdfc.calc.program import MAX_NESTING, MAX_OPERATIONS, Block, If, Instruction, Op, Select
from brdfc.data import data_dir
from brdfc.source.diagnostics import Diagnostic, did_you_mean
from brdfc.source.errors import ProgramError
from brdfc.source.span import Source, Span

if TYPE_CHECKING:
    from lark import Lark, Tree

__all__ = ["Parsed", "Refer", "assemble", "disassemble", "parse", "text_of"]

Refer = Callable[[Span], Block]
"""What a word that refers to a name stands for: `tget{v}`, `call{m}`, `#m`."""

_TEXT_LIMIT = 4 << 20
"""Characters of a text, comments included."""


@cache
def _parser() -> Lark:
    from lark import Lark

    grammar = (data_dir("grammars") / "calc.lark").read_text(encoding="utf-8")
    return Lark(grammar, parser="lalr")


@dataclass(frozen=True)
class Parsed:
    """The syntax of a calculator text that stands in a source, `start` characters into it."""

    source: Source
    start: int
    tree: Tree[Any]

    def block(self, refer: Refer | None = None) -> Block:
        """The instructions. refer: what names stand for; without it, a name is an error."""
        return _block(self, self.tree, refer or _no_names)

    def span(self, token: Any) -> Span:
        """Where a token stands."""
        return self.source.span(self.start + token.start_pos, self.start + token.end_pos)


def assemble(text: str, name: str = "calculator text") -> Block:
    """The main function a text stands for; ProgramError shows the place of a mistake."""
    return parse(Source(name, text), 0, text).block()


def parse(source: Source, start: int, text: str) -> Parsed:
    """The syntax of the text that stands in a source from `start` on; ProgramError shows the place
    of a mistake."""
    from lark.exceptions import UnexpectedInput, UnexpectedToken

    _refuse_excess(source, start, text)
    try:
        tree: Any = _parser().parse(text)
    except UnexpectedInput as error:
        if isinstance(error, UnexpectedToken) and error.token.type == "$END":
            end = start + len(text.rstrip())
            raise _fault(source.span(end, end + 1), "the text ends before its last '}'") from None
        raise _misplaced(source, start + (error.pos_in_stream or 0)) from None
    return Parsed(source, start, tree.children[0])


def _no_names(span: Span) -> Block:
    raise _fault(
        span,
        f"'{span.text}' refers to a name, and this text has none",
        "variables, macros and channels have names in XML only; here they are called by number",
    )


def _misplaced(source: Source, start: int) -> ProgramError:
    """The error for a word that cannot stand where it does."""
    found = re.compile(r"[{}]|[^\s{}]+").match(source.text, start)
    word = found.group() if found else source.text[start : start + 1]
    hint = "calculator text is one { ... }, with a block { ... } after each if, else, case and dflt"
    if word == "{":
        hint = "a block stands after if, else, case and dflt only; names in braces have no spaces"
    elif word in ("else", "case", "dflt"):
        before = {"else": "'if { ... }'", "case": "'sel'", "dflt": "'case { ... }'"}[word]
        hint = f"'{word}' stands right after {before}"
    elif re.search(r"[)\]].", word):
        hint = "put a space after the closing bracket"
    elif word.startswith("+"):
        hint = "a number has no sign '+'"
    return _fault(source.span(start, start + len(word)), f"'{word}' cannot stand here", hint)


def _refuse_excess(source: Source, start: int, text: str) -> None:
    """Refuse what would take too long to parse, or too much of Python's stack."""
    if len(text) > _TEXT_LIMIT:
        message = f"a calculator text of {len(text):,} characters is over {_TEXT_LIMIT:,}"
        raise _fault(source.span(start, start + 1), message)
    depth = words = 0
    for found in re.finditer(r"[%;/][^\n]*|[{}]|[^\s{}%;/]+", text):
        word = found.group()
        depth += {"{": 1, "}": -1}.get(word, 0)
        words += word[0] not in "{}%;/"
        if depth > MAX_NESTING + 1:  # the whole function is in braces, too
            raise _fault(_span(source, start, found), f"blocks nest deeper than {MAX_NESTING}")
        if words > MAX_OPERATIONS:
            raise _fault(_span(source, start, found), f"more than {MAX_OPERATIONS:,} operations")


def _span(source: Source, start: int, found: re.Match[str]) -> Span:
    return source.span(start + found.start(), start + found.end())


def _fault(span: Span, message: str, hint: str | None = None) -> ProgramError:
    return ProgramError(str(Diagnostic(span, message, hint=hint)))


def _block(parsed: Parsed, tree: Tree[Any], refer: Refer) -> Block:
    block: list[Instruction] = []
    for child in tree.children:
        if child.data == "reference":
            block += refer(parsed.span(child.children[0]))
        else:
            block.append(_instruction(parsed, child, refer))
    return tuple(block)


def _instruction(parsed: Parsed, tree: Tree[Any], refer: Refer) -> Instruction:
    if tree.data == "conditional":
        then, otherwise = tree.children
        return If(
            _block(parsed, then, refer),
            None if otherwise is None else _block(parsed, otherwise, refer),
        )
    if tree.data == "selection":
        bodies = [(child.data, child.children[0]) for child in tree.children if child is not None]
        cases = tuple(_block(parsed, body, refer) for kind, body in bodies if kind == "case")
        defaults = [_block(parsed, body, refer) for kind, body in bodies if kind == "default"]
        return Select(cases, defaults[0] if defaults else None)
    span = parsed.span(tree.children[0])
    if tree.data == "number":
        return Op("data", value=_float32(span))
    return _operation(span)


def _float32(span: Span) -> float:
    try:
        (value,) = struct.unpack("f", struct.pack("f", float(span.text)))
    except OverflowError:
        value = math.inf
    if math.isinf(value):
        raise _fault(span, "this number does not fit a 32-bit float", "infinity is +INF or -INF")
    return float(value)


def _operation(span: Span) -> Op:
    name, _, rest = span.text.replace("[", "(").replace("]", ")").partition("(")
    operator = OPERATORS.get(name)
    if operator is None:
        raise _fault(span, f"'{name}' is no operator", did_you_mean(name, OPERATORS))
    if operator.operand is Operand.CONSTANT:
        raise _fault(span, "a constant is written as the bare number")
    operand = operator.operand
    words = [word.strip() for word in rest.rstrip(")").split(",")] if rest else []
    if operand is Operand.SIGNATURE:
        if len(words) != 1 or not re.fullmatch(r"[!-~]{1,4}|[0-9A-Fa-f]{8}", words[0]):
            raise _fault(span, f"'{name}' takes a name of up to 4 characters, or 8 hex digits")
        return Op(name, signature=_signature_of(words[0]))
    if operand is Operand.NONE:
        if words:
            raise _fault(span, f"'{name}' takes no argument")
        return Op(name)
    if len(words) > ARGUMENTS[operand] or not all(re.fullmatch("[0-9]{1,6}", w) for w in words):
        raise _fault(span, f"'{name}' takes {operand.value}")
    first, second = (*map(int, words), *DEFAULTS[operand][len(words) :])
    limits = HALVES[operand][: ARGUMENTS[operand]]
    for value, (least, less) in zip((first, second), limits, strict=False):
        if not least <= value <= 0xFFFF + less:
            raise _fault(span, f"{value} is outside {least} to {0xFFFF + less}")
    return Op(name, first, second)


def _signature_of(word: str) -> str:
    text = bytes.fromhex(word).decode("latin-1") if len(word) == 8 else word
    return text.rstrip(" ")
