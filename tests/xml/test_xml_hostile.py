"""Documents that mean harm: one error that shows the line, soon and in little memory."""

from __future__ import annotations

import contextlib
import gc
import subprocess
import sys
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from xml_samples import calculator, document, pipeline, read

from brdfc.calc.program import Program
from brdfc.calc.text import assemble
from brdfc.icc.header import Header
from brdfc.icc.profile import Profile
from brdfc.icc.types import Pipeline
from brdfc.inspection import inspect
from brdfc.source.errors import BrdfcError
from brdfc.xml.document import SIZE_LIMIT
from brdfc.xml.profile import to_xml

SECONDS = 2.0
MEGABYTES = 200


def refused(data: bytes) -> str:
    gc.freeze()  # what the other tests have left is not walked over again while this is read
    started = time.process_time()
    with pytest.raises(BrdfcError) as caught:
        read(data)
    took = time.process_time() - started
    gc.unfreeze()
    assert took < SECONDS
    message = str(caught.value)
    assert len(message) < 2000
    return message


def element(tag: str, channels: str, inside: str, attributes: str = "") -> bytes:
    inputs, outputs = channels.split()
    return pipeline(
        f'<{tag} InputChannels="{inputs}" OutputChannels="{outputs}" {attributes}>{inside}</{tag}>'
    )


BOMB = b"""<?xml version="1.0"?>
<!DOCTYPE IccProfile [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">]>
<IccProfile>&b;</IccProfile>"""
FILE = b'<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/passwd">]>\n<IccProfile>&x;</IccProfile>'
TABLE = "<GridPoints>2 2</GridPoints><TableData>{}</TableData>"


def curve(start: str, end: str, kind: int, parameters: str) -> bytes:
    ends = f'Start="{start}" End="{end}"'
    segment = f'<FormulaSegment {ends} FunctionType="{kind}">{parameters}</FormulaSegment>'
    return element("CurveSetElement", "1 1", f"<SegmentedCurve>{segment}</SegmentedCurve>")


def matrix(channels: str, numbers: str, attributes: str = "") -> bytes:
    data = f"<MatrixData {attributes}>{numbers}</MatrixData>"
    return element("MatrixElement", channels, data if numbers else "")


def array(kind: str, tag: str, numbers: str) -> bytes:
    inside = f"<{kind}><{tag}>{numbers}</{tag}></{kind}>"
    return document(f"<spectralWhitePointTag>{inside}</spectralWhitePointTag>")


def private(kind: str, data: str) -> bytes:
    inside = f'<PrivateType type="{kind}"><UnknownData>{data}</UnknownData></PrivateType>'
    return document(f'<PrivateTag TagSignature="abcd">{inside}</PrivateTag>')


def header(tag: str, inside: str) -> bytes:
    return document("", f"<Header><{tag}>{inside}</{tag}></Header>")


def macros(count: int, text: str) -> bytes:
    """Macros of which each calls the one before it, as the text says."""
    listed = ['<Macro Name="m0">1 pop</Macro>']
    for i in range(count):
        listed.append(f'<Macro Name="m{i + 1}">{text.format(i)}</Macro>')
    return calculator(f"{{ #m{count} }}", f"<Macros>{''.join(listed)}</Macros>")


LARGE_TABLE = f"<GridPoints>{'255 ' * 16}</GridPoints><TableData>1</TableData>"
OUTSIDE = '<GridPoints>2 2</GridPoints><TableData Filename="../../etc/passwd"/>'
MANY_ATTRIBUTES = " ".join(f'a{i}=""' for i in range(50_000))
TEXT = "<copyrightTag><utf8Type><TextData>a</TextData></utf8Type></copyrightTag>"

