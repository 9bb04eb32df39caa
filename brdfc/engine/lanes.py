"""Text of LLVM's language for several pixels at a time, an operation a line.

Values are names in that text. Three kinds of vector stand for the pixels' values: F of float32, D
of float64, I of 64-bit integers; masks are what comparisons give. Nothing here is allowed to be
contracted, reordered or assumed: results are the same on every processor.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass, field

_ELEMENTS = {"F": "float", "D": "double", "I": "i64"}
_SHORT = {"F": "f32", "D": "f64", "I": "i64"}


def bits(value: float) -> int:
    """The bits of a float64."""
    return int(struct.unpack("<Q", struct.pack("<d", value))[0])


@dataclass
class Lanes:
    """One function under construction. width: pixels at a time; lines: its text so far; declared:
    what it calls, by name; known: what belongs to a value and is not computed twice: a
    mask, the same in float64, parts of functions; block: the label that the text stands under."""

    width: int
    lines: list[str] = field(default_factory=list)
    declared: dict[str, str] = field(default_factory=dict)
    known: dict[tuple[str, ...], Sequence[str]] = field(default_factory=dict)
    block: str = "entry"
    names: int = 0

    def kind(self, kind: str) -> str:
        """The type of a kind of vector; M is a mask."""
        return f"<{self.width} x {_ELEMENTS.get(kind, 'i1')}>"

    def name(self, start: str = "%v") -> str:
        self.names += 1
        return f"{start}{self.names}"

    def new(self, text: str) -> str:
        """A line that gives a value, by its new name."""
        name = self.name()
        self.lines.append(f"  {name} = {text}")
        return name

    def label(self, name: str) -> None:
        """Begin a block."""
        self.lines.append(f"{name}:")
        self.block = name

    def constant(self, kind: str, value: float | int) -> str:
        """The same number for all pixels."""
        number = str(value) if kind == "I" else f"0x{bits(value):016X}"
        return f"splat ({_ELEMENTS[kind]} {number})"

    def do(self, operation: str, kind: str, *arguments: str | float) -> str:
        """An operation of LLVM on values of one kind; numbers stand for themselves."""
        return self.new(f"{operation} {self.kind(kind)} {', '.join(self.all(kind, arguments))}")

    def test(self, relation: str, kind: str, x: str | float, y: str | float) -> str:
        """A mask; relations of floats are `olt`, `oge`, `uno` and so on."""
        return self.do(f"{'icmp' if kind == 'I' else 'fcmp'} {relation}", kind, x, y)

    def pick(self, kind: str, mask: str, x: str | float, y: str | float) -> str:
        """x where the mask holds, else y."""
        a, b = self.all(kind, (x, y))
        whole = self.kind(kind)
        return self.new(f"select {self.kind('M')} {mask}, {whole} {a}, {whole} {b}")

    def either(self, operation: str, x: str, y: str) -> str:
        """Masks joined: `and`, `or`, `xor`."""
        return self.do(operation, "M", x, y)

    def convert(self, operation: str, kind: str, x: str, to: str) -> str:
        """`fpext`, `fptrunc`, `bitcast`, `uitofp`, of one kind or of a mask to another kind."""
        return self.new(f"{operation} {self.kind(kind)} {x} to {self.kind(to)}")

    def call(self, function: str, kind: str, *arguments: str | float) -> str:
        """A function that LLVM knows, such as `sqrt`, `fabs`, `floor`."""
        whole = self.kind(kind)
        name = f"@llvm.{function}.v{self.width}{_SHORT[kind]}"
        self.declared[name] = f"declare {whole} {name}({', '.join([whole] * len(arguments))})"
        given = ", ".join(f"{whole} {a}" for a in self.all(kind, arguments))
        return self.new(f"call {whole} {name}({given})")

    def any(self, mask: str) -> str:
        """Whether a mask holds for one pixel at least."""
        name = f"@llvm.vector.reduce.or.v{self.width}i1"
        self.declared[name] = f"declare i1 {name}({self.kind('M')})"
        return self.new(f"call i1 {name}({self.kind('M')} {mask})")

    def all(self, kind: str, arguments: Sequence[str | float]) -> list[str]:
        return [a if isinstance(a, str) else self.constant(kind, a) for a in arguments]

    def polynomial(self, x: str, coefficients: Sequence[float]) -> str:
        """In float64, by Horner's rule; coefficients from the constant on."""
        result: str | float = coefficients[-1]
        for c in reversed(coefficients[:-1]):
            result = self.do("fadd", "D", self.do("fmul", "D", result, x), c)
        assert isinstance(result, str)
        return result
