"""Profiles for scenes: cheaper, within their tolerance by other engines too, finite elsewhere."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import brdfc
from brdfc.cmm import reference
from brdfc.compiled import Compiled
from brdfc.icc.types import Dictionary
from brdfc.profiles.metadata import describe
from brdfc.scenes.scene import Scene
from brdfc.source.errors import SceneError, ValueGivenError
from brdfc.symbolic.evaluate import evaluate

CYAN = ["0.05..0.2", "0.1..0.3", "0.3..0.6"]
ANGLES = {"incident": "40deg", "reflection": "-10deg"}


def compiled(model: str, tolerance: float = 0.1, **sections: Any) -> Compiled:
    scene = Scene(tolerance=tolerance, **sections)
    return brdfc.compile(brdfc.load(model), scene=scene, cache=False, effort=30)


@pytest.fixture(scope="module")
def invisible() -> Compiled:
    channels = {"Rd": CYAN, "ks": "0.02..0.1", "m": "0.05..0.1"}
    return compiled("ward", variables=ANGLES, channels=channels)


@pytest.fixture(scope="module")
def swept() -> Compiled:
    """Angles in a range, and several parts left out."""
    variables = {"incident": "35deg..45deg", "reflection": "-20deg..10deg"}
    channels = {"Rd": CYAN, "ks": "0.02..0.05", "alpha": "0.2..0.25", "F0": "0.04..0.05"}
    return compiled("ggx", 0.5, variables=variables, channels=channels)


def worst(found: Compiled, count: int = 20_000) -> float:
    """The largest difference of profiles from the whole formula, at random points of the scene."""
    assert found.plan is not None
    random = np.random.default_rng(5)
    ranges = found.plan.at.narrowed.ranges
    whole = found.plan.at.roles
    runs = []
    for _ in range(20):
        env, columns = {}, {}
        for q in whole.variables:
            (of,) = ranges[q.name]
            env[q.name] = float(np.float32(random.uniform(of.low, of.high)))
        for q in whole.channels:
            parts = [random.uniform(r.low, r.high, count // 20) for r in ranges[q.name]]
            columns[q.name] = np.stack(parts, axis=-1).astype(np.float32)
        samples = np.concatenate([columns[q.name] for q in whole.channels], axis=-1)
        names = whole.channel_names
        link = brdfc.connect(found.mid, found.mvis, env=env)
        got = link.apply(samples[:, [names.index(n) for n in link.channels]])
        values = {n: v.astype(np.float64) for n, v in columns.items()}
        values |= {n: np.array([v]) for n, v in env.items()}
        truth = evaluate(found.plan.at.ready.exact, values)
        runs.append(found.plan.problem.colorimetry.difference(got, truth).max())
    return float(max(runs))


def test_an_invisible_lobe_is_dropped(invisible: Compiled) -> None:
    assert invisible.plan is not None
    lean = invisible.plan.fitted.lean
    assert invisible.roles.channel_names == ("Rdx", "Rdy", "Rdz")
    assert invisible.roles.variables == ()
    assert invisible.price < 60
    assert 0 < lean.bound.seen <= lean.bound.most < 1e-3
    assert "the term" in lean.omissions[0].words
    assert lean.bound.at["m"] == pytest.approx((0.1,), rel=1e-6)
    assert worst(invisible) < 1e-3


def test_a_scene_keeps_to_its_tolerance(swept: Compiled) -> None:
    assert swept.plan is not None
    lean = swept.plan.fitted.lean
    assert len(lean.omissions) >= 2
    assert lean.bound.seen <= lean.bound.most <= 0.45
    assert worst(swept) <= lean.bound.most + 0.01


def test_the_reference_engine_agrees(swept: Compiled, tmp_path: Path) -> None:
    if not reference.available():
        pytest.skip("the reference engine is not installed")
    mid, mvis = swept.save(tmp_path / "scene_mvis.icc")
    pixels = np.array([[0.1, 0.2, 0.4, 0.03, 0.22, 0.045]], np.float32)
    names = swept.plan.at.roles.channel_names if swept.plan else ()
    env = {"incident": 0.7, "reflection": 0.1}
    link = brdfc.connect(mid, mvis, env=env)
    pixels = pixels[:, [names.index(n) for n in link.channels]]
    judged = reference.apply(mid, mvis, pixels, [{"inci": 0.7, "refl": 0.1}]).xyz[0]
    assert np.allclose(link.apply(pixels), judged, rtol=1e-5, atol=1e-7)


def test_outside_the_scene_is_refused_or_finite(swept: Compiled) -> None:
    with pytest.raises(ValueGivenError, match="outside the profile's range"):
        brdfc.connect(swept.mid, swept.mvis, env={"reflection": 1.5})
    for reflection in (-np.pi / 2, -1.5, 0.0, 1.57, np.pi / 2):
        env = {"incident": 1.5707, "reflection": reflection}
        link = brdfc.connect(swept.mid, swept.mvis, env=env, extrapolate=True)
        ends = np.array(np.meshgrid(*[[0.001, 1.0]] * len(link.channels))).reshape(
            len(link.channels), -1
        )
        assert np.isfinite(link.apply(ends.T)).all()


def test_guards_are_for_all_that_the_model_declares() -> None:
    """In the scene the root below the lobe needs none; at grazing angles it would be NaN."""
    variables = {"incident": "40deg", "reflection": "-20deg..30deg"}
    channels = {"Rd": CYAN, "ks": "0.02..0.1", "m": "0.1..0.15"}
    found = compiled("ward", variables=variables, channels=channels)
    pixels = np.array([[0.0] * 3 + [ks, m] for ks in (0, 1) for m in (0.001, 1)], np.float32)
    for reflection in (-np.pi / 2, np.pi / 2):
        env = {"reflection": reflection}
        link = brdfc.connect(found.mid, found.mvis, env=env, extrapolate=True)
        assert np.isfinite(link.apply(pixels)).all()


def test_what_a_scene_fixed_may_be_said_again(invisible: Compiled) -> None:
    env = {"incident": np.radians(40), "reflection": np.radians(-10)}
    brdfc.connect(invisible.mid, invisible.mvis, env=env)
    with pytest.raises(ValueGivenError, match="compiled for incident=40deg"):
        brdfc.connect(invisible.mid, invisible.mvis, env={"incident": 0.5})


def test_metadata_say_what_was_left_out(swept: Compiled) -> None:
    meta = swept.mvis.tags["meta"]
    assert isinstance(meta, Dictionary)
    assert meta.get("scene.tolerance") == "0.5 CIEDE2000"
    assert (meta.get("scene.samples") or "").split() == ["Rdx", "Rdy", "Rdz", "ks", "alpha", "F0"]
    assert "at most" in (meta.get("scene.omission.1") or "")
    ranges = {d.name: (d.low, d.high) for d in describe(swept.mvis, "env")}
    assert ranges["incident"] == pytest.approx((np.radians(35), np.radians(45)))


def test_a_variable_that_changes_nothing_is_dropped_with_its_range() -> None:
    channels = {"Rd": CYAN, "ks": "0.01..0.02", "m": "0.05..0.06"}
    found = compiled(
        "ward", variables={**ANGLES, "reflection": "-40deg..-30deg"}, channels=channels
    )
    assert found.roles.variables == ()
    link = brdfc.connect(found.mid, found.mvis, env={"reflection": np.radians(-35)})
    assert link.environment == {}
    with pytest.raises(ValueGivenError, match="outside the profile's range"):
        brdfc.connect(found.mid, found.mvis, env={"reflection": 0.0})


def test_the_same_scene_gives_the_same_bytes(invisible: Compiled) -> None:
    channels = {"Rd": CYAN, "ks": "0.02..0.1", "m": "0.05..0.1"}
    again = compiled("ward", variables=ANGLES, channels=channels)
    assert again.mvis.to_bytes() == invisible.mvis.to_bytes()


def test_channels_that_are_alike_become_one() -> None:
    """Anisotropic to isotropic, or both to a constant: at most one roughness is left."""
    variables = {"incident": "40deg", "reflection": "-20deg..0deg", "orientation": "0deg..90deg"}
    channels = {"Rd": CYAN, "ks": "0.02..0.03", "mx": "0.3..0.302", "my": "0.3..0.302"}
    found = compiled("ward_anisotropic", 1.0, variables=variables, channels=channels)
    assert len({"mx", "my"} & set(found.roles.channel_names)) <= 1
    assert worst(found) <= 1.0


def test_a_tolerance_that_no_float_reaches() -> None:
    variables = {"incident": "-85deg..85deg", "reflection": "-85deg..85deg"}
    channels = {"Rd": "0..0.5", "ks": "0..0.3", "m": "0.01..1"}
    with pytest.raises(SceneError, match="tolerance is 1e-06"):
        compiled("ward", 1e-6, variables=variables, channels=channels)


def test_ranges_that_touch_a_singularity() -> None:
    """Grazing angles: proofs that cannot be had are not had, and the profile is right."""
    variables = {"incident": "80deg..90deg", "reflection": "80deg..90deg"}
    channels = {"Rd": CYAN, "ks": "0..0.1", "m": "0.1..0.2"}
    found = compiled("ward", 0.5, variables=variables, channels=channels)
    assert found.verdict.worst <= 0.5


def test_a_scene_leaves_no_choice_of_accuracy() -> None:
    model = brdfc.load("ward")
    with pytest.raises(ValueGivenError, match="said by the scene"):
        brdfc.compile(model, scene=Scene(), max_error="0.1dE")
    with pytest.raises(ValueGivenError, match="a MID and an MVIS"):
        brdfc.compile(model, scene=Scene(), encode="ncolour")
