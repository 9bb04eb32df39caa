"""Tint arrays, appearance transforms and calculator curves: layouts, and bytes from outside."""

import struct

import pytest
from calc.calc_elements import APPEARANCE, D65, appearance, calculated

from brdfc.calc.appearance import AppearanceTransform
from brdfc.calc.binary import decode_element, encode_element
from brdfc.calc.calculator_curves import CalculatorCurve
from brdfc.calc.curves import CurveSet
from brdfc.calc.listing import listing
from brdfc.calc.portability import portability
from brdfc.calc.price import price
from brdfc.calc.program import MAX_NESTING, Matrix, Op, OpaqueElement, Program
from brdfc.calc.samples import Samples, Storage
from brdfc.calc.text import assemble
from brdfc.calc.tints import TintArray
from brdfc.calc.verify import verify
from brdfc.source.errors import ProgramError

COPY = Program(1, 1, assemble("{ in out }"))


def head(kind: bytes, inputs: int, outputs: int) -> bytes:
    return struct.pack(">4sIHH", kind, 0, inputs, outputs)


def test_bytes():
    tint = TintArray(2, Samples.of([0, 0.25, 0.5, 1], Storage.UINT8))
    assert encode_element(tint).hex(" ", 4) == (
        "74696e74 00000000 00010002 75693038 00000000 004080ff"
    )
    jab = encode_element(appearance("JtoX", 1, 2, 4, 8, 16, 0.5, 0.25, 0.125))
    assert jab.hex(" ", 4) == (
        "4a746f58 00000000 00030003 3f800000 40000000 40800000 41000000 41800000 3f000000 "
        "3e800000 3e000000"
    )
    curves = encode_element(CurveSet((calculated("sq", 5, -1, 1, extend=True),)))
    assert curves[20:44].hex(" ", 4) == "636c6366 00000000 00000005 bf800000 3f800000 00010000"
    assert curves[44:48] == b"calc"


@pytest.mark.parametrize("kind", [b"fl64", b"ui32", b"ui64", b"sf32", b"text"])
def test_tints_of_other_types_are_carried(kind):
    data = head(b"tint", 1, 1) + kind + bytes(4) + bytes(16)
    assert decode_element(data, "x") == OpaqueElement("tint", 1, 1, data)


# ---------------------------------------------------------------- what is refused


FLOATS, BYTES = b"fl32" + bytes(4), b"ui08" + bytes(4)
ONE, NAN = struct.pack(">f", 1), struct.pack(">f", float("nan"))
NUMBERS = struct.pack(">8f", *D65, 60, 20, 0.69, 1, 1)


def curve(data: bytes) -> bytes:
    return head(b"cvst", 1, 1) + struct.pack(">II", 20, len(data)) + data


def clcf(size: int, first: float, last: float, extension: int, element: bytes) -> bytes:
    return curve(struct.pack(">4sIIffHH", b"clcf", 0, size, first, last, extension, 0) + element)


INSIDE = encode_element(COPY)
INF = float("inf")


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (head(b"tint", 1, 1) + FLOATS, "two steps or more of 1 outputs, and has 0 numbers"),
        (head(b"tint", 1, 1) + FLOATS + ONE, "two steps or more of 1 outputs, and has 1 numbers"),
        (head(b"tint", 1, 2) + FLOATS + ONE * 3, "two steps or more of 2 outputs"),
        (head(b"tint", 1, 0) + FLOATS + ONE * 2, "two steps or more of 0 outputs"),
        (head(b"tint", 1, 65535) + BYTES + bytes(65535), "has 65535 numbers"),
        (head(b"tint", 2, 1) + FLOATS + ONE * 2, "has 1 input, not 2"),
        (head(b"tint", 1, 1) + FLOATS + ONE * 2 + b"x", "ends within a number"),
        (head(b"tint", 1, 1) + b"fl32" + b"xx", "ends within a number"),
        (head(b"tint", 1, 1) + FLOATS + ONE + NAN, "sample 1 is NaN or infinite"),
        (head(b"XtoJ", 3, 3) + NUMBERS[:-1], "ends within its numbers"),
        (head(b"JtoX", 3, 3) + NUMBERS[4:] + NAN, "a viewing condition is NaN or infinite"),
        (head(b"XtoJ", 3, 1) + NUMBERS, "takes 3 channels to 3, not 3 to 1"),
        (head(b"JtoX", 65535, 3) + NUMBERS, "takes 3 channels to 3"),
        (curve(b"clcf"), "curve 0: the calculator curve ends within its header"),
        (clcf(5, 0, 1, 0, b""), "curve 0, calculator: an element needs 12 bytes"),
        (clcf(5, 0, 1, 0, head(b"emtx", 1, 1)), "from a calculator, not from a 'emtx'"),
        (clcf(5, 0, 1, 0, INSIDE[:-4]), "calculator"),
        (clcf(5, 0, 1, 2, INSIDE), "no extension has the number 2"),
        (clcf(1, 0, 1, 0, INSIDE), "a calculator curve of 1 points"),
        (clcf(5, 1, 1, 0, INSIDE), "a calculator curve from 1 to 1"),
        (clcf(5, 1, 0, 0, INSIDE), "a calculator curve from 1 to 0"),
        (clcf(5, 0, INF, 0, INSIDE), "a calculator curve from 0 to inf"),
        (
            clcf(5, 0, 1, 0, encode_element(Program(2, 1, assemble("{ in out }")))),
            "takes 1 channel to 1, not 2 to 1",
        ),
    ],
)
def test_malformed(data, message):
    with pytest.raises(ProgramError, match=message) as caught:
        decode_element(data, "M2B0")
    assert caught.value.where.startswith("M2B0")


