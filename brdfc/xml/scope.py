"""What the names in a calculator's text stand for: channels, variables, macros, sub-elements.

The places of things follow the reference: variables with a Position stay there, the others come
after them in the order of their first use, and the locals of macros after all variables, those of
a macro called from a macro after the caller's. Unnamed sub-elements come first, named ones follow
in the order of their first use, and unused ones are left out.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import NoReturn, TypeVar

from brdfc.calc.operators import OPERATORS, Operand
from brdfc.calc.program import (
    MAX_NESTING,
    MAX_OPERATIONS,
    MAX_TEMPORARIES,
    Block,
    Element,
    Op,
    encoded_length,
)
from brdfc.calc.text import Parsed
from brdfc.source.diagnostics import Diagnostic, did_you_mean
from brdfc.source.errors import ProgramError
from brdfc.source.span import Span

T = TypeVar("T")
Slice = tuple[int, int]
"""The first and how many."""

_CHANNELS = ("in", "out")
_TEMPORARY = ("tget", "tput", "tsav")
_WORD = re.compile(r"(?:#(?P<macro>\w+)|(?P<op>[A-Za-z]+)\{(?P<reference>[^}]*)\})$")
_REFERENCE = re.compile(
    r"(?P<name>@?\w+(?:\.\w+)?)(?:[\[(](?P<offset>\d{1,6})(?:,(?P<size>\d{1,6}))?[\])])?"
    r"(?:,(?P<count>\d{1,6}))?$",
    re.ASCII,
)


@dataclass
class Variable:
    """A declared variable: its size, its members as slices of it, and where it stands; None until
    it is used."""

    size: int
    members: dict[str, Slice]
    position: int | None = None


@dataclass(frozen=True)
class Macro:
    """A macro's text and its local variables, as slices of `size` temporaries."""

    parsed: Parsed
    text: str
    locals: dict[str, Slice]
    size: int


@dataclass(frozen=True)
class _Call:
    """A macro that is being written out: its name, itself, and where its locals begin."""

    name: str = ""
    macro: Macro | None = None
    first_local: int = 0
    callers: tuple[str, ...] = ()

    @property
    def after(self) -> int:
        return self.first_local + (self.macro.size if self.macro else 0)


