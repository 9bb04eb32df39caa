"""Bytes from outside: one clear ProfileError, at once and in little memory, and nothing else. The
classes of bad profiles, each with its message, are listed in test_bad_input.py."""

import contextlib
import random
import struct
import time
import tracemalloc

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from icc_samples import MINIMAL_MID, mid, mvis, patched

from brdfc.calc.program import Matrix
from brdfc.icc.header import Header
from brdfc.icc.profile import FILE_LIMIT, Profile
from brdfc.icc.types import Opaque, Pipeline, decode_tag
from brdfc.icc.validate import validate
from brdfc.source.errors import BrdfcError, ProfileError

GOOD = mid().to_bytes()
SECOND = 2.0
"""Of processor time, which a busy machine has hardly more of than an idle one."""


def refused(data: bytes) -> ProfileError:
    """The error that reading gives, which comes soon and takes little memory."""
    tracemalloc.start()
    started = time.process_time()
    with pytest.raises(ProfileError) as caught:
        Profile.from_bytes(data, "x.icc")
    assert time.process_time() - started < SECOND
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 10_000_000 + 2 * len(data)
    return caught.value


@pytest.mark.parametrize(
    ("data", "looks"),
    [
        (b"", "the file is empty"),
        (b"II*\0" + bytes(400), "a TIFF image"),
        (b"MM\0*" + bytes(400), "a TIFF image"),
        (b"II+\0" + bytes(400), "a BigTIFF image"),
        (b"\x89PNG\r\n\x1a\n" + bytes(400), "a PNG image"),
        (b"\xff\xd8\xff\xe0" + bytes(400), "a JPEG image"),
        (b"PK\x03\x04" + bytes(400), "a ZIP archive"),
        (b'<?xml version="1.0"?><IccProfile/>', "XML"),
        (b'model ward "Isotropic Ward"\n' * 100, "text"),
        ("modèle ρ\n".encode() * 500, "text"),
        (bytes(400), "'acsp' is missing"),
        (bytes(range(256)), "'acsp' is missing"),
        (GOOD[:30], "'acsp' is missing"),
    ],
)
def test_not_a_profile(data, looks):
    error = refused(data)
    assert error.message.startswith("not an ICC profile: ")
    assert looks in error.message
    assert error.where == "x.icc"


@pytest.mark.parametrize(
    "data",
    [
        b"fl32\0\0\0\0\x7f\xc0\0\0",
        b"fl32\0\0\0\0\xff\x80\0\0",
        b"fl16\0\0\0\0\x7e\0",
        b"fl64\0\0\0\0\x7f\xf8\0\0\0\0\0\0",
        b"fl32\0\0\0\0\0\0",
        b"ui16\0\0\0\0\0",
        b"XYZ \0\0\0\0" + bytes(16),
        b"sig \0\0\0\0ab",
        b"tary\0\0\0\0",
        b"dict\0\0\0\0",
        b"ui08" + bytes(4 + 65537),
    ],
)
def test_faulty_numbers(data):
    with pytest.raises(ProfileError) as caught:
        decode_tag(data, "the tag")
    assert caught.value.where == "the tag"


def test_overlapping_elements_cannot_stand_for_more_than_is_there():
    count = 5000
    table = b"".join(struct.pack(">II", 16 + 8 * count + 4 * i, 20_000) for i in range(count))
    data = b"mpet" + struct.pack(">IHHI", 0, 1, 1, count) + table + bytes(40_000)
    assert "overlaps" in refused(Profile(Header("mid "), {"A2M0": Opaque(data)}).to_bytes()).message


def test_many_tags_and_elements_at_one_place_cost_what_one_does():
    step = Matrix(60, 60, (0.5,) * 3600, (0.0,) * 60)
    pipeline = Pipeline(60, 60, (step,) * 60_000)
    data = Profile(Header("mid "), {f"{n:04x}": pipeline for n in range(20_000)}).to_bytes()
    started = time.process_time()
    profile = Profile.from_bytes(data)
    validate(profile)
    assert profile.to_bytes() == data
    assert time.process_time() - started < 3 * SECOND


def test_deep_nesting_ends():
    func = b"func" + struct.pack(">II", 0, 0)
    inner = func
    for _ in range(3000):
        head = b"calc" + struct.pack(">IHHI", 0, 1, 1, 1)
        head += struct.pack(">IIII", 32, 12, 44, len(inner))
        inner = head + func + inner
    data = b"mpet" + struct.pack(">IHHIII", 0, 1, 1, 1, 24, len(inner)) + inner
    assert (
        "nest deeper" in refused(Profile(Header("mid "), {"A2M0": Opaque(data)}).to_bytes()).message
    )


def test_a_file_beyond_the_limit_is_not_read(tmp_path):
    path = tmp_path / "huge.icc"
    with path.open("wb") as stream:
        stream.truncate(FILE_LIMIT + 1)  # sparse
    with pytest.raises(BrdfcError, match="bytes are more than"):
        Profile.load(path)


def survives(data: bytes) -> None:
    """Reading gives a profile or a ProfileError; what was read can be judged and written."""
    started = time.process_time()
    with contextlib.suppress(ProfileError):
        profile = Profile.from_bytes(data)
        validate(profile)
        Profile.from_bytes(profile.to_bytes())
    assert time.process_time() - started < SECOND


VALID = (GOOD, mvis().to_bytes(), MINIMAL_MID)


@pytest.mark.parametrize("data", VALID)
def test_every_truncation(data):
    for length in range(len(data)):
        survives(data[:length])
        survives((struct.pack(">I", length) + data[4:])[:length])  # the size made to fit


@pytest.mark.parametrize("data", VALID)
def test_every_byte_put_to_extremes(data):
    for offset in range(len(data)):
        for value in (0, 1, 0x7F, 0x80, 0xFF, data[offset] ^ 1):
            survives(patched(data, offset, "B", value))


@given(st.sampled_from(VALID), st.integers(0, 2**32))
@settings(max_examples=500, deadline=None)
def test_random_mutations(data, seed):
    generator = random.Random(seed)
    for _ in range(generator.randint(1, 8)):
        form, top = generator.choice((("B", 255), ("H", 65535), ("I", 2**32 - 1)))
        offset = generator.randrange(0, len(data) - 4)
        data = patched(data, offset, form, generator.choice((0, 1, top, generator.randint(0, top))))
    survives(data)


@given(st.binary(max_size=600), st.integers(0, 400))
@settings(deadline=None)
def test_random_bytes(data, tags):
    survives(data)
    head = Header("mid ").encode(132 + len(data)) + struct.pack(">I", tags)
    survives(head + data)
