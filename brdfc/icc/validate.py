"""What is wrong with a profile that can be read: the rules of ICC.2 that the reference checks.

Where the reference's releases differ, the stricter reading holds here, so that what passes here
passes everywhere: a MID, MVIS or MLNK needs its transform and its channel names.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import pairwise

from brdfc.icc.findings import Finding, error, warning
from brdfc.icc.header import D50, Header
from brdfc.icc.header_rules import header_findings
from brdfc.icc.layout import unpack, unpack_records
from brdfc.icc.profile import TABLE_START, Profile, compute_profile_id
from brdfc.icc.signatures import (
    DEVICE_CLASSES,
    NO_SPACE,
    NOT_IN,
    ONLY_IN_INPUT_AND_DISPLAY,
    Requirement,
    signature_text,
    space_channels,
)
from brdfc.icc.tags import TAGS
from brdfc.icc.types import (
    Dictionary,
    FixedArray,
    NamedColours,
    NumberArray,
    Pipeline,
    Record,
    StagedLut,
    TableLut,
    Tag,
    Utf8Array,
    XYZArray,
)


def validate(profile: Profile) -> list[Finding]:
    """All findings, those on the header first; an empty list for a profile without fault."""
    return [
        *header_findings(profile.header),
        *_required_tags(profile),
        *_unfit_tags(profile),
        *_transforms(profile),
        *_channel_names(profile),
        *_values(profile),
        *_layout(profile.source),
    ]


# --- which tags ---------------------------------------------------------------------------------


def _required_tags(profile: Profile) -> Iterator[Finding]:
    header, tags = profile.header, profile.tags
    required: list[Requirement] = []
    if header.device_class != "cenc":
        required += [(("desc",),), (("cprt",),)]
    if header.device_class not in ("link", "mid ", "mlnk", "cenc") and header.pcs != NO_SPACE:
        required.append((("wtpt",),))
    if header.device_class in DEVICE_CLASSES:
        required += DEVICE_CLASSES[header.device_class].requirements(header.major_version)
    if header.device_class in ("prtr", "link") and header.major_version >= 4:
        for space, tag in ((header.colour_space, "clrt"), (header.pcs, "clot")):
            if space[1:] == b"CLR":
                required.append(((tag,),))
    for alternatives in required:
        if not any(all(tag in tags for tag in alternative) for alternative in alternatives):
            texts = (" with ".join(alternative) for alternative in alternatives)
            yield error(f"required: {' or '.join(texts)}", alternatives[0][0])
    if header.spectral_pcs != NO_SPACE and "swpt" not in tags:
        yield warning("a spectral PCS has a spectral white point", "swpt")
    if header.device_class == "mvis" and header.pcs != NO_SPACE and header.illuminant != D50:
        for tag in ("svcn", "c2sp", "s2cp"):
            if tag not in tags:
                yield warning("needed to connect, as the illuminant is not D50", tag)


def _unfit_tags(profile: Profile) -> Iterator[Finding]:
    header = profile.header
    unfit = NOT_IN.get(header.device_class, ())
    if header.device_class not in ("scnr", "mntr", "cenc"):
        unfit += ONLY_IN_INPUT_AND_DISPLAY
    for signature, tag in profile.tags.items():
        if signature in unfit:
            yield warning(f"has no meaning in class '{header.device_class}'", signature)
        kind = TAGS.get(signature)
        allowed = kind.allowed(header.major_version) if kind else ()
        if allowed and tag.type_signature not in allowed:
            yield error(f"of type '{tag.type_signature}', not {' or '.join(allowed)}", signature)


# --- what is in them ----------------------------------------------------------------------------


def _transforms(profile: Profile) -> Iterator[Finding]:
    """Channel counts: of the tag against the header, and from element to element."""
    seen: set[int] = set()
    for signature, tag in profile.tags.items():
        if not isinstance(tag, (Pipeline, TableLut, StagedLut)):
            continue
        sides = TAGS[signature].channels if signature in TAGS else None
        actual = (tag.inputs, tag.outputs)
        for side, name, count in zip(sides or (), ("in", "out"), actual, strict=False):
            expected = _channels(side, profile.header)
            if expected not in (None, count):
                yield error(f"{count} channels {name}, the header says {expected}", signature)
        if (
            isinstance(tag, Pipeline) and id(tag) not in seen
        ):  # thousands of signatures may share one pipeline
            seen.add(id(tag))
            yield from _chain(signature, tag)


def _chain(signature: str, pipeline: Pipeline) -> Iterator[Finding]:
    """Each element takes what the one before it gives; otherwise no CMM begins."""
    given = pipeline.inputs
    for index, element in enumerate(pipeline.elements):
        if element.inputs != given:
            yield error(
                f"{given} channels arrive at element {index}, which takes {element.inputs}",
                signature,
            )
        given = element.outputs
    if given != pipeline.outputs:
        yield error(f"{given} channels leave, the tag says {pipeline.outputs}", signature)
    if not pipeline.elements:
        yield warning("a pipeline without elements", signature)


def _channels(side: str, header: Header) -> int | None:
    """The channels of one side of a transform (TagKind.channels); None where unknown."""
    device = space_channels(header.device_space)
    match side:
        case "device":
            return device
        case "mcs":
            return space_channels(header.mcs)
        case "pcs":
            return space_channels(header.pcs)
        case "spectral":
            return space_channels(header.spectral_pcs)
        case "spectral or pcs":
            chosen = header.spectral_pcs if header.spectral_pcs != NO_SPACE else header.pcs
            return space_channels(chosen)
        case "brdf":
            return None if device is None else 4 + device
        case _:
            return int(side)


def _channel_names(profile: Profile) -> Iterator[Finding]:
    """Names and defaults of the multiplex channels."""
    count = space_channels(profile.header.mcs) or 0
    names, defaults = profile.tags.get("mcta"), profile.tags.get("mdv ")
    if isinstance(names, Utf8Array):
        if len(names.names) != count:
            yield error(f"{len(names.names)} names for {count} channels", "mcta")
        if "" in names.names:
            yield error("an empty channel name", "mcta")
        for name in _repeated(names.names):
            yield error(f"two channels are called '{name}'", "mcta")
    elif names is not None:
        yield error("an array of utf8 is needed; with another, profiles do not connect", "mcta")
    if isinstance(defaults, NumberArray) and len(defaults.values) != count:
        yield error(f"{len(defaults.values)} defaults for {count} channels", "mdv ")


def _values(profile: Profile) -> Iterator[Finding]:
    for signature, side, what in _COUNTED:
        tag, expected = profile.tags.get(signature), _channels(side, profile.header)
        count = _count(tag) if tag else None
        if expected and count is not None and count != expected:
            yield error(f"{count} {what}, not {expected}", signature)
    metadata = profile.tags.get("meta")
    if isinstance(metadata, Dictionary):
        names = [name for name, _ in metadata.entries]
        if "" in names:
            yield warning("an entry without a name", "meta")
        for name in _repeated(names):
            yield warning(f"two entries are called '{name}'", "meta")


_COUNTED = (
    *((signature, "1", "colours") for signature in ("wtpt", "bkpt", "lumi")),
    *((f"{colour}XYZ", "1", "colours") for colour in "rgb"),
    ("chad", "9", "numbers"),
    ("clrt", "device", "colorants"),
    ("clot", "pcs", "colorants"),
    ("clro", "device", "colorants"),
    ("ncl2", "device", "device coordinates"),
)
"""Tags, how many values they have (TagKind.channels), and of what."""


def _count(tag: Tag) -> int | None:
    """The values in a tag that _COUNTED has; None if it holds others."""
    match tag:
        case XYZArray(values) | FixedArray(_, values):
            return len(values)
        case Record("clrt" | "clro"):
            return len(tag.rows)
        case NamedColours():
            return tag.coordinates or None
    return None


def _repeated(names: tuple[str, ...] | list[str]) -> list[str]:
    return [name for name, count in Counter(names).items() if count > 1]


# --- the bytes ----------------------------------------------------------------------------------


def _layout(source: bytes | None) -> Iterator[Finding]:
    """Alignment, double entries and the profile ID, of a profile that was read."""
    if source is None:
        return
    if len(source) % 4 and source[8] >= 4:  # version 2 does not pad the last tag
        yield error(f"a size of {len(source)} bytes is not a multiple of 4")
    (count,) = unpack("I", source, TABLE_START - 4, "tag table")
    records = unpack_records("4sII", count, source, TABLE_START, "tag table")
    for signature, offset, _ in records:
        if offset % 4:
            yield error(f"begins at byte {offset}, not a multiple of 4", signature_text(signature))
    ordered = sorted(signature for signature, _, _ in records)
    for signature in dict.fromkeys(a for a, b in pairwise(ordered) if a == b):
        yield warning("stands twice in the tag table", signature_text(signature))
    if any(source[84:100]) and source[8] >= 4 and source[84:100] != compute_profile_id(source):
        yield error("the profile ID is not the MD5 of the contents")
