"""Every class of bad profile: what a file may claim, and the one error that `brdfc eval` gives.

Each is refused within a second, and all of them together by a process that stays small, whatever
they claim. A right profile is built here byte by byte, and one thing in it made wrong.
"""

from __future__ import annotations

import json
import re
import struct
import subprocess
import sys
from pathlib import Path

import pytest
from icc_parts import (
    GOOD,
    IN,
    OUT,
    array,
    calc,
    conditions,
    curves,
    entry,
    header,
    jump,
    nested,
    op,
    profile,
    put,
    segments,
    structure,
    table,
    within,
)
from icc_samples import entry_of, patched, tag_start

from brdfc.icc.profile import Profile

SECONDS = 1.0
MEGABYTES = 200
HUGE = 2**32 - 1
NAN, INFINITY = float("nan"), float("inf")


FIRST = tag_start(GOOD, "desc")
ELEMENT = "tag 'A2B0', element 0"
CALC = 16 + 4 * 8  # where the first of four elements begins in the tag, as in GOOD
ONE = 16 + 8  # and where the only one begins

# What is wrong: the bytes, the place that the error names, and what it says.
CASES: dict[str, tuple[bytes, str, str]] = {
    # the file
    "header: fewer bytes": (GOOD[:-4], "header at byte 0", "truncated: the header says"),
    "header: more bytes": (GOOD + bytes(4), "header at byte 0", "bytes after the end"),
    "header: no tag table": (patched(GOOD[:131], 0, "I", 131), "x.icc", "truncated: 131 bytes"),
    "header: range": (patched(GOOD, 104, "H", 0x7E00), "header at byte 104", "not a finite number"),
    # the table of tags
    "tags: more than bytes": (patched(GOOD, 128, "I", 1000), "tag table", "1000 entries of 12"),
    "tags: 2^32 - 1": (patched(GOOD, 128, "I", HUGE), "tag table", "more than 65536"),
    "tag: size wraps": (entry("A2B0", "II", FIRST, HUGE - 3), "x.icc", "tag 'A2B0' takes bytes"),
    "tag: offset wraps": (entry("A2B0", "II", HUGE - 3, 64), "x.icc", "past the end"),
    "tag: is the header": (entry("A2B0", "II", 0, 64), "x.icc", "overlaps the table of entries"),
    "tag: is the table": (entry("A2B0", "II", 128, 64), "x.icc", "overlaps the table of entries"),
    "tag: overlaps": (entry("A2B0", "II", FIRST + 4, 40), "x.icc", "overlaps tag 'desc'"),
    "tag: part of another": (entry("A2B0", "I", FIRST), "x.icc", "overlaps tag"),
    "tag: no bytes": (entry("A2B0", "II", FIRST, 0), "tag 'A2B0'", "too few for a tag type"),
    "tag: 7 bytes": (entry("A2B0", "II", tag_start(GOOD, "A2B0"), 7), "tag 'A2B0'", "too few for"),
    # texts
    "text: records": (put(GOOD, "desc", 8, "I", 2**20), "tag 'desc'", "more than 65536"),
    "text: records than bytes": (put(GOOD, "desc", 8, "I", 60_000), "tag 'desc'", "60000 entries"),
    "text: in its own table": (put(GOOD, "desc", 8, "I", 3), "tag 'desc'", "overlaps the table"),
    "text: record size": (put(GOOD, "desc", 12, "I", 0), "tag 'desc'", "records of 0 bytes"),
    "text: size": (put(GOOD, "desc", 20, "I", 2**31), "tag 'desc'", "text 'enUS' takes bytes"),
    "text: half a character": (put(GOOD, "desc", 20, "I", 1), "tag 'desc'", "not UTF-16"),
    "text: half a pair": (put(GOOD, "desc", 28, "H", 0xD800), "tag 'desc'", "not UTF-16"),
    "dictionary: record size": (put(GOOD, "meta", 12, "I", 17), "tag 'meta'", "of 17 bytes"),
    "dictionary: records": (put(GOOD, "meta", 8, "I", 100), "tag 'meta'", "100 entries"),
    "dictionary: value": (put(GOOD, "meta", 24, "II", 16, 8), "tag 'meta'", "value 0 at byte 16 o"),
    # arrays, and structures
    "array: count": (put(GOOD, "mcta", 12, "I", 50), "tag 'mcta'", "50 entries of 8 bytes"),
    "array: contains itself": (
        put(GOOD, "mcta", 16, "I", 0),
        "tag 'mcta'",
        "name 0 at byte 0 over",
    ),
    "array: another type": (put(GOOD, "mcta", 40, "4s", b"mluc"), "tag 'mcta', name 0", "b'mluc'"),
    "array: bad UTF-8": (
        profile(namd=array(b"\xff\0")),
        "tag 'namd', name 0",
        "not UTF-8: invalid",
    ),
    "array: no terminator": (profile(namd=array(b"A")), "tag 'namd', name 0", "no terminating NUL"),
    "array: after the end": (profile(namd=array(b"A\0B\0")), "tag 'namd', name 0", "goes on after"),
    "utf8: no terminator": (
        profile(text=b"utf8" + bytes(4) + b"A"),
        "tag 'text'",
        "no terminating",
    ),
    "numbers: NaN": (put(GOOD, "mdv ", 12, "f", NAN), "tag 'mdv '", "value 1 is nan, not a finite"),
    "numbers: infinite": (put(GOOD, "mdv ", 8, "f", INFINITY), "tag 'mdv '", "value 0 is inf"),
    "numbers: half of one": (profile(numb=b"fl32" + bytes(6)), "tag 'numb'", "no whole count of"),
    "numbers: too many": (profile(numb=b"ui08" + bytes(70_000)), "tag 'numb'", "more than 65536"),
    "structure: members": (profile(strc=structure(b"", 999)), "tag 'strc'", "999 entries of 12"),
    "structure: contains itself": (
        profile(strc=structure(bytes(28), offset=0)),
        "tag 'strc'",
        "member 'type' at byte 0 overlaps the table of entries",
    ),
    "structure: deep": (profile(strc=within(12)), "tag 'strc', member 'type'", "more than 8 deep"),
    "conditions: more than bytes": (
        profile(svcn=conditions(steps=65535)),
        "tag 'svcn'",
        "786440 are needed",
    ),
    "conditions: range": (profile(svcn=conditions(start=NAN)), "tag 'svcn'", "not a finite number"),
    "conditions: spectrum": (
        profile(svcn=conditions(value=INFINITY)),
        "tag 'svcn'",
        "not a finite",
    ),
    # elements
    "elements: count": (put(GOOD, "A2B0", 12, "I", HUGE), "tag 'A2B0'", "more than 65536"),
    "elements: than bytes": (put(GOOD, "A2B0", 12, "I", 60_000), "tag 'A2B0'", "60000 entries"),
    "element: offset wraps": (
        put(GOOD, "A2B0", 16, "I", HUGE),
        "tag 'A2B0'",
        "element 0 takes byt",
    ),
    "element: size wraps": (
        put(GOOD, "A2B0", 20, "I", HUGE),
        "tag 'A2B0'",
        "element 0 takes bytes",
    ),
    "element: contains itself": (
        put(GOOD, "A2B0", 16, "I", 0),
        "tag 'A2B0'",
        "element 0 at byte 0",
    ),
    "element: overlaps": (put(GOOD, "A2B0", 24, "I", CALC + 4), "tag 'A2B0'", "overlaps element 0"),
    "element: no header": (put(GOOD, "A2B0", 20, "I", 8), ELEMENT, "an element needs 12 bytes"),
    "matrix: than bytes": (
        profile(header("matf", 65535, 65535)),
        ELEMENT,
        "does not fit its bytes",
    ),
    "matrix: NaN": (
        profile(header("matf") + struct.pack(">12f", NAN, *[1] * 11)),
        ELEMENT,
        "the matrix holds NaN or infinity",
    ),
    # curves and lookup tables
    "curves: in is not out": (profile(header("cvst", 3, 4)), ELEMENT, "3 inputs and 4 outputs"),
    "curves: than bytes": (profile(header("cvst", 999, 999)), ELEMENT, "999 curves are claimed"),
    "curve: contains its set": (
        put(profile(curves()), "A2B0", ONE + 12, "I", 0),
        ELEMENT,
        "part 0 at 0",
    ),
    "curve: no point": (profile(curves(count=0)), f"{ELEMENT}, curve 0", "of 0 points"),
    "curve: one point": (profile(curves(count=1)), f"{ELEMENT}, curve 0", "of 1 points"),
    "curve: 2^32 - 1 points": (profile(curves(count=HUGE)), f"{ELEMENT}, curve 0", "are claimed"),
    "curve: range of NaN": (profile(curves(first=NAN)), f"{ELEMENT}, curve 0", "from nan to 1"),
    "curve: infinite range": (profile(curves(last=INFINITY)), f"{ELEMENT}, curve 0", "to inf"),
    "curve: empty range": (profile(curves(first=1)), f"{ELEMENT}, curve 0", "from 1 to 1"),
    "curve: NaN": (profile(curves(low=NAN)), f"{ELEMENT}, curve 0", "sample 0 is NaN or infinite"),
    "segments: order": (profile(segments((1, 0))), f"{ELEMENT}, curve 0", "do not ascend"),
    "segments: NaN": (profile(segments((NAN,))), f"{ELEMENT}, curve 0", "do not ascend"),
    "segments: than bytes": (
        put(profile(segments(())), "A2B0", ONE + 36 + 8, "H", 65535),
        f"{ELEMENT}, curve 0",
        "65535 segments are claimed",
    ),
    "segment: parameter": (
        profile(segments((), (INFINITY, 1, 0, 0))),
        f"{ELEMENT}, curve 0, segment 0",
        "a parameter is NaN or infinite",
    ),
    "table: no grid point": (profile(table((2, 0, 2))), ELEMENT, "2 to 255 points for each of 3"),
    "table: one grid point": (profile(table((1, 2, 2))), ELEMENT, "2 to 255 points for each of 3"),
    "table: product": (profile(table((255,) * 16)), ELEMENT, "numbers (FLOAT32) are claimed"),
    "table: 17 inputs": (profile(table((2,) * 17)), ELEMENT, "1 to 16 inputs"),
    "table: than bytes": (profile(table(numbers=23)), ELEMENT, "24 numbers (FLOAT32) are claimed"),
    "table: NaN": (profile(table(low=NAN)), ELEMENT, "sample 0 is NaN or infinite"),
    # calculators
    "calc: sub-elements": (
        put(GOOD, "A2B0", CALC + 12, "I", HUGE),
        ELEMENT,
        "4294967295 sub-elements are claimed, more than fit",
    ),
    "calc: main contains it": (put(GOOD, "A2B0", CALC + 16, "I", 0), ELEMENT, "part 0 at 0"),
    "calc: contains itself": (
        put(profile(calc(IN, OUT, parts=(table(),))), "A2B0", ONE + 24, "I", 0),
        ELEMENT,
        "part 1 at 0",
    ),
    "calc: part wraps": (
        put(profile(calc(IN, OUT, parts=(table(),))), "A2B0", ONE + 28, "I", HUGE - 15),
        ELEMENT,
        "lies outside the element",
    ),
    "calc: a part's fault": (
        profile(calc(IN, OUT, parts=(table((1, 2, 2)),))),
        f"{ELEMENT}, sub-element 0",
        "2 to 255 points",
    ),
    "calc: deep": (profile(nested(300)), f"{ELEMENT}, sub-element 0", "nest deeper than 64"),
    "calc: 2^60 calls": (profile(nested(60, 2)), ELEMENT, "more than 10,000,000 steps"),
    "calc: operations": (
        put(GOOD, "A2B0", CALC + 32, "I", HUGE),
        f"{ELEMENT}, main function",
        "4294967295 operations are claimed, more than fit",
    ),
}


