"""Programs whose times tell what operators cost: each operator alone, and formulas at random.

All read the same channels: 0..4 hold numbers above 0, 5 and 6 angles, all in ordinary ranges, as
the time of tan, exp or pow depends on the argument.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.curves import CurveSet, SampledCurve
from brdfc.calc.operators import OPERATORS, Operand
from brdfc.calc.program import Block, Element, Matrix, Op, Program
from brdfc.calc.samples import Samples
from brdfc.calc.tables import LookupTable
from brdfc.calc.text import assemble

CHANNELS = 7
EMPTY: Block = (Op("in", 0, 3), Op("out", 0, 3))
"""The least program that writes its outputs."""
VARIABLE = "vari"
"""An environment variable that is defined (0.4) wherever probes run."""
FEW, MANY = 2, 14
"""How often a probe's text stands in its two programs."""

_LOW = (0.1, 0.1, 0.1, 0.02, 0.05, -1.5, -1.5)
_HIGH = (1.0, 1.0, 1.0, 0.3, 0.5, 1.5, 1.5)
_CURVE = SampledCurve(0.0, 1.0, Samples.of([k / 255 for k in range(256)]))
ELEMENTS: tuple[Element, ...] = (
    CurveSet((_CURVE,)),
    CurveSet((_CURVE,) * 3),
    Matrix(1, 1, (0.5,), (0.25,)),
    Matrix(3, 3, (0.5,) * 9, (0.25,) * 3),
    LookupTable(1, 1, (9,), Samples.of([k / 8 for k in range(9)])),
    LookupTable(2, 3, (9, 9), Samples.of([k / 242 for k in range(243)])),
    Program(1, 1, (Op("in", 0, 1), Op("out", 0, 1))),
)
_CALLS = (("curv", 0), ("curv", 1), ("mtx", 2), ("mtx", 3), ("clut", 4), ("clut", 5), ("calc", 6))
# Operators whose argument is an angle, or any number below and above 0.
_ANGLES = ("sin", "cos", "tan", "atan", "exp", "sign", "abs", "flor", "ceil", "trnc", "rond", "neg")
_CONTROL = (
    "1 if { 0.5 pop }",
    "0 if { } else { 0.5 pop }",
    "0 sel case { 0.5 pop } dflt { }",
)
# In all else, what is pushed is popped, so that time could be moved from pops to pushes.
_LEFT = ("in[0,1]", "in[0,3]", "tget[0,1]", "pi")


def pixels(count: int) -> NDArray[np.float32]:
    """The same varied pixels every time."""
    chance = np.random.default_rng(1)
    return chance.uniform(_LOW, _HIGH, (count, CHANNELS)).astype(np.float32)


@dataclass(frozen=True)
class Probe:
    """A piece of program, FEW and MANY times: the difference is free of all that is around it."""

    few: Block
    many: Block

    @classmethod
    def of(cls, piece: Block) -> Probe:
        """The probe of a piece."""
        return cls(_whole(piece * FEW), _whole(piece * MANY))


def probes() -> tuple[Probe, ...]:
    """At least one for every price that can be measured, two where there are components."""
    pieces = [assemble(f"{{ {text} }}") for text in _CONTROL + _LEFT]
    pieces += [piece for name in OPERATORS for piece in _pieces(name)]
    return tuple(map(Probe.of, pieces))


def _whole(block: Block) -> Block:
    return (Op("in", 0, 3), Op("tput", 0, 3), *block, *EMPTY)


def _pieces(name: str) -> Iterator[Block]:
    """An operator between what pushes its arguments and what drops its results."""
    operand = OPERATORS[name].operand
    sizes = {
        Operand.NONE: [(0, 0)],
        Operand.SPAN: [(0, 1), (0, 3)],
        Operand.VECTOR: [(1, 0), (3, 0)],
        Operand.FOLD: [(2, 0), (5, 0)],
        Operand.COPIES: [(1, 1), (2, 3)],
        Operand.ROTATION: [(2, 1), (5, 1)],
        Operand.POSITION: [(2, 1), (2, 4)],
        Operand.SHAPE: [(3, 3)] if name == "solv" else [(2, 2), (3, 3)],
    }
    if operand is Operand.CONSTANT:
        for count in (1, 4):
            yield (*(Op("data", value=0.25),) * count, Op("pop", count))
    elif operand is Operand.SIGNATURE:
        yield Op(name, signature=VARIABLE), Op("pop", 2)
    elif operand is Operand.ELEMENT:
        for call, index in _CALLS:
            if call == name:
                element = ELEMENTS[index]
                yield (*_push(element.inputs, 0), Op(call, index), *_drop(element.outputs))
    else:
        effect = OPERATORS[name].effect
        assert effect is not None
        for first, second in sizes[operand]:
            popped, pushed = effect(first, second)
            start = (5 if popped == 1 else 4) if name in _ANGLES else 0
            yield (*_push(popped, start), Op(name, first, second), *_drop(pushed))


