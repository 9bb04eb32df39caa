"""Curves and lookup tables as tags: there and back, their layout, and what is refused."""

import struct
from dataclasses import replace

import pytest
from icc_luts import CURVES, random_samples, staged_lut, table_lut
from icc_samples import patched

from brdfc.calc.samples import Samples, Storage
from brdfc.icc.curves import Curve, ParametricCurve
from brdfc.icc.types import decode_tag
from brdfc.source.errors import ProfileError

LUTS = {
    "mft1": table_lut(8, 3, 4, 3),
    "mft1 one channel": table_lut(8, 1, 1, 2),
    "mft2": table_lut(16, 4, 3, 3, 17),
    "mft2 shortest": table_lut(16, 1, 3, 2, 2),
    **{
        f"{kind}{stages} {storage.name}": staged_lut(kind, device, stages, storage)
        for kind in ("mAB ", "mBA ")
        for storage in (Storage.UINT8, Storage.UINT16)
        for device, stages in ((4, "AC3MB"), (4, "ACB"), (3, "3MB"), (3, "B"), (2, "CB"))
    },
}


@pytest.mark.parametrize("tag", [*CURVES, *LUTS.values()], ids=[*map(repr, CURVES), *LUTS])
def test_there_and_back(tag):
    data = tag.encode()
    read = decode_tag(data, "tag")
    assert read == tag
    assert read.encode() == data
    assert data[:4] == tag.type_signature.encode()


def test_layout_of_curves():
    assert Curve().encode() == b"curv" + bytes(8)
    assert Curve(gamma=1.5).encode() == b"curv" + struct.pack(">IIH", 0, 1, 0x0180)
    sampled = Curve(samples=Samples.of((0.0, 1.0), Storage.UINT16))
    assert sampled.encode() == b"curv" + struct.pack(">IIHH", 0, 2, 0, 65535)
    parametric = ParametricCurve(1, (2.0, 1.0, -0.5))
    assert parametric.encode() == b"para" + struct.pack(">IHHiii", 0, 1, 0, 131072, 65536, -32768)


def test_layout_of_a_table():
    """The places of the fields as ICC.1 has them in lut16Type."""
    lut = table_lut(16, 2, 3, 5, 7)
    data = lut.encode()
    assert data[:12] == b"mft2\0\0\0\0\2\3\5\0"
    assert struct.unpack_from(">9i", data, 12)[2] == -16384
    assert data[48:52] == struct.pack(">HH", 7, 7)
    assert data[52:80] == lut.input_curves.data
    assert data[80:230] == lut.table.samples.data
    assert data[230:] == lut.output_curves.data


def test_layout_of_stages():
    data = staged_lut("mAB ", 4, "AC3MB", Storage.UINT8).encode()
    assert data[:12] == b"mAB \0\0\0\0\4\3\0\0"
    b, matrix, m, clut, a = struct.unpack_from(">5I", data, 12)
    assert (b, matrix) == (32, 32 + 12 + 16 + 20)  # an identity, a gamma, three samples
    assert m == matrix + 48
    assert data[clut : clut + 20] == bytes((2, 3, 4, 5)) + bytes(12) + b"\1\0\0\0"
    assert data[a : a + 4] == b"curv"
    assert all(start % 4 == 0 for start in (b, matrix, m, clut, a))


def test_stages_in_any_order_and_curves_in_two_stages():
    """Another writer's order, and M and B curves that are the same bytes."""
    curves, matrix = Curve().encode() * 3, struct.pack(">12i", *range(12))
    head = struct.pack(">4sIBBxx5I", b"mAB ", 0, 3, 3, 80, 32, 80, 0, 0)
    lut = decode_tag(head + matrix + curves, "tag")
    assert lut.m_curves == lut.b_curves == (Curve(),) * 3
    assert lut.matrix == tuple(number / 65536 for number in range(12))


def of(name: str, offset: int, form: str, *values: object) -> bytes:
    """A good tag with fields put over its bytes."""
    return patched(LUTS[name].encode(), offset, form, *values)


