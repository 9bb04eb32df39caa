"""Curve sets and lookup tables as bytes: round trips, exact layouts, and bytes from outside."""

import contextlib
import struct
import time
import tracemalloc

import numpy as np
import pytest
from calc.calc_elements import (
    ALONE,
    APPEARANCE,
    CURVE_SETS,
    LINE,
    SHARED,
    TABLES,
    TINTS,
)
from hypothesis import given, settings
from hypothesis import strategies as st

from brdfc.calc.binary import decode_element, encode_element
from brdfc.calc.curves import (
    CurveSet,
    FormulaSegment,
    SampledCurve,
    SampledSegment,
    SegmentedCurve,
)
from brdfc.calc.program import Op, Program
from brdfc.calc.samples import Samples, Storage
from brdfc.calc.tables import LookupTable
from brdfc.calc.text import assemble
from brdfc.calc.verify import verify
from brdfc.engine.interpreter import run
from brdfc.source.errors import ProgramError

RAMP = Samples.of([0, 1])
NAN, INF = struct.pack(">f", float("nan")), struct.pack(">f", float("inf"))


@pytest.mark.parametrize(
    "element", [*CURVE_SETS, *TABLES, *TINTS, *APPEARANCE.values()], ids=lambda e: e.signature
)
def test_round_trip(element):
    data = encode_element(element)
    again = decode_element(data, "x")
    assert again == element
    assert encode_element(again) == data
    if element.signature != "tint":  # which has as many numbers as there is room for
        assert decode_element(data + bytes(7), "x") == element  # padding is not looked at


def test_bytes_of_a_table():
    table = LookupTable(2, 1, (2, 3), Samples.of([0, 0.25, 0.5, 1, 2, 3]))
    assert encode_element(table).hex(" ", 4) == (
        "636c7574 00000000 00020001 02030000 00000000 00000000 00000000 "
        "00000000 3e800000 3f000000 3f800000 40000000 40400000"
    )
    small = LookupTable(1, 1, (3,), Samples.of([0, 0.5, 1], Storage.UINT8), extended=True)
    assert encode_element(small)[:16].hex(" ", 4) == "78636c74 00000000 00010001 00030000"
    assert encode_element(small)[32:].hex() == "0080ff"


def test_bytes_of_curves():
    segmented = SegmentedCurve(
        (0.5, 1.0), (LINE, SampledSegment(Samples.of([2.0])), FormulaSegment(0, (1.0,) * 4))
    )
    sampled = SampledCurve(-1.0, 1.0, Samples.of([0, 1, 0.5], Storage.UINT16), extend=True)
    data = encode_element(CurveSet((sampled, segmented, sampled)))
    assert data[:12].hex(" ", 4) == "63767374 00000000 00030003"
    places = list(struct.iter_unpack(">II", data[12:36]))
    assert places == [(36, 30), (68, 92), (36, 30)]
    assert data[36:66].hex() == "736e67660000000000000003bf8000003f800000000100020000ffff8000"
    assert data[68:88].hex(" ", 4) == "63757266 00000000 00030000 3f000000 3f800000"
    assert data[88:100].hex(" ", 4) == "70617266 00000000 00000000"
    assert data[116:132].hex(" ", 4) == "73616d66 00000000 00000001 40000000"


def test_one_curve_in_two_places_is_one_object():
    again = decode_element(encode_element(SHARED), "x")
    assert again.curves[0] is again.curves[2]


@pytest.mark.parametrize("storage", Storage)
def test_samples(storage):
    values = np.array([0, 0.25, 0.3, 1])
    samples = Samples.of(values, storage)
    assert samples.count == 4
    step = {Storage.UINT8: 1 / 255, Storage.UINT16: 1 / 65535}.get(storage, 1e-3)
    assert np.abs(samples.values - values).max() <= 0.502 * step
    for bad in ([float("nan")], [float("inf")], [1e39]):
        with pytest.raises(ProgramError, match=r"finite|0 to 1"):
            Samples.of(bad, storage)
    if storage.one > 1:
        with pytest.raises(ProgramError, match="0 to 1 only"):
            Samples.of([1.01], storage)