def program(*words: bytes, at: int, message: str) -> tuple[bytes, str, str]:
    """A calculator whose operation `at` is wrong."""
    return profile(calc(*words)), f"{ELEMENT}, op {at}", message


CASES |= {
    "op: none of this name": program(op("nope"), at=0, message="no operator has the signature"),
    "op: no name": program(IN, op("\0\1"), at=1, message="no operator has the signature"),
    "if: past the end": program(IN, jump("if", 2), OUT, at=1, message="'if' claims 2 operations"),
    "if: 2^32 - 1": program(
        IN, jump("if", HUGE), OUT, at=1, message="claims 4294967295 operations"
    ),
    "if: out of its block": program(
        *(IN, jump("if", 2), op("pi"), jump("if", 1), OUT), at=3, message="0 are left in its block"
    ),
    "if: deep": program(
        *[jump("if", 1999 - i) for i in range(2000)], at=65, message="blocks nest deeper than 64"
    ),
    "else: past the end": program(
        *(IN, jump("if", 1), jump("else", 9), OUT), at=2, message="'else' claims 9 operations"
    ),
    "else: without if": program(IN, jump("else", 1), OUT, at=1, message="'else' without what it"),
    "case: without sel": program(IN, jump("case", 1), OUT, at=1, message="'case' without what it"),
    "dflt: without sel": program(IN, jump("dflt", 1), OUT, at=1, message="'dflt' without what it"),
    "sel: without case": program(IN, jump("sel"), OUT, at=1, message="'sel' without a 'case'"),
    "case: past the end": program(
        *(IN, jump("sel"), jump("case", 2), OUT), at=2, message="'case' claims 2 operations"
    ),
    "in: a channel too many": program(op("in", 1, 2), at=0, message="channel 3; there are 3"),
    "in: 65536 channels": program(op("in", 65535, 65535), at=0, message="reaches channel 131070"),
    "out: a channel too many": program(IN, op("out", 3), at=1, message="channel 3; there are 3"),
    "tput: past the last": program(
        IN, op("tput", 65535, 1), at=1, message="temporary 65536; there are 65536"
    ),
    "tget: not written": program(op("tget", 7), at=0, message="temporary 7 is read"),
    "copy: huge": program(IN, op("copy", 0, 65535), at=1, message="the stack grows beyond 65535"),
    "posd: huge": program(IN, op("posd", 65535, 1), at=1, message="'posd' needs 65536 values"),
    "rotl: huge": program(IN, op("rotl", 65535), at=1, message="'rotl' needs 65536 values"),
    "sum: huge": program(IN, op("sum", 65535), at=1, message="'sum' needs 65537 values"),
    "solv: huge": program(IN, op("solv", 65535, 65535), at=1, message="needs 4295032832 values"),
    "solv: one row": program(IN, op("solv", 0, 0), at=1, message="is undefined in the reference"),
    "tran: huge": program(IN, op("tran", 65535, 65535), at=1, message="needs 4294967296 values"),
    "add: no values": program(op("add"), at=0, message="'add' needs 2 values, 0 are on the stack"),
    "calc: calls none": program(IN, op("calc"), OUT, at=1, message="sub-element 0; there are 0"),
    "mtx: calls no matrix": (
        profile(calc(IN, op("mtx"), OUT, parts=(table(),))),
        f"{ELEMENT}, op 1",
        "'mtx' needs a 'matf' element, sub-element 0 is a 'clut'",
    ),
    "out: not written": (profile(calc(IN)), ELEMENT, "output 0 is not written on every path"),
    "out: on one path": (
        profile(calc(IN, jump("if", 1), OUT)),
        f"{ELEMENT}, op 2",
        "'out' needs 3 values, 2 are on the stack",
    ),
}


