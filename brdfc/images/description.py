"""What a file of results says of itself, a fact a line: what its numbers are and how they came."""

from __future__ import annotations

from collections.abc import Sequence

from brdfc.cmm.link import Link
from brdfc.cmm.rendering import Rendering, Target
from brdfc.icc.profile import Profile, compute_profile_id
from brdfc.icc.texts import LocalizedText
from brdfc.images.samples import Samples
from brdfc.images.scaling import Scaling
from brdfc.profiles.metadata import value_text

_NAMES = {
    Target.XYZ: "XYZ, Y = 1 for white",
    Target.LAB: "CIELAB",
    Target.SRGB: "sRGB",
    Target.SPECTRUM: "reflectances",
    Target.DEVICE: "device values",
}

_DIGITS = 7
"""As many as a float32 has."""


def described(
    rendering: Rendering,
    profiles: Sequence[Profile],
    samples: Samples,
    scaling: Scaling | None,
    run: str,
) -> str:
    """ASCII, a fact a line; run: what else there is to say. See variables for the run's."""
    link = rendering.link
    lines = [_NAMES[rendering.to]]
    if rendering.to is Target.DEVICE:
        lines[0] = str(link.gives)
    if str(samples):
        lines.append(f"samples: {samples}")
    if rendering.note and rendering.note != lines[0]:
        lines.append(rendering.note)
    if rendering.to in (Target.XYZ, Target.LAB):
        lines.append("white: " + " ".join(f"{value:.6g}" for value in rendering.white))
    lines += [f"{name}={value}" for name, value in variables(link).items()]
    lines += [f"profile: {_title(profile)}, ID {profile_id(profile)}" for profile in profiles]
    lines.append(f"transform: {link.transform}")
    if scaling is not None:
        lines.append(f"samples of the source: {scaling}")
    if run:
        lines.append(run)
    return "\n".join(map(_plain, lines))


def variables(link: Link) -> dict[str, str]:
    """Every variable of a run, with the value in effect: given, or the profile's default."""
    found = {}
    for signature, known in (v for stage in link.stages for v in stage.variables):
        value = link.environment.get(signature)
        if known is not None:
            values = known.default if value is None else (float(value),)  # type: ignore[arg-type]
            found[known.name] = value_text(values, known.type, _DIGITS)
        else:
            found[signature] = "the profile's default" if value is None else f"{value:.{_DIGITS}g}"
    return found


def profile_id(profile: Profile) -> str:
    """The MD5 that a profile's header states, or that it would."""
    stated = profile.header.profile_id
    return (stated if any(stated) else compute_profile_id(profile.to_bytes())).hex()


def _title(profile: Profile) -> str:
    text = profile.tags.get("desc")
    return (text.text if isinstance(text, LocalizedText) else "") or "without a description"


def _plain(line: str) -> str:
    """A line of printable ASCII: texts of profiles come from outside."""
    ascii_text = line.encode("ascii", "replace").decode()
    return "".join(c if c.isprintable() else " " for c in ascii_text)
