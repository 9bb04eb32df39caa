"""The variables of a run: what a user gives, checked against what a profile says it takes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from brdfc.cmm.stages import Stage
from brdfc.icc.profile import Profile
from brdfc.lang.types import TYPES
from brdfc.lang.values import parse_value
from brdfc.profiles.metadata import Described, describe, describe_constants, value_text
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import ValueGivenError


def environment_of(
    stages: Sequence[Stage], given: Mapping[str, float], extrapolate: bool = False
) -> dict[str, float]:
    """Values by signature for a run of some profiles; by name or signature in what is given.

    A variable that several of them read has one value. What a profile was compiled for, a variable
    fixed then or one that changes nothing within its range, may be given too, and is only checked.
    extrapolate: take values outside the ranges that the profiles state. Raises ValueGivenError.
    """
    by_name: dict[str, list[tuple[str, Described | None]]] = {}
    listed: dict[str, None] = {}
    for signature, described in (v for stage in stages for v in stage.variables):
        for name in {signature, described.name} if described else {signature}:
            by_name.setdefault(name, []).append((signature, described))
        listed[described.name if described else signature] = None
    environment: dict[str, float] = {}
    by: dict[str, str] = {}
    for name, value in given.items():
        if name not in by_name:
            settled = [_settled(stage.profile, name, value, extrapolate) for stage in stages]
            if any(settled):
                continue
            raise ValueGivenError(
                f"the profile has no variable '{name}'",
                hint=did_you_mean(name, by_name) or f"its variables: {', '.join(listed) or 'none'}",
            )
        for signature, described in by_name[name]:
            if by.setdefault(signature, name) != name:
                raise ValueGivenError(f"'{name}' is given twice, by name and by signature")
            environment[signature] = _in_range(name, value, described, extrapolate)
    return environment


def _settled(profile: Profile, name: str, value: float, extrapolate: bool) -> bool:
    """Whether a variable is one that the compilation has settled; ValueGivenError where it settled
    it otherwise."""
    for described in describe(profile, "unread"):
        if name in (described.name, described.signature):
            _in_range(name, value, described, extrapolate)
            return True
    text = describe_constants(profile).get(name)
    if text is None:
        return False
    declared = TYPES["angle" if text.endswith("deg") else "number"]
    try:
        fixed = parse_value(text, declared, name)[0]
    except ValueGivenError:  # a text from outside that makes no sense is passed over
        return False
    if not math.isclose(fixed, value, rel_tol=1e-6, abs_tol=1e-9) and not extrapolate:
        shown = value_text((value,), declared)
        raise ValueGivenError(
            f"{name}={shown}: the profile was compiled for {name}={text}",
            hint="compile it for this value, or without fixing it",
        )
    return True


def _in_range(
    name: str, value: float, described: Described | None, extrapolate: bool = False
) -> float:
    """A variable's value as float32 has it; ValueGivenError where the model does not reach, unless
    that is asked for."""
    if not math.isfinite(value):
        raise ValueGivenError(f"{name}={value} is not a finite number")
    rounded = float(np.float32(value))
    if described is None or extrapolate:
        return rounded
    low, high = described.reach
    if not low <= rounded <= high:
        shown = value_text((value,), described.type)
        raise ValueGivenError(
            f"{name}={shown} lies outside the profile's range {described.range_text}",
            hint="--extrapolate takes it all the same, and the colours are what they are",
        )
    return rounded
