"""Bytes from outside: a ProgramError at once, and nothing else."""

import contextlib
import random
import struct
import time
import tracemalloc

import pytest
from calc_programs import programs, random_program
from hypothesis import given, settings
from hypothesis import strategies as st

from brdfc.calc.binary import decode_element, encode_element
from brdfc.calc.operators import BY_SIGNATURE
from brdfc.calc.program import MAX_NESTING, If, Matrix, Op, Program
from brdfc.calc.text import assemble
from brdfc.calc.verify import verify
from brdfc.engine.interpreter import run
from brdfc.source.errors import ProgramError

SECOND = 2.0
"""Of processor time, which a busy machine has hardly more of than an idle one."""


def op(name: str, first: int = 0, second: int = 0) -> bytes:
    return struct.pack(">4sHH", name.ljust(4).encode(), first, second)


def jump(name: str, length: int) -> bytes:
    return struct.pack(">4sI", name.ljust(4).encode(), length)


def function(*words: bytes, count: int | None = None) -> bytes:
    return b"func" + struct.pack(">II", 0, len(words) if count is None else count) + b"".join(words)


def calculator(places: list[tuple[int, int]], body: bytes, count: int | None = None) -> bytes:
    """An element with a table of places as given: (offset, size), the main function's first."""
    head = struct.pack(">4sIHHI", b"calc", 0, 1, 1, len(places) - 1 if count is None else count)
    return head + b"".join(struct.pack(">II", *place) for place in places) + body


def simple(*words: bytes, count: int | None = None) -> bytes:
    main = function(*words, count=count)
    return calculator([(24, len(main))], main)


def refused(data: bytes) -> str:
    """The message of decoding, or of verifying what was decoded; soon, and in little memory."""
    tracemalloc.start()
    started = time.process_time()
    with pytest.raises(ProgramError) as caught:
        verify(decode_element(data, "M2B0"), "M2B0")
    assert time.process_time() - started < SECOND
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 10_000_000 + 100 * len(data)
    return str(caught.value)


COPY = (op("in"), op("out"))
HUGE = 0xFFFFFFFF


