"""Bytes from outside: one clear ProfileError, at once and in little memory, and nothing else."""

import contextlib
import random
import struct
import time
import tracemalloc

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from icc_samples import MINIMAL_MID, entry_of, mid, mvis, patched, tag_start

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


def put(signature: str, offset: int, form: str, *values: object) -> bytes:
    """GOOD with fields put over the bytes of one tag."""
    return patched(GOOD, tag_start(GOOD, signature) + offset, form, *values)


def entry(signature: str, form: str, *values: object) -> bytes:
    """GOOD with the offset and size of one tag put over."""
    return patched(GOOD, entry_of(GOOD, signature) + 4, form, *values)


A2M0 = tag_start(GOOD, "A2M0")
DESC = tag_start(GOOD, "desc")


@pytest.mark.parametrize(
    ("data", "where", "message"),
    [
        (GOOD[:-4], "header at byte 0", "truncated: the header says"),
        (GOOD[:131], "", "truncated: 131 bytes"),
        (GOOD + bytes(4), "header at byte 0", "bytes after the end"),
        (patched(GOOD, 104, "4s", b"\x7e\0\0\0"), "header at byte 104", "not a finite number"),
        (patched(GOOD, 128, "I", 1000), "tag table", "1000 entries of 12 bytes"),
        (patched(GOOD, 128, "I", 2**32 - 1), "tag table", "more than 65536"),
        (entry("A2M0", "II", A2M0, 2**32 - 4), "x.icc", "tag 'A2M0' takes bytes"),
        (entry("A2M0", "II", 2**32 - 4, 64), "x.icc", "past the end"),
        (entry("A2M0", "II", 128, 64), "x.icc", "overlaps the table of entries"),
        (entry("A2M0", "II", 0, 64), "x.icc", "overlaps the table of entries"),
        (entry("A2M0", "II", DESC + 4, 40), "x.icc", "overlaps tag 'desc'"),
        (entry("A2M0", "I", DESC), "x.icc", "overlaps tag"),
        (entry("A2M0", "II", A2M0, 0), "tag 'A2M0'", "too few for a tag type"),
        (entry("A2M0", "II", A2M0, 7), "tag 'A2M0'", "too few for a tag type"),
        (entry("A2M0", "II", A2M0, 12), "tag 'A2M0'", "16 are needed"),
        (put("A2M0", 12, "I", 2**32 - 1), "tag 'A2M0'", "more than 65536"),
        (put("A2M0", 12, "I", 60_000), "tag 'A2M0'", "60000 entries of 8 bytes"),
        (put("A2M0", 16, "I", 2**32 - 8), "tag 'A2M0'", "element 0 takes bytes"),
        (put("A2M0", 20, "I", 2**32 - 8), "tag 'A2M0'", "element 0 takes bytes"),
        (put("A2M0", 16, "I", 0), "tag 'A2M0'", "element 0 at byte 0 overlaps"),
        (put("A2M0", 20, "I", 8), f"tag 'A2M0' at byte {A2M0}, element 0 at byte 24", "12 bytes"),
        (put("A2M0", 24 + 12, "I", 2**32 - 1), "element 0", "sub-elements"),
        (put("A2M0", 24 + 16, "I", 0), "element 0", "outside the element"),
        (put("A2M0", 24 + 24 + 8, "I", 2**31), "element 0", "operations are claimed"),
        (put("A2M0", 24 + 24 + 12, "4s", b"what"), "element 0", "no operator"),
        (put("A2M0", 24 + 24 + 12, "4sI", b"if  ", 9), "element 0", "claims 9 operations"),
        (put("desc", 8, "I", 2**20), "tag 'desc'", "more than 65536"),
        (put("desc", 8, "I", 60_000), "tag 'desc'", "60000 entries of 12 bytes"),
        (put("desc", 8, "I", 3), "tag 'desc'", "overlaps the table of entries"),
        (put("desc", 12, "I", 0), "tag 'desc'", "records of 0 bytes"),
        (put("desc", 20, "I", 2**31), "tag 'desc'", "text 'enUS' takes bytes"),
        (put("desc", 20, "I", 1), "tag 'desc'", "not UTF-16"),
        (put("desc", 28, "H", 0xD800), "tag 'desc'", "not UTF-16"),
        (put("mcta", 12, "I", 50), "tag 'mcta'", "50 entries"),
        (put("mcta", 16, "I", 4), "tag 'mcta'", "name 0 at byte 4 overlaps the table"),
        (put("mcta", 40, "4s", b"mluc"), "name 0", "an entry of type b'mluc'"),
        (put("mcta", 48, "B", 0xFF), "name 0 at byte 40", "not UTF-8: invalid start byte"),
        (put("mcta", 51, "B", 65), "name 0", "no terminating NUL"),
        (put("mcta", 49, "B", 0), "name 0", "goes on after its terminating NUL"),
        (put("meta", 12, "I", 17), "tag 'meta'", "records of 17 bytes"),
        (put("meta", 8, "I", 100), "tag 'meta'", "100 entries"),
        (put("meta", 24, "II", 16, 8), "tag 'meta'", "value 0 at byte 16 overlaps"),
    ],
)
def test_every_class_of_fault_has_its_message(data, where, message):
    error = refused(data)
    assert error.where is not None
    assert error.where.startswith("x.icc")
    assert where in error.where
    assert message in error.message


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
