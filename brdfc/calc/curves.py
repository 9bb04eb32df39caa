"""Curve sets (`cvst`): one curve a channel, and their bytes.

A curve is sampled at equal steps (`sngf`), put together from segments (`curf`), each a formula
(`parf`) or sampled at equal steps (`samf`), or sampled from a calculator (calculator_curves.py).
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

from brdfc.calc.calculator_curves import (
    CalculatorCurve,
    decode_calculator_curve,
    encode_calculator_curve,
)
from brdfc.calc.places import ENTRY, decode_parts, decode_places, encode_parts
from brdfc.calc.program import Element
from brdfc.calc.samples import Samples, Storage
from brdfc.source.errors import ProgramError

PARAMETERS = {0: 4, 1: 5, 2: 5, 3: 5, 4: 5, 5: 6, 6: 7, 7: 6}
"""How many parameters a formula segment of each type has (ICC.2, formulaCurveSegment; the formulas
stand in engine/curves.py). Types above 2 are unknown to ICC.1."""


@dataclass(frozen=True)
class FormulaSegment:
    """`parf`: a formula's type and its float32 parameters, in the order of the file."""

    type: int
    parameters: tuple[float, ...]


@dataclass(frozen=True)
class SampledSegment:
    """`samf`: values at equal steps up to the segment's end; the value at its start is what the
    segment before it gives there."""

    samples: Samples


Segment = FormulaSegment | SampledSegment


@dataclass(frozen=True)
class SegmentedCurve:
    """`curf`: segment k holds up to breaks[k], the last one without end. The first and the last are
    formulas."""

    breaks: tuple[float, ...]
    segments: tuple[Segment, ...]


@dataclass(frozen=True)
class SampledCurve:
    """`sngf`: values at equal steps from first to last. Beyond, the end values hold (clip), or the
    end lines go on (extend)."""

    first: float
    last: float
    samples: Samples
    extend: bool = False


Curve = SegmentedCurve | SampledCurve | CalculatorCurve


@dataclass(frozen=True)
class CurveSet:
    """`cvst`: a curve a channel; one object in two places is written once."""

    curves: tuple[Curve, ...]

    @property
    def inputs(self) -> int:
        return len(self.curves)

    @property
    def outputs(self) -> int:
        return len(self.curves)

    @property
    def signature(self) -> str:
        return "cvst"


def calculator_curves(element: Element) -> dict[int, CalculatorCurve]:
    """The curves of an element that are sampled from calculators, each once, by its first place."""
    curves = element.curves if isinstance(element, CurveSet) else ()
    places = {id(curve): place for place, curve in reversed(list(enumerate(curves)))}
    return {
        place: curve
        for place, curve in enumerate(curves)
        if isinstance(curve, CalculatorCurve) and places[id(curve)] == place
    }


def encode_curves(curves: CurveSet, encode: Callable[[Element], bytes]) -> bytes:
    """The element from its own signature on. encode: the bytes of a curve's calculator."""
    count = len(curves.curves)

    def encode_curve(curve: Curve) -> bytes:
        return _encode_curve(curve, encode)

    places, data = encode_parts(curves.curves, encode_curve, 12 + ENTRY * count)
    return struct.pack(">4sIHH", b"cvst", 0, count, count) + places + data


def _encode_curve(curve: Curve, encode: Callable[[Element], bytes]) -> bytes:
    where = "a curve"
    if isinstance(curve, CalculatorCurve):
        return encode_calculator_curve(curve, encode)
    if isinstance(curve, SampledCurve):
        _check_sampled(curve, where)
        storage = curve.samples.storage
        fields = (curve.samples.count, curve.first, curve.last, curve.extend, storage.code)
        return struct.pack(">4sIIffHH", b"sngf", 0, *fields) + curve.samples.data
    _check_segmented(curve, where)
    head = struct.pack(">4sIHH", b"curf", 0, len(curve.segments), 0)
    breaks = struct.pack(f">{len(curve.breaks)}f", *curve.breaks)
    return head + breaks + b"".join(map(_encode_segment, curve.segments))


def _encode_segment(segment: Segment) -> bytes:
    if isinstance(segment, SampledSegment):
        return struct.pack(">4sII", b"samf", 0, segment.samples.count) + segment.samples.data
    head = struct.pack(">4sIHH", b"parf", 0, segment.type, 0)
    return head + struct.pack(f">{len(segment.parameters)}f", *segment.parameters)


def decode_curves(
    data: bytes, inputs: int, outputs: int, where: str, decode: Callable[[bytes, str], Element]
) -> CurveSet:
    """The curve set that `data` begins with, its header of 12 bytes included. decode: the element
    that a curve is sampled from, of its bytes and its name for errors."""
    if inputs != outputs:
        raise ProgramError(f"a curve set of {inputs} inputs and {outputs} outputs", where=where)
    if 12 + ENTRY * inputs > len(data):
        raise ProgramError(f"{inputs} curves are claimed, more than fit", where=where)
    places = decode_places(data, 12, inputs, where)

    def decode_curve(part: bytes, name: str) -> Curve:
        return _decode_curve(part, name, decode)

    return CurveSet(decode_parts(data, places, decode_curve, "curve", where))


