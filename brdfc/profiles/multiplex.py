"""The encoding of the published workflow: a MID and an MVIS, joined in the multiplex space.

The MID passes the samples of a coefficient image on under their names; the MVIS takes them by name
and evaluates the model to XYZ; with wavelengths, to reflectances as well.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from brdfc.calc.program import Op, Program
from brdfc.files import write_all
from brdfc.icc.header import Header
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import multiplex_space, n_channel_space
from brdfc.icc.types import NumberArray, Pipeline, Tag, Utf8Array
from brdfc.profiles.content import Content


@dataclass(frozen=True)
class ProfilePair:
    """A MID and the MVIS it feeds."""

    mid: Profile
    mvis: Profile

    def files(self, mvis: str | Path, mid: str | Path | None = None) -> list[tuple[Path, bytes]]:
        """Path and bytes of the MID and of the MVIS; the MID beside the MVIS unless said where."""
        place = Path(mvis)
        mid_place = Path(mid) if mid is not None else mid_beside(place)
        return [(mid_place, self.mid.to_bytes()), (place, self.mvis.to_bytes())]

    def save(self, mvis: str | Path, mid: str | Path | None = None) -> tuple[Path, Path]:
        """Write both or none; see files. Returns (mid, mvis) paths."""
        (mid_place, first), (place, second) = self.files(mvis, mid)
        write_all((mid_place, first), (place, second))
        return mid_place, place


def mid_beside(mvis: Path) -> Path:
    """`ward_mvis.icc` -> `ward_mid.icc`; any other name gets `_mid` before its suffix."""
    stem = mvis.stem
    base = stem[: -len("mvis")] if stem.endswith("mvis") else f"{stem}_"
    return mvis.with_name(f"{base}mid{mvis.suffix}")


def profile_pair(content: Content) -> ProfilePair:
    """A MID that names the channels, and an MVIS that evaluates the program."""
    count = len(content.names)
    channels = Utf8Array(content.names)
    passing = Program(count, count, (Op("in", 0, count), Op("out", 0, count)))
    mid = Profile(
        Header("mid ", colour_space=n_channel_space(count), mcs=multiplex_space(count)),
        {
            **content.texts("coefficients"),
            "A2M0": Pipeline(count, count, (passing,)),
            "mcta": channels,
        },
    )
    tags: dict[str, Tag] = {
        **content.texts("appearance"),
        "M2B0": content.colorimetric(),
        "mcta": channels,
        "mdv ": NumberArray("fl32", content.defaults),
        **content.colours(),
    }
    if content.grid is not None:
        tags["M2S0"] = content.spectral()
    mvis = Profile(content.header("mvis", mcs=multiplex_space(count)), tags)
    return ProfilePair(mid, mvis)
