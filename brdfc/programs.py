"""The calculators of a profile: where they stand, and what can be said of them without pixels."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from brdfc.calc.facts import Facts
from brdfc.calc.follow import Follower
from brdfc.calc.portability import listed
from brdfc.calc.program import Program
from brdfc.calc.verify import verify
from brdfc.icc.profile import Profile
from brdfc.icc.structures import Structure
from brdfc.icc.tags import TAGS
from brdfc.icc.texts import Utf8Array
from brdfc.icc.types import Pipeline, Tag
from brdfc.profiles.metadata import Described, describe
from brdfc.source.errors import ProgramError
from brdfc.symbolic.intervals import EVERYTHING, Interval, single


@dataclass(frozen=True)
class Examined:
    """A calculator in its place. facts: what verification found; refused: why it failed. remarks:
    what releases of the reference engine may do differently, where channels and variables lie in
    the ranges that the profile states."""

    program: Program
    where: str
    facts: Facts | None = None
    refused: str | None = None
    remarks: Sequence[str] = ()


def examined(profile: Profile, tag: str, pipeline: Pipeline) -> list[Examined | None]:
    """Each element of a transform, None where it is no calculator.

    What one element gives is what the next is given.
    """
    follower = Follower(_variables(profile))
    given: list[Interval] | None = _stated(profile, tag)
    found: list[Examined | None] = []
    for index, element in enumerate(pipeline.elements):
        if given is None or len(given) != element.inputs:
            given = [EVERYTHING] * element.inputs
        if not isinstance(element, Program):
            given = follower.reach(element)
            found.append(None)
            continue
        where = place(tag, index)
        try:
            facts = verify(element, where)
        except ProgramError as error:
            given = None
            found.append(Examined(element, where, refused=str(error)))
            continue
        given = follower.follow(element, given)
        remarks = list(listed(element, f"{where}, ", follower.findings))
        found.append(Examined(element, where, facts, remarks=remarks))
    return found


def place(tag: str, index: int) -> str:
    """An element as messages name it."""
    return f"tag '{tag}', element {index}"


def transforms(tags: Mapping[str, Tag]) -> Iterator[tuple[str, Pipeline]]:
    """Transforms by their tags; those in a structure, once, as `bcp0.xfrm`."""
    seen: set[int] = set()
    for signature, tag in tags.items():
        if isinstance(tag, Pipeline):
            yield signature, tag
        elif isinstance(tag, Structure) and id(tag) not in seen:
            seen.add(id(tag))
            for member, pipeline in transforms(tag.members):
                yield f"{signature}.{member}", pipeline


def distinct_transforms(profile: Profile) -> Iterator[tuple[str, Pipeline]]:
    """The same, one that several tags share under the first of them."""
    seen: set[int] = set()
    for signature, pipeline in transforms(profile.tags):
        if id(pipeline) not in seen:
            seen.add(id(pipeline))
            yield signature, pipeline


def _range(described: Described) -> Interval:
    """As float32 has it: 90deg is slightly more than a right angle."""
    ends = single(described.low), single(described.high)
    return Interval(*ends) if all(map(math.isfinite, ends)) and ends[0] <= ends[1] else EVERYTHING


def _variables(profile: Profile) -> dict[str, Interval]:
    return {d.signature: _range(d) for d in describe(profile, "env")}


def _stated(profile: Profile, tag: str) -> list[Interval] | None:
    """What a transform is given: multiplex channels by their names, device channels in the order
    that they are described in, four angles before them in a BRDF function. Of any others nothing is
    stated."""
    described = {
        name: _range(quantity)
        for quantity in describe(profile, "channel")
        for name in quantity.component_names
    }
    kind, names = TAGS.get(tag), profile.tags.get("mcta")
    match kind.channels[0] if kind and kind.channels else "":
        case "mcs" if isinstance(names, Utf8Array):
            return [described.get(name, EVERYTHING) for name in names.names]
        case "device":
            return list(described.values())
        case "brdf":
            return [Interval(0.0, 1.0)] * 4 + list(described.values())
        case _:
            return None
