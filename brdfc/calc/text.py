"""The calculator's text form: assembler and disassembler.

`assemble(disassemble(block))` gives the block back, constants bit for bit (9 significant digits).
Only a `data` constant that is infinite or not a number has no text: it comes back as the operator
+INF, -INF or NaN. The grammar is grammars/calc.lark.
"""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING, Any

from brdfc.calc.operators import ARGUMENTS, DEFAULTS, HALVES, OPERATORS, Operand
from brdfc.calc.program import MAX_NESTING, Block, If, Instruction, Op, Select
from brdfc.data import data_dir
from brdfc.source.diagnostics import Diagnostic, did_you_mean
from brdfc.source.errors import ProgramError
from brdfc.source.span import Source, Span

if TYPE_CHECKING:
    from lark import Lark, Tree

_WIDTH = 88
_NAME = r"[A-Za-z0-9_]{1,4}"
"""Names of variables the text writes as they are; others go in as 8 hexadecimal digits."""
_ROUND = {Operand.FOLD, Operand.COPIES, Operand.ROTATION, Operand.POSITION, Operand.SHAPE}
_ROUND |= {Operand.ELEMENT}

# ---------------------------------------------------------------- disassembler


def disassemble(block: Block) -> str:
    """The text of a main function, braces included, blocks indented, lines of moderate length."""
    return "\n".join(["{", *_lines(block, "  "), "}"]) + "\n"


def _lines(block: Block, indent: str) -> Iterator[str]:
    line = indent
    for instruction in block:
        piece = text_of(instruction)
        if len(line) + len(piece) > _WIDTH and line != indent:
            yield line.rstrip()
            line = indent
        if "{" not in piece or len(piece) <= _WIDTH - len(line):
            line += piece + " "
            # A value put away ends a thought: the next line begins another.
            if isinstance(instruction, Op) and instruction.name in ("tput", "tsav"):
                yield line.rstrip()
                line = indent
            continue
        yield from _long(instruction, indent)  # it is too long to stand behind anything
    if line != indent:
        yield line.rstrip()


def _long(instruction: Instruction, indent: str) -> Iterator[str]:
    """A control structure over several lines."""
    opening = indent + ("if" if isinstance(instruction, If) else "sel")
    for name, block in _blocks(instruction):
        yield " ".join(filter(None, (opening, name, "{")))
        yield from _lines(block, indent + "  ")
        opening = indent + "}"
    yield indent + "}"


def _blocks(instruction: Instruction) -> list[tuple[str, Block]]:
    if isinstance(instruction, If):
        otherwise = instruction.otherwise
        return [("", instruction.then)] + ([("else", otherwise)] if otherwise is not None else [])
    assert isinstance(instruction, Select)
    cases: list[tuple[str, Block]] = [("case", case) for case in instruction.cases]
    return cases + ([("dflt", instruction.default)] if instruction.default is not None else [])


def text_of(instruction: Instruction) -> str:
    """One instruction on one line."""
    if isinstance(instruction, Op):
        return _op_text(instruction)
    head = "if" if isinstance(instruction, If) else "sel"
    for name, block in _blocks(instruction):
        inner = " ".join(text_of(inner) for inner in block)
        head += f"{' ' + name if name else ''} {{ {inner + ' ' if inner else ''}}}"
    return head


def _op_text(op: Op) -> str:
    operand = op.operator.operand
    if operand is Operand.CONSTANT:
        return _constant_text(op.value)
    if operand is Operand.NONE:
        return op.name
    if operand is Operand.SIGNATURE:
        plain = re.fullmatch(_NAME, op.signature)
        word = op.signature if plain else op.signature.ljust(4).encode("latin-1").hex()
        return f"{op.name}({word})"
    arguments = [op.first, op.second][: ARGUMENTS[operand]]
    if operand is not Operand.SPAN and tuple(arguments) == DEFAULTS[operand][: len(arguments)]:
        return op.name
    listed = ",".join(map(str, arguments))
    return f"{op.name}({listed})" if operand in _ROUND else f"{op.name}[{listed}]"


def _constant_text(value: float) -> str:
    if math.isnan(value):
        return "NaN"
    if math.isinf(value):
        return "+INF" if value > 0 else "-INF"
    return f"{value:.9g}"


# ---------------------------------------------------------------- assembler


@cache
def _parser() -> Lark:
    from lark import Lark

    grammar = (data_dir("grammars") / "calc.lark").read_text(encoding="utf-8")
    return Lark(grammar, parser="lalr", propagate_positions=True)


def assemble(text: str, name: str = "calculator text") -> Block:
    """The main function a text stands for; ProgramError shows the place of a mistake."""
    from lark.exceptions import UnexpectedInput, UnexpectedToken

    source = Source(name, text)
    _refuse_deep_nesting(source)
    try:
        tree: Any = _parser().parse(text)
    except UnexpectedInput as error:
        if isinstance(error, UnexpectedToken) and error.token.type == "$END":
            end = len(text.rstrip())
            raise _fault(source.span(end, end + 1), "the text ends before its last '}'") from None
        raise _misplaced(source, error.pos_in_stream or 0) from None
    return _block(source, tree.children[0])


def _misplaced(source: Source, start: int) -> ProgramError:
    """The error for a word that cannot stand where it does."""
    found = re.compile(r"[{}]|[^\s{}]+").match(source.text, start)
    word = found.group() if found else source.text[start : start + 1]
    hint = "calculator text is one { ... }, with a block { ... } after each if, else, case and dflt"
    if word == "{":
        hint = (
            "a block stands after if, else, case and dflt only; sub-elements are called by number"
        )
    elif word in ("else", "case", "dflt"):
        before = {"else": "'if { ... }'", "case": "'sel'", "dflt": "'case { ... }'"}[word]
        hint = f"'{word}' stands right after {before}"
    elif re.search(r"[)\]].", word):
        hint = "put a space after the closing bracket"
    elif word.startswith("+"):
        hint = "a number has no sign '+'"
    return _fault(source.span(start, start + len(word)), f"'{word}' cannot stand here", hint)


def _refuse_deep_nesting(source: Source) -> None:
    depth = 0
    for found in re.finditer(r"[%;/][^\n]*|[{}]", source.text):
        depth += {"{": 1, "}": -1}.get(found.group(), 0)
        if depth > MAX_NESTING + 1:  # the whole function is in braces, too
            message = f"blocks nest deeper than {MAX_NESTING}"
            raise _fault(source.span(found.start(), found.end()), message)


def _fault(span: Span, message: str, hint: str | None = None) -> ProgramError:
    return ProgramError(str(Diagnostic(span, message, hint=hint)))


def _block(source: Source, tree: Tree[Any]) -> Block:
    return tuple(_instruction(source, child) for child in tree.children)


def _instruction(source: Source, tree: Tree[Any]) -> Instruction:
    if tree.data == "conditional":
        then, otherwise = tree.children
        return If(_block(source, then), None if otherwise is None else _block(source, otherwise))
    if tree.data == "selection":
        bodies = [(child.data, child.children[0]) for child in tree.children if child is not None]
        cases = tuple(_block(source, body) for kind, body in bodies if kind == "case")
        defaults = [_block(source, body) for kind, body in bodies if kind == "default"]
        return Select(cases, defaults[0] if defaults else None)
    token: Any = tree.children[0]
    span = source.span(token.start_pos, token.end_pos)
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
    words = rest.rstrip(")").split(",") if rest else []
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
