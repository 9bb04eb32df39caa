"""Chains of profiles: against the reference engine, and what does not connect."""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from pathlib import Path

import numpy as np
import pytest
from chain_profiles import (
    GAMMA,
    SRGB,
    TABLE,
    display,
    gray,
    pipelined,
    printer,
    profile,
    staged,
)

import brdfc
from brdfc.calc.samples import Storage
from brdfc.cmm import reference
from brdfc.cmm.connect import connect
from brdfc.cmm.connection import NEEDS_SUBSET
from brdfc.cmm.intents import Intent
from brdfc.colour.conditions import viewing_conditions
from brdfc.colour.difference import D50
from brdfc.icc.curves import Curve, ParametricCurve
from brdfc.icc.profile import Profile
from brdfc.icc.types import Pipeline, Utf8Array
from brdfc.source.errors import LinkError, ValueGivenError

RNG = np.random.default_rng(5)
RGB = RNG.uniform(0, 1, (400, 3)).astype(np.float32)
CMYK = RNG.uniform(0, 1, (400, 4)).astype(np.float32)


@pytest.fixture(scope="module")
def ward() -> brdfc.Compiled:
    return brdfc.compile(brdfc.load("ward"))


def judged(
    folder: Path,
    profiles: list[Profile],
    pixels: np.ndarray,
    intent: Intent,
    to_xyz: bool,
    tetrahedral: bool = False,
) -> np.ndarray:
    paths = []
    for number, each in zip(count(), profiles, strict=False):
        paths.append(folder / f"{number}.icc")
        each.save(paths[-1])
    run = reference.chain(
        paths, pixels, encoded=to_xyz, intent=int(intent), tetrahedral=tetrahedral
    )
    return run.xyz[0]


TO_COLOURS = {
    "formula": (display(SRGB), RGB),
    "gamma": (display(GAMMA), RGB),
    "table": (display(TABLE, 2), RGB),
    "mft1": (printer(Storage.UINT8), CMYK),
    "mft2": (printer(), CMYK),
    "mft2 v4": (printer(version=4), CMYK),
    "mAB Lab": (staged(), RGB),
    "mAB XYZ": (staged(b"XYZ "), RGB),
    "elements XYZ": (pipelined(), RGB),
    "elements Lab": (pipelined(b"Lab "), RGB),
    "gray": (gray(), RGB[:, :1]),
}


@pytest.mark.parametrize("name", TO_COLOURS)
@pytest.mark.parametrize("intent", list(Intent))
def test_device_values_to_colours(name: str, intent: Intent, tmp_path: Path) -> None:
    pytest.importorskip("iccdev")
    made, pixels = TO_COLOURS[name]
    ours = connect(made, intent=intent).apply(pixels).astype(np.float64)
    theirs = judged(tmp_path, [made], pixels, intent, to_xyz=True)
    np.testing.assert_allclose(ours, theirs, atol=5e-6)


def test_tables_in_tetrahedra(tmp_path: Path) -> None:
    pytest.importorskip("iccdev")
    made = staged()
    ours = connect(made, interpolation="tetrahedral").apply(RGB)
    theirs = judged(tmp_path, [made], RGB, Intent.RELATIVE, to_xyz=True, tetrahedral=True)
    np.testing.assert_allclose(ours, theirs, atol=5e-6)
    assert np.abs(ours - connect(made).apply(RGB)).max() > 1e-3


TO_DEVICES = {
    "formula": display(SRGB),
    "gamma": display(GAMMA, 2),
    "table": display(TABLE),
    "mft1": printer(Storage.UINT8),
    "mft2": printer(),
    "mBA Lab": staged(),
    "mBA XYZ": staged(b"XYZ "),
    "elements XYZ": pipelined(),
    "elements Lab": pipelined(b"Lab "),
    "gray": gray(),
}


@pytest.mark.parametrize("name", TO_DEVICES)
@pytest.mark.parametrize("intent", list(Intent))
def test_channels_to_colours_to_devices(
    name: str, intent: Intent, ward: brdfc.Compiled, tmp_path: Path
) -> None:
    """The reference inverts tone curves in 2048 equal steps, which for dark values is coarse, and a
    power of less than one makes much of the last digit of a dark colour."""
    pytest.importorskip("iccdev")
    pixels = RNG.uniform([0.05] * 3 + [0.0, 0.1], [0.6] * 3 + [0.1, 0.3], (400, 5))
    chain = [ward.mid, ward.mvis, TO_DEVICES[name]]
    ours = connect(*chain, intent=intent).apply(pixels)
    theirs = judged(tmp_path, chain, pixels, intent, to_xyz=False)
    assert ours.shape == theirs.shape
    steep = name in ("formula", "gamma", "table", "gray", "elements Lab")
    np.testing.assert_allclose(ours, theirs, atol=2e-2 if steep else 1e-5)
    assert np.median(np.abs(ours - theirs)) < 5e-6


