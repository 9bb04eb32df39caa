"""Programs as text and as bytes: what is written reads back the same, bit for bit."""

import struct

import pytest
from calc_programs import CONSTANTS, programs
from hypothesis import given, settings
from hypothesis import strategies as st

from brdfc.calc.binary import decode_element, encode_block, encode_element
from brdfc.calc.listing import listing
from brdfc.calc.operators import BY_SIGNATURE, DEFAULTS, HALVES, OPERATORS, Operand
from brdfc.calc.program import MAX_NESTING, If, Matrix, Op, OpaqueElement, Program, Select
from brdfc.calc.text import assemble, disassemble
from brdfc.calc.verify import verify
from brdfc.source.errors import ProgramError


@settings(max_examples=300, deadline=None)
@given(programs())
def test_random_programs_come_back(program):
    verify(program)
    text = disassemble(program.body)
    assert all(len(line) <= 100 for line in text.splitlines())
    assert encode_block(assemble(text)) == encode_block(program.body)
    data = encode_element(program)
    again = decode_element(data, "program")
    assert again == program
    assert again.elements[2] is again.elements[3]
    assert encode_element(again) == data


@settings(deadline=None)
@given(st.floats(width=32, allow_nan=False, allow_infinity=False))
def test_constants_come_back_bit_for_bit(value):
    block = (Op("data", value=value),)
    assert encode_block(assemble(disassemble(block))) == encode_block(block)


@pytest.mark.parametrize("value", CONSTANTS)
def test_odd_constants_come_back_bit_for_bit(value):
    (op,) = assemble(disassemble((Op("data", value=value),)))
    assert struct.pack(">f", op.value) == struct.pack(">f", value)


def extremes():
    """Every operator with the least and the greatest that its operand holds."""
    for operator in OPERATORS.values():
        if operator.operand in (Operand.NONE, Operand.CONSTANT):
            continue
        if operator.operand is Operand.SIGNATURE:
            yield from (Op(operator.name, signature=s) for s in ("thti", "a", "", "ä/;%", "\0{}("))
            continue
        (first, less), (second, second_less) = HALVES[operator.operand]
        one = operator.operand in (Operand.VECTOR, Operand.FOLD, Operand.ELEMENT)
        yield Op(operator.name, first, 0 if one else second)
        yield Op(operator.name, 0xFFFF + less, 0 if one else 0xFFFF + second_less)


@pytest.mark.parametrize("op", list(extremes()), ids=str)
def test_operands_come_back(op):
    assert assemble(disassemble((op,))) == (op,)
    program = Program(0, 0, (op,))
    assert decode_element(encode_element(program), "program") == program


@pytest.mark.parametrize("name", [n for n, o in OPERATORS.items() if o.operand in DEFAULTS])
def test_defaults(name):
    """What may be left out: `copy` is copy(1,1), `in` is in[0,1], `sum` is sum(2)."""
    operand = OPERATORS[name].operand
    one = operand in (Operand.VECTOR, Operand.FOLD, Operand.ELEMENT)
    expected = Op(name, DEFAULTS[operand][0], 0 if one else DEFAULTS[operand][1])
    assert assemble(f"{{ {name} }}") == (expected,)
    assert assemble(f"{{ {name}({expected.first}) }}") == (expected,)


def test_both_brackets_comments_and_spacing():
    text = """
      {in(0,3)   % the ICC's tools take three kinds of comment: { {
        smul[3]  ; a second one }
        / a third
        1 if{pop(1)}else{ pop [0] }
      }""".replace(" pop [0] ", "sin[1] ")
    assert assemble(text) == (
        Op("in", 0, 3),
        Op("smul", 3),
        Op("data", value=1.0),
        If((Op("pop", 1),), (Op("sin", 1),)),
    )
    assert assemble("{ in[0,3] }") == assemble("{ in(0,3) }")


@pytest.mark.parametrize(
    ("text", "value"), [("-0", -0.0), (".5", 0.5), ("1.", 1.0), ("-1e-3", -0.001), ("2E+2", 200.0)]
)
def test_numbers(text, value):
    (op,) = assemble(f"{{ {text} }}")
    assert struct.pack("f", op.value) == struct.pack("f", value)


def test_constants_without_a_text():
    """`data` of an infinity or NaN is legal in a file and comes back as the operator."""
    infinite = Op("data", value=float("inf"))
    assert assemble(disassemble((infinite,))) == (Op("+INF"),)
    assert disassemble((Op("data", value=float("nan")),)) == "{\n  NaN\n}\n"


def test_layout():
    """What a person reads: a line for each value put away, blocks indented."""
    body = assemble("{ in[0,3] tput[0,3] tget(0) if { 1 } else { 0 } 0 sel case { 1 } dflt { } }")
    assert disassemble(body) == (
        "{\n  in[0,3] tput[0,3]\n  tget[0,1] if { 1 } else { 0 } 0 sel case { 1 } dflt { }\n}\n"
    )
    long = (Op("in", 0, 1), If((Op("sin", 1),) * 30, (Op("cos", 1),)))
    assert disassemble(long) == (
        "{\n"
        "  in[0,1]\n"
        "  if {\n"
        f"    {' '.join(['sin'] * 21)}\n"
        f"    {' '.join(['sin'] * 9)}\n"
        "  } else {\n"
        "    cos\n"
        "  }\n"
        "}\n"
    )


