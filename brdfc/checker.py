"""Everything that can be verified about a model or a profile, one finding a line."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from brdfc.calc.curves import calculator_curves
from brdfc.calc.portability import portability
from brdfc.calc.price import operations, price
from brdfc.calc.program import Element, Program
from brdfc.calc.verify import verify
from brdfc.cmm import reference
from brdfc.compiler import compile_model
from brdfc.icc.profile import Profile
from brdfc.icc.types import Pipeline
from brdfc.icc.validate import validate
from brdfc.judge.examples import check_examples
from brdfc.lang.load import load, load_file
from brdfc.lang.model import Breach, Law, Model
from brdfc.laws.breaches import reproduce
from brdfc.laws.claims import Claim, LawResult, shown
from brdfc.laws.examine import examine
from brdfc.laws.reflectance import Reflectance, in_full_geometry
from brdfc.profiles.metadata import describe
from brdfc.source.errors import BrdfcError
from brdfc.symbolic.build import build

OK, WARNING, ERROR, OPEN = "ok", "warning", "error", "open"
EXPECTED = ("reciprocal", "positive")
"""Laws of nature: a model that breaks one of them without a word deserves a warning."""


@dataclass(frozen=True)
class Finding:
    """status: ok, warning, error, or open for what was not checked."""

    status: str
    message: str


def is_profile(path: str | Path) -> bool:
    """Whether a file begins as an ICC profile does."""
    try:
        with Path(path).open("rb") as stream:
            return stream.read(40)[36:] == b"acsp"
    except OSError:
        return False


def check_model(name: str) -> Iterator[Finding]:
    """Text, examples, the compiled program and its profiles. Errors in the text are raised."""
    model = load_file(name)
    if not isinstance(model, Model):
        yield Finding(OK, f"text: module '{model.name}', {len(model.definitions)} definitions")
        return
    yield Finding(
        OK,
        f"text: model '{model.name}', {len(model.quantities)} quantities, "
        f"{len(model.definitions)} definitions",
    )
    count = check_examples(model)
    yield Finding(OK if count else OPEN, f"examples: {count} hold" if count else "examples: none")
    compiled = compile_model(model)
    verdict = compiled.verdict
    yield Finding(
        OK,
        f"self-check: worst CIEDE2000 {verdict.worst:.1e} of {verdict.points} points, where "
        f"{verdict.worst_at}",
    )
    for guard in compiled.guards:
        yield Finding(OK, f"guard: {guard.reason}, in {guard.operation}")
    yield from check_laws(load(name, "full") if model.geometry else model)
    with tempfile.TemporaryDirectory() as folder:
        for path in compiled.save(Path(folder) / "checked_mvis.icc"):
            kind = "MID" if path.name.endswith("mid.icc") else "MVIS"
            for finding in check_profile(path):
                yield Finding(finding.status, f"{kind}: {finding.message}")


def check_laws(model: Model) -> Iterator[Finding]:
    """The laws a model claims, those it says it breaks, and those it should have spoken of.

    model: in the full geometry, as albedos and both ways need all directions.
    """
    if not in_full_geometry(model):
        for law in model.laws:
            message = (
                f"law: {law} is claimed; only a model in all directions can be held against it"
            )
            yield Finding(OPEN, f"{message} (import geometry)")
        return
    reflectance = Reflectance(model)
    for law in model.laws:
        found = examine(reflectance, _claim(law))
        status = (OK if found.holds else ERROR) if found.settled else OPEN
        hint = "; correct the formula, narrow the ranges, or say that the model breaks the law"
        yield Finding(status, f"law: {found}{hint if status == ERROR else ''}")
    worst: dict[str, LawResult] = {}
    for breach in model.breaches:
        claim = _claim(breach.law)
        if str(claim) not in worst:
            worst[str(claim)] = examine(reflectance, claim)
        yield _breach(reflectance, breach, worst[str(claim)])
    spoken_of = {law.name for law in (*model.laws, *(b.law for b in model.breaches))}
    for law_name in EXPECTED:
        if law_name not in spoken_of:
            found = examine(reflectance, Claim(law_name))
            said = "holds, but is not claimed" if found.holds else "is broken, and nothing says so"
            yield Finding(OK if found.holds else WARNING, f"law: {law_name} {said}; {found}")


def _claim(law: Law) -> Claim:
    condition = build(law.condition, {}, free=True) if law.condition else None
    return Claim(law.name, law.bound, law.quantities, condition, str(law))


def _breach(reflectance: Reflectance, breach: Breach, worst: LawResult) -> Finding:
    there = reproduce(reflectance, worst.claim, breach.given, breach.figure, breach.within)
    said = f"breaks: {breach.law}: {there.figure:.6g} at {shown(breach.given, reflectance.angular)}"
    if not there.breaks:
        return Finding(ERROR, f"{said} does not break the law")
    if not there.agrees:
        return Finding(ERROR, f"{said}, and not {breach.figure:g}; correct the figure")
    return Finding(OK, f"{said}, as stated; {worst}")


def check_profile(path: str | Path) -> Iterator[Finding]:
    """Container, rules of the class, every calculator, and the reference engine's verdict."""
    profile = Profile.load(path)
    data = profile.source or b""
    header = profile.header
    yield Finding(
        OK,
        f"container: class '{header.device_class}', {len(profile.tags)} tags, {len(data):,} bytes",
    )
    same = profile.to_bytes(profile_id=any(header.profile_id)) == data
    yield Finding(
        OK if same else OPEN,
        "layout: written again, the bytes are the same"
        if same
        else "layout: written again, the bytes differ (another writer's order or padding)",
    )
    findings = validate(profile)
    for finding in findings:
        yield Finding(finding.severity, f"{finding.tag or 'profile'}: {finding.message}")
    if not findings:
        yield Finding(OK, "rules: all required tags, channel counts and names agree")
    for signature, tag in profile.tags.items():
        if isinstance(tag, Pipeline):
            for index, element in enumerate(tag.elements):
                where = f"{signature}, element {index}"
                if isinstance(element, Program):
                    yield from _program(element, where)
                elif calculator_curves(element):
                    yield _curves(element, where)
    named = [*describe(profile, "channel"), *describe(profile, "env")]
    for d in named:
        kind = f"variable ({d.signature})" if d.signature else "channel"
        yield Finding(OK, f"{kind}: {d.name} : {d.type.name} in {d.range_text}, {d.description}")
    yield _reference_verdict(path)


