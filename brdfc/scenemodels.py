"""The models of the library in one scene: what each costs there, and how far it is off."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from brdfc.colours import colours_of
from brdfc.compiled import Compiled
from brdfc.compiler import compile_model
from brdfc.lang.load import library, load
from brdfc.lang.model import Model, Quantity, Role
from brdfc.profiles.metadata import value_text
from brdfc.scenecheck import compared
from brdfc.sceneplan import InScene, in_scene
from brdfc.scenes.scene import Scene
from brdfc.source.errors import BrdfcError, SceneError
from brdfc.symbolic.expression import walk
from brdfc.symbolic.formula import formula

EFFORT = 40
"""Forms measured of each model."""
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Rival:
    """A model in the scene. price: nanoseconds a pixel of its program there; difference: CIEDE2000
    from the richest model, at worst of the samples. adequate: that keeps to the
    tolerance; chosen: the cheapest of those that do."""

    name: str
    price: float
    difference: float
    adequate: bool
    richest: bool = False
    chosen: bool = False


@dataclass(frozen=True)
class Compared:
    """rivals: cheapest first. needed: the channels that the richest model's program reads, which
    every rival has. left_out: names of models with the reason why they are no rivals."""

    rivals: tuple[Rival, ...]
    needed: tuple[str, ...]
    left_out: Mapping[str, str]


def compare_models(scene: Scene, progress: Progress = lambda done, total: None) -> Compared:
    """Every model of the library that has the channels the scene needs, compiled for it.

    The richest model is the one the scene names, or else the most elaborate formula of those that
    have all quantities it speaks of, and fewest others. Channels that the scene does not speak of
    have their default. Raises SceneError where no model has what the scene speaks of.
    """
    models = _library(scene)
    first = _richest(scene, models)
    colours = colours_of(first, scene.conditions, scene.highlight)
    explicit = _explicit(scene, in_scene(first, scene, colours))
    own = _own(explicit, first)
    at, whole = in_scene(first, own, colours), compile_model(first, scene=own, effort=EFFORT)
    read = set(whole.roles.channel_names)
    needed = [q for q in at.roles.channels if read & {q.name, *q.component_names}]
    rivals, left_out = [_rival(first, whole, at, richest=True)], {}
    for done, (name, model) in enumerate(models.items()):
        progress(done, len(models))
        lacking = [q.name for q in needed if not _has(model, q)]
        if name == first.name or lacking:
            if lacking:
                left_out[name] = f"no {', '.join(lacking)}"
            continue
        try:
            own = _own(explicit, model)
            rivals.append(_rival(model, compile_model(model, scene=own, effort=EFFORT), at))
        except BrdfcError as error:
            left_out[name] = str(error).splitlines()[0]
    rivals.sort(key=lambda r: (r.price, r.difference))
    cheapest = next(r for r in rivals if r.adequate)
    marked = tuple(replace(r, chosen=r is cheapest) for r in rivals)
    return Compared(marked, tuple(q.name for q in needed), left_out)


def _library(scene: Scene) -> dict[str, Model]:
    names = [name for name, entry in library().items() if entry.kind == "model"]
    return {name: load(name, scene.geometry) for name in names}


def _richest(scene: Scene, models: Mapping[str, Model]) -> Model:
    if scene.model is not None:
        return load(scene.model, scene.geometry)
    if scene.image is not None and not scene.samples:
        raise scene.error(
            "channels.from",
            "nothing says what the samples of the image are",
            'name them: samples = ["Rd", "ks", "m"], or the model: model = "ward"',
        )
    spoken = [*scene.variables, *scene.channels, *scene.samples]
    having = [m for m in models.values() if all(m.quantity(n) is not None for n in spoken)]
    if not having:
        raise SceneError(
            f"no model of the library has all of {', '.join(spoken)}",
            where=scene.path,
            hint='name the richest model: model = "ward"',
        )
    spoken_of = {q.name for m in having for n in spoken if (q := m.quantity(n)) is not None}

    def richness(model: Model) -> tuple[int, int, str]:
        channels = {q.name for q in model.quantities if q.role is Role.CHANNEL}
        parts = sum(1 for _ in walk(formula(model, {}).exact))
        return -len(channels - spoken_of), parts, model.name

    return max(having, key=richness)


def _has(model: Model, q: Quantity) -> bool:
    own = model.quantity(q.name)
    return own is not None and own.type == q.type and own.role is q.role


def _explicit(scene: Scene, at: InScene) -> Scene:
    """The scene with all its ranges said, and no image."""
    variables: dict[str, Any] = {}
    channels: dict[str, Any] = {}
    constants: dict[str, Any] = {}
    section = {Role.CHANNEL: channels, Role.ENV: variables, Role.CONSTANT: constants}
    quantities = {q.name: q for q in at.model.quantities}
    for name, ends in at.narrowed.ends.items():
        q = quantities[name]
        unit = "rad" if q.type.is_angle else ""
        texts = [f"{low!r}{unit}..{high!r}{unit}" for low, high in ends]
        place = channels if name in at.narrowed.pixel else section[q.role]
        place[name] = texts if len(texts) > 1 else texts[0]
    for name, values in at.narrowed.fixed.items():
        q = quantities[name]
        section[q.role][name] = value_text(values, q.type, 17)
    return replace(
        scene,
        image=None,
        samples=(),
        share=0.0,
        variables=variables,
        channels=channels,
        constants=constants,
    )


def _own(scene: Scene, model: Model) -> Scene:
    """The scene as a model takes it: without quantities that it does not have, and with its default
    for each of its channels that the scene does not speak of."""

    def had(section: Mapping[str, Any]) -> dict[str, Any]:
        return {n: v for n, v in section.items() if model.quantity(n) is not None}

    channels = had(scene.channels)
    spoken = {*channels, *scene.variables, *scene.constants}
    for q in model.quantities:
        if q.role is Role.CHANNEL and q.name not in spoken:
            channels[q.name] = value_text(q.default, q.type, 17)
    variables, constants = had(scene.variables), had(scene.constants)
    return replace(scene, model=None, variables=variables, channels=channels, constants=constants)


def _rival(model: Model, compiled: Compiled, at: InScene, *, richest: bool = False) -> Rival:
    found = compared(compiled.mvis, at, 96, 32)
    if isinstance(found, str):
        raise BrdfcError(f"its profile reads {found}")
    difference, _ = found
    return Rival(
        model.name,
        compiled.price,
        difference,
        difference <= at.scene.tolerance,
        richest,
    )
