"""From connection spaces to colours for a purpose, held against colour-science."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import brdfc
from brdfc.cmm.rendering import Target, spectral_grid, target
from brdfc.colour.adaptation import adaptation_matrix
from brdfc.colour.conditions import viewing_conditions
from brdfc.colour.difference import D50, ciede2000
from brdfc.icc.profile import Profile
from brdfc.source.errors import BrdfcError, LinkError, ValueGivenError

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import colour

LAMP = (0.97, 1.0, 0.484)
PIXELS = np.random.default_rng(4).uniform(0.05, 0.4, (40, 5)).astype(np.float32)
CORNELL = Path(__file__).resolve().parents[3] / "shared" / "data" / "cornell"
"""Beside the checkout; nothing of it is in the project."""
RUN = {"incident": 0.7, "reflection": 0.4}


@pytest.fixture(scope="module")
def lamp() -> brdfc.Compiled:
    conditions = viewing_conditions(white=LAMP)
    return brdfc.compile(brdfc.load("ward"), conditions=conditions, effort=1)


@pytest.fixture(scope="module")
def spectral() -> brdfc.Compiled:
    model = brdfc.load("ward", spectral="400nm..700nm,10nm")
    return brdfc.compile(model, conditions=viewing_conditions("A"), effort=1)


def link(compiled: brdfc.Compiled, transform: str | None = None) -> brdfc.Link:
    return brdfc.connect(compiled.mid, compiled.mvis, env=RUN, transform=transform)


def test_the_profiles_own_xyz_is_what_the_link_gives(lamp: brdfc.Compiled) -> None:
    found = brdfc.rendering(link(lamp))
    np.testing.assert_array_equal(found.apply(PIXELS), link(lamp).apply(PIXELS))
    assert found.white == pytest.approx(LAMP, rel=1e-7)


@pytest.mark.parametrize("name", ["D50", "D65", "A"])
@pytest.mark.parametrize("transform", ["bradford", "cat16"])
def test_colours_come_to_another_white_by_way_of_d50(
    name: str, transform: str, lamp: brdfc.Compiled
) -> None:
    found = brdfc.rendering(link(lamp), adapt=name, transform=transform)
    white = viewing_conditions(name).white
    own = link(lamp).apply(PIXELS).astype(np.float64)
    expected = own @ adaptation_matrix(LAMP, D50).T @ adaptation_matrix(D50, white, transform).T
    np.testing.assert_allclose(found.apply(PIXELS), expected, rtol=1e-6)
    assert found.white == white
    perfect = np.array([[*LAMP, 0.0, 0.1]], np.float32)
    at_normal = brdfc.connect(lamp.mid, lamp.mvis, env={"incident": 0, "reflection": 0})
    white_paper = brdfc.rendering(at_normal, adapt=name, transform=transform).apply(perfect)
    np.testing.assert_allclose(white_paper[0] * np.pi, white, rtol=1e-6)


def test_a_white_may_be_given_as_numbers(lamp: brdfc.Compiled) -> None:
    by_name = brdfc.rendering(link(lamp), adapt="D50").apply(PIXELS)
    by_number = brdfc.rendering(link(lamp), adapt="96.42,100,82.49").apply(PIXELS)
    np.testing.assert_allclose(by_number, by_name, rtol=1e-7)


@pytest.mark.parametrize("adapt", [None, "D50", "D65"])
def test_cielab_is_that_of_colour_science(adapt: str | None, lamp: brdfc.Compiled) -> None:
    found = brdfc.rendering(link(lamp), Target.LAB, adapt)
    xyz = brdfc.rendering(link(lamp), adapt=adapt).apply(PIXELS).astype(np.float64)
    expected = colour.XYZ_to_Lab(xyz, colour.XYZ_to_xy(np.array(found.white)))
    np.testing.assert_allclose(found.apply(PIXELS), expected, atol=2e-4)


def test_srgb_is_that_of_colour_science(lamp: brdfc.Compiled) -> None:
    picture, outside = brdfc.rendering(link(lamp), "sRGB").counted(PIXELS)
    xyz = brdfc.rendering(link(lamp), adapt="D50").apply(PIXELS).astype(np.float64)
    exact = colour.XYZ_to_sRGB(
        xyz,
        illuminant=colour.XYZ_to_xy(np.array(D50)),
        chromatic_adaptation_transform="Bradford",
    )
    assert picture.dtype == np.uint8
    assert np.abs(picture - 255 * np.clip(exact, 0, 1)).max() <= 0.51
    assert outside == ((exact < -0.5 / 255) | (exact > 255.5 / 255)).any(axis=-1).sum()


def test_a_profile_for_d50_needs_no_conditions_to_be_adapted() -> None:
    compiled = brdfc.compile(brdfc.load("ward"), effort=1)
    found = brdfc.rendering(link(compiled), adapt="D65").apply(PIXELS)
    own = link(compiled).apply(PIXELS).astype(np.float64)
    expected = own @ adaptation_matrix(D50, viewing_conditions("D65").white).T
    np.testing.assert_allclose(found, expected, rtol=1e-6)


# ---------------------------------------------------------------- reflectances


def test_reflectances_are_seen_under_any_light(spectral: brdfc.Compiled) -> None:
    """The same as integrating what the model gives, for lights the profile does not know."""
    pixels = np.random.default_rng(6).uniform(0.05, 0.9, (20, 33)).astype(np.float32)
    reflectances = brdfc.rendering(link(spectral, "M2S0"), "spectrum").apply(pixels)
    assert reflectances.shape == (20, 31)
    for light, observer in (("D65", "1931-2"), ("FL11", "1964-10"), (None, None)):
        asked = viewing_conditions(light, observer) if light else None
        found = brdfc.rendering(link(spectral, "M2S0"), conditions=asked)
        seen = asked or viewing_conditions("A")
        matrix = seen.reflectances_to_xyz(spectral_grid(spectral.mvis))
        np.testing.assert_allclose(found.apply(pixels), reflectances @ matrix.T, rtol=1e-5)
        np.testing.assert_allclose(found.white, seen.white, rtol=1e-6)


def test_the_spectral_and_the_colorimetric_path_agree() -> None:
    """Flat and smooth reflectances through wavelengths, and their colours through X, Y, Z."""
    grid = np.arange(400, 701, 10.0)
    samples = [0.5 + 0.4 * np.sin(grid / s + p) for s, p in ((40.0, 0), (60.0, 1), (90.0, 2))]
    samples += [np.full(31, 0.18), np.linspace(0.05, 0.8, 31)]
    for light in ("A", "D65", "FL11"):
        conditions = viewing_conditions(light)
        wide = brdfc.load("ward", spectral="400nm..700nm,10nm")
        by_wavelength = brdfc.compile(wide, conditions=conditions)
        by_colour = brdfc.compile(brdfc.load("ward"), conditions=conditions)
        matrix = conditions.reflectances_to_xyz(spectral_grid(by_wavelength.mvis))
        for angles in ({"incident": 0.7, "reflection": a} for a in (-0.2, 0.0, 0.6, 0.7)):
            ends = np.array([[0.05, 0.1]] * len(samples), np.float32)
            spectra = np.array(samples, np.float32)
            colours = (spectra.astype(np.float64) @ matrix.T).astype(np.float32)
            first = brdfc.connect(
                by_wavelength.mid, by_wavelength.mvis, env=angles, transform="M2S0"
            )
            second = brdfc.connect(by_colour.mid, by_colour.mvis, env=angles)
            one = brdfc.rendering(first).apply(np.hstack([spectra, ends]))
            other = brdfc.rendering(second).apply(np.hstack([colours, ends]))
            assert ciede2000(one, other, conditions.white).max() <= 1e-4


def test_metamers_part_under_another_light(spectral: brdfc.Compiled) -> None:
    """Two spectra with one colour under A, and another under D65."""
    under_a = viewing_conditions("A").reflectances_to_xyz(spectral_grid(spectral.mvis))
    first = np.full(31, 0.5)
    _, _, rows = np.linalg.svd(under_a)
    kept = rows[3:]  # what A does not see; of it, what D65 sees best
    under_d65 = viewing_conditions("D65").reflectances_to_xyz(spectral_grid(spectral.mvis))
    unseen = kept.T @ (kept @ under_d65[2])
    second = first + 0.3 * unseen / np.abs(unseen).max()
    ends = [0.0, 0.1]
    pixels = np.array([[*first, *ends], [*second, *ends]], np.float32)
    same = brdfc.rendering(link(spectral, "M2S0"), "Lab").apply(pixels)
    other = brdfc.rendering(link(spectral, "M2S0"), "Lab", conditions=viewing_conditions("D65"))
    assert np.abs(same[0] - same[1]).max() < 1e-3
    assert np.abs(np.subtract(*other.apply(pixels))).max() > 1


@pytest.mark.skipif(not CORNELL.is_dir(), reason="the measured paints are not beside the checkout")
@pytest.mark.parametrize("paint", ["garnet_red", "mystique", "acryl_blue"])
def test_measured_reflectances_go_through(paint: str, spectral: brdfc.Compiled) -> None:
    """The colours that colour-science integrates from the measurement, under lights and for an
    observer that the profile does not know."""
    words = [
        word
        for line in (CORNELL / f"{paint}.brdf").read_text().splitlines()
        for word in line.partition("#")[0].split()
    ]
    numbers = np.array(words[1 : 1 + 31 + 1439 * 35], np.float64)
    assert (int(words[0]), len(words), numbers[30]) == (31, 1 + len(numbers), 700)
    records = numbers[31:].reshape(-1, 35)
    factors = np.pi * np.cos(records[:, :1]) * records[:, 4:]
    factors = factors[(factors <= 1).all(axis=1)]  # the diffuse body, and not the highlight
    assert len(factors) > 1000
    ends = np.tile([0.0, 0.1], (len(factors), 1))
    pixels = np.hstack([factors, ends]).astype(np.float32)
    from_above = {"incident": 0.0, "reflection": 0.3}  # where the radiance is Rd / pi
    found = brdfc.connect(spectral.mid, spectral.mvis, env=from_above, transform="M2S0")
    back = np.pi * brdfc.rendering(found, "spectrum").apply(pixels)
    np.testing.assert_allclose(back, pixels[:, :31], rtol=3e-7, atol=1e-9)

    # as the ICC's engine reads spectra: linear between the samples, and constant beyond their ends
    for light in ("D65", "FL11"):
        conditions = viewing_conditions(light, "1964-10")
        nm = conditions.grid.wavelengths
        shape = colour.SpectralShape(nm[0], nm[-1], nm[1] - nm[0])
        spread = [np.interp(nm, spectral_grid(spectral.mvis).wavelengths, row) for row in factors]
        theirs = colour.msds_to_XYZ(
            colour.MultiSpectralDistributions(np.transpose(spread), nm),
            colour.MSDS_CMFS["CIE 1964 10 Degree Standard Observer"].copy().align(shape),
            colour.SDS_ILLUMINANTS[light].copy().align(shape),
            method="Integration",
        )
        ours = np.pi * brdfc.rendering(found, conditions=conditions).apply(pixels)
        assert ciede2000(ours, theirs / 100, conditions.white).max() < 0.01


# ---------------------------------------------------------------- what cannot be


def without(profile: Profile, *tags: str) -> Profile:
    return replace(profile, tags={k: v for k, v in profile.tags.items() if k not in tags})


def test_an_adaptation_without_viewing_conditions_is_refused(lamp: brdfc.Compiled) -> None:
    silent = brdfc.connect(lamp.mid, without(lamp.mvis, "svcn", "c2sp", "s2cp"), env=RUN)
    brdfc.rendering(silent)
    with pytest.raises(LinkError, match=r"white \(0\.97, 1, 0\.484\), and the profile does not"):
        brdfc.rendering(silent, adapt="D65")
    with pytest.raises(LinkError, match="no viewing conditions"):
        brdfc.rendering(silent, "sRGB")


@pytest.mark.parametrize(
    ("how", "error", "message"),
    [
        ({"to": "Labb"}, ValueGivenError, "did you mean 'Lab'?"),
        ({"adapt": "D56"}, ValueGivenError, "did you mean 'D55'?"),
        ({"adapt": "1,2"}, ValueGivenError, "three finite numbers"),
        ({"adapt": "a,b,c"}, ValueGivenError, "is no white"),
        ({"adapt": "0.9,0,0.8"}, ValueGivenError, "the white's Y is 0"),
        ({"adapt": "D65", "transform": "brad"}, ValueGivenError, "did you mean 'bradford'?"),
        ({"to": "sRGB", "adapt": "A"}, ValueGivenError, "sRGB is seen under D65"),
        ({"to": "spectrum"}, LinkError, "no reflectances to give"),
        ({"conditions": viewing_conditions("A")}, LinkError, "needs reflectances"),
    ],
)
def test_what_cannot_be_is_said(
    how: dict[str, object], error: type[BrdfcError], message: str, lamp: brdfc.Compiled
) -> None:
    with pytest.raises(error) as caught:
        brdfc.rendering(link(lamp), **how)  # type: ignore[arg-type]
    assert message in str(caught.value)


def test_reflectances_are_adapted_to_nothing(spectral: brdfc.Compiled) -> None:
    with pytest.raises(ValueGivenError, match="changes no reflectances"):
        brdfc.rendering(link(spectral, "M2S0"), "spectrum", adapt="D65")


def test_a_spectral_space_of_another_kind_is_refused(spectral: brdfc.Compiled) -> None:
    header = replace(spectral.mvis.header, spectral_pcs=b"es\x00\x1f")
    other = replace(spectral.mvis, header=header)
    wrong = brdfc.connect(spectral.mid, other, env=RUN, transform="M2S0")
    with pytest.raises(LinkError, match="not one of reflectances"):
        brdfc.rendering(wrong)


def test_targets_are_taken_in_any_case() -> None:
    assert target("srgb") is Target.SRGB
    assert target(" XYZ ") is Target.XYZ