def test_a_good_one():
    assert verify(decode_element(simple(*COPY), "M2B0")).stack == 1


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "an element needs 12 bytes, 0 are left"),
        (b"calc" + bytes(8), "the calculator has no main function"),
        (simple(*COPY)[:-1], "part 0 at 24, 28 bytes, lies outside the element"),
        (simple(*COPY, count=3), "3 operations are claimed, more than fit"),
        (simple(*COPY, count=HUGE), "4294967295 operations are claimed, more than fit"),
        (simple(*COPY).replace(b"func", b"funk"), "no 'func' here"),
        (calculator([(24, 11)], function(*COPY)), "no 'func' here"),
        (calculator([(24, 28)], function(*COPY), count=HUGE), "4294967295 sub-elements"),
        (calculator([(24, 28)], function(*COPY), count=65536), "65536 sub-elements"),
        (calculator([(HUGE, 28)], function(*COPY)), "part 0 at 4294967295, 28 bytes, lies outside"),
        (calculator([(24, HUGE)], function(*COPY)), "part 0 at 24, 4294967295 bytes, lies outside"),
        (calculator([(0, 28)], function(*COPY)), "part 0 at 0, 28 bytes, lies outside"),
        (calculator([(32, 28), (0, 60)], function(*COPY)), "part 1 at 0, 60 bytes, lies outside"),
        (calculator([(32, 28), (4, 16)], function(*COPY)), "part 1 at 4, 16 bytes, lies outside"),
        (
            calculator([(40, 28), (68, 20), (72, 16)], function(*COPY) + bytes(20)),
            "sub-elements at 68 and 72 overlap",
        ),
        (
            calculator([(40, 28), (68, 20), (68, 16)], function(*COPY) + bytes(20)),
            "sub-elements at 68 and 68 overlap",
        ),
        (calculator([(32, 28), (60, 0)], function(*COPY)), "an element needs 12 bytes, 0 are left"),
        (simple(op("nope")), "op 0: no operator has the signature b'nope'"),
        (simple(op("in"), op("\0\1")), "op 1: no operator has the signature"),
        (simple(*COPY, jump("else", 0)), "op 2: 'else' without what it belongs to"),
        (simple(*COPY, jump("case", 0)), "op 2: 'case' without what it belongs to"),
        (simple(*COPY, jump("dflt", 0)), "op 2: 'dflt' without what it belongs to"),
        (simple(op("in"), jump("sel", 0)), "op 1: 'sel' without a 'case'"),
        (simple(op("in"), jump("sel", 0), jump("dflt", 0)), "op 1: 'sel' without a 'case'"),
        (simple(op("in"), jump("if", 1)), "op 1: 'if' claims 1 operations where 0 are left"),
        (simple(op("in"), jump("if", HUGE), op("pi")), "'if' claims 4294967295 operations"),
        (
            simple(op("in"), jump("if", 1), jump("else", HUGE), op("pi")),
            "op 2: 'else' claims 4294967295 operations where 0 are left in its block",
        ),
        (
            simple(op("in"), jump("sel", 0), jump("case", 0), jump("dflt", 2), op("pi")),
            "op 3: 'dflt' claims 2 operations where 1 are left",
        ),
        (
            # The inner block reaches past the end of the outer one, though not of the function.
            simple(op("in"), jump("if", 2), op("pi"), jump("if", 1), op("pi"), *COPY),
            "op 3: 'if' claims 1 operations where 0 are left in its block",
        ),
        (
            simple(*[jump("if", 1999 - i) for i in range(2000)]),
            f"op 65: blocks nest deeper than {MAX_NESTING}",
        ),
    ],
)
def test_malformed(data, message):
    assert message in refused(data)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([op("in"), op("copy", 65535, 65535)], "op 1: 'copy' needs 65536 values, 1 are on"),
        ([op("in"), op("copy", 0, 65535)], "op 1: the stack grows beyond 65535 values"),
        ([op("in"), op("posd", 0, 65535)], "op 1: the stack grows beyond 65535 values"),
        ([op("in"), op("solv", 65535, 65535)], "op 1: 'solv' needs 4295032832 values"),
        ([op("in"), op("tran", 65535, 65535)], "op 1: 'tran' needs 4294967296 values"),
        ([op("in"), op("rotl", 65535, 65535)], "op 1: 'rotl' needs 65536 values"),
        ([op("in"), op("sum", 65535)], "op 1: 'sum' needs 65537 values"),
        ([op("in", 65535, 65535)], "op 0: 'in' reaches channel 131070; there are 1"),
        ([op("in"), op("out", 65535, 65535)], "op 1: 'out' reaches channel 131070; there are 1"),
        ([op("in"), op("tput", 65535, 1)], "op 1: 'tput' reaches temporary 65536; there are 65536"),
        ([op("in"), op("calc")], "op 1: 'calc' calls sub-element 0; there are 0"),
    ],
)
def test_huge_operands(words, message):
    assert message in refused(simple(*words))


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), float("-inf")])
def test_matrix_numbers(bad):
    data = struct.pack(">4sIHH2f", b"matf", 0, 1, 1, 1.0, bad)
    assert "the matrix holds NaN or infinity" in refused(data)


@pytest.mark.parametrize(("inputs", "outputs"), [(65535, 65535), (2, 1), (0, 2)])
def test_matrix_larger_than_its_bytes(inputs, outputs):
    data = struct.pack(">4sIHHf", b"matf", 0, inputs, outputs, 1.0)
    assert f"a {outputs} x {inputs} matrix does not fit its bytes" in refused(data)


def test_overstated_main_function_is_accepted():
    """Other writers add the main function's offset to its size as soon as there are elements."""
    matrix = struct.pack(">4sIHH2f", b"matf", 0, 1, 1, 2.0, 0.0)
    main = function(op("in"), op("mtx"), op("out"))
    for size in (len(main), len(main) + len(matrix), len(main) + 12):
        data = calculator([(32, size), (32 + len(main), len(matrix))], main + matrix)
        program = decode_element(data, "M2B0")
        assert run(program, [[3.0]], {}) == 6.0
    assert "lies outside" in refused(
        calculator([(32, len(main) + 32), (32 + len(main), 20)], main + matrix)
    )


