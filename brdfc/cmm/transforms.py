"""Transforms of a profile: checked, and what they read."""

from __future__ import annotations

from collections.abc import Iterable

from brdfc.calc.program import Element
from brdfc.calc.verify import verify
from brdfc.icc.luts import StagedLut, TableLut
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import NO_SPACE
from brdfc.icc.types import Pipeline
from brdfc.profiles.metadata import Described, describe
from brdfc.source.errors import LinkError, ProgramError

Transform = Pipeline | TableLut | StagedLut
Variables = tuple[tuple[str, Described | None], ...]
"""Variables by signature, each with its description if it has one."""


def check_fit(tag: Transform, signature: str) -> None:
    """LinkError unless the elements of a transform fit each other's channels."""
    if not isinstance(tag, Pipeline):
        return
    channels = tag.inputs
    for element in tag.elements:
        if element.inputs != channels:
            raise LinkError(f"the elements of '{signature}' do not fit each other's channels")
        channels = element.outputs
    if channels != tag.outputs:
        raise LinkError(f"the elements of '{signature}' do not fit its {tag.outputs} outputs")


def leads_to_reflectances(profile: Profile, transform: str) -> bool:
    """Whether a transform leads to reflectances, not to X, Y, Z."""
    kind = transform[:3]
    return kind in ("M2S", "bDB") or (kind == "D2B" and profile.header.spectral_pcs != NO_SPACE)


def variables_of(profile: Profile, transform: str, elements: Iterable[Element]) -> Variables:
    """The variables that the programs of a transform read.

    Its programs are proven on the way; LinkError names the element and the operation.
    """
    described = {d.signature: d for d in describe(profile, "env")}
    signatures: dict[str, None] = {}
    for index, element in enumerate(elements):
        try:
            facts = verify(element, f"tag '{transform}', element {index}")
        except ProgramError as error:
            message = f"the profile's program is refused: {error.message}"
            raise LinkError(message, where=error.where) from error
        signatures |= dict.fromkeys(facts.variables)
    return tuple((s, described.get(s)) for s in signatures if s not in ("true", "ndef"))
