"""Transforms of a profile: found, checked, and run on samples."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from brdfc.calc.verify import verify
from brdfc.engine.runs import run
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import NO_SPACE
from brdfc.icc.types import Pipeline
from brdfc.profiles.metadata import Described, describe
from brdfc.source.errors import LinkError, ProgramError

Values = NDArray[np.float32]

COLORIMETRIC = ("A2B", "D2B", "M2B", "bAB")
"""How the tags begin that lead to X, Y, Z."""
DEVICE_TRANSFORMS = ("A2B1", "A2B0", "A2B3")
"""Of a profile of device values the first of these: its colours are media-relative."""


def pipeline(profile: Profile, signature: str) -> Pipeline:
    """A transform of a profile, whose elements fit each other; LinkError where there is none."""
    tag = profile.tags.get(signature)
    if not isinstance(tag, Pipeline):
        spectral = "compile the model with --spectral 400nm..700nm,10nm"
        hint = spectral if signature.startswith(("M2S", "D2B")) else None
        raise LinkError(f"the profile has no '{signature}' transform", hint=hint)
    channels = tag.inputs
    for element in tag.elements:
        if element.inputs != channels:
            raise LinkError(f"the elements of '{signature}' do not fit each other's channels")
        channels = element.outputs
    if channels != tag.outputs:
        raise LinkError(f"the elements of '{signature}' do not fit its {tag.outputs} outputs")
    return tag


def run_pipeline(
    transform: Pipeline, pixels: ArrayLike, environment: Mapping[str, ArrayLike]
) -> Values:
    """The elements of a transform; see engine.runs.run."""
    return run(transform.elements, transform.inputs, pixels, environment)


def device_transform(profile: Profile) -> str:
    """The tag of a profile of device values that leads to colours."""
    kind = profile.header.device_class
    if kind in ("mid ", "mvis"):
        other = "an MVIS" if kind == "mid " else "a MID"
        raise LinkError(f"one profile, and it needs {other}", hint="give the MID, then the MVIS")
    found = next((t for t in DEVICE_TRANSFORMS if isinstance(profile.tags.get(t), Pipeline)), None)
    if found is None:
        raise LinkError(
            f"the profile (class '{kind}') has no transform to colours that can be run",
            hint=f"one of {', '.join(DEVICE_TRANSFORMS)} with processing elements is needed",
        )
    return found


def leads_to_reflectances(profile: Profile, transform: str) -> bool:
    """Whether a transform leads to reflectances, not to X, Y, Z."""
    kind = transform[:3]
    return kind in ("M2S", "bDB") or (kind == "D2B" and profile.header.spectral_pcs != NO_SPACE)


def check_colours(profile: Profile, transform: str, outputs: int) -> None:
    """LinkError unless a transform leads to what can be rendered: reflectances, or X, Y, Z."""
    if leads_to_reflectances(profile, transform):
        return
    if not transform.startswith(COLORIMETRIC):
        raise LinkError(
            f"'{transform}' does not lead to colours", hint=f"{', '.join(COLORIMETRIC)}..."
        )
    space = profile.header.pcs.decode("ascii", "replace").strip()
    if (space, outputs) != ("XYZ", 3):
        raise LinkError(f"'{transform}' leads to {outputs} values of '{space}', not to X, Y, Z")


def transform_variables(
    profile: Profile, transform: str
) -> tuple[tuple[str, Described | None], ...]:
    """The variables a transform reads: signature, and its description if it has one."""
    described = {d.signature: d for d in describe(profile, "env")}
    signatures: dict[str, None] = {}
    for element in pipeline(profile, transform).elements:
        try:
            signatures |= dict.fromkeys(verify(element).variables)
        except ProgramError as error:
            raise LinkError(f"the profile's program is refused: {error}") from error
    return tuple((s, described.get(s)) for s in signatures if s not in ("true", "ndef"))