def _push(count: int, start: int) -> Block:
    room = CHANNELS - start
    return tuple(Op("in", start, min(room, count - at)) for at in range(0, count, room))


def _drop(count: int) -> Block:
    return (Op("pop", count),) if count else ()


# V is any value between about -2 and 2, L a channel or a constant, P a channel above 0; {t} is a
# temporary of its own. The commonest in reflectance models stand more than once.
_TEMPLATES = (
    *("V V mul", "V V add 0.5 mul", "V V sub 0.5 mul", "V P mul", "V P 0.1 add div 0.1 mul") * 3,
    *("V cos", "V sin", "V sq 0.5 mul", "V neg exp 0.2 mul", "V abs sqrt", "1 V sub 0.5 mul") * 2,
    *("V tsav[{t},1] cos V mul tget[{t},1] mul", "V tsav[{t},1] L mul tget[{t},1] vmin") * 2,
    *("V L V prod(3)", "V V L sum(3) 0.3 mul", "in[0,3] V smul[3] sum(3) 0.3 mul", "V copy mul"),
    *("V cos tan", "V atan", "V sin asin", "V cos acos 0.5 mul", "V neg", "V abs", "V cb 0.2 mul"),
    *("V sq 0.5 add ln 0.3 mul", "V abs 0.1 add log", "V abs P pow", "V V atn2 0.5 mul", "V cbrt"),
    *("V V vmin", "V V vmax", "V V lt", "V V ge V mul", "V V V min(3)", "V V V max(3)", "V flor"),
    *("in[0,3] V sadd[3] in[1,3] mul[3] sum(3) 0.2 mul", "in[0,3] V gama[3] prod(3)"),
    *("in[5,2] V smul[2] cos[2] mul", "V V tput[{t},2] tget[{t},2] add tget[{t},1] mul 0.3 mul"),
    *("env(vari) pop V mul", "env(vari) if { } else { pop 0.5 } V mul"),
)
_BRANCHES = (
    "P 0 gt if { V V mul V sub 0.5 mul } else { 0 }",
    "P 0 lt if { 0 } else { V V mul V mul }",
    "V P 0 ge if { cos V mul V mul }",
    "V P 2 lt if { 0.5 mul V sub } 0.5 mul",
    "0 sel case { V V mul V mul } dflt { 0 }",
)
_ENDS = ("in[0,3] V smul[3] V sadd[3] V smul[3] out[0,3]", "V V V out[0,3]", "V copy(1,2) out[0,3]")
_LEAVES = ("in[0,1]", "in[1,1]", "in[4,1]", "in[5,1]", "in[6,1]", "0.31831", "-0.7", "tget[0,1]")


def formulas(seed: int, count: int) -> tuple[Block, ...]:
    """Programs like those of reflectance models, of 10 to 150 operators, half of them branching."""
    chance = random.Random(seed)
    texts = []
    for index in range(count):
        templates = _TEMPLATES + _BRANCHES * (index % 2 * 2)
        end = chance.choice(_ENDS)
        text = _grown(chance, templates, f"in[0,1] tput[0,1] {end}", chance.randrange(2, 24))
        texts.append(assemble(f"{{ {text} }}"))
    return tuple(texts)


def _grown(chance: random.Random, templates: tuple[str, ...], text: str, steps: int) -> str:
    """The text with values put in, so many of them by templates, the others by leaves."""
    words = text.split()
    for step in range(steps):
        places = [index for index, word in enumerate(words) if word == "V"]
        if not places:
            break
        at = chance.choice(places)
        words[at : at + 1] = chance.choice(templates).replace("{t}", str(1 + 2 * step)).split()
    for index, word in enumerate(words):
        if word in "VL":
            words[index] = chance.choice(_LEAVES)
        elif word == "P":
            words[index] = f"in[{chance.randrange(5)},1]"
    return " ".join(words)
