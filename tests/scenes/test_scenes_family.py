"""Simpler members of a model's family, displays, and models side by side."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import brdfc
from brdfc.colours import colours_of
from brdfc.lang.load import load_text
from brdfc.lang.model import Model
from brdfc.scenemodels import compare_models
from brdfc.sceneplan import Plan, in_scene, plan_for
from brdfc.scenes.scene import Scene
from brdfc.source.errors import SceneError
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.formula import simpler_in

EXACT = """model member "A model whose Fresnel term has a simpler form"
channel Rd : XYZ    in 0..1 = 0.5
channel n  : number in 1..3 = 1.5
env incident : angle in 0deg..80deg = 45deg as inci
import fresnel (dielectric)
radiance = (Rd + dielectric(n, cos(incident))*(1, 1, 1))/pi
"""


def planned(model: Model, tolerance: float, **scene: object) -> Plan:
    given = Scene(tolerance=tolerance, **scene)  # type: ignore[arg-type]
    return plan_for(in_scene(model, given, colours_of(model)))


def member() -> Model:
    found = load_text(EXACT)
    assert isinstance(found, Model)
    return found


def test_an_exact_fresnel_term_becomes_schlicks() -> None:
    """Where the difference is proved to be small; and is kept where it is not."""
    offered = simpler_in(member(), {})
    assert [s.words for s in offered] == ["dielectric: dielectric_schlick in its place"]
    scene = {
        "variables": {"incident": "0deg..30deg"},
        "channels": {"Rd": "0.3..0.6", "n": "1.4..1.6"},
    }
    near = planned(member(), 0.3, **scene).fitted.lean
    assert near.omissions
    assert near.bound.most <= 0.3
    scene["variables"] = {"incident": "60deg..80deg"}
    kept = planned(member(), 1e-3, **scene).fitted.lean
    assert not any("schlick" in o.words for o in kept.omissions)


def test_what_is_simpler_is_offered_through_imports() -> None:
    for name in ("ggx", "ggx_anisotropic", "cook_torrance_1982"):
        model = brdfc.load(name)
        assert simpler_in(model, {})
    point = {"incident": 0.5, "reflection": -0.2, "alpha": 0.2, "F0": 0.04}
    values = {n: np.array([v]) for n, v in point.items()}
    (offer,) = simpler_in(brdfc.load("ggx"), {})
    exact, bound = (evaluate(e, values)[0] for e in (offer.part, offer.by))
    assert 0.9 * bound < exact < bound  # Smith's form to its bound


def test_what_a_display_clips_is_not_computed() -> None:
    """A highlight beyond white is white in sRGB, whatever it is."""
    channels = {"Rd": "0.3..0.6", "ks": "0.3..0.4", "m": "0.1..0.12"}
    scene = Scene(
        tolerance=0.5,
        output="sRGB",
        variables={"incident": "40deg", "reflection": "38deg..42deg"},
        channels=channels,
    )
    found = brdfc.compile(brdfc.load("ward"), scene=scene, cache=False)
    assert found.roles.variables == ()
    assert found.price < 30
    for_xyz = planned(brdfc.load("ward"), 0.5, variables=scene.variables, channels=channels)
    assert for_xyz.roles.variables != ()


CYAN = Scene(
    tolerance=0.1,
    variables={"incident": "40deg", "reflection": "-10deg"},
    channels={"Rd": ["0.1..0.2", "0.1..0.3", "0.3..0.6"], "ks": "0.02..0.1", "m": "0.05..0.1"},
)


def test_models_side_by_side(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lambert serves where the lobe cannot be seen; a model without Rd is no rival."""
    from brdfc import scenemodels

    few = {n: brdfc.load(n) for n in ("ward", "lambert", "ward_gmd", "hapke", "minnaert")}
    monkeypatch.setattr(scenemodels, "_library", lambda scene: few)
    found = compare_models(CYAN)
    by_name = {r.name: r for r in found.rivals}
    assert found.needed == ("Rd",)
    assert by_name["ward_gmd"].richest
    assert by_name["lambert"].adequate
    assert not by_name["minnaert"].adequate
    assert found.left_out == {"hapke": "no Rd"}
    (chosen,) = [r for r in found.rivals if r.chosen]
    assert chosen.adequate
    assert chosen.price == min(r.price for r in found.rivals if r.adequate)


def test_no_model_has_it_all(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="no model of the library has all of"):
        compare_models(Scene(channels={"glitter": 0.5}))
    with pytest.raises(SceneError, match="what the samples of the image are"):
        compare_models(Scene(image=tmp_path / "c.tif"))