def test_nesting_at_its_limit():
    block = ()
    for _ in range(MAX_NESTING):
        block = (Op("pi"), If(block))
    assert assemble(disassemble(block)) == block
    program = Program(0, 0, block)
    assert decode_element(encode_element(program), "program") == program
    assert verify(program).nesting == MAX_NESTING


def test_bytes_of_the_fact_sheet():
    """The layout by hand: in[0,3] smul[3] ... sum, flip count less two, if before else."""
    body = assemble("{ in[1,3] sum(3) flip copy(2,3) 1 if { pi } else { 0.5 pop } }")
    assert encode_block(body).hex(" ", 8) == " ".join(
        [
            "696e202000010002",
            "73756d2000010000",
            "666c697000000000",
            "636f707900010002",
            "646174613f800000",
            "6966202000000001",
            "656c736500000002",
            "7069202000000000",
            "646174613f000000",
            "706f702000000000",
        ]
    )
    select = assemble("{ 1 sel case { pi } case { } dflt { 2 } env(azi) }")
    assert encode_block(select).hex(" ", 8) == " ".join(
        [
            "646174613f800000",
            "73656c2000000000",
            "6361736500000001",
            "6361736500000000",
            "64666c7400000001",
            "7069202000000000",
            "6461746140000000",
            "656e7620617a6920",
        ]
    )


def test_element_layout():
    """Main function first, parts after one another, one object written once."""
    matrix = Matrix(1, 1, (2.0,), (0.5,))
    inner = Program(1, 1, (Op("in", 0, 1), Op("out", 0, 1)))
    program = Program(
        1, 1, (Op("in", 0, 1), Op("mtx", 0), Op("out", 0, 1)), (matrix, inner, matrix)
    )
    data = encode_element(program)
    assert data[:16].hex() == "63616c63000000000001000100000003"
    places = [struct.unpack_from(">II", data, 16 + 8 * i) for i in range(4)]
    assert places == [(48, 36), (84, 20), (104, 52), (84, 20)]
    assert data[84:104].hex() == "6d6174660000000000010001400000003f000000"
    assert decode_element(data, "x") == program


def test_unknown_elements_are_carried():
    data = b"tint" + bytes(4) + struct.pack(">HH", 1, 2) + b"anything"
    element = OpaqueElement("tint", 1, 2, data)
    program = Program(2, 2, (Op("in", 0, 1), Op("tint", 0), Op("out", 0, 2)), (element,))
    again = decode_element(encode_element(program), "x")
    assert again == program
    verify(again)


@pytest.mark.parametrize(
    ("element", "message"),
    [
        (Program(70000, 1, ()), "cannot be encoded"),
        (Program(1, 1, (Op("data", value=1e39),)), "does not fit a 32-bit float"),
        (Program(1, 1, (Op("sin", 0),)), "'sin' cannot hold (0,0)"),
        (Program(1, 1, (Op("sum", 70000),)), "'sum' cannot hold (70000,0)"),
        (Program(1, 1, (Op("env", signature="azimu"),)), "'azimu' is no name"),
        (Program(1, 1, (Op("env", signature="Ω"),)), "'Ω' is no name"),
        (Program(1, 1, (), (Matrix(2, 1, (1.0,), (0.0,)),)), "a 1 x 2 matrix needs (2, 1) numbers"),
        (Matrix(1, 1, (1e39,), (0.0,)), "cannot be encoded"),
    ],
)
def test_what_no_file_can_hold(element, message):
    with pytest.raises(ProgramError) as caught:
        encode_element(element)
    assert message in str(caught.value)


def test_listing_shows_calculators_inside():
    inner = Program(1, 1, (Op("in", 0, 1), Op("out", 0, 1)))
    program = Program(
        1,
        1,
        (Op("in", 0, 1), Op("calc", 0), Op("out", 0, 1)),
        (inner, inner, Matrix(1, 1, (1,), (0,))),
    )
    assert list(listing(program, "M2B0")) == [
        "; M2B0: calculator, 1 channels in, 1 out, 3 operators\n{\n  in[0,1] calc out[0,1]\n}\n",
        "; M2B0, sub-element 0: calculator, 1 channels in, 1 out, 2 operators\n"
        "{\n  in[0,1] out[0,1]\n}\n",
    ]
    assert all(assemble(text) for text in listing(program, "M2B0"))


def test_signatures_are_four_bytes_and_unique():
    assert len(BY_SIGNATURE) == len(OPERATORS)
    assert all(len(signature) == 4 for signature in BY_SIGNATURE)


def test_select_needs_no_default():
    block = (Op("pi"), Select(((Op("pi"),), ())))
    assert assemble(disassemble(block)) == block