@pytest.mark.parametrize(
    ("element", "message"),
    [
        (TintArray(1, Samples.of([0])), "two steps or more"),
        (TintArray(2, Samples.of([0, 1, 1])), "two steps or more"),
        (appearance("XtoJ", *D65, 60, 20, INF, 1, 1), "NaN or infinite"),
        (AppearanceTransform("XtoJ", D65, 60, 20, 0.69, 1, 1e39), "cannot be encoded"),
        (CurveSet((CalculatorCurve(1, 0.0, 1.0, COPY),)), "of 1 points"),
        (CurveSet((CalculatorCurve(1 << 32, 0.0, 1.0, COPY),)), "cannot be encoded"),
        (CurveSet((CalculatorCurve(9, 0.0, 1.0, Program(1, 2, ())),)), "1 channel to 1"),
    ],
)
def test_what_cannot_be_encoded(element, message):
    with pytest.raises(ProgramError, match=message):
        encode_element(element)


def test_calculators_in_curves_in_calculators_have_a_limit():
    program = COPY
    for _ in range(MAX_NESTING // 2 + 1):
        curves = CurveSet((CalculatorCurve(2, 0.0, 1.0, program),))
        program = Program(1, 1, assemble("{ in curv out }"), (curves,))
    with pytest.raises(ProgramError, match="nest deeper than 64"):
        decode_element(encode_element(program), "x")
    with pytest.raises(ProgramError, match="nest deeper than 64"):
        verify(program)


# ---------------------------------------------------------------- in programs


def test_operators_call_their_own_kind():
    kinds = {"tint": TintArray(1, Samples.of([0, 1])), "tJab": APPEARANCE["XtoJ"]}
    kinds["fJab"] = APPEARANCE["JtoX"]
    for name in kinds:
        for other, element in kinds.items():
            body = (Op("in", 0, 3), Op(name, 0), Op("out", 0, 1))
            program = Program(3, 1, body, (element,))
            if other == name:
                verify(program)
                assert price(program) > 0
            else:
                with pytest.raises(ProgramError, match=f"'{name}' needs a"):
                    verify(program)


def curve_of(text: str, size: int, *elements) -> CurveSet:
    program = Program(1, 1, assemble(f"{{ {text} }}"), elements)
    return CurveSet((CalculatorCurve(size, 0.0, 1.0, program),) * 2)


def test_programs_of_curves_are_proven_safe():
    curves = curve_of("in add out", 5)
    for element in (curves, Program(2, 2, assemble("{ in[0,2] curv out[0,2] }"), (curves,))):
        with pytest.raises(ProgramError, match="curve 0, op 1: 'add' needs 2 values"):
            verify(element)
    facts = verify(curve_of("in env(inci) pop mul out", 5))
    assert facts.variables == ("inci",)
    assert verify(
        Program(
            2, 1, assemble("{ in[0,2] curv out[0,1] }"), (curve_of("in env(inci) pop mul out", 5),)
        )
    ).variables == ("inci",)


def test_samples_count_as_work():
    """A curve in two places is sampled once."""
    inside = verify(COPY).work
    assert verify(curve_of("in out", 1000)).work == 1000 * inside + 2
    with pytest.raises(ProgramError, match="curve 0: the curve is sampled 4,294,967,295 times"):
        verify(curve_of("in out", 0xFFFFFFFF))
    # Each level samples the next one: a few hundred bytes that would never be done.
    curves = curve_of("in out", 1000)
    curves = curve_of("in in curv pop out", 1000, curves)
    verify(Program(1, 1, COPY.body, (curves,)))
    with pytest.raises(ProgramError, match="10,000,000"):
        verify(curve_of("in in curv pop out", 1000, curves))


def test_programs_of_curves_are_shown():
    curves = curve_of("in rond out", 5)
    elements = (Matrix(1, 1, (1,), (0,)), curves)
    program = Program(2, 2, assemble("{ in[0,2] curv(1) out[0,2] }"), elements)
    shown = [text.splitlines()[0] for text in listing(program, "M2B0")]
    assert [text.partition(": ")[0] for text in shown] == [
        "; M2B0",
        "; M2B0, sub-element 1, curve 0",
    ]
    (finding,) = portability(program)
    assert finding.startswith("sub-element 1, curve 0, op 1: 'rond' gives different results")
