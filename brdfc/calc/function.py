"""A calculator's main function (`func`) as bytes: operations of 8 bytes, blocks as jump lengths.

Bytes are not trusted: every count and length is checked against what is there before it is
followed, and nesting has a limit.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence

from brdfc.calc.operators import (
    ARGUMENTS,
    BY_SIGNATURE,
    CASE,
    DEFAULT,
    ELSE,
    HALVES,
    IF,
    SELECT,
    Operand,
)
from brdfc.calc.program import MAX_NESTING, MAX_OPERATIONS, Block, If, Instruction, Op, Select
from brdfc.source.errors import ProgramError

Word = tuple[bytes, bytes]
"""An operation as a file has it: signature and operand, four bytes each."""


def encode_block(block: Block) -> bytes:
    """The operations of a block, 8 bytes each."""
    return b"".join(_encode_instruction(instruction) for instruction in block)


def _encode_instruction(instruction: Instruction) -> bytes:
    if isinstance(instruction, Op):
        return instruction.operator.signature + _encode_operand(instruction)
    if isinstance(instruction, If):
        then = encode_block(instruction.then)
        head = _jump(IF, then)
        if instruction.otherwise is None:
            return head + then
        otherwise = encode_block(instruction.otherwise)
        return head + _jump(ELSE, otherwise) + then + otherwise
    bodies = [(CASE, encode_block(case)) for case in instruction.cases]
    if instruction.default is not None:
        bodies.append((DEFAULT, encode_block(instruction.default)))
    heads = b"".join(_jump(signature, body) for signature, body in bodies)
    return SELECT + bytes(4) + heads + b"".join(body for _, body in bodies)


def _jump(signature: bytes, body: bytes) -> bytes:
    return signature + struct.pack(">I", len(body) // 8)


def _encode_operand(op: Op) -> bytes:
    operand = op.operator.operand
    if operand is Operand.NONE:
        return bytes(4)
    if operand is Operand.CONSTANT:
        try:
            return struct.pack(">f", op.value)
        except OverflowError:
            raise ProgramError(f"{op.value} does not fit a 32-bit float") from None
    if operand is Operand.SIGNATURE:
        if len(op.signature) > 4 or any(ord(c) > 0xFF for c in op.signature):
            raise ProgramError(f"'{op.signature}' is no name of at most four 8-bit characters")
        return op.signature.ljust(4).encode("latin-1")
    (_, first_less), (_, second_less) = HALVES[operand]
    try:
        return struct.pack(">HH", op.first - first_less, op.second - second_less)
    except struct.error:
        raise ProgramError(f"'{op.name}' cannot hold ({op.first},{op.second})") from None


def decode_block(words: Sequence[Word], where: str) -> Block:
    """Nested blocks from flat operations; ProgramError names the operation's index."""
    return _Decoder(words, where).block(0, len(words), 0)


class _Decoder:
    def __init__(self, words: Sequence[Word], where: str) -> None:
        self.words = words
        self.where = where
        self.known: dict[Word, Op] = {}
        """Operations by their bytes: most stand in a program many times."""

    def fail(self, message: str, at: int) -> ProgramError:
        return ProgramError(message, where=f"{self.where}, op {at}")

    def block(self, start: int, end: int, depth: int) -> Block:
        if depth > MAX_NESTING:
            raise self.fail(f"blocks nest deeper than {MAX_NESTING}", start)
        words, known = self.words, self.known
        block: list[Instruction] = []
        at = start
        while at < end:
            word = words[at]
            op = known.get(word)
            if op is not None:
                block.append(op)
                at += 1
            elif word[0] == IF:
                otherwise_follows = at + 1 < end and words[at + 1][0] == ELSE
                heads = [at, at + 1] if otherwise_follows else [at]
                bodies, at = self.bodies(heads, end, depth)
                block.append(If(bodies[0], bodies[1] if otherwise_follows else None))
            elif word[0] == SELECT:
                instruction, at = self.select(at, end, depth)
                block.append(instruction)
            else:
                known[word] = self.op(at)
        return tuple(block)

    def select(self, at: int, end: int, depth: int) -> tuple[Select, int]:
        """The `sel` at a place, and the index after its last body."""
        stop = at + 1
        while stop < end and self.words[stop][0] == CASE:
            stop += 1
        if stop == at + 1:
            raise self.fail("'sel' without a 'case'", at)
        default_follows = stop < end and self.words[stop][0] == DEFAULT
        heads = list(range(at + 1, stop + default_follows))
        bodies, after = self.bodies(heads, end, depth)
        default = bodies.pop() if default_follows else None
        return Select(tuple(bodies), default), after

    def bodies(self, heads: list[int], end: int, depth: int) -> tuple[list[Block], int]:
        """The bodies whose lengths stand in consecutive heads, and the index after the last one."""
        at = heads[-1] + 1
        bodies: list[Block] = []
        for head in heads:
            (length,) = struct.unpack(">I", self.words[head][1])
            if length > end - at:
                name = self.words[head][0].decode("ascii").strip()
                left = f"{end - at} are left in its block"
                raise self.fail(f"'{name}' claims {length} operations where {left}", head)
            bodies.append(self.block(at, at + length, depth + 1))
            at += length
        return bodies, at

    def op(self, at: int) -> Op:
        signature, word = self.words[at]
        operator = BY_SIGNATURE.get(signature)
        if operator is None:
            if signature in (ELSE, CASE, DEFAULT):
                name = signature.decode("ascii").strip()
                raise self.fail(f"'{name}' without what it belongs to", at)
            raise self.fail(f"no operator has the signature {signature!r}", at)
        operand = operator.operand
        if operand is Operand.NONE:
            return Op(operator.name)
        if operand is Operand.CONSTANT:
            return Op(operator.name, value=struct.unpack(">f", word)[0])
        if operand is Operand.SIGNATURE:
            return Op(operator.name, signature=word.decode("latin-1").rstrip(" "))
        (_, first_less), (_, second_less) = HALVES[operand]
        first, second = struct.unpack(">HH", word)
        if ARGUMENTS[operand] == 1:
            second = 0  # a half that is not used means nothing
        return Op(operator.name, first + first_less, second + second_less)


def encode_function(block: Block) -> bytes:
    """The main function of a calculator: its header, then its operations."""
    code = encode_block(block)
    return b"func" + struct.pack(">II", 0, len(code) // 8) + code


def decode_function(data: bytes, where: str) -> Block:
    """The main function that `data` begins with."""
    if len(data) < 12 or data[:4] != b"func":
        raise ProgramError("no 'func' here", where=where)
    (count,) = struct.unpack_from(">I", data, 8)
    # Other writers over-state the size of a function with sub-elements; the count is what holds.
    if 12 + 8 * count > len(data):
        raise ProgramError(f"{count} operations are claimed, more than fit", where=where)
    if count > MAX_OPERATIONS:
        raise ProgramError(f"{count} operations, more than {MAX_OPERATIONS:,}", where=where)
    return decode_block(list(struct.iter_unpack(">4s4s", data[12 : 12 + 8 * count])), where)
