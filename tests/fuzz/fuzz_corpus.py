"""What the fuzzer begins with: small inputs that are right, of every kind that brdfc reads."""

from __future__ import annotations

import struct
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import brdfc
from brdfc.calc.appearance import AppearanceTransform
from brdfc.calc.calculator_curves import CalculatorCurve
from brdfc.calc.curves import CurveSet, SegmentedCurve
from brdfc.calc.program import Op, OpaqueElement, Program
from brdfc.calc.samples import Samples
from brdfc.calc.text import assemble, disassemble
from brdfc.calc.tints import TintArray
from brdfc.icc.header import D50, Header
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import multiplex_space
from brdfc.icc.types import NumberArray, Opaque, Pipeline, Tag, Utf8Array, XYZArray
from brdfc.xml.profile import encoded, load_xml, to_xml

TESTS = Path(__file__).parents[1]
sys.path += [str(TESTS), str(TESTS / "icc"), str(TESTS / "calc")]

from calc_elements import FORMULAS, LINE, SAMPLED, SEGMENTED, SHARED, TABLES  # noqa: E402
from calc_programs import random_program  # noqa: E402
from icc_profiles import V2, V4, display, gray, link, named, printer  # noqa: E402
from icc_samples import MINIMAL_MID, mid, mvis  # noqa: E402

EXAMPLES = TESTS.parent / "examples" / "xml"
"""Documents stand here, so that those which import others find them."""


@cache
def profiles(whole: bool = True) -> tuple[bytes, ...]:
    """Profiles of every element and tag type that brdfc reads; whole: and of every layout that it
    writes, from models that are compiled now."""
    return (
        MINIMAL_MID,
        *(p.to_bytes() for p in (mid(), mvis(), elements(), carried())),
        *(p.to_bytes() for p in older() if len(p.to_bytes()) < MOST),
        *(with_program(random_program(seed, length=30)).to_bytes() for seed in (0, 1, 4)),
        *(encoded(load_xml(EXAMPLES / name)) for name in ("inks.xml", "display.xml")),
        *(profile.to_bytes() for profile in (compiled() if whole else ())),
    )


@cache
def documents(whole: bool = True) -> tuple[bytes, ...]:
    """XML as brdfc writes it, and as people do: with imports, macros, variables and names."""
    written = [to_xml(Profile.from_bytes(data)).encode() for data in profiles(whole)]
    return (*(path.read_bytes() for path in sorted(EXAMPLES.glob("*.xml"))), *written)


@cache
def texts(whole: bool = True) -> tuple[bytes, ...]:
    """Calculator texts: the goldens, which come from models, and programs with every operator."""
    golden = [
        path.read_bytes()
        for path in sorted((TESTS / "golden").glob("*.calc"))[:: 4 if whole else 20]
    ]
    drawn = [disassemble(random_program(seed).body).encode() for seed in range(8)]
    return (*golden, *drawn, b"{ in(0) 2 sel case { 1 } case { 2 } dflt { } % all\n out[0] }")


CORPORA: dict[str, Callable[[bool], tuple[bytes, ...]]] = {
    "profile": profiles,
    "document": documents,
    "text": texts,
}
"""What each target begins with; all of it, or what is soon made."""


def compiled() -> Iterator[Profile]:
    """Profiles of models, each layout once; the formula as it is written, which is soon done."""
    lambert, ward = brdfc.load("lambert"), brdfc.load("ward")
    angles = {"incident": 0.5, "reflection": 0.25}
    for compiled in (
        brdfc.compile(lambert, effort=1),
        brdfc.compile(brdfc.load("lambert", spectral="400nm..700nm,60nm"), effort=1),
        brdfc.compile(ward, channels=("incident", "reflection"), effort=1),
        brdfc.compile(lambert, effort=1, encode="ncolour"),
        brdfc.compile(brdfc.load("ward", "full"), effort=1, encode="brdf-function"),
        brdfc.compile(ward, effort=1, encode="brdf-struct"),
        brdfc.compile(ward, set=angles, effort=1, encode="curve:9", max_error="100dE"),
    ):
        yield from compiled.profiles


MOST = 6000
"""Bytes of a profile that a mutation still finds the parts of."""


def older() -> Iterator[Profile]:
    """Profiles of versions 2 and 4, of every tag type of theirs."""
    for version in (V2, V4):
        for make in (display, printer, gray, named, link):
            yield make(version)


def with_program(program: Program) -> Profile:
    """An MVIS with this program."""
    names = tuple(f"c{i}" for i in range(program.inputs))
    tags = {
        "wtpt": XYZArray((D50,)),
        "mcta": Utf8Array(names),
        "M2B0": Pipeline(program.inputs, program.outputs, (program,)),
    }
    return Profile(Header("mvis", pcs=b"XYZ ", mcs=multiplex_space(program.inputs)), tags)


def elements() -> Profile:
    """Curves and tables of every kind, in a pipeline and called from a calculator, one of them
    twice."""
    sampled = list(SAMPLED.values())[::4]
    curves = CurveSet((sampled[0], SEGMENTED[0], SegmentedCurve((0.5,), (LINE, FORMULAS[1]))))
    called = (SHARED, curves, *(t for t in TABLES if t.inputs == 2), *(t for t in TABLES[:4]))
    calls = "in[0,3] curv(0) curv(1) pop clut(2) pop clut(3) out[0,3]"
    inner = Program(3, 3, assemble(f"{{ {calls} }}"), called)
    twice = Program(
        3, 3, (Op("in", 0, 3), Op("calc", 0), Op("calc", 1), Op("out", 0, 3)), (inner,) * 2
    )
    return Profile(with_program(twice).header, {"M2B0": Pipeline(3, 3, (curves, twice, curves))})


def carried() -> Profile:
    """Arrays of every number, and types of tags, elements and curves that are not run."""
    kinds = ("fl16", "fl32", "fl64", "ui08", "ui16", "ui32", "ui64")
    tags: dict[str, Tag] = {kind: NumberArray(kind, (0, 1, 2)) for kind in kinds}
    tags["text"] = Opaque(b"text" + bytes(4) + b"carried\0")
    elements = (
        CurveSet((CalculatorCurve(9, 0.0, 1.0, Program(1, 1, assemble("{ in out }"))),)),
        TintArray(3, Samples.of((0, 0, 0, 1, 1, 1))),
        AppearanceTransform("XtoJ", (0.96, 1, 0.82), 60, 20, 0.69, 1, 1),
        OpaqueElement("emtx", 3, 1, struct.pack(">4sIHH", b"emtx", 0, 3, 1) + bytes(20)),
    )
    tags["D2B0"] = Pipeline(1, 1, elements)
    return Profile(Header("scnr", colour_space=b"GRAY", pcs=b"XYZ "), tags)