CASES: dict[str, tuple[bytes, str]] = {
    "entity bomb": (BOMB, "x.xml:2:1: error: a document type is not read"),
    "external entity": (FILE, "x.xml:1:1: error: a document type is not read"),
    "undeclared entity": (
        document("&x;"),
        "x.xml:9:1: error: not well-formed XML: undefined entity",
    ),
    "empty": (b"", "not well-formed XML: no element found"),
    "no XML": (b"\0\1\2", "not well-formed XML"),
    "bad UTF-8": (b"<IccProfile>\n\n\xff</IccProfile>", "x.xml:3: not UTF-8: invalid start byte"),
    "another encoding": ("<a>".encode("utf-16"), "not UTF-8"),
    "another root": (b"<svg/>", "a profile is an <IccProfile>, not a <svg>"),
    "no tags": (b"<IccProfile><Header/></IccProfile>", "holds <Header> and <Tags>"),
    "too large": (b"<a>" + b" " * SIZE_LIMIT, "8,388,611 bytes are more than 8,388,608"),
    "deep": (document("<a>" * 10_000), "elements nest deeper than 200"),
    "many": (document("<a/>" * 300_000), "more than 150,000 elements"),
    "attributes": (document(f"<a {MANY_ATTRIBUTES}/>"), "more than 100 attributes"),
    "long name": (document(f"<{'a' * 5_000_000}/>"), "a name of 5,000,000 characters"),
    "long attribute": (
        document(f'<AToB1Tag SameAs="{"a" * 5_000_000}"/>'),
        "x.xml:9:1: error: 'aaaaaaa",
    ),
    "unknown tag": (document("<AToB9Tag/>"), "x.xml:9:1: error: <AToB9Tag> is not read here"),
    "no type": (document("<AToB1Tag/>"), "x.xml:9:1: error: one type stands in a tag, not 0"),
    "unknown type": (
        document("<AToB1Tag><lutAtoBType/></AToB1Tag>"),
        "<lutAtoBType> is not read here",
    ),
    "same as none": (document('<AToB1Tag SameAs="AToB0Tag"/>'), "no tag 'A2B0' stands before"),
    "twice": (document(TEXT * 2), "stands here twice"),
    "private tag": (document('<PrivateTag TagSignature="abcde"/>'), "a signature is four"),
    "no hexadecimal": (private("abcd", "0"), "not hexadecimal"),
    "bad bytes": (private("mpet", "00000000ffffffffffffffff"), "entries, more than"),
    "unknown element": (
        pipeline("<Emission/>"),
        "<Emission> cannot stand in <MultiProcessElements>",
    ),
    "no channels": (
        pipeline("<MatrixElement/>"),
        "<MatrixElement> needs the attribute 'InputChannels'",
    ),
    "many channels": (
        element("MatrixElement", "70000 1", ""),
        "InputChannels is a whole number from 0 to 65535",
    ),
    "negative channels": (element("MatrixElement", "-1 1", ""), "InputChannels is a whole number"),
    "misspelt attribute": (
        element("MatrixElement", "1 1", "", 'Invert="true"'),
        "has no attribute 'Invert'",
    ),
    "matrix of nothing": (
        element("MatrixElement", "65535 65535", ""),
        "a matrix of zeros has at most",
    ),
    "matrix too short": (matrix("2 2", "1 2 3"), "3 numbers, where 4 are needed"),
    "matrix of NaN": (matrix("1 2", "1\n nan"), "x.xml:11:2: error: 'nan' is not a finite number"),
    "matrix of words": (matrix("1 2", "1 2,5"), "'2,5' is not a finite number"),
    "matrix of infinity": (matrix("1 2", "1 1e99"), "holds NaN or infinity"),
    "singular": (matrix("2 2", "1 2 2 4", 'InvertMatrix="true"'), "this matrix has no inverse"),
    "large inverse": (
        matrix("300 300", "1 " * 90000, 'InvertMatrix="true"'),
        "only a square matrix is inverted",
    ),
    "table too large": (element("CLutElement", "16 65535", LARGE_TABLE), "1 numbers, where "),
    "table of one point": (
        element("CLutElement", "2 1", "<GridPoints>1 2</GridPoints><TableData/>"),
        "2 to 255 points",
    ),
    "table of NaN": (
        element("CLutElement", "2 1", TABLE.format("1 2 3 NaN")),
        "'NaN' is not a finite number",
    ),
    "table beyond 0..1": (
        element("ExtCLutElement", "2 1", TABLE.format("1 2 3 4"), 'StorageType="3"'),
        "holds numbers from 0 to 1 only",
    ),
    "storage": (
        element("ExtCLutElement", "2 1", TABLE.format("1 2 3 4"), 'StorageType="4"'),
        "StorageType is a whole number from 0 to 3",
    ),
    "file": (element("CLutElement", "2 1", OUTSIDE), "lies outside the folder"),
    "grid of fractions": (
        element("CLutElement", "1 1", "<GridPoints>1e300</GridPoints><TableData/>"),
        "2 to 255 points",
    ),
    "too few curves": (element("CurveSetElement", "3 3", ""), "3 channels in, 3 out, 0 curves"),
    "duplicate of none": (
        element("CurveSetElement", "1 1", '<DuplicateCurve Index="0"/>'),
        "no curve before this one has the index 0",
    ),
    "curve with a gap": (
        curve("0", "+inf", 0, "1 1 0 0"),
        "this segment starts at 0, where -inf is expected",
    ),
    "curve without end": (curve("-inf", "1", 0, "1 1 0 0"), "the last segment ends at +infinity"),
    "unknown formula": (curve("-inf", "+inf", 9, "1"), "no formula segment has the type 9"),
    "too few parameters": (curve("-inf", "+inf", 0, "1"), "takes 4 parameters, not 1"),
    "huge array": (
        array("float32ArrayType", "Data", "0 " * 2_000_000),
        "2,000,000 numbers are more than 65,536",
    ),
    "late word": (
        array("float32ArrayType", "Data", "0 " * 2_000_000 + "x"),
        "'x' is not a finite number",
    ),
    "whole numbers": (array("uInt8ArrayType", "Array", "1 256"), "'ui08' cannot hold a value"),
    "date": (header("CreationDateTime", "yesterday"), "x.xml:2:11: error: a date is written"),
    "version": (header("ProfileVersion", "five"), "a version is written 5.00"),
    "long space": (header("PCS", "CIELAB76"), "a signature is four Latin-1 characters"),
    "intent": (header("RenderingIntent", "Nice"), "an intent is Perceptual"),
    "illuminant": (
        header("PCSIlluminant", '<XYZNumber X="nan" Y="1" Z="1"/>'),
        "X is a number, not 'nan'",
    ),
    "range": (
        header("SpectralRange", '<Wavelengths start="1e9" end="2" steps="3"/>'),
        "a field does not fit",
    ),
    "macro bomb": (macros(40, "#m{0} #m{0}"), "macros make this more than 131,072 operations"),
    "macro chain": (macros(99, "#m{0}"), "macros call macros deeper than 64"),
    "long text": (calculator("{" + " 1 pop" * 150_000 + " }"), "more than 131,072 operations"),
    "deep blocks": (calculator("{" + "1 if { " * 100 + "}" * 101), "blocks nest deeper than 64"),
    "comments": (calculator("<!---->" * 1_000_000 + "{ 1 }"), "is over 4,194,304"),
}