@pytest.mark.parametrize(
    "curve",
    [
        SRGB,
        GAMMA,
        TABLE,
        Curve(),
        Curve(gamma=1.0),
        ParametricCurve(0, (1.8,)),
        ParametricCurve(1, (2.0, 0.9, 0.1)),
        ParametricCurve(2, (2.0, 0.8, 0.1, 0.1)),
        ParametricCurve(4, (2.4, 0.9, 0.05, 0.2, 0.1, 0.02 - 0.14**2.4, 0.0)),
        ParametricCurve(0, (0.0,)),
    ],
    ids=str,
)
def test_a_tone_curve_and_its_inverse(curve: Curve | ParametricCurve) -> None:
    """To the last digits, down to black; where the curve is level, back to what gives the same."""
    from brdfc.cmm.tones import inverse_tone, tone
    from brdfc.engine.curves import apply_curve

    x = np.concatenate([np.linspace(0, 1, 1001), np.logspace(-5, 0, 200)]).astype(np.float32)
    y = apply_curve(tone(curve), x)
    if curve.parameters == (0.0,) if isinstance(curve, ParametricCurve) else False:
        with pytest.raises(LinkError, match="constant"):
            inverse_tone(curve)
        return
    back = apply_curve(inverse_tone(curve), y)
    again = apply_curve(tone(curve), back)
    np.testing.assert_allclose(again, y, rtol=1e-5, atol=1e-7)
    if curve is not TABLE:  # whose 16 bits are level in places
        rises = y > y.min()
        np.testing.assert_allclose(back[rises], x[rises], rtol=2e-5, atol=1e-6)
    beyond = apply_curve(inverse_tone(curve), np.float32([-1, 2]))
    assert ((beyond >= 0) & (beyond <= 1)).all()


def test_a_value_that_a_tone_curve_jumps_over_leads_to_the_jump() -> None:
    from brdfc.cmm.tones import inverse_tone
    from brdfc.engine.curves import apply_curve

    jumps = ParametricCurve(3, (2.2, 0.8, 0.2, 0.1, 0.5))  # from 0.05 to 0.325
    back = apply_curve(inverse_tone(jumps), np.float32([0.02, 0.06, 0.2, 0.32, 0.6**2.2, 1.0]))
    np.testing.assert_allclose(back, [0.2, 0.5, 0.5, 0.5, 0.5, 1.0], rtol=1e-6)


@pytest.mark.parametrize("intent", [Intent.RELATIVE, Intent.ABSOLUTE])
def test_cielab_goes_on_as_it_is(intent: Intent) -> None:
    """Colours too of which X, Y or Z would be negative: tables are full of them."""
    as_it_is = {"A2B1": Pipeline(3, 3, ()), "B2A1": Pipeline(3, 3, ())}
    made = profile("spac", b"3CLR", b"Lab ", 5, **as_it_is)
    imaginary = np.float32([[5, 90, 90], [20, -120, 0], [60, 10, -10]])
    np.testing.assert_array_equal(connect(made, made, intent=intent).apply(imaginary), imaginary)


def test_absolute_colours_are_relative_ones_times_the_medium() -> None:
    made = printer()
    relative = connect(made, intent="relative").apply(CMYK)
    absolute = connect(made, intent="absolute").apply(CMYK)
    media = np.array([0.9, 0.93, 0.75]) / (0.9642, 1.0, 0.8249)
    np.testing.assert_allclose(absolute, relative * media, rtol=1e-4, atol=1e-6)
    inks = connect(made, made, intent="absolute").apply(CMYK)
    np.testing.assert_allclose(inks, connect(made, made).apply(CMYK), atol=1e-5)


def test_device_values_through_two_profiles_and_back() -> None:
    link = connect(display(SRGB), display(TABLE), display(TABLE), display(SRGB))
    np.testing.assert_allclose(link.apply(RGB), RGB, atol=2e-4)
    assert link.channels == ("R", "G", "B")


def test_a_light_of_its_own_comes_to_the_display_by_way_of_d50() -> None:
    compiled = brdfc.compile(brdfc.load("lambert"), conditions=viewing_conditions(light="A"))
    white = np.array(compiled.mvis.header.illuminant)
    assert not np.allclose(white, D50, atol=0.01)
    shown = connect(compiled.mid, compiled.mvis, display(SRGB)).apply([white / 2])
    assert np.ptp(shown) < 1e-3  # a gray is a gray
    without = replace(compiled.mvis, tags=_without(compiled.mvis, "c2sp").tags)
    with pytest.raises(LinkError, match="does not say how its colours come to another"):
        connect(compiled.mid, without, display(SRGB))


def _linked(mcs_first: bool) -> Profile:
    """An MLNK, its device space where the specification or where the reference has it."""
    from brdfc.calc.program import Matrix
    from brdfc.icc.header import Header
    from brdfc.icc.signatures import NO_SPACE, multiplex_space

    spaces = {"pcs": b"RGB "} if mcs_first else {"colour_space": b"RGB ", "pcs": NO_SPACE}
    header = Header("mlnk", mcs=multiplex_space(2), **spaces)
    matrix = Matrix(2, 3, (1.0, 0.0, 0.0, 1.0, 0.5, 0.5), (0.0, 0.0, 0.0))
    return Profile(header, {"mcta": Utf8Array(("ks", "m")), "M2A0": Pipeline(2, 3, (matrix,))})