@pytest.mark.parametrize(
    ("element", "message"),
    [
        (LookupTable(1, 1, (1,), Samples.of([0])), "2 to 255 points"),
        (LookupTable(1, 1, (256,), Samples.of([0] * 256)), "2 to 255 points"),
        (LookupTable(2, 1, (2,), RAMP), "2 to 255 points for each of 2 inputs"),
        (LookupTable(0, 1, (), RAMP), "1 to 16 inputs"),
        (LookupTable(17, 1, (2,) * 17, RAMP), "1 to 16 inputs"),
        (LookupTable(1, 2, (2,), RAMP), "needs 4 numbers, not 2"),
        (LookupTable(1, 1, (2,), Samples.of([0, 1], Storage.UINT8)), "takes an 'xclt'"),
        (CurveSet((SampledCurve(0.0, 1.0, Samples.of([1])),)), "a sampled curve of 1 points"),
        (CurveSet((SampledCurve(1.0, 1.0, RAMP),)), "a sampled curve from 1 to 1"),
        (CurveSet((SegmentedCurve((), ()),)), "0 segments with 0 breaks"),
        (CurveSet((SegmentedCurve((1.0,), (LINE,)),)), "1 segments with 1 breaks"),
        (CurveSet((SegmentedCurve((1.0, 1.0), (LINE,) * 3),)), "do not ascend"),
        (CurveSet((SegmentedCurve((1.0,), (LINE, SampledSegment(RAMP))),)), "must be formulas"),
        (CurveSet((SegmentedCurve((1.0,), (SampledSegment(RAMP), LINE)),)), "must be formulas"),
        (CurveSet((SegmentedCurve((), (FormulaSegment(8, ()),)),)), "has the type 8"),
        (CurveSet((SegmentedCurve((), (FormulaSegment(0, (1.0,)),)),)), "takes 4 parameters"),
        (CurveSet((ALONE[0],) * 65536), "cannot be encoded"),
    ],
)
def test_what_cannot_be_encoded(element, message):
    with pytest.raises(ProgramError, match=message):
        encode_element(element)


# ---------------------------------------------------------------- bytes from outside


def head(kind: bytes, inputs: int, outputs: int) -> bytes:
    return struct.pack(">4sIHH", kind, 0, inputs, outputs)


def grid(*points: int) -> bytes:
    return bytes(points).ljust(16, b"\0")


def one_curve(data: bytes) -> bytes:
    return head(b"cvst", 1, 1) + struct.pack(">II", 20, len(data)) + data


def sampled(
    count: int, first: bytes, last: bytes, extension: int, storage: int, data: bytes
) -> bytes:
    numbers = struct.pack(">II", 0, count) + first + last + struct.pack(">HH", extension, storage)
    return one_curve(b"sngf" + numbers + data)


def segmented(count: int, data: bytes) -> bytes:
    return one_curve(struct.pack(">4sIHH", b"curf", 0, count, 0) + data)


ZERO, ONE = struct.pack(">f", 0), struct.pack(">f", 1)
PARF = struct.pack(">4sIHH4f", b"parf", 0, 0, 0, 1, 1, 0, 0)
SAMF = struct.pack(">4sIIf", b"samf", 0, 1, 1)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (head(b"clut", 1, 1), "ends within its header"),
        (head(b"clut", 0, 1) + grid(2) + ZERO * 2, "1 to 16 inputs"),
        (head(b"clut", 17, 1) + grid(*[2] * 16) + ZERO * 9, "1 to 16 inputs"),
        (head(b"clut", 1, 0) + grid(2), "1 output or more"),
        (head(b"clut", 1, 1) + grid(0) + ZERO, "2 to 255 points"),
        (head(b"clut", 2, 1) + grid(2, 1) + ZERO * 2, "2 to 255 points"),
        (head(b"clut", 16, 65535) + grid(*[255] * 16) + ZERO, "numbers \\(FLOAT32\\) are claimed"),
        (head(b"clut", 1, 1) + grid(2) + ZERO, "2 numbers \\(FLOAT32\\) are claimed, 4 bytes"),
        (head(b"clut", 1, 1) + grid(2) + ZERO + NAN, "NaN or infinite"),
        (head(b"clut", 1, 1) + grid(2) + INF + ZERO, "NaN or infinite"),
        (head(b"xclt", 1, 1) + struct.pack(">HH", 4, 0) + grid(2) + ZERO * 2, "the number 4"),
        (head(b"xclt", 1, 1) + struct.pack(">HH", 2, 0) + grid(2) + bytes(3), "UINT16"),
        (head(b"xclt", 1, 1) + struct.pack(">HH", 1, 0) + grid(2) + b"\x7e\0\0\0", "NaN or inf"),
        (head(b"cvst", 1, 2), "a curve set of 1 inputs and 2 outputs"),
        (head(b"cvst", 65535, 65535), "65535 curves are claimed"),
        (head(b"cvst", 1, 1) + struct.pack(">II", 0, 12), "part 0 at 0, 12 bytes, lies outside"),
        (head(b"cvst", 1, 1) + struct.pack(">II", 20, 0xFFFFFFFF), "lies outside"),
        (head(b"cvst", 1, 1) + struct.pack(">II", 0xFFFFFFFF, 8), "lies outside"),
        (
            head(b"cvst", 2, 2) + struct.pack(">IIII", 28, 40, 32, 36) + bytes(40),
            "curves at 28 and 32 overlap",
        ),
        (one_curve(b""), "no curve has the signature b''"),
        (one_curve(b"what" + bytes(40)), "curve 0: no curve has the signature b'what'"),
        (one_curve(b"sngf" + bytes(8)), "ends within its header"),
        (sampled(0xFFFFFFFF, ZERO, ONE, 0, 0, ZERO * 2), "4294967295 numbers"),
        (sampled(0, ZERO, ONE, 0, 0, b""), "a sampled curve of 0 points"),
        (sampled(1, ZERO, ONE, 0, 0, ZERO), "a sampled curve of 1 points"),
        (sampled(2, ZERO, ZERO, 0, 0, ZERO * 2), "a sampled curve from 0 to 0"),
        (sampled(2, ONE, ZERO, 0, 0, ZERO * 2), "a sampled curve from 1 to 0"),
        (sampled(2, NAN, ONE, 0, 0, ZERO * 2), "a sampled curve from nan to 1"),
        (sampled(2, ZERO, INF, 0, 0, ZERO * 2), "a sampled curve from 0 to inf"),
        (sampled(2, ZERO, ONE, 2, 0, ZERO * 2), "no extension has the number 2"),
        (sampled(2, ZERO, ONE, 0, 9, ZERO * 2), "no storage type has the number 9"),
        (sampled(2, ZERO, ONE, 0, 0, ZERO + NAN), "NaN or infinite"),
        (one_curve(b"curf"), "ends within its header"),
        (segmented(0, b""), "0 segments"),
        (segmented(65535, PARF), "65535 segments are claimed"),
        (segmented(1, b""), "segment 0: the segment ends within its header"),
        (segmented(1, PARF[:-1]), "ends within its parameters"),
        (segmented(1, SAMF), "must be formulas"),
        (segmented(1, b"quux" + bytes(20)), "no segment has the signature b'quux'"),
        (segmented(1, struct.pack(">4sIHH", b"parf", 0, 8, 0) + bytes(40)), "has the type 8"),
        (segmented(1, PARF[:-4] + NAN), "a parameter is NaN or infinite"),
        (segmented(2, NAN + PARF * 2), "do not ascend"),
        (segmented(3, ONE + ONE + PARF * 3), "do not ascend"),
        (segmented(3, ONE + INF + PARF * 3), "do not ascend"),
        (segmented(2, ONE + PARF + SAMF), "must be formulas"),
        (segmented(3, ZERO + ONE + PARF + SAMF[:8] + bytes(4) + PARF), "needs FLOAT32 samples"),
        (segmented(3, ZERO + ONE + PARF + SAMF[:8] + b"\xff" * 8), "4294967295 numbers"),
    ],
)
def test_malformed(data, message):
    tracemalloc.start()
    started = time.perf_counter()
    with pytest.raises(ProgramError, match=message) as caught:
        decode_element(data, "M2B0")
    assert time.perf_counter() - started < 1
    assert tracemalloc.get_traced_memory()[1] < 1_000_000
    tracemalloc.stop()
    assert caught.value.where.startswith("M2B0")


