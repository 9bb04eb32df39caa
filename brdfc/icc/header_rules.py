"""What a header may hold: its fields, and the colour spaces of each class."""

from __future__ import annotations

from collections.abc import Iterator

from brdfc.icc.findings import Finding, error, warning
from brdfc.icc.header import Header, SpectralRange
from brdfc.icc.signatures import (
    DEVICE_CLASSES,
    MULTIPLEX_CLASSES,
    NO_SPACE,
    space_channels,
    space_text,
)


def header_findings(header: Header) -> Iterator[Finding]:
    """The rules on the header alone."""
    yield from _fields(header)
    yield from _spaces(header)


def _fields(header: Header) -> Iterator[Finding]:
    if header.device_class not in DEVICE_CLASSES:
        yield error(f"unknown device class '{header.device_class}'")
    if header.major_version not in (2, 4, 5):
        yield error(f"unknown version {header.version:08X}")
    elif header.device_class in MULTIPLEX_CLASSES and header.major_version < 5:
        yield error(f"class '{header.device_class}' is not in version {header.major_version}")
    if header.flags & 0xFFF0:
        yield error(f"reserved flags are set: {header.flags:08X}")
    if header.attributes & 0xFFFFFFF0:
        yield error(f"reserved attributes are set: {header.attributes:016X}")
    if header.reserved:
        yield error("the reserved bytes at 124 are not zero")
    if header.device_class in ("mid ", "mlnk", "cenc"):
        return  # the reference leaves the fields below unread in these classes
    if header.rendering_intent & 0xFFFF > 3:
        yield error(f"unknown rendering intent {header.rendering_intent}")
    year, month, day, hour, minute, second = header.creation_date
    in_range = 1 <= month <= 12 and 1 <= day <= 31 and hour < 24 and minute < 60 and second < 60
    if year < 1992 or not in_range:
        yield warning(f"no likely creation date: {header.creation_date}")


def _spaces(header: Header) -> Iterator[Finding]:
    """The colour spaces that each class must and must not have."""
    kind = header.device_class
    mcs, pcs, spectral = header.mcs, header.pcs, header.spectral_pcs
    if kind in MULTIPLEX_CLASSES:
        if mcs[:2] != b"mc" or not space_channels(mcs):
            yield error(f"class '{kind}' needs a multiplex space such as mc0003")
    elif mcs != NO_SPACE and kind != "scnr":
        yield error(f"class '{kind}' takes no multiplex space")
    if kind == "mid " and pcs != NO_SPACE:
        yield error("a MID has no PCS")
    device = header.device_space
    if not space_channels(device) and not (kind in ("mvis", "cenc") and device == NO_SPACE):
        yield error(f"no known data colour space: '{space_text(device)}'")
    if kind == "mvis" and pcs not in (NO_SPACE, b"XYZ ", b"Lab "):
        yield error(f"the PCS of an MVIS is XYZ or Lab, not '{space_text(pcs)}'")
    if kind not in ("mid ", "mlnk", "cenc"):
        if pcs == NO_SPACE and spectral == NO_SPACE:
            yield error("neither a PCS nor a spectral PCS")
        elif space_channels(pcs) is None:
            yield error(f"unknown PCS '{space_text(pcs)}'")
        yield from _spectral(header)


def _spectral(header: Header) -> Iterator[Finding]:
    space, main, second = header.spectral_pcs, header.spectral_range, header.bispectral_range
    if space == NO_SPACE:
        return
    count = space_channels(space)
    if space[:2] not in (b"rs", b"ts", b"es", b"bs", b"sm") or not count:
        yield error(f"unknown spectral PCS '{space_text(space)}'")
        return
    bispectral = space[:2] in (b"bs", b"sm")
    for name, spectral in (("spectral", main), *((("bi-spectral", second),) * bispectral)):
        if spectral.end <= spectral.start or spectral.steps < 2:
            yield error(f"the {name} range needs 2 steps and an end above its start")
    if not bispectral and second != SpectralRange():
        yield error("a bi-spectral range without a bi-spectral PCS")
    steps = main.steps * (second.steps if bispectral else 1)
    if count != steps:
        yield error(f"spectral PCS '{space_text(space)}' has {count} channels, its range {steps}")
