"""What verification proves and refuses, with the index of the operation as a file counts."""

import time

import pytest
from calc_programs import programs
from hypothesis import given, settings

from brdfc.calc.binary import decode_element, encode_element
from brdfc.calc.facts import Facts
from brdfc.calc.operators import OPERATORS, Operand
from brdfc.calc.price import operations
from brdfc.calc.program import If, Matrix, Op, OpaqueElement, Program, Select, encoded_length
from brdfc.calc.text import assemble
from brdfc.calc.verify import verify
from brdfc.source.errors import ProgramError

MATRIX = Matrix(2, 1, (1.0, 2.0), (0.0,))
INNER = Program(1, 1, assemble("{ in env(azi) pop add out }"))
CURVES = OpaqueElement("cvst", 1, 1, b"")


def program(text: str, *elements) -> Program:
    return Program(2, 1, assemble(text), elements)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{ add out }", "op 0: 'add' needs 2 values, 0 are on the stack"),
        ("{ in add out }", "op 1: 'add' needs 2 values, 1 are on the stack"),
        ("{ in[0,2] smul[2] out }", "op 1: 'smul' needs 3 values, 2 are on the stack"),
        ("{ in[0,2] env(x) pop(5) }", "op 2: 'pop' needs 5 values, 4 are on the stack"),
        ("{ if { } }", "op 0: 'if' needs 1 values, 0 are on the stack"),
        ("{ sel case { } }", "op 0: 'sel' needs 1 values, 0 are on the stack"),
        ("{ in copy(1,65535) 1 }", "op 1: the stack grows beyond 65535 values"),
        ("{ in copy(1,65534) 1 }", "op 2: the stack grows beyond 65535 values"),
        # Indices count `if`, `else`, `sel`, `case` and `dflt`, which stand before their bodies.
        ("{ in if { 1 } else { 2 add } out }", "op 5: 'add' needs 2 values, 1 are on the stack"),
        ("{ in if { add } out }", "op 2: 'add' needs 2 values, 0 are on the stack"),
        ("{ in if { } add }", "op 2: 'add' needs 2 values, 0 are on the stack"),
        ("{ in sel case { 1 } case { } dflt { 2 } sin }", "op 7: 'sin' needs 1 values, 0 are"),
        ("{ 1 in sel case { pop } sin }", "op 5: 'sin' needs 1 values, 0 are"),
        ("{ in if { in if { 1 } else { 2 neg } add } out }", "op 8: 'add' needs 2 values, 1 are"),
        ("{ in out(1) }", "op 1: 'out' reaches channel 1; there are 1"),
        ("{ in[1,2] }", "op 0: 'in' reaches channel 2; there are 2"),
        ("{ in tput[65535,1] in[0,2] tput[65535,2] }", "op 3: 'tput' reaches temporary 65536; "),
        ("{ tget(3) }", "op 0: temporary 3 is read, and on some path nothing was written"),
        ("{ in if { 1 tput(2) } tget(2) }", "op 4: temporary 2 is read, and on some path"),
        ("{ in sel case { 1 tput } case { 1 tput } tget }", "op 8: temporary 0 is read"),
        ("{ in sel case { 1 tput } dflt { 1 tput(1) } tget }", "op 8: temporary 0 is read"),
        ("{ in tput(1) tget[0,3] }", "op 2: temporary 0 is read"),
        ("{ }", "M2B0: output 0 is not written on every path"),
        ("{ in if { 1 out } }", "M2B0: output 0 is not written on every path"),
        ("{ in sel case { 1 out } }", "M2B0: output 0 is not written on every path"),
        ("{ in mtx(5) }", "op 1: 'mtx' calls sub-element 5; there are 3"),
        ("{ in calc(0) }", "op 1: 'calc' needs a 'calc' element, sub-element 0 is a 'matf'"),
        ("{ in mtx(1) }", "op 1: 'mtx' needs a 'matf' element, sub-element 1 is a 'calc'"),
        ("{ in clut(2) }", "op 1: 'clut' needs a 'clut' element, sub-element 2 is a 'cvst'"),
        ("{ in mtx(0) }", "op 1: 'mtx' needs 2 values, 1 are on the stack"),
        ("{ in calc(1) }", "M2B0, sub-element 1, op 1: 'add' needs 2 values, 1 are"),
        ("{ in[0,2] solv(1,1) }", "op 1: 'solv' of one row or column is undefined"),
        ("{ in if { 1 } else { 1 2 } scnt }", "op 6: 'scnt' where the paths leave different depth"),
    ],
)
def test_refused(text, message):
    broken = Program(1, 1, assemble("{ in add out }"))
    with pytest.raises(ProgramError) as caught:
        verify(program(text, MATRIX, broken, CURVES), "M2B0")
    assert message in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        "{ in if { 1 out } else { 2 out } }",
        "{ in sel case { 1 out } case { 2 out } dflt { 3 out } }",
        # Unbalanced, and what is read lies within the lesser depth.
        "{ 5 in if { 1 2 3 } else { 4 } add out }",
        "{ 1 2 in if { pop } sin out }",
        "{ in sel case { 1 2 } case { 3 } dflt { 4 5 6 } out }",
        "{ in if { 1 tput } else { 2 tput } tget out }",
        "{ 1 tput in if { 2 tput } tget out }",
        "{ in if { 1 } else { 2 } scnt add out }",
        "{ 0 out 1 out }",
        "{ in[0,2] in[0,2] 1 out }",
        "{ env(x) if { } else { pop 7 } out }",
        "{ in[0,2] elem(0) curv(2) out }",
    ],
)
def test_accepted(text):
    verify(program(text, MATRIX, INNER, CURVES))