# --- what becomes of them ------------------------------------------------------------------------

RUN = """
import json, sys, time
from brdfc.cli.main import cli
from brdfc.source.errors import BrdfcError

def answer(path):
    started = time.process_time()
    try:
        cli.main(["eval", path, "--pixel", "0.1,0.2,0.3"], standalone_mode=False)
        return ["", "", 0]
    except BrdfcError as error:
        return [error.where or "", error.message, time.process_time() - started]

answers = [answer(path) for path in sys.argv[1:]]
try:
    lines = open("/proc/self/status").read().splitlines()
    peak = next(int(line.split()[1]) for line in lines if line.startswith("VmHWM"))
except OSError:
    peak = None
print("\\n" + json.dumps([peak, answers]))
"""


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> tuple[int, dict[str, list]]:
    """Kilobytes at most, and where, what and how soon the program says of each file; one process
    takes them all, the right one first."""
    folder = tmp_path_factory.mktemp("bad")
    paths = {}
    for index, (name, data) in enumerate(
        {"right": GOOD, **{n: c[0] for n, c in CASES.items()}}.items()
    ):
        paths[name] = folder / f"x{index}.icc"
        paths[name].write_bytes(data)
    done = subprocess.run(
        [sys.executable, "-c", RUN, *map(str, paths.values())],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    peak, found = json.loads(done.stdout.splitlines()[-1])
    return peak, dict(zip(paths, found, strict=True))


def test_the_right_one(answers: tuple[int, dict[str, list]]) -> None:
    assert answers[1]["right"] == ["", "", 0]


@pytest.mark.parametrize("name", CASES)
def test_one_error_that_names_the_place_and_soon(
    name: str, answers: tuple[int, dict[str, list]]
) -> None:
    _, place, expected = CASES[name]
    where, message, seconds = answers[1][name]
    assert expected in message
    words = [re.escape(word) for word in place.split(", ")]
    assert re.search(".*, ".join(words).replace("x\\.icc", r"x\d+\.icc"), where)
    assert seconds < SECONDS


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="memory is read from /proc")
def test_none_takes_much_memory(answers: tuple[int, dict[str, list]]) -> None:
    assert answers[0] < MEGABYTES * 1024


def test_tags_may_be_one() -> None:
    """Overlapping is legal only where two are the same."""
    start, size = struct.unpack_from(">II", GOOD, entry_of(GOOD, "desc") + 4)
    read = Profile.from_bytes(entry("cprt", "II", start, size))
    assert read.tags["cprt"] is read.tags["desc"]
