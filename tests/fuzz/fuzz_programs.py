"""Programs changed within profiles, their counts and sizes made right, so that what is wrong is the
program alone."""

from __future__ import annotations

import random
import struct
from dataclasses import replace

from brdfc.calc.binary import encode_element
from brdfc.calc.function import encode_block
from brdfc.calc.operators import CASE, DEFAULT, ELSE, IF, OPERATORS, SELECT, Operand
from brdfc.calc.places import encode_parts
from brdfc.calc.program import Element, OpaqueElement, Program
from brdfc.icc.profile import Profile
from brdfc.icc.types import Pipeline
from brdfc.source.errors import BrdfcError

OPERATION = 8
BRANCHES = (IF, ELSE, SELECT, CASE, DEFAULT)
NESTED = 40
"""Calculators put around one, at most."""


def with_another_program(data: bytes, generator: random.Random) -> bytes:
    """The profile with one element of a transform changed; as it is where there is none."""
    try:
        profile = Profile.from_bytes(data)
    except BrdfcError:
        return data
    found = [s for s, tag in profile.tags.items() if isinstance(tag, Pipeline) and tag.elements]
    if not found:
        return data
    signature = generator.choice(found)
    pipeline = profile.tags[signature]
    assert isinstance(pipeline, Pipeline)
    elements = list(pipeline.elements)
    at = generator.randrange(len(elements))
    elements[at] = changed_element(elements[at], generator)
    if generator.random() < 0.1:
        elements.append(generator.choice(elements))
    other = replace(pipeline, elements=tuple(elements))
    changed = replace(profile, tags={**profile.tags, signature: other})
    try:
        return changed.to_bytes(profile_id=False)
    except BrdfcError:  # what can be read and not written, such as some texts
        return data


def changed_element(element: Element, generator: random.Random) -> Element:
    """A calculator with other operations or sub-elements, or within others."""
    if not isinstance(element, Program):
        return element
    parts = list(element.elements)
    words = operations(encode_block(element.body))
    chosen = generator.random()
    if chosen < 0.1:
        return nested(element, generator)
    if chosen < 0.3 and parts:
        at = generator.randrange(len(parts))
        parts[at] = generator.choice(
            (generator.choice(parts), changed_element(parts[at], generator))
        )
    else:
        for _ in range(generator.choice((1, 1, 2, 4))):
            change_operations(words, generator)
    return calculator(element.inputs, element.outputs, words, parts)


def operations(code: bytes) -> list[bytes]:
    """The operations of a main function, eight bytes each."""
    return [code[at : at + OPERATION] for at in range(0, len(code), OPERATION)]


def change_operations(words: list[bytes], generator: random.Random) -> None:
    """One operation put in, taken out, replaced, moved, or given another operand."""
    at = generator.randrange(len(words) + 1)
    chosen = generator.randrange(6)
    if chosen == 0 or at == len(words):
        words.insert(at, operation(generator))
    elif chosen == 1:
        del words[at]
    elif chosen == 2:
        words[at] = operation(generator)
    elif chosen == 3:
        words.insert(generator.randrange(len(words)), words.pop(at))
    else:
        words[at] = words[at][:4] + operand(words[at][:4], generator)


def operation(generator: random.Random) -> bytes:
    """Any operation, mostly with an operand that might be right."""
    signature = generator.choice((*(o.signature for o in OPERATORS.values()), *BRANCHES * 3))
    return signature + operand(signature, generator)


def operand(signature: bytes, generator: random.Random) -> bytes:
    """The four bytes after an operation's signature."""
    if signature in BRANCHES:
        return struct.pack(">I", generator.choice((0, 1, 2, 3, 5, 9, 30, 2**31, 2**32 - 1)))
    known = OPERATORS.get(signature.decode("latin-1").rstrip())
    kind = known.operand if known else Operand.NONE
    if kind is Operand.CONSTANT:
        return struct.pack(
            ">f", generator.choice((0, 1, 2, 0.5, -1, 1e30, 1e-40, float("nan"), float("inf")))
        )
    if kind is Operand.SIGNATURE:
        return generator.choice((b"inci", b"refl", b"true", b"ndef", b"\0\0\0\0", b"\xff   "))
    first, second = (generator.choice((0, 0, 1, 2, 3, 7, 255, 65535)) for _ in range(2))
    return struct.pack(">HH", first, second)


def nested(element: Program, generator: random.Random) -> Element:
    """Calculators around a program, which call the next once or more often."""
    for _ in range(generator.randrange(1, NESTED)):
        calls = generator.choice((1, 1, 2, 3))
        head = [struct.pack(">4sHH", b"in  ", 0, element.inputs - 1)] if element.inputs else []
        words = [*head, struct.pack(">4sHH", b"calc", 0, 0)] * calls
        words += [struct.pack(">4sHH", b"out ", 0, element.outputs - 1)] if element.outputs else []
        coded = calculator(element.inputs, element.outputs, words, [element])
        if len(coded.data) > 20_000:
            break
        element = coded  # type: ignore[assignment]
    return element


def calculator(
    inputs: int, outputs: int, words: list[bytes], parts: list[Element]
) -> OpaqueElement:
    """A calculator of such operations, right or wrong, with its sizes right."""
    main = b"func" + struct.pack(">II", 0, len(words)) + b"".join(words)
    start = 16 + 8 * (len(parts) + 1)
    places, body = encode_parts(parts, encode_element, start + len(main))
    head = struct.pack(">4sIHHIII", b"calc", 0, inputs, outputs, len(parts), start, len(main))
    return OpaqueElement("calc", inputs, outputs, head + places + main + body)
