"""The examples, against their formulas in float64; and the reference engine's numbers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import brdfc
from brdfc.cmm import reference
from brdfc.xml.profile import encoded, from_xml, load_xml, to_xml

EXAMPLES = Path(__file__).parents[2] / "examples" / "xml"
PIXELS = np.random.default_rng(3).uniform(-0.1, 1.1, (200, 3)).astype(np.float32)


def inks(pixels: np.ndarray) -> np.ndarray:
    tone = np.loadtxt(EXAMPLES / "tone.txt")
    amounts = np.interp(np.clip(pixels, 0, 1), np.linspace(0, 1, len(tone)), tone)
    absorption = np.array([[2.1, 0.06, 0.02], [0.35, 2.4, 0.08], [0.12, 0.55, 2.6]])
    scattering = np.array([[0.08, 0.1, 0.14], [0.09, 0.11, 0.15], [0.1, 0.12, 0.16]])
    bands = np.array([[0.466, 0.3851, 0.1131], [0.2225, 0.7169, 0.0606], [0.0139, 0.0971, 0.7139]])
    q = (amounts @ absorption.T + [0.004, 0.005, 0.012]) / (amounts @ scattering.T + 1)
    return np.asarray((1 + q - np.sqrt(q * q + 2 * q)) @ bands.T)


def display(pixels: np.ndarray) -> np.ndarray:
    drive = np.clip(np.clip(0.98 * pixels + 0.02, 0, None) ** 2.2, 0, 1)
    corners = np.array(
        [
            [0, 0, 0],
            [0, 0.02, 0.99],
            [0.02, 0.98, 0.01],
            [0.02, 1, 1],
            [0.99, 0.02, 0],
            [0.99, 0.04, 0.99],
            [1, 1, 0.01],
            [1, 1, 1],
        ]
    ).reshape(2, 2, 2, 3)
    ends = [np.stack([1 - channel, channel]) for channel in drive.T]
    light = np.einsum("rn,gn,bn,rgbc->nc", *ends, corners)
    primaries = np.array(
        [[0.436, 0.3851, 0.1431], [0.2225, 0.7169, 0.0606], [0.0139, 0.0971, 0.7139]]
    )
    return np.asarray(light @ primaries.T)


@pytest.mark.parametrize("name", ["inks", "display"])
def test_compiled_written_and_compiled_again(name: str, tmp_path: Path) -> None:
    profile = load_xml(EXAMPLES / f"{name}.xml")
    data = encoded(profile)
    assert encoded(from_xml(to_xml(profile).encode(), "again.xml")) == data
    path = tmp_path / "x.icc"
    path.write_bytes(data)
    link = brdfc.connect(path)
    found = link.apply(PIXELS)
    if name == "inks":
        np.testing.assert_allclose(found, inks(PIXELS), rtol=2e-5, atol=1e-6)
    if reference.available():
        judged = reference.chain([path], PIXELS).xyz[0]
        np.testing.assert_allclose(found, judged, rtol=1e-5, atol=1e-6)


def test_the_displays_flare_adds_the_white(tmp_path: Path) -> None:
    path = tmp_path / "x.icc"
    path.write_bytes(encoded(load_xml(EXAMPLES / "display.xml")))
    dark = brdfc.connect(path).apply(PIXELS)
    lit = brdfc.connect(path, env={"flar": 0.01}).apply(PIXELS)
    white = np.broadcast_to([0.009642, 0.01, 0.008249], lit.shape)
    np.testing.assert_allclose(lit - dark, white, rtol=1e-4)
    np.testing.assert_allclose(dark, display(PIXELS), rtol=2e-5, atol=1e-6)