@dataclass
class Scope:
    """The declarations of one calculator; `function` makes its main function of them."""

    inputs: int
    outputs: int
    input_names: dict[str, Slice] = field(default_factory=dict)
    output_names: dict[str, Slice] = field(default_factory=dict)
    variables: dict[str, Variable] = field(default_factory=dict)
    macros: dict[str, Macro] = field(default_factory=dict)
    named: dict[str, Element] = field(default_factory=dict)
    elements: list[Element] = field(default_factory=list)
    """Unnamed sub-elements, then the named ones that are used."""
    indices: dict[str, int] = field(default_factory=dict)
    local_base: int = 0
    next_variable: int = 0
    written: dict[tuple[str, int], tuple[Block, int]] = field(default_factory=dict)
    """Macros written out already, by where their locals begin, and how many operations they are."""

    def function(self, parsed: Parsed) -> Block:
        """The main function; ProgramError shows the place of a name that stands for nothing."""
        placed = [v for v in self.variables.values() if v.position is not None]
        self.next_variable = max((v.size + (v.position or 0) for v in placed), default=0)
        block = self._block(parsed, _Call())
        if any(macro.locals for macro in self.macros.values()):
            # The locals come after all variables, which all have their places only now.
            self.local_base = self.next_variable
            self.written.clear()
            block = self._block(parsed, _Call())
        return block

    def _block(self, parsed: Parsed, call: _Call) -> Block:
        grown = 0

        def refer(span: Span) -> Block:
            nonlocal grown
            block, length = self._refer(span, call)
            grown += length
            if grown > MAX_OPERATIONS:
                _fail(span, f"macros make this more than {MAX_OPERATIONS:,} operations")
            return block

        return parsed.block(refer)

    def _refer(self, span: Span, call: _Call) -> tuple[Block, int]:
        """The instructions a word stands for, and how many operations they are."""
        word = _WORD.match(span.text)
        if word is None:
            _fail(span, f"'{span.text}' is no name in braces")
        op, reference = word["op"], word["reference"]
        if word["macro"] or op == "call":
            return self._macro(span, word["macro"] or reference, call)
        if op not in OPERATORS or OPERATORS[op].operand not in (Operand.SPAN, Operand.ELEMENT):
            _fail(span, f"'{op}' takes no name in braces")
        if OPERATORS[op].operand is Operand.ELEMENT:
            return (Op(op, self._element(span, reference), 0),), 1
        found = _REFERENCE.match(reference)
        if found is None:
            _fail(span, f"'{reference}' is no name, nor a name with [first,count]")
        first, count = (
            self._channels(span, op, found)
            if op in _CHANNELS
            else self._temporaries(span, found, call)
        )
        return (Op(op, first, count),), 1

    def _channels(self, span: Span, op: str, found: re.Match[str]) -> Slice:
        names = self.input_names if op == "in" else self.output_names
        limit = self.inputs if op == "in" else self.outputs
        first, size = _known(span, found["name"], names, f"{op}put channel")
        if found["size"]:
            _fail(span, "a count of channels stands after the bracket: in{name[first],count}")
        if found["offset"] is not None or found["count"] is not None:
            first, size = first + int(found["offset"] or 0), int(found["count"] or 1)
        if size < 1 or first + size > limit:
            _fail(span, f"this reaches channel {first + size - 1}; there are {limit}")
        return first, size

    def _temporaries(self, span: Span, found: re.Match[str], call: _Call) -> Slice:
        name = found["name"]
        if found["count"] is not None:
            _fail(span, "a count of temporaries stands in the bracket: tget{name[first,count]}")
        if name.startswith("@"):
            if call.macro is None:
                _fail(span, f"'{name}' is a local variable, and this is no macro")
            kind = f"local variable of macro '{call.name}'"
            first, size = _known(span, name[1:], call.macro.locals, kind)
            first += self.local_base + call.first_local
        else:
            first, size = self._variable(span, name)
        if found["offset"] is not None:
            offset, count = int(found["offset"]), int(found["size"] or 1)
            if count < 1 or offset + count > size:
                _fail(span, f"'{name}' has {size} values, none at {offset + count - 1}")
            first, size = first + offset, count
        if first + size > MAX_TEMPORARIES:
            _fail(span, f"there are {MAX_TEMPORARIES} temporaries")
        return first, size

    def _variable(self, span: Span, name: str) -> Slice:
        name, _, member = name.partition(".")
        variable = _known(span, name, self.variables, "variable")
        if variable.position is None:
            variable.position = self.next_variable
            self.next_variable += variable.size
        if not member:
            return variable.position, variable.size
        first, size = _known(span, member, variable.members, f"member of '{name}'")
        return variable.position + first, size

    def _element(self, span: Span, name: str) -> int:
        element = _known(span, name, self.named, "sub-element")
        if name not in self.indices:
            self.indices[name] = len(self.elements)
            self.elements.append(element)
        return self.indices[name]

    def _macro(self, span: Span, name: str, call: _Call) -> tuple[Block, int]:
        macro = _known(span, name, self.macros, "macro")
        if name in call.callers or name == call.name:
            chain = " calls ".join((*call.callers, call.name, name)).removeprefix(" calls ")
            _fail(span, f"macros in a circle: {chain}")
        if len(call.callers) >= MAX_NESTING:
            _fail(span, f"macros call macros deeper than {MAX_NESTING}")
        key = name, call.after
        if key not in self.written:
            inner = _Call(name, macro, call.after, (*call.callers, call.name))
            block = self._block(macro.parsed, inner)
            self.written[key] = block, encoded_length(block)
        return self.written[key]


def _known(span: Span, name: str, known: dict[str, T], kind: str) -> T:
    if name not in known:
        hint = did_you_mean(name, known) or _listed(kind, known)
        _fail(span, f"no {kind} is called '{name}'", hint)
    return known[name]


def _listed(kind: str, known: Iterable[str]) -> str:
    names = sorted(known)
    return f"declared: {', '.join(names[:20])}" if names else f"no {kind} is declared"


def _fail(span: Span, message: str, hint: str | None = None) -> NoReturn:
    raise ProgramError(str(Diagnostic(span, message, hint=hint)))