@pytest.mark.parametrize("name", CASES)
def test_refused(name: str) -> None:
    data, message = CASES[name]
    assert message in refused(data)


def test_calculators_in_calculators() -> None:
    opening = '<CalculatorElement InputChannels="1" OutputChannels="1"><SubElements>'
    closing = "</SubElements><MainFunction>{ }</MainFunction></CalculatorElement>"
    assert "calculators nest deeper than 64" in refused(pipeline(opening * 80 + closing * 80))


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="memory is read from /proc")
@pytest.mark.parametrize("name", ["many", "attributes", "late word", "huge array", "long text"])
def test_memory(name: str, tmp_path: Path) -> None:
    """A process of its own: what the whole program takes."""
    path = tmp_path / "x.xml"
    path.write_bytes(CASES[name][0])
    code = (
        "from brdfc.cli.main import main\n"
        "try: main()\n"
        "finally: print(*(line for line in open('/proc/self/status') if 'VmHWM' in line))"
    )
    command = [sys.executable, "-c", code, "compile", str(path), "-o", str(tmp_path / "x.icc")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 1
    assert "Traceback" not in done.stderr
    assert int(done.stdout.split()[1]) < MEGABYTES * 1024
    assert not (tmp_path / "x.icc").exists()


PIECES = [b"", b"<", b">", b'"', b"{", b"}", b"[", b"9", b"\xff", b"#m "]


@settings(max_examples=200)
@given(st.data())
def test_damaged_documents_are_read_or_refused(data: st.DataObject) -> None:
    good = calculator(
        "{ in{a} #m mtx{M} tget{v.x} out[0,3] }",
        '<Variables><Declare Name="v">x y</Declare></Variables>'
        '<Macros><Macro Name="m" Local="t[2]">tput{@t} 1</Macro></Macros>'
        '<SubElements><MatrixElement Name="M" InputChannels="1" OutputChannels="1">'
        "<MatrixData>2</MatrixData></MatrixElement></SubElements>",
        'InputNames="a b c"',
    )
    at = data.draw(st.integers(0, len(good) - 1))
    length = data.draw(st.integers(0, 8))
    piece = data.draw(
        st.sampled_from([b"", b"<", b">", b'"', b"{", b"}", b"[", b"9", b"\xff", b"#m "])
    )
    with contextlib.suppress(BrdfcError):
        read(good[:at] + piece + good[at + length :])


# ---------------------------------------------------------------- profiles that mean harm


def shared(levels: int) -> Profile:
    """Calculators that each call the next one twice, from two places."""
    program = Program(1, 1, assemble("{ in out }"))
    for _ in range(levels):
        program = Program(1, 1, assemble("{ in calc(0) calc(1) out }"), (program, program))
    header = Header("scnr", colour_space=b"GRAY", pcs=b"XYZ ")
    return Profile(header, {"A2B0": Pipeline(1, 1, (program,))})


def test_elements_that_stand_for_more_than_there_is_room_for(tmp_path: Path) -> None:
    path = tmp_path / "x.icc"
    shared(50).save(path)
    assert path.stat().st_size < 10_000
    started = time.process_time()
    with pytest.raises(BrdfcError, match="as XML this profile is over"):
        to_xml(Profile.load(path))
    found = inspect(path, engine=False)
    assert time.process_time() - started < 2 * SECONDS
    (calculator_found,) = (p.calculator for p in found.transforms[0].elements)
    assert calculator_found is not None
    assert "a pixel may take more than" in str(calculator_found.refused)


def test_a_price_is_added_up_once_a_calculator(tmp_path: Path) -> None:
    path = tmp_path / "x.icc"
    shared(18).save(path)
    started = time.process_time()
    found = inspect(path, engine=False)
    assert time.process_time() - started < SECONDS
    calculator_found = found.transforms[0].elements[0].calculator
    assert calculator_found is not None
    assert calculator_found.nanoseconds is not None
    assert calculator_found.nanoseconds > 2**18