@pytest.mark.parametrize("by_specification", [True, False])
def test_an_mlnk_leads_back_to_device_values(by_specification: bool, ward: brdfc.Compiled) -> None:
    link = connect(ward.mid, _linked(by_specification))
    np.testing.assert_allclose(link.apply([[0.1, 0.2, 0.3, 0.4, 0.6]]), [[0.4, 0.6, 0.5]])
    assert connect(ward.mid, _linked(by_specification), display(SRGB)).gives.kind.name == "COLOURS"


def test_an_input_profile_with_channels_stands_for_a_mid(ward: brdfc.Compiled) -> None:
    tags = {**ward.mid.tags, "A2B0": pipelined().tags["A2B1"]}
    header = replace(ward.mid.header, device_class="scnr", pcs=b"XYZ ")
    scanner = Profile(header, tags)
    pixel = [[0.1, 0.2, 0.6, 0.05, 0.15]]
    np.testing.assert_array_equal(
        connect(scanner, ward.mvis).apply(pixel), connect(ward.mid, ward.mvis).apply(pixel)
    )


@pytest.mark.parametrize("place", ["mid", "mvis"])
def test_a_profile_that_needs_all_of_its_channels(place: str, ward: brdfc.Compiled) -> None:
    """Every name must be there; the order is free."""
    flagged = {
        n: replace(p, header=replace(p.header, flags=NEEDS_SUBSET if n == place else 0))
        for n, p in (("mid", ward.mid), ("mvis", ward.mvis))
    }
    names = ("m", "ks", "Rdz", "Rdy", "Rdx")
    turned = {"mcta": Utf8Array(names)}
    other = "mvis" if place == "mid" else "mid"
    flagged[other] = replace(flagged[other], tags={**flagged[other].tags, **turned})
    connect(flagged["mid"], flagged["mvis"])
    less = {"mcta": Utf8Array((*names[:4], "Red"))}
    flagged[other] = replace(flagged[other], tags={**flagged[other].tags, **less})
    with pytest.raises(LinkError, match=r"needs subset.*it has not: Rdx"):
        connect(flagged["mid"], flagged["mvis"])


def _without(made: Profile, *names: str) -> Profile:
    return replace(made, tags={k: v for k, v in made.tags.items() if k not in names})


def _with(made: Profile, **tags: object) -> Profile:
    return replace(made, tags={**made.tags, **tags})


def _spaced(made: Profile, space: bytes) -> Profile:
    return replace(made, header=replace(made.header, colour_space=space))


NO_CHAIN = {
    "a display after a MID": (lambda w: (w.mid, display(SRGB)), "after a MID the next profile"),
    "a MID after colours": (lambda w: (w.mid, w.mvis, w.mid), "colours do not go into"),
    "other device values": (
        lambda w: (display(SRGB), display(SRGB), printer()),
        "profile 3 of 3: device values of RGB do not go into .* of CMYK",
    ),
    "no way back": (
        lambda w: (w.mid, w.mvis, _without(printer(), "B2A0", "B2A1", "B2A2")),
        "no transform from colours to device values of CMYK",
    ),
    "no tone curve": (
        lambda w: (_without(display(SRGB), "gTRC"),),
        "no transform from device values of RGB to colours",
    ),
    "named colours": (lambda w: (profile("nmcl", b"RGB ", b"Lab ", 4),), "names colours"),
    "another connection space": (
        lambda w: (replace(staged(), header=replace(staged().header, pcs=b"Luv ")),),
        "'Luv', not to X, Y, Z",
    ),
    "no white": (lambda w: (_without(printer(), "wtpt"),), "no white of its medium"),
    "more channels than the device": (
        lambda w: (_with(display(SRGB), A2B1=printer().tags["A2B1"]),),
        "'A2B1' has 4 channels, and device values of RGB are 3",
    ),
    "a space of no known size": (
        lambda w: [_spaced(p, b"none") for p in (printer(), printer(), pipelined())],
        "profile 3 of 3: 4 values do not go into a profile that takes 3",
    ),
    "colorants in a plane": (
        lambda w: (w.mid, w.mvis, _with(display(SRGB), bXYZ=display(SRGB).tags["rXYZ"])),
        "lie in a plane",
    ),
}


@pytest.mark.parametrize("name", NO_CHAIN)
def test_what_does_not_connect(name: str, ward: brdfc.Compiled) -> None:
    make, message = NO_CHAIN[name]
    with pytest.raises(LinkError, match=message):
        connect(*make(ward), intent="absolute" if name == "no white" else None)


def test_an_intent_there_is_not() -> None:
    with pytest.raises(ValueGivenError, match="'vivid' is no rendering intent"):
        connect(display(SRGB), intent="vivid")