def test_limits_block_is_stepped_over():
    """Between the table and the main function there may be anything, such as `clmt`."""
    main = function(*COPY)
    data = calculator([(24 + 28, len(main))], b"clmt" + bytes(24) + main)
    assert decode_element(data, "M2B0").body == assemble("{ in out }")


def nested(levels: int, calls: int, depth_of_call: int = 0) -> bytes:
    """Calculators in calculators; each calls the next `calls` times, by as many entries."""
    data = simple(*COPY)
    for _ in range(levels):
        call = [op("calc", i) for i in range(calls)]
        length = len(call)
        wrapped = []
        for i in range(depth_of_call):
            wrapped += [op("pi"), jump("if", length + 2 * (depth_of_call - 1 - i))]
        main = function(op("in"), *wrapped, *call, op("out"))
        offset = 16 + 8 * (calls + 1)
        places = [(offset, len(main))] + [(offset + len(main), len(data))] * calls
        data = calculator(places, main + data)
    return data


def test_elements_nested_without_end():
    assert "nest deeper than 64" in refused(nested(200, 1))
    assert "nest deeper than 64" in refused(nested(2000, 1))


def test_nesting_of_calls_inside_blocks():
    """Each limit alone is kept here; together they would exhaust Python's stack."""
    assert "nest deeper than 64" in refused(nested(60, 1, depth_of_call=30))
    program = decode_element(nested(10, 1, depth_of_call=5), "M2B0")
    assert verify(program).nesting == 60
    assert run(program, [[3.0]], {}) == 3.0


def test_exponential_trees():
    """2^60 calls in a few kilobytes: found by adding up, not by running."""
    data = nested(60, 2)
    assert len(data) < 6000
    assert "a pixel may take more than 10,000,000 steps up to here" in refused(data)
    small = decode_element(nested(8, 2), "M2B0")
    assert run(small, [[3.0]], {}) == 3.0


def test_a_shared_element_called_deeper_the_second_time():
    element = Program(1, 1, assemble("{ in out }"))
    for _ in range(32):
        element = Program(1, 1, assemble("{ in calc(0) out }"), (element,))
    body = (Op("calc", 0),)
    for _ in range(33):
        body = (Op("pi"), If(body))
    program = Program(1, 1, (Op("in", 0, 1), Op("calc", 0), *body, Op("out", 0, 1)), (element,))
    with pytest.raises(ProgramError, match="nest deeper than 64"):
        verify(program)


@settings(max_examples=200, deadline=None)
@given(programs(), st.data())
def test_mutations(program, data):
    """Any bytes changed: a program that verifies and runs, or a ProgramError."""
    encoded = bytearray(encode_element(program))
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, len(encoded) - 1))
        encoded[place] = data.draw(st.sampled_from([0, 1, 2, 3, 0x7F, 0x80, 0xFF, *b"ifelscadt "]))
    attempt(bytes(encoded))


@settings(max_examples=200, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.sampled_from([*BY_SIGNATURE, b"if  ", b"else", b"sel ", b"case", b"dflt"]),
            st.integers(0, 6),
            st.integers(0, 6),
        )
    )
)
def test_random_operations(words):
    attempt(simple(*(struct.pack(">4sHH", *word) for word in words)))
    attempt(simple(*(struct.pack(">4sHH", s, 0, b) for s, _, b in words)))


def test_cuts():
    encoded = encode_element(random_program(1))
    for end in range(0, len(encoded), 7):
        attempt(encoded[:end])


def test_noise():
    noise = random.Random(3)
    for _ in range(300):
        attempt(b"calc" + noise.randbytes(noise.randrange(200)))


def attempt(data: bytes) -> None:
    started = time.process_time()
    with contextlib.suppress(ProgramError):
        element = decode_element(data, "M2B0")
        if isinstance(element, Program | Matrix) and element.inputs < 100:
            run(element, [[0.25] * element.inputs] * 3, {"thti": 0.5})
    assert time.process_time() - started < 2 * SECOND