def _program(program: Program, where: str) -> Iterator[Finding]:
    try:
        facts = verify(program, where)
    except BrdfcError as error:
        yield Finding(ERROR, str(error))
        return
    yield Finding(
        OK,
        f"{where}: proven safe; {operations(program)} operators, at most "
        f"{price(program):.0f} ns a pixel, stack {facts.stack}, temporaries "
        f"{facts.temporaries}, variables {' '.join(facts.variables) or 'none'}",
    )
    for remark in portability(program):
        yield Finding(WARNING, f"{where}: {remark}")


def _curves(element: Element, where: str) -> Finding:
    """Curves that are sampled from programs."""
    try:
        facts = verify(element, where)
    except BrdfcError as error:
        return Finding(ERROR, str(error))
    read = " ".join(facts.variables) or "none"
    return Finding(OK, f"{where}: curves proven safe to sample, variables {read}")


def _reference_verdict(path: str | Path) -> Finding:
    if not reference.available():
        return Finding(OPEN, "reference engine: not installed (pip install 'brdfc[verify]')")
    try:
        verdict, report = reference.validate(path)
    except BrdfcError as error:
        return Finding(ERROR, str(error))
    listed = " ".join(report.split())
    return Finding(
        OK if verdict == "OK" else (WARNING if verdict == "warning" else ERROR),
        f"reference engine: {verdict}" + (f": {listed}" if listed else ""),
    )


def check(name: str) -> Iterator[Finding]:
    """Check a profile, or a model by path or library name."""
    function: Callable[[str], Iterator[Finding]]
    function = check_profile if is_profile(name) else check_model
    return function(name)
