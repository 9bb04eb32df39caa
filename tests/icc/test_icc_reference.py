"""The reference library accepts what brdfc.icc writes, and runs it."""

import itertools

import pytest
from icc_reference import reference_link, reference_verdict
from icc_samples import COPY, MINIMAL_MID, mid, mvis

from brdfc.icc.types import Dictionary, NumberArray, Pipeline, Utf8Array
from brdfc.icc.validate import validate

pytest.importorskip("iccdev", reason="the reference engine is not installed")

PROFILES = {
    "minimal MID": MINIMAL_MID,
    "MID": mid().to_bytes(),
    "MVIS": mvis().to_bytes(),
    "no profile ID": mvis().to_bytes(profile_id=False),
    "shared tag": mvis(M2B1=COPY, M2B3=COPY).to_bytes(),
    "shared element": mvis(M2B0=Pipeline(3, 3, COPY.elements * 2)).to_bytes(),
    "defaults in 8 bits": mvis(mdv=NumberArray("ui08", (255, 0, 9))).to_bytes(),
    "defaults in 16 bits": mvis(mdv=NumberArray("ui16", (65535, 0, 9))).to_bytes(),
    "defaults in halves": mvis(mdv=NumberArray("fl16", (0.5, 0.25, 2.0))).to_bytes(),
    "longest dictionary text": mid(meta=Dictionary((("n" * 200, "ä" * 100),))).to_bytes(),
}


@pytest.mark.parametrize("name", PROFILES)
def test_accepted_without_a_warning(name, tmp_path):
    assert reference_verdict(PROFILES[name], tmp_path) == ("OK", "")


REFUSED = {
    "no white point": mvis(wtpt=None),
    "no names": mid(mcta=None),
    "no transform": mid(A2M0=None),
    "too few names": mid(mcta=Utf8Array(("a", "b"))),
    "too few defaults": mvis(mdv=NumberArray("fl32", (0.5,))),
    "two entries of one name": mid(meta=Dictionary((("a", "1"), ("a", "2")))),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_the_reference_complains_of_validate_finds(name, tmp_path):
    verdict, report = reference_verdict(REFUSED[name].to_bytes(), tmp_path)
    findings = validate(REFUSED[name])
    assert verdict != "OK", "the reference judge is asleep"
    assert report
    assert ("error" in {finding.severity for finding in findings}) == (verdict != "warning")
    assert findings


def test_a_mid_links_to_an_mvis_and_carries_the_numbers(tmp_path):
    mid().save(tmp_path / "mid.icc")
    mvis().save(tmp_path / "mvis.icc")
    pixels = [list(pixel) for pixel in itertools.product((0.0, 0.1, 0.75), repeat=3)]
    results = reference_link(pixels, tmp_path / "mid.icc", tmp_path / "mvis.icc")
    for pixel, result in zip(pixels, results, strict=True):
        assert result == pytest.approx(pixel, rel=1e-5, abs=1e-7)


def test_channels_connect_by_name_and_defaults_fill_the_rest(tmp_path):
    mid(mcta=Utf8Array(("ρdz", "Rdx", "unused"))).save(tmp_path / "mid.icc")
    mvis().save(tmp_path / "mvis.icc")
    result = reference_link([[0.1, 0.2, 0.3]], tmp_path / "mid.icc", tmp_path / "mvis.icc")
    assert result[0] == pytest.approx([0.2, 0.25, 0.1], rel=1e-5)
