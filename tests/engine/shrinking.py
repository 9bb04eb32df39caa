"""From a program at fault to a small one: many shorter programs are tried at a time."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from brdfc.calc.binary import encode_element
from brdfc.calc.portability import portability
from brdfc.calc.program import Block, If, Instruction, Op, Program, Select, encoded_length
from brdfc.calc.verify import verify
from brdfc.source.errors import ProgramError

AT_A_TIME = 150


def accepted(program: Program) -> bool:
    """Whether the reference does not refuse it (calc/portability.py)."""
    return not any("rejected" in finding for finding in portability(program))


def smallest(program: Program, faulty: Callable[[Sequence[Program]], Sequence[bool]]) -> Program:
    """The program cut down as long as it is at fault; faulty tells which of some programs are."""
    while True:
        candidates = list(_valid(program))
        for start in range(0, len(candidates), AT_A_TIME):
            tried = candidates[start : start + AT_A_TIME]
            still = [p for p, bad in zip(tried, faulty(tried), strict=True) if bad]
            if still:
                program = min(still, key=_size)
                break
        else:
            return program


def _size(program: Program) -> tuple[int, int]:
    """Operations, and of programs that have as many, bytes."""
    return encoded_length(program.body), len(encode_element(program))


def _valid(program: Program) -> Iterator[Program]:
    """Shorter programs that verify; what is shorter by more comes first."""
    for body in sorted(_shorter(program.body), key=encoded_length):
        candidate = replace(program, body=body)
        with contextlib.suppress(ProgramError):
            verify(candidate)
            if accepted(candidate):
                yield candidate


def _shorter(body: Block) -> Iterator[Block]:
    """The block without one instruction, with a value for some, or with a body for a branch."""
    for i, instruction in enumerate(body):
        before, after = body[:i], body[i + 1 :]
        yield before + after
        for j in range(i + 2, len(body)):
            yield (*before, *_VALUE, *body[j:])
        if isinstance(instruction, Op):
            continue
        for k, inner in enumerate(instruction.bodies):
            yield (*before, Op("pop", 1), *inner, *after)
            for shorter in _shorter(inner):
                yield (*before, _with_body(instruction, k, shorter), *after)


_VALUE = (Op("data", value=0.5),)


def _with_body(instruction: If | Select, k: int, body: Block) -> Instruction:
    bodies = list(instruction.bodies)
    bodies[k] = body
    if isinstance(instruction, If):
        return If(bodies[0], bodies[1] if instruction.complete else None)
    count = len(instruction.cases)
    return Select(tuple(bodies[:count]), bodies[count] if instruction.complete else None)
