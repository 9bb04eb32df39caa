"""The ICC's reference engine on profiles that the tests of the container make."""

from pathlib import Path

from brdfc.cmm import reference


def reference_verdict(data: bytes, folder: Path) -> tuple[str, str]:
    """The reference's verdict ("OK", "warning", ...) on a profile's bytes, and its report."""
    path = folder / "judged.icc"
    path.write_bytes(data)
    return reference.validate(path)


def reference_link(pixels: list[list[float]], mid: Path, mvis: Path) -> list[list[float]]:
    """XYZ for each pixel through a MID and an MVIS."""
    return reference.apply(mid, mvis, pixels).xyz[0].tolist()
