"""Whether a profile serves a scene: what of the scene lies outside it, and how far off it is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from brdfc.checker import ERROR, OK, OPEN, Finding
from brdfc.cmm.connect import connect_alone
from brdfc.cmm.rendering import spectral_grid
from brdfc.colours import colours_of
from brdfc.icc.profile import Profile
from brdfc.icc.types import Dictionary
from brdfc.lang.load import load
from brdfc.lang.model import Quantity
from brdfc.lang.values import parse_value
from brdfc.profiles.conditions import profile_white, stated_conditions
from brdfc.profiles.metadata import (
    Described,
    describe,
    describe_constants,
    range_text,
    value_text,
)
from brdfc.sceneplan import InScene, in_scene
from brdfc.scenes.scene import Scene, read_scene
from brdfc.source.errors import BrdfcError, LinkError, SceneError, ValueGivenError
from brdfc.symbolic.evaluate import evaluate

RUNS, PIXELS = 240, 64
"""Sets of variables, and pixels of each, that a profile is compared at with its model."""


def check_scene(path: str | Path, scene_path: str | Path) -> Iterator[Finding]:
    """Findings on an MVIS, or a profile of device values, and a scene: every quantity of the scene
    within the profile's range or not, the light, and the worst difference from the model.

    Raises SceneError where neither says which model it is, and what reading either raises.
    """
    profile, scene = Profile.load(path), read_scene(scene_path)
    if profile.header.device_class == "mid ":
        raise SceneError(
            "this is a MID, which only names channels", where=str(path), hint="give the MVIS"
        )
    at = _model_in(profile, scene)
    findings = [_light(profile, scene), *_model(profile, scene)]
    ends = at.narrowed.ends
    for q in (*at.roles.channels, *at.roles.variables):
        of = ends.get(q.name) or ((q.low, q.high),) * q.type.value.width
        findings += _within(profile, q, of)
    for q in at.model.quantities:
        if q.name in at.roles.constants:
            findings += _fixed(profile, q, at.roles.constants[q.name])
    yield from findings
    if any(finding.status == ERROR for finding in findings):
        yield Finding(OPEN, "difference: not compared, as the scene is another")
    else:
        yield _difference(profile, at)


def _model(profile: Profile, scene: Scene) -> Iterator[Finding]:
    meta = profile.tags.get("meta")
    own = meta.get("model") if isinstance(meta, Dictionary) else None
    if scene.model is not None and own is not None and Path(scene.model).stem != own:
        yield Finding(ERROR, f"model: {scene.model} in the scene, {own} in the profile")


def _model_in(profile: Profile, scene: Scene) -> InScene:
    meta = profile.tags.get("meta")
    said = (
        {k: meta.get(k) for k in ("model", "geometry", "highlight")}
        if isinstance(meta, Dictionary)
        else {}
    )
    name = scene.model or said.get("model")
    if name is None:
        raise SceneError(
            "the profile does not say its model", where=scene.path, hint='model = "ward"'
        )
    try:
        wavelengths = spectral_grid(profile)
        step = (wavelengths.end - wavelengths.start) / (wavelengths.steps - 1)
        spectral = f"{wavelengths.start:g}nm..{wavelengths.end:g}nm,{step:g}nm"
    except LinkError:
        spectral = None
    try:
        model = load(name, scene.geometry or said.get("geometry"), spectral)
    except BrdfcError as error:
        raise SceneError(
            f"the profile's model '{name}' cannot be read: {error}",
            where=scene.path,
            hint='name its file: model = "my_model.brdf"',
        ) from None
    conditions = scene.conditions or stated_conditions(profile)
    return in_scene(
        model, scene, colours_of(model, conditions, scene.highlight or said.get("highlight"))
    )


def _known(profile: Profile) -> dict[str, Described]:
    roles = ("channel", "env", "unread")
    return {d.name: d for role in roles for d in describe(profile, role)}


def _within(
    profile: Profile, q: Quantity, ends: tuple[tuple[float, float], ...]
) -> Iterator[Finding]:
    """Whether a quantity's range lies within the profile's, a component at a time where the profile
    has them apart."""
    known, constants = _known(profile), describe_constants(profile)
    low, high = min(e[0] for e in ends), max(e[1] for e in ends)
    if q.name in constants:
        yield Finding(
            ERROR,
            f"{q.name}: {range_text(low, high, q.type)} in the scene; the profile was compiled for "
            f"{constants[q.name]}",
        )
    elif q.name in known:
        yield _inside(q.name, low, high, known[q.name])
    else:
        parts = [(n, e) for n, e in zip(q.component_names, ends, strict=True) if n in known]
        for name, (first, last) in parts:
            yield _inside(name, first, last, known[name])
        if not parts:
            yield Finding(OK, f"{q.name}: not read; compared below")


def _inside(name: str, low: float, high: float, has: Described) -> Finding:
    here = value_text((low,), has.type) if low == high else range_text(low, high, has.type)
    slack = 1e-6 * max(abs(has.low), abs(has.high))
    if has.low - slack <= low and high <= has.high + slack:
        return Finding(OK, f"{name}: {here} lies in the profile's range {has.range_text}")
    return Finding(ERROR, f"{name}: {here} lies outside the profile's range {has.range_text}")


def _fixed(profile: Profile, q: Quantity, values: tuple[float, ...]) -> Iterator[Finding]:
    """Whether a value of the scene is what the profile was compiled for, or lies in its range."""
    known, constants = _known(profile), describe_constants(profile)
    if q.name in known:
        yield _inside(q.name, min(values), max(values), known[q.name])
    elif q.name in constants:
        shown = value_text(values, q.type)
        try:
            same = np.allclose(parse_value(constants[q.name], q.type, q.name), values, rtol=1e-6)
        except ValueGivenError:
            same = False
        if same:
            yield Finding(OK, f"{q.name}: {shown}, as the profile was compiled for")
        else:
            said = f"{shown} in the scene; the profile was compiled for {constants[q.name]}"
            yield Finding(ERROR, f"{q.name}: {said}")
    else:
        yield Finding(OK, f"{q.name}: not read; compared below")


def _light(profile: Profile, scene: Scene) -> Finding:
    own = profile_white(profile)
    if scene.conditions is None:
        return Finding(OK, "light: the scene does not say; the profile's white is taken")
    wanted = scene.conditions.white
    text = " ".join(f"{v:.4g}" for v in wanted)
    if np.allclose(own, wanted, atol=1e-3):
        return Finding(OK, f"light: white {text}, the profile's")
    return Finding(
        ERROR,
        f"light: white {text} in the scene, {' '.join(f'{v:.4g}' for v in own)} in the profile",
    )


def _difference(profile: Profile, at: InScene) -> Finding:
    found = compared(profile, at)
    if isinstance(found, str):
        return Finding(OPEN, f"difference: the model does not have the channel '{found}'")
    worst, where = found
    good = worst <= at.scene.tolerance
    return Finding(
        OK if good else ERROR,
        f"difference: CIEDE2000 {worst:.2g} at worst of {RUNS * PIXELS:,} points, "
        f"{'within' if good else 'beyond'} the tolerance of {at.scene.tolerance:g}, where {where}",
    )


def compared(
    profile: Profile, at: InScene, runs: int = RUNS, pixels: int = PIXELS
) -> tuple[float, str] | str:
    """The worst difference of a profile's colours from a model's own formula, CIEDE2000, at samples
    of the scene, and where that is; or the name of a channel that the model does not have."""
    samples = at.samples(runs, pixels)
    known = {d.name for d in describe(profile, "env")}
    fixed = {
        name: np.full((pixels, 1), value, np.float32)
        for q in at.model.quantities
        if q.name in at.roles.constants
        for name, value in zip(q.component_names, at.roles.constants[q.name], strict=True)
    }
    off, points = [], []
    for run, columns in zip(samples.runs, samples.pixels, strict=True):
        env = {n: float(v[0, 0]) for n, v in fixed.items()} | dict(run)
        link = connect_alone(profile, {n: v for n, v in env.items() if n in known})
        given = {**fixed, **columns}
        missing = [name for name in link.channels if name not in given]
        if missing:
            return missing[0]
        found = link.apply(np.concatenate([given[name] for name in link.channels], axis=-1))
        values = {n: v.astype(np.float64) for n, v in columns.items()}
        values |= {n: np.array([v]) for n, v in run.items()}
        truth = at.colorimetry.xyz(evaluate(at.ready.exact, values))
        # What the model leaves undefined has no difference.
        apart = replace(at.colorimetry, rows=()).difference(found, truth)
        off.append(np.where(np.isfinite(truth).all(axis=-1), np.nan_to_num(apart, nan=np.inf), 0.0))
        points.append((run, columns))
    number, pixel = np.unravel_index(int(np.argmax(off)), np.shape(off))
    run, columns = points[number]
    point = {n: v[pixel].tolist() for n, v in columns.items() if n in at.ready.domain}
    point |= {n: [v] for n, v in run.items()}
    types = {q.name: q.type for q in at.roles.channels + at.roles.variables}
    where = " ".join(f"{n}={value_text(v, types[n], 5)}" for n, v in point.items())
    return float(off[number][pixel]), where
