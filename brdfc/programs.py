"""The calculators of a profile: where they stand, and what the profile says of what they get."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from brdfc.calc.portability import portability
from brdfc.calc.program import Program
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import TAGS
from brdfc.icc.structures import Structure
from brdfc.icc.texts import Utf8Array
from brdfc.icc.types import Pipeline, Tag
from brdfc.profiles.metadata import Described, describe
from brdfc.symbolic.intervals import EVERYTHING, Interval, single


@dataclass(frozen=True)
class Placed:
    """A calculator, and its place in a profile."""

    program: Program
    tag: str
    index: int
    profile: Profile

    @property
    def where(self) -> str:
        return f"tag '{self.tag}', element {self.index}"

    @property
    def remarks(self) -> list[str]:
        """What releases of the reference engine may do differently, where channels and variables
        lie in the ranges that the profile states; the program is one that verify accepts."""
        stated = _channels(self.profile, self.tag) if self.index == 0 else []
        inputs = stated if len(stated) == self.program.inputs else None
        return portability(self.program, f"{self.where}, ", inputs, _variables(self.profile))


def calculators(profile: Profile) -> Iterator[Placed]:
    """Every calculator that stands in a transform; of tags that share one, under the first."""
    seen: set[int] = set()
    for signature, pipeline in pipelines(profile.tags):
        if id(pipeline) in seen:
            continue
        seen.add(id(pipeline))
        for index, element in enumerate(pipeline.elements):
            if isinstance(element, Program):
                yield Placed(element, signature, index, profile)


def pipelines(tags: Mapping[str, Tag]) -> Iterator[tuple[str, Pipeline]]:
    """Transforms by their tags; those in a structure, once, as `bcp0.xfrm`."""
    seen: set[int] = set()
    for signature, tag in tags.items():
        if isinstance(tag, Pipeline):
            yield signature, tag
        elif isinstance(tag, Structure) and id(tag) not in seen:
            seen.add(id(tag))
            for member, pipeline in pipelines(tag.members):
                yield f"{signature}.{member}", pipeline


def _range(described: Described) -> Interval:
    """As float32 has it: 90deg is slightly more than a right angle."""
    ends = single(described.low), single(described.high)
    return Interval(*ends) if all(map(math.isfinite, ends)) and ends[0] <= ends[1] else EVERYTHING


def _variables(profile: Profile) -> dict[str, Interval]:
    return {d.signature: _range(d) for d in describe(profile, "env")}


def _channels(profile: Profile, tag: str) -> list[Interval]:
    """What a transform is given: multiplex channels by their names, device channels in the order
    that they are described in. Of any others nothing is stated."""
    kind = TAGS.get(tag)
    side = kind.channels[0] if kind and kind.channels else ""
    described = {
        name: _range(quantity)
        for quantity in describe(profile, "channel")
        for name in quantity.component_names
    }
    names = profile.tags.get("mcta")
    if side == "mcs" and isinstance(names, Utf8Array):
        return [described.get(name, EVERYTHING) for name in names.names]
    return list(described.values()) if side == "device" else []
