"""A calculator's main function as text, blocks indented; `assemble` (text.py) gives it back."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator

from brdfc.calc.operators import ARGUMENTS, DEFAULTS, Operand
from brdfc.calc.program import Block, If, Instruction, Op, Select

_WIDTH = 88
_NAME = r"[A-Za-z0-9_]{1,4}"
"""Names of variables the text writes as they are; others go in as 8 hexadecimal digits."""
_ROUND = {Operand.FOLD, Operand.COPIES, Operand.ROTATION, Operand.POSITION, Operand.SHAPE}
_ROUND |= {Operand.ELEMENT}

Naming = Callable[[Op], str | None]
"""The text of an operation by the names of what it refers to; None for one that has no names."""


def no_names(_op: Op) -> None:
    """The naming of a text that stands alone: channels and temporaries by number."""


def disassemble(block: Block, naming: Naming = no_names) -> str:
    """The text of a main function, braces included, blocks indented, lines of moderate length."""
    return "\n".join(["{", *_lines(block, "  ", naming), "}"]) + "\n"


def _lines(block: Block, indent: str, naming: Naming) -> Iterator[str]:
    line = indent
    for instruction in block:
        piece = text_of(instruction, naming)
        if len(line) + len(piece) > _WIDTH and line != indent:
            yield line.rstrip()
            line = indent
        if isinstance(instruction, Op) or len(piece) <= _WIDTH - len(line):
            line += piece + " "
            # A value put away ends a thought: the next line begins another.
            if isinstance(instruction, Op) and instruction.name in ("tput", "tsav"):
                yield line.rstrip()
                line = indent
            continue
        yield from _long(instruction, indent, naming)  # it is too long to stand behind anything
    if line != indent:
        yield line.rstrip()


def _long(instruction: Instruction, indent: str, naming: Naming) -> Iterator[str]:
    """A control structure over several lines."""
    opening = indent + ("if" if isinstance(instruction, If) else "sel")
    for name, block in _blocks(instruction):
        yield " ".join(filter(None, (opening, name, "{")))
        yield from _lines(block, indent + "  ", naming)
        opening = indent + "}"
    yield indent + "}"


def _blocks(instruction: Instruction) -> list[tuple[str, Block]]:
    if isinstance(instruction, If):
        otherwise = instruction.otherwise
        return [("", instruction.then)] + ([("else", otherwise)] if otherwise is not None else [])
    assert isinstance(instruction, Select)
    cases: list[tuple[str, Block]] = [("case", case) for case in instruction.cases]
    return cases + ([("dflt", instruction.default)] if instruction.default is not None else [])


def text_of(instruction: Instruction, naming: Naming = no_names) -> str:
    """One instruction on one line."""
    if isinstance(instruction, Op):
        return naming(instruction) or _op_text(instruction)
    head = "if" if isinstance(instruction, If) else "sel"
    for name, block in _blocks(instruction):
        inner = " ".join(text_of(inner, naming) for inner in block)
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