def test_facts():
    inner = Program(1, 1, assemble("{ in env(azi) pop pop tsav[7,1] out }"))
    text = "{ env(thti) pop tput(4) in[0,2] in if { pi copy(1,3) pop(4) } calc add out env(azi) }"
    assert verify(program(text, inner)) == Facts(
        stack=6,
        temporaries=5,
        variables=("azi", "thti"),
        held=6 + 5 + 3 + (3 + 8 + 2),
        work=verify(program(text, inner)).work,
        nesting=1,
    )


def test_shared_elements_are_proven_once(function_calls):
    element = Program(1, 1, assemble("{ in out }"))
    for _ in range(15):
        element = Program(1, 1, assemble("{ in calc(0) calc(1) out }"), (element, element))
    assert verify(element).work > 2**15
    assert function_calls(lambda: verify(element)) < 2000


@settings(max_examples=100, deadline=None)
@given(programs())
def test_index_is_the_files(random):
    """An operation that fails behind a random program is reported where the file has it."""
    body = (*random.body, Op("pop", 1000))
    with pytest.raises(ProgramError) as caught:
        verify(Program(random.inputs, random.outputs, body, random.elements), "x")
    index = (len(encode_element(Program(0, 0, random.body))) - 24 - 12) // 8
    assert encoded_length(random.body) == index == operations(random)
    assert f"x, op {index}: 'pop' needs 1000 values" in str(caught.value)


def test_a_long_program_decodes_and_verifies_quickly(function_calls):
    body = (Op("in", 0, 1), *(Op("sin", 1), Op("tsav", 9, 1)) * 50_000, Op("out", 0, 1))
    data = encode_element(Program(1, 1, body))
    assert verify(decode_element(data, "x")).stack == 1
    assert function_calls(lambda: verify(decode_element(data, "x"))) < 20 * len(body)


def test_sub_elements_that_nothing_calls():
    """The reference engine refuses a profile for them, and so does brdfc."""
    with pytest.raises(ProgramError) as caught:
        verify(program("{ in out }", MATRIX, INNER, Program(1, 1, assemble("{ in add out }"))))
    assert "calculator, sub-element 2, op 1: 'add' needs 2 values" in str(caught.value)


def test_work_of_branches_over_a_deep_stack():
    """Each keeps the whole state aside for the pixels that go another way."""
    deep = (Op("in", 0, 1), Op("copy", 1, 50_000), Op("tsav", 0, 50_000))
    branch = (Op("in", 0, 1), If(()))
    verify(Program(1, 1, (*deep, *branch * 30, Op("out", 0, 1))))
    with pytest.raises(ProgramError) as caught:
        verify(Program(1, 1, (*deep, *branch * 300, Op("out", 0, 1))))
    assert "a pixel may take more than 10,000,000 steps" in str(caught.value)
    verify(Program(1, 1, (*branch * 40_000, Op("in", 0, 1), Op("out", 0, 1))))


IN, LAST = Op("in", 0, 1), Op("out", 0, 1)


@pytest.mark.parametrize(
    "body",
    [
        (IN, *[Op("tsav", 65535, 1)] * 100_000),
        (IN, Op("tsav", 65535, 1), *(Op("tget", 65535, 1), Op("pop", 1)) * 50_000),
        tuple(op for i in range(50_000) for op in (IN, Op("tput", i, 1))),
        (IN, Op("tput", 65535, 1), *(IN, If(())) * 30_000),
        (IN, Select(tuple((IN, Op("tput", 65534, 1)) for _ in range(30_000)))),
    ],
    ids=["writes", "reads", "all temporaries", "branches", "cases"],
)
def test_the_greatest_temporaries_take_no_longer(body):
    started = time.process_time()
    verify(Program(1, 1, (*body, IN, LAST)))
    assert time.process_time() - started < 3  # under 0.4 s where nothing else runs


def test_effects_of_the_table():
    """Values popped and pushed, from the fact sheet's stack pictures."""
    pictures = {
        "in": (0, 3), "out": (3, 0), "tget": (0, 3), "tput": (3, 0), "tsav": (3, 3),
    }  # fmt: skip
    for name, expected in pictures.items():
        assert OPERATORS[name].effect(1, 3) == expected
    assert OPERATORS["copy"].effect(2, 2) == (2, 6)
    assert OPERATORS["posd"].effect(2, 2) == (2, 4)
    assert OPERATORS["solv"].effect(3, 3) == (12, 4)
    assert OPERATORS["tran"].effect(2, 3) == (6, 6)
    assert OPERATORS["env"].effect(0, 0) == (0, 2)
    for name in ("sum", "prod", "min", "max", "and", "or"):
        assert OPERATORS[name].effect(4, 0) == (4, 1)
    for name in ("gama", "sadd", "ssub", "smul", "sdiv"):
        assert OPERATORS[name].effect(4, 0) == (5, 4)
    assert OPERATORS["ctop"].effect(2, 0) == OPERATORS["ptoc"].effect(2, 0) == (4, 4)
    assert OPERATORS["tLab"].effect(2, 0) == OPERATORS["tXYZ"].effect(2, 0) == (6, 6)
    calls = {name for name, o in OPERATORS.items() if o.operand is Operand.ELEMENT}
    assert {name for name, o in OPERATORS.items() if o.effect is None} == calls
