"""What a person wants to know of a profile, gathered."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from brdfc.calc.binary import encode_element
from brdfc.calc.census import census
from brdfc.calc.curves import CurveSet, calculator_curves
from brdfc.calc.facts import Facts
from brdfc.calc.price import operations, price
from brdfc.calc.program import Element, Program
from brdfc.calc.tables import LookupTable
from brdfc.calc.verify import verify
from brdfc.cmm import reference
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import (
    DEVICE_CLASSES,
    signature_bytes,
    space_channels,
    space_text,
)
from brdfc.icc.summaries import summary
from brdfc.icc.tags import TAGS
from brdfc.icc.texts import Dictionary, LocalizedText, Utf8Array
from brdfc.icc.types import NumberArray, Pipeline, TextDescription
from brdfc.icc.validate import validate
from brdfc.inspected import Calculator, Channel, Inspection, OtherTag, Part, Transform, Variable
from brdfc.profiles.metadata import describe, value_text
from brdfc.programs import Examined, distinct_transforms, examined, place, transforms
from brdfc.source.errors import BrdfcError, ProgramError
from brdfc.xml.names import signature_name

KINDS = {
    "calc": "calculator",
    "matf": "matrix",
    "cvst": "curves",
    "clut": "lookup table",
    "xclt": "lookup table",
    "tint": "tint array",
    "XtoJ": "XYZ to Jab",
    "JtoX": "Jab to XYZ",
}
"""Elements by their signatures."""


def prove(profile: Profile, path: str) -> None:
    """Prove every program of a profile safe to run; ProgramError names the tag and operation."""
    for signature, pipeline in distinct_transforms(profile):
        for index, element in enumerate(pipeline.elements):
            verify(element, f"{path}, {place(signature, index)}")


def inspect(path: str | Path, engine: bool = True) -> Inspection:
    """The profile in a file. engine: ask the reference engine for its verdict too.

    Raises ProfileError for what is no profile.
    """
    profile = Profile.load(path)
    header = profile.header
    title = profile.tags.get("desc")
    metadata = profile.tags.get("meta")
    transforms = tuple(_transforms(profile))
    major, minor = header.version >> 24, header.version >> 16 & 0xFF
    device_class = DEVICE_CLASSES.get(header.device_class)
    return Inspection(
        path=str(path),
        bytes=len(profile.source or b""),
        device_class=header.device_class.strip(),
        class_name=device_class.name if device_class else "unknown",
        version=f"{major:x}.{minor:02x}",
        title=title.text if isinstance(title, (LocalizedText, TextDescription)) else "",
        spaces=_spaces(profile),
        channels=_channels(profile),
        variables=_variables(profile, transforms),
        transforms=transforms,
        other_tags={
            signature: OtherTag(
                TAGS[signature].name if signature in TAGS else "", tag.type_signature, summary(tag)
            )
            for signature, tag in profile.tags.items()
            if not isinstance(tag, Pipeline)
        },
        metadata=dict(metadata.entries) if isinstance(metadata, Dictionary) else {},
        verdicts=_verdicts(profile, transforms, path if engine else None),
    )


def _spaces(profile: Profile) -> dict[str, str]:
    header = profile.header
    spaces = {
        "device": header.colour_space,
        "PCS": header.pcs,
        "spectral PCS": header.spectral_pcs,
        "MCS": header.mcs,
    }
    found = {name: _space(space) for name, space in spaces.items() if any(space)}
    if "spectral PCS" in found:
        at = header.spectral_range
        found["spectral PCS"] += f", {at.start:g}..{at.end:g} nm"
    return found


def _space(space: bytes) -> str:
    text, count = space_text(space).strip(), space_channels(space)
    # The count in the name is hexadecimal.
    return f"{text} ({count} channels)" if count and len(text) == 6 else text


def _channels(profile: Profile) -> tuple[Channel, ...]:
    names, defaults = profile.tags.get("mcta"), profile.tags.get("mdv ")
    if not isinstance(names, Utf8Array):
        return ()
    values: list[float | None] = [None] * len(names.names)
    if isinstance(defaults, NumberArray) and len(defaults.values) == len(values):
        values = list(defaults.scaled)
    return tuple(map(Channel, names.names, values))


def _variables(profile: Profile, transforms: tuple[Transform, ...]) -> tuple[Variable, ...]:
    described = {d.signature: d for d in describe(profile, "env")}
    read = {
        signature: None
        for transform in transforms
        for part in transform.elements
        if part.calculator
        for signature in part.calculator.variables
    }
    for facts in _sampled_programs(profile):
        if isinstance(facts, Facts):
            read |= dict.fromkeys(v for v in facts.variables if v not in ("true", "ndef"))
    found = []
    for signature in read:
        d = described.get(signature)
        if d is None:
            found.append(Variable(signature_name(signature_bytes(signature.ljust(4))).strip()))
        else:
            default = value_text(d.default, d.type, 6)
            found.append(Variable(signature, d.name, d.range_text, default))
    return tuple(found)


def _transforms(profile: Profile) -> Iterator[Transform]:
    first: dict[int, str] = {}
    for signature, tag in transforms(profile.tags):
        kind = TAGS.get(signature[:4])
        name = kind.name if kind else ""
        same = first.setdefault(id(tag), signature)
        shared = same if same != signature else None
        parts = () if shared else tuple(map(_part, tag.elements, examined(profile, signature, tag)))
        yield Transform(signature, name, tag.inputs, tag.outputs, parts, shared)


def _part(element: Element, found: Examined | None) -> Part:
    kind = KINDS.get(element.signature, f"'{element.signature}'")
    size = len(encode_element(element))
    calculator = None
    inside: dict[str, int] = {}
    if isinstance(element, Program) and found is not None:
        calculator = _calculator(element, found)
        for inner in element.elements:
            name = KINDS.get(inner.signature, f"'{inner.signature}'")
            inside[name] = inside.get(name, 0) + 1
    return Part(kind, element.inputs, element.outputs, size, _size(element), calculator, inside)


def _size(element: Element) -> str:
    if isinstance(element, LookupTable):
        grid = " x ".join(map(str, element.grid))
        return f"{grid} points of {element.samples.storage.name.lower()}"
    if isinstance(element, CurveSet):
        distinct = len({id(curve) for curve in element.curves})
        return f"{distinct} different" if distinct < len(element.curves) else ""
    return ""


def _calculator(program: Program, found: Examined) -> Calculator:
    count, kinds, facts = operations(program), census(program.body), found.facts
    if facts is None:
        return Calculator(count, kinds, refused=found.refused)
    return Calculator(
        count,
        kinds,
        price(program),
        facts.stack,
        facts.temporaries,
        tuple(v for v in facts.variables if v not in ("true", "ndef")),
        remarks=tuple(found.remarks),
    )


def _sampled_programs(profile: Profile) -> Iterator[Facts | str]:
    """What is proven of curve sets that are sampled from programs, or why they are refused."""
    for signature, pipeline in distinct_transforms(profile):
        for index, element in enumerate(pipeline.elements):
            if calculator_curves(element):
                try:
                    yield verify(element, place(signature, index))
                except ProgramError as error:
                    yield str(error)


def _verdicts(
    profile: Profile, transforms: tuple[Transform, ...], path: str | Path | None
) -> dict[str, tuple[str, ...]]:
    calculators = [p.calculator for t in transforms for p in t.elements if p.calculator]
    verdicts = {
        "rules": tuple(map(str, validate(profile))),
        "programs": (
            *(c.refused for c in calculators if c.refused),
            *(refused for refused in _sampled_programs(profile) if isinstance(refused, str)),
        ),
        "portability": tuple(remark for c in calculators for remark in c.remarks),
    }
    if path is not None and reference.available() and not verdicts["programs"]:
        verdicts["reference"] = tuple(_reference(path))
    return verdicts


def _reference(path: str | Path) -> Iterator[str]:
    try:
        verdict, report = reference.validate(path)
    except BrdfcError as error:
        yield str(error)
        return
    if verdict != "OK":
        yield " ".join([f"{verdict}:", *report.split()])
