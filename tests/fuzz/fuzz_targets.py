"""What is done with an input: all that brdfc does with a file of its kind.

A target gives True where the input was accepted to the end. BrdfcError is an answer; whatever else
escapes is a finding, and so is what does not come back as it was written.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, replace
from pathlib import Path
from zlib import crc32

import numpy as np
from calc_programs import INPUTS, OUTPUTS, SHARED
from fuzz_corpus import EXAMPLES

from brdfc.calc.binary import decode_element, encode_element
from brdfc.calc.program import Program
from brdfc.calc.text import assemble, disassemble
from brdfc.calc.verify import verify
from brdfc.engine import runs
from brdfc.engine.choice import Engine
from brdfc.icc.profile import Profile
from brdfc.icc.types import Pipeline, Structure, Tag
from brdfc.icc.validate import validate
from brdfc.inspection import inspect
from brdfc.source.errors import BrdfcError
from brdfc.xml.profile import from_xml, to_xml

MOST_WORK = 100_000
"""Values popped and pushed for a pixel by the programs that are run: what is dear may take long."""
INSPECTED = 8
"""One accepted profile in so many, by its bytes, is inspected: that reads it from a file."""
VARIABLES = {"inci": 0.5, "refl": -0.25}


def profile(data: bytes) -> bool:
    """A profile: read, judged, proven, run, and written as bytes and as XML."""
    try:
        found = Profile.from_bytes(data, "x.icc")
    except BrdfcError as error:
        shown(error)
        return False
    for finding in validate(found):
        assert str(finding)
    if crc32(data) % INSPECTED == 0:
        inspected(data)
    for pipeline in pipelines(found.tags):
        run(pipeline)
    return written(found)


def document(data: bytes) -> bool:
    """The XML of a profile: read, and the profile taken on."""
    try:
        found = from_xml(data, EXAMPLES / "x.xml")
        data = found.to_bytes()
    except BrdfcError as error:
        shown(error)
        return False
    for pipeline in pipelines(found.tags):
        run(pipeline)
    return written(Profile.from_bytes(data))


def text(data: bytes) -> bool:
    """A calculator text: assembled, encoded, proven, run, and written as text."""
    try:
        block = assemble(data.decode("latin-1"))
        element = Program(INPUTS, OUTPUTS, block, SHARED)
        coded = encode_element(element)
    except BrdfcError as error:
        shown(error)
        return False
    assert encode_element(decode_element(coded, "x")) == coded
    assert assemble(disassemble(block)) == block
    run(Pipeline(INPUTS, OUTPUTS, (element,)))
    return True


TARGETS: dict[str, Callable[[bytes], bool]] = {
    "profile": profile,
    "document": document,
    "text": text,
}


def shown(error: BrdfcError) -> None:
    """A message has a size that a person reads, and one line can hold each part of it."""
    assert len(str(error)) < 4000


def pipelines(tags: Mapping[str, Tag]) -> Iterator[Pipeline]:
    """Transforms, those in structures too."""
    for tag in tags.values():
        if isinstance(tag, Pipeline):
            yield tag
        elif isinstance(tag, Structure):
            yield from pipelines(tag.members)


def run(pipeline: Pipeline) -> None:
    """Prove every program of a pipeline; run it on two pixels, alike on two engines."""
    work = 0
    try:
        for element in pipeline.elements:
            if isinstance(element, Program):
                work += verify(element).work
    except BrdfcError as error:
        shown(error)
        return
    if work > MOST_WORK:
        return
    ramp = np.linspace(-0.25, 1.25, 2 * pipeline.inputs, dtype=np.float32)
    pixels = ramp.reshape(2, pipeline.inputs)
    results = []
    for engine in (Engine.INTERPRETER, Engine.BLOCKS):
        try:
            values = runs.run(pipeline.elements, pipeline.inputs, pixels, VARIABLES, engine=engine)
        except BrdfcError as error:
            shown(error)
            values = np.zeros(0, np.float32)
        results.append(values)
    np.testing.assert_array_equal(*results)


def written(found: Profile) -> bool:
    """What is written is read again as what it was; as XML, too, where it is not too large."""
    try:
        data = found.to_bytes()
    except BrdfcError as error:
        shown(error)
        return False
    assert Profile.from_bytes(data).to_bytes() == data, "other bytes when written again"
    try:
        document = to_xml(found)
    except BrdfcError as error:
        shown(error)
        return False
    again = from_xml(document.encode(), EXAMPLES / "x.xml").to_bytes()
    assert said(Profile.from_bytes(again)) == said(found), "another profile by way of XML"
    return True


def said(found: Profile) -> str:
    """All that a profile holds but its identity. A constant that is no number has no text; it comes
    back as the operator that pushes it."""
    header = replace(found.header, profile_id=bytes(16))
    whole = repr((header, dict(found.tags)))
    for value, name in (("nan", "NaN"), ("inf", "+INF"), ("-inf", "-INF")):
        constant = f"Op(name='data', first=0, second=0, value={value}, "
        whole = whole.replace(constant, f"Op(name='{name}', first=0, second=0, value=0.0, ")
    return whole


def inspected(data: bytes) -> None:
    """What `brdfc inspect` shows, without the reference engine."""
    with tempfile.NamedTemporaryFile(suffix=".icc", dir=_IN_MEMORY) as file:
        file.write(data)
        file.flush()
        try:
            found = inspect(file.name, engine=False)
        except BrdfcError as error:
            shown(error)
            return
        json.dumps(asdict(found))


_IN_MEMORY = "/dev/shm" if Path("/dev/shm").is_dir() else None
