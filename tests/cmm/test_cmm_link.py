"""Connections: by name, with defaults, and every refusal."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import brdfc
from brdfc.calc.calculator_curves import CalculatorCurve
from brdfc.calc.curves import CurveSet
from brdfc.calc.program import Element, Matrix, Op, Program
from brdfc.calc.samples import Samples
from brdfc.calc.tables import LookupTable
from brdfc.calc.text import assemble
from brdfc.icc.profile import Profile
from brdfc.icc.types import NumberArray, Pipeline, Utf8Array
from brdfc.profiles.content import Content
from brdfc.profiles.multiplex import profile_pair
from brdfc.source.errors import BrdfcError, LinkError, ProgramError, ValueGivenError

PIXEL = [0.1, 0.2, 0.6, 0.05, 0.15]


@pytest.fixture(scope="module")
def ward() -> brdfc.Compiled:
    return brdfc.compile(brdfc.load("ward"))


def pair(text: str, names: list[str], defaults: list[float] | None = None):
    """A MID and an MVIS around a calculator text."""
    program = Program(len(names), 3, assemble(text))
    return profile_pair(
        Content("test", program, tuple(names), tuple(defaults or [0.0] * len(names)))
    )


def with_tags(profile: Profile, **tags: object) -> Profile:
    kept = {k: v for k, v in {**profile.tags, **tags}.items() if v is not None}
    return replace(profile, tags=kept)


def test_the_public_interface_in_one_breath(tmp_path: Path) -> None:
    model = brdfc.load("ward")
    compiled = brdfc.compile(model, set={"m": 0.15})
    mid, mvis = compiled.save(tmp_path / "ward_mvis.icc")
    from_files = brdfc.connect(mid, mvis, env={"incident": 0.7, "reflection": -0.2})
    from_memory = brdfc.connect(compiled.mid, compiled.mvis, env={"inci": 0.7, "refl": -0.2})
    pixels = np.random.default_rng(0).uniform(0, 1, (4, 6, 4)).astype(np.float32)
    xyz = from_files.apply(pixels)
    assert xyz.shape == (4, 6, 3)
    assert xyz.dtype == np.float32
    np.testing.assert_array_equal(xyz, from_memory.apply(pixels))
    assert from_files.channels == ("Rdx", "Rdy", "Rdz", "ks")


def test_channels_connect_by_name_in_any_order(ward: brdfc.Compiled) -> None:
    order = [4, 0, 3, 2, 1]
    names = [ward.roles.channel_names[i] for i in order]
    mixed = profile_pair(Content("m", ward.program, tuple(names), (0.0,) * 5)).mid
    expected = brdfc.connect(ward.mid, ward.mvis).apply(PIXEL)
    result = brdfc.connect(mixed, ward.mvis).apply([PIXEL[i] for i in order])
    np.testing.assert_array_equal(result, expected)


def test_a_channel_the_mid_lacks_takes_its_default(ward: brdfc.Compiled) -> None:
    names = list(ward.roles.channel_names[:4])
    mid = pair("{ in[0,3] out[0,3] }", names).mid
    link = brdfc.connect(mid, ward.mvis)
    assert link.defaulted == ("m",)
    expected = brdfc.connect(ward.mid, ward.mvis).apply([*PIXEL[:4], 0.15])
    np.testing.assert_array_equal(link.apply(PIXEL[:4]), expected)


def test_names_agree_byte_for_byte(ward: brdfc.Compiled) -> None:
    mid = pair("{ in[0,3] out[0,3] }", ["rdx", "RDY", "Rdz "]).mid
    with pytest.raises(LinkError, match="no channel in common: rdx, RDY, Rdz  and Rdx, Rdy"):
        brdfc.connect(mid, ward.mvis)


def test_pipelines_of_several_elements_run_in_order(ward: brdfc.Compiled) -> None:
    half = Matrix(5, 5, tuple(np.eye(5).ravel() * 0.5), (0.0, 0.0, 0.0, 0.0, 0.1))
    passing = Program(5, 5, (Op("in", 0, 5), Op("out", 0, 5)))
    mid = with_tags(ward.mid, A2M0=Pipeline(5, 5, (half, passing)))
    scaled = [v / 2 for v in PIXEL[:4]] + [PIXEL[4] / 2 + 0.1]
    expected = brdfc.connect(ward.mid, ward.mvis).apply(scaled)
    np.testing.assert_allclose(brdfc.connect(mid, ward.mvis).apply(PIXEL), expected, rtol=1e-6)


def test_variables_reach_both_profiles() -> None:
    made = pair("{ in(0) env(gain) if { } else { pop 2 } mul copy(1,2) out[0,3] }", ["A"])
    assert brdfc.connect(made.mid, made.mvis).apply([3.0]).tolist() == [6, 6, 6]
    link = brdfc.connect(made.mid, made.mvis, env={"gain": 0.5})
    assert link.apply([3.0]).tolist() == [1.5, 1.5, 1.5]
    with pytest.raises(ValueGivenError, match="no variable 'loss'"):
        brdfc.connect(made.mid, made.mvis, env={"loss": 1})


def test_undefined_variables_take_the_models_default(ward: brdfc.Compiled) -> None:
    given = {"incident": np.pi / 4, "reflection": 0.0}
    np.testing.assert_array_equal(
        brdfc.connect(ward.mid, ward.mvis).apply(PIXEL),
        brdfc.connect(ward.mid, ward.mvis, env=given).apply(PIXEL),
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda c: (c.mvis, c.mid), "the first profile must be a MID"),
        (lambda c: (c.mid, c.mid), "the second profile must be an MVIS"),
        (lambda c: (with_tags(c.mid, A2M0=None), c.mvis), "no 'A2M0' transform"),
        (lambda c: (with_tags(c.mid, mcta=None), c.mvis), "names no channels"),
        (
            lambda c: (with_tags(c.mid, mcta=Utf8Array(("Rdx",))), c.mvis),
            "do not match the transforms' channels",
        ),
        (
            lambda c: (c.mid, with_tags(c.mvis, **{"mdv ": NumberArray("fl32", (0.0,))})),
            "1 defaults",
        ),
        (
            lambda c: (c.mid, with_tags(c.mvis, M2B0=Pipeline(5, 3, ()))),
            "do not fit its 3 outputs",
        ),
        (
            lambda c: (
                c.mid,
                with_tags(c.mvis, M2B0=Pipeline(5, 3, (Program(5, 3, assemble("{ add }")),))),
            ),
            "needs 2 values",
        ),
    ],
)
def test_profiles_that_do_not_connect_are_refused(
    change: Callable[[brdfc.Compiled], tuple[Profile, Profile]],
    message: str,
    ward: brdfc.Compiled,
) -> None:
    with pytest.raises(LinkError, match=message):
        brdfc.connect(*change(ward))


def test_pixels_with_another_number_of_channels_are_refused(ward: brdfc.Compiled) -> None:
    link = brdfc.connect(ward.mid, ward.mvis)
    for shape in ((4,), (3, 6), ()):
        with pytest.raises(ProgramError, match="5 channels are needed"):
            link.apply(np.zeros(shape))


def test_empty_arrays_are_fine(ward: brdfc.Compiled) -> None:
    link = brdfc.connect(ward.mid, ward.mvis, env={"incident": 0.5})
    assert link.apply(np.zeros((0, 5))).shape == (0, 3)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), 2.0, -1.6])
def test_variables_outside_their_range_are_refused(value: float, ward: brdfc.Compiled) -> None:
    with pytest.raises(ValueGivenError):
        brdfc.connect(ward.mid, ward.mvis, env={"incident": value})


def test_ninety_degrees_is_inside_and_dark(ward: brdfc.Compiled) -> None:
    for angle in (np.pi / 2, -np.pi / 2):
        link = brdfc.connect(ward.mid, ward.mvis, env={"incident": angle})
        assert link.apply(PIXEL).tolist() == [0, 0, 0]


def test_a_missing_file_is_said(tmp_path: Path, ward: brdfc.Compiled) -> None:
    with pytest.raises(BrdfcError, match="No such file"):
        brdfc.connect(tmp_path / "none.icc", ward.mvis)


@pytest.fixture(scope="module")
def ward_link() -> brdfc.Link:
    compiled = brdfc.compile(brdfc.load("ward"))
    return brdfc.connect(compiled.mid, compiled.mvis, env={"incident": 0.7})


def test_a_sweep_is_many_links(ward_link: brdfc.Link) -> None:
    """By name and by signature, side by side, as a grid, and with what the link has."""
    pixels = np.random.default_rng(1).uniform(0.1, 0.9, (4, 5, 5)).astype(np.float32)
    angles = np.array([-0.5, 0.0, 0.5])

    def alone(incident: float, reflection: float) -> np.ndarray:
        env = {"inci": incident, "refl": reflection}
        return replace(ward_link, environment=env).apply(pixels)

    found = ward_link.sweep(pixels, reflection=angles)
    assert found.shape == (3, 4, 5, 3)
    for k, angle in enumerate(angles):
        np.testing.assert_array_equal(found[k], alone(np.float32(0.7), angle))
    pairs = ward_link.sweep(pixels, inci=[0.1, 0.2, 0.3], refl=angles)
    np.testing.assert_array_equal(pairs[2], alone(0.3, 0.5))
    grid = ward_link.sweep(pixels, incident=[[0.1], [0.2]], reflection=angles)
    assert grid.shape == (2, 3, 4, 5, 3)
    np.testing.assert_array_equal(grid[1, 0], alone(0.2, -0.5))
    np.testing.assert_array_equal(ward_link.sweep(pixels), ward_link.apply(pixels))
    assert ward_link.sweep(pixels, reflection=[]).shape == (0, 4, 5, 3)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"reflection": [0.1, 0.2], "incident": [0.1, 0.2, 0.3]}, "do not go side by side"),
        ({"reflection": "45deg"}, "the values of 'reflection' are no numbers"),
        ({"reflection": [[0.1], [0.1, 0.2]]}, "the values of 'reflection' are no numbers"),
        ({"reflektion": 0.1}, "no variable 'reflektion'"),
        ({"reflection": [0.1, 3.0]}, "outside the profile's range"),
        ({"reflection": np.nan}, "not a finite number"),
    ],
    ids=str,
)
def test_sweeps_that_cannot_be(
    given: dict[str, object], message: str, ward_link: brdfc.Link
) -> None:
    with pytest.raises(ValueGivenError, match=message):
        ward_link.sweep(np.ones((2, 5)), **given)  # type: ignore[arg-type]


TABLE = LookupTable(3, 3, (2, 2, 2), Samples.of(np.linspace(0, 1, 24) ** 2))
GAIN = Program(1, 1, assemble("{ in env(gain) pop mul out }"))


def with_elements(*elements: Element) -> tuple[Profile, Profile]:
    """A pair whose MVIS runs some elements of three channels after its program."""
    made = pair("{ in[0,3] out[0,3] }", ["a", "b", "c"])
    pipeline = made.mvis.tags["M2B0"]
    assert isinstance(pipeline, Pipeline)
    changed = Pipeline(3, 3, (*pipeline.elements, *elements))
    return made.mid, with_tags(made.mvis, M2B0=changed)


def test_tables_in_tetrahedra() -> None:
    pixels = np.random.default_rng(0).uniform(0, 1, (50, 3)).astype(np.float32)
    linear, tetrahedral = (
        brdfc.connect(*with_elements(TABLE), interpolation=name)
        for name in ("linear", "tetrahedral")
    )
    found = tetrahedral.apply(pixels)
    assert np.abs(found - linear.apply(pixels)).max() > 0.01
    np.testing.assert_array_equal(found, tetrahedral.sweep(pixels))
    np.testing.assert_array_equal(found, tetrahedral.together([tetrahedral], pixels)[1])
    with pytest.raises(ValueGivenError, match="no interpolation 'cubic'"):
        brdfc.connect(*with_elements(TABLE), interpolation="cubic")


def test_variables_of_curves() -> None:
    """A curve that is sampled from a program makes the program's variables those of the link."""
    link = brdfc.connect(
        *with_elements(CurveSet((CalculatorCurve(9, 0.0, 1.0, GAIN),) * 3)), env={"gain": 0.5}
    )
    np.testing.assert_allclose(link.apply([1.0, 0.5, 0.25]), [0.5, 0.25, 0.125])
    np.testing.assert_allclose(link.sweep([1.0, 0.5, 0.25], gain=[1, 2])[1], [2, 1, 0.5])
    hostile = CalculatorCurve(0xFFFFFFFF, 0.0, 1.0, Program(1, 1, assemble("{ in out }")))
    with pytest.raises(LinkError, match="sampled 4,294,967,295 times"):
        brdfc.connect(*with_elements(CurveSet((hostile,) * 3)))