def test_many_curves_cannot_share_bytes_in_part():
    """Each of 2000 curves would be the rest of the file."""
    count = 2000
    start = 12 + 8 * count
    places = [(start + 4 * i, 4 * (count - i)) for i in range(count)]
    table = b"".join(struct.pack(">II", *place) for place in places)
    with pytest.raises(ProgramError, match="overlap"):
        decode_element(head(b"cvst", count, count) + table + bytes(4 * count), "x")


@settings(max_examples=200, deadline=None)
@given(st.sampled_from([*CURVE_SETS, *TABLES[:12], *TINTS[::4], *APPEARANCE.values()]), st.data())
def test_mutations(element, data):
    """Any bytes changed or cut off: an element that runs, or a ProgramError."""
    encoded = bytearray(encode_element(element))
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, min(len(encoded), 120) - 1))
        encoded[place] = data.draw(st.sampled_from([0, 1, 2, 3, 0x7F, 0x80, 0xFF]))
    end = data.draw(st.sampled_from([len(encoded), len(encoded) - 1, len(encoded) // 2]))
    started = time.perf_counter()
    with contextlib.suppress(ProgramError):
        found = decode_element(bytes(encoded[:end]), "x")
        run(found, [[0.25] * found.inputs] * 3, {})
    assert time.perf_counter() - started < 1


# ---------------------------------------------------------------- in a program


def test_verification_knows_their_kinds():
    curve = CurveSet((ALONE[0],))
    table = LookupTable(1, 1, (2,), RAMP)
    extended = LookupTable(1, 1, (2,), RAMP, extended=True)
    for name, element in (("curv", curve), ("clut", table), ("clut", extended), ("elem", curve)):
        verify(Program(1, 1, assemble(f"{{ in {name} out }}"), (element,)))
    for name, element in (("curv", table), ("clut", curve), ("mtx", curve), ("calc", table)):
        with pytest.raises(ProgramError, match=f"'{name}' needs a"):
            verify(Program(1, 1, assemble(f"{{ in {name} out }}"), (element,)))


def test_the_corners_of_a_table_count_as_work():
    table = LookupTable(16, 1, (2,) * 16, Samples(Storage.UINT8, bytes(2**16)), extended=True)
    call = (Op("in", 0, 16), Op("clut", 0), Op("out", 0, 1))
    verify(Program(16, 1, call * 8, (table,)))
    with pytest.raises(ProgramError, match="more than 10,000,000 steps"):
        verify(Program(16, 1, call * 9, (table,)))