def _decode_curve(data: bytes, where: str, decode: Callable[[bytes, str], Element]) -> Curve:
    kind = data[:4]
    if kind == b"sngf":
        return _decode_sampled(data, where)
    if kind == b"curf":
        return _decode_segmented(data, where)
    if kind == b"clcf":
        return decode_calculator_curve(data, where, decode)
    raise ProgramError(f"no curve has the signature {kind!r}", where=where)


def _decode_sampled(data: bytes, where: str) -> SampledCurve:
    if len(data) < 24:
        raise ProgramError("the sampled curve ends within its header", where=where)
    count, first, last, extension, code = struct.unpack_from(">IffHH", data, 8)
    if extension > 1:
        raise ProgramError(f"no extension has the number {extension}", where=where)
    samples = Samples.read(Storage.of_code(code, where), count, data, 24, where)
    curve = SampledCurve(first, last, samples, bool(extension))
    _check_sampled(curve, where)
    return curve


def _decode_segmented(data: bytes, where: str) -> SegmentedCurve:
    if len(data) < 12:
        raise ProgramError("the segmented curve ends within its header", where=where)
    (count,) = struct.unpack_from(">H", data, 8)
    at = 12 + 4 * max(0, count - 1)
    if at > len(data):
        raise ProgramError(f"{count} segments are claimed, more than fit", where=where)
    breaks = struct.unpack_from(f">{max(0, count - 1)}f", data, 12)
    segments: list[Segment] = []
    for index in range(count):  # back to back, so each tells where the next begins
        segment, at = _decode_segment(data, at, f"{where}, segment {index}")
        segments.append(segment)
    curve = SegmentedCurve(breaks, tuple(segments))
    _check_segmented(curve, where)
    return curve


def _decode_segment(data: bytes, at: int, where: str) -> tuple[Segment, int]:
    """The segment at a place, and where the next begins."""
    if at + 12 > len(data):
        raise ProgramError("the segment ends within its header", where=where)
    kind = data[at : at + 4]
    if kind == b"samf":
        (count,) = struct.unpack_from(">I", data, at + 8)
        samples = Samples.read(Storage.FLOAT32, count, data, at + 12, where)
        return SampledSegment(samples), at + 12 + len(samples.data)
    if kind != b"parf":
        raise ProgramError(f"no segment has the signature {kind!r}", where=where)
    (number,) = struct.unpack_from(">H", data, at + 8)
    count = PARAMETERS.get(number, 0)
    end = at + 12 + 4 * count
    if end > len(data):
        raise ProgramError("the segment ends within its parameters", where=where)
    return FormulaSegment(number, struct.unpack_from(f">{count}f", data, at + 12)), end


def _check_sampled(curve: SampledCurve, where: str) -> None:
    if curve.samples.count < 2:
        raise ProgramError(f"a sampled curve of {curve.samples.count} points", where=where)
    if not (math.isfinite(curve.first) and math.isfinite(curve.last) and curve.first < curve.last):
        raise ProgramError(f"a sampled curve from {curve.first:g} to {curve.last:g}", where=where)


def _check_segmented(curve: SegmentedCurve, where: str) -> None:
    if not curve.segments or len(curve.breaks) != len(curve.segments) - 1:
        raise ProgramError(
            f"{len(curve.segments)} segments with {len(curve.breaks)} breaks", where=where
        )
    ascending = all(one < next_one for one, next_one in pairwise(curve.breaks))
    if not (ascending and all(map(math.isfinite, curve.breaks))):
        raise ProgramError("the breaks between segments do not ascend", where=where)
    for end in (curve.segments[0], curve.segments[-1]):
        if isinstance(end, SampledSegment):
            raise ProgramError("the first and the last segment must be formulas", where=where)
    for index, segment in enumerate(curve.segments):
        _check_segment(segment, f"{where}, segment {index}")


def _check_segment(segment: Segment, where: str) -> None:
    if isinstance(segment, SampledSegment):
        if segment.samples.count < 1 or segment.samples.storage is not Storage.FLOAT32:
            raise ProgramError("a sampled segment needs FLOAT32 samples", where=where)
        return
    if segment.type not in PARAMETERS:
        raise ProgramError(f"no formula segment has the type {segment.type}", where=where)
    if len(segment.parameters) != PARAMETERS[segment.type]:
        raise ProgramError(
            f"a formula of type {segment.type} takes {PARAMETERS[segment.type]} parameters, not "
            f"{len(segment.parameters)}",
            where=where,
        )
    if not all(map(math.isfinite, segment.parameters)):
        raise ProgramError("a parameter is NaN or infinite", where=where)