STAGED = "mAB AC3MB UINT8"
B, MATRIX, M, CLUT, A = struct.unpack_from(">5I", LUTS[STAGED].encode(), 12)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"curv" + struct.pack(">II", 0, 2**32 - 1) + bytes(8), "4294967295 numbers"),
        (b"curv" + struct.pack(">II", 0, 1), "14 are needed"),
        (b"curv" + bytes(4), "12 are needed"),
        (b"para" + struct.pack(">IHH", 0, 5, 0) + bytes(40), "type 5, not 0 to 4"),
        (b"para" + struct.pack(">IHH", 0, 4, 0) + bytes(24), "40 are needed"),
        (of("mft1", 8, "B", 0), "not 0 and 4"),
        (of("mft1", 8, "B", 255), "1 to 16 inputs"),
        (of("mft1", 8, "B", 16), "numbers"),
        (of("mft1", 9, "B", 0), "not 3 and 0"),
        (of("mft1", 10, "B", 0), "a grid has 2 to 255 points"),
        (of("mft1", 10, "B", 1), "a grid has 2 to 255 points"),
        (of("mft1", 10, "B", 255), "66325500 numbers"),
        (LUTS["mft1"].encode()[:-1], "output curves: 1024 numbers"),
        (of("mft2", 48, "H", 1), "a curve of 1 samples"),
        (of("mft2", 50, "H", 4097), "a curve of 4097 samples"),
        (of("mft2", 50, "H", 18), "output curves: 54 numbers"),
        (LUTS["mft2"].encode()[:50], "52 are needed"),
        (of(STAGED, 8, "B", 0), "1 to 16 inputs"),
        (of(STAGED, 8, "B", 17), "1 to 16 inputs"),
        (of(STAGED, 9, "B", 4), "curve 3"),
        (of(STAGED, 12, "I", 0), "no B curves"),
        (of(STAGED, 12, "I", 4), "'curv' or 'para' is expected"),
        (of(STAGED, 12, "I", 2**32 - 2), "are needed"),
        (of(STAGED, 12, "I", A + 12), "overlap A curves"),
        (of(STAGED, 16, "I", 4), "overlap the header"),
        (of(STAGED, 16, "I", MATRIX + 4), "M curves at byte 128 overlap the matrix"),
        (of(STAGED, 16, "I", 2**32 - 1), "are needed"),
        (of(STAGED, 24, "I", 0), "no table, which 4 channels in and 3 out need"),
        (of(STAGED, CLUT + 2, "B", 1), "a grid has 2 to 255 points"),
        (of(STAGED, CLUT, "4B", 255, 255, 255, 255), "12684751875 numbers"),
        (of(STAGED, CLUT + 16, "B", 3), "3 bytes a number"),
        (of(STAGED, CLUT + 16, "B", 2), "360 numbers (UINT16)"),
        (of(STAGED, A + 8, "I", 2**31), "A curves, curve 0"),
        (of(STAGED, B, "4s", b"mAB "), "B curves, curve 0 at byte 32"),
        (staged_lut("mBA ", 2, "CB").encode()[:32], "are needed"),
    ],
)
def test_refused(data, message):
    with pytest.raises(ProfileError) as caught:
        decode_tag(data, "tag 'A2B0'")
    assert message in str(caught.value)
    assert str(caught.value).startswith("tag 'A2B0'")


GOOD = table_lut(16, 2, 3, 2, 4)
STAGES = staged_lut("mAB ", 4)


@pytest.mark.parametrize(
    "tag",
    [
        Curve(gamma=256.0),
        Curve(gamma=-1.0),
        Curve(gamma=float("nan")),
        Curve(gamma=1.0, samples=random_samples(4, Storage.UINT16)),
        Curve(samples=random_samples(1, Storage.UINT16)),
        Curve(samples=random_samples(4, Storage.UINT8)),
        ParametricCurve(5, (1.0,)),
        ParametricCurve(0, (1.0, 2.0)),
        ParametricCurve(0, (float("inf"),)),
        replace(GOOD, matrix=(1.0,)),
        replace(GOOD, input_curves=random_samples(8, Storage.UINT8)),
        replace(GOOD, input_curves=random_samples(7, Storage.UINT16)),
        replace(GOOD, output_curves=random_samples(3, Storage.UINT16)),
        replace(GOOD, table=replace(GOOD.table, grid=(2, 3))),
        replace(GOOD, table=replace(GOOD.table, grid=(1, 1))),
        replace(table_lut(8, 1, 1, 2), input_curves=random_samples(255, Storage.UINT8)),
        replace(STAGES, b_curves=()),
        replace(STAGES, a_curves=CURVES[:3]),
        replace(STAGES, matrix=(1.0,) * 9),
        replace(STAGES, clut=None),
        replace(STAGES, clut=replace(STAGES.clut, grid=(2, 2, 2, 2))),
        replace(STAGES, inputs=256, a_curves=None),
    ],
    ids=lambda tag: repr(tag)[:60],
)
def test_not_written(tag):
    with pytest.raises(ProfileError):
        tag.encode()
