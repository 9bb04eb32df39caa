"""A model made ready to compile for a scene: fitted to it, and how its program is judged there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from brdfc.colour.colorimetry import Colorimetry
from brdfc.colour.picture import srgb_display
from brdfc.colours import Colours
from brdfc.judge.cache import Remembered
from brdfc.judge.goals import Goal
from brdfc.judge.problem import Problem
from brdfc.judge.samples import Samples, sample
from brdfc.lang.model import Model, Quantity, Role
from brdfc.prepared import prepare, problem_of
from brdfc.profiles.metadata import value_text
from brdfc.proof.subdivide import Bound
from brdfc.roles import Roles, Value
from brdfc.scenes.fitting import Fitted, fit
from brdfc.scenes.ranges import Narrowed, narrowed
from brdfc.scenes.scene import Scene
from brdfc.source.errors import BrdfcError, SceneError, SelfCheckError
from brdfc.symbolic.formula import Formula, simpler_in
from brdfc.symbolic.intervals import Interval, hull

SHARE = 0.5
"""Of what the omissions leave of a tolerance: what a program may be seen to round by, which is at
some thousand points only."""


@dataclass(frozen=True)
class InScene:
    """A model in a scene. narrowed: what the scene says; ready, roles: the formula and all its
    quantities, with their ranges there; declared: the ranges that the model itself declares."""

    model: Model
    scene: Scene
    narrowed: Narrowed
    ready: Formula
    roles: Roles
    colorimetry: Colorimetry
    declared: Mapping[str, Interval]

    @property
    def samples_of_image(self) -> tuple[str, ...]:
        """The names of the samples of an image for the scene: as they were measured, or all
        channels of the model, those of one value too."""
        if self.narrowed.measured is not None:
            return self.narrowed.measured.names
        pixel = self.narrowed.pixel
        return tuple(
            name
            for q in self.model.quantities
            if q.role is Role.CHANNEL or q.name in pixel
            for name in q.component_names
        )

    def samples(self, runs: int = 48, pixels: int = 8) -> Samples:
        """Samples of the scene, with the components of colours also by their own names."""
        ranges, domain = self.narrowed.ranges, self.ready.domain
        drawn = sample(domain, self.roles.channels, self.roles.variables, runs=runs, pixels=pixels)
        moved = [
            {
                name: values
                for q in self.roles.channels
                for name, values in _columns(q, columns[q.name], domain[q.name], ranges.get(q.name))
            }
            for columns in drawn.pixels
        ]
        return Samples(drawn.runs, tuple(moved))


def in_scene(
    model: Model,
    scene: Scene,
    colours: Colours,
    fixed: Mapping[str, Value] | None = None,
    pixel: Sequence[str] = (),
    cache: bool = False,
) -> InScene:
    """A model in a scene; fixed, pixel, cache: as for prepare, beside what the scene says.

    Raises SceneError where the scene asks for what the model does not have.
    """
    white, colorimetry = colours.formula_white, colours.colorimetry
    if scene.output == "sRGB":
        colorimetry = replace(colorimetry, display=srgb_display(colorimetry.white))
    given = fixed or {}
    named = {q.name for name in given if (q := model.quantity(name)) is not None}
    found = narrowed(scene, model, white, named)
    roles, ready = prepare(model, {**found.fixed, **given}, (*pixel, *found.pixel), cache, white)
    whole = replace(
        roles,
        channels=tuple(map(found.quantity, roles.channels)),
        variables=tuple(map(found.quantity, roles.variables)),
    )
    domain = dict(ready.domain) | {n: hull(*of) for n, of in found.ranges.items()}
    here = Formula(ready.exact, domain, white)
    return InScene(model, scene, found, here, whole, colorimetry, ready.domain)


@dataclass(frozen=True)
class Plan:
    """What is compiled for a scene. at: the whole model in it. roles: of the quantities that are
    left; fitted: what is left of the formula; problem: to find a program for that, so exact as goal
    says. inside: samples of the scene, at which the program is judged by the whole formula;
    outside: of the ranges that the model declares, in which it has to be finite."""

    at: InScene
    roles: Roles
    fitted: Fitted
    problem: Problem
    goal: Goal
    inside: Samples
    outside: Samples

    def facts(self) -> dict[str, str]:
        """What the metadata say of the scene and of what was left out for it."""
        facts = {
            "scene.tolerance": f"{self.at.scene.tolerance:g} CIEDE2000",
            "scene.output": self.at.scene.output,
            "scene.bound": f"{self.fitted.lean.bound.most:.2g} CIEDE2000",
            "scene.samples": " ".join(self.at.samples_of_image),
        }
        if self.at.narrowed.measured is not None and self.at.narrowed.measured.outside:
            facts["scene.outside"] = f"{self.at.narrowed.measured.outside} pixels of its image"
        lines = enumerate(self.ledger(), 1)
        return facts | {f"scene.omission.{i}": line for i, line in lines}

    def ledger(self) -> list[str]:
        """What was left out, a line each: what it and those before change at most, and where they
        were seen to change most; and what the scene's ranges alone make needless."""
        lines = [
            f"{o.words}: {self.said(o.bound)}; saves {o.saved:.0f} ns"
            for o in self.fitted.lean.omissions
        ]
        lines += [f"{words}: changes nothing in these ranges" for words in self.fitted.always]
        unread = ", ".join(self.fitted.unread)
        return lines + ([f"no longer read: {unread}"] if unread else [])

    def unreachable(self, error: SelfCheckError, form: Remembered | None) -> BrdfcError:
        """Why a tolerance is not kept, in place of the self-check's own words where that is why."""
        if form is None or form.derivation[-1].measured.de <= self.goal.limit:
            return error
        rounding = form.derivation[-1].measured.de
        return SceneError(
            f"{error.message}; the best program rounds by {rounding:.2g}, and the tolerance is "
            f"{self.at.scene.tolerance:g}",
            where=f"{self.at.scene.path}: tolerance",
            hint="32-bit floats reach no more; allow more, or narrow the ranges",
        )

    @property
    def unread(self) -> tuple[Quantity, ...]:
        """The quantities that nothing reads any more, with their ranges in the scene."""
        every = self.at.roles.channels + self.at.roles.variables
        left = {n for q in (*self.roles.channels, *self.roles.variables) for n in q.component_names}
        return tuple(q for q in every if not left & {q.name, *q.component_names})

    def said(self, bound: Bound) -> str:
        """A bound in words: `at most 0.034, seen 0.033 at ks=0.1 m=0.2`."""
        types = {q.name: q.type for q in self.at.roles.channels + self.at.roles.variables}
        at = " ".join(f"{name}={value_text(v, types[name], 5)}" for name, v in bound.at.items())
        return f"at most {bound.most:.2g}, seen {bound.seen:.2g}" + (f" at {at}" if at else "")


def plan_for(at: InScene) -> Plan:
    """Fit a model to the scene it is in."""
    problem = problem_of(at.roles, at.ready, at.colorimetry, at.declared)
    ranges, tolerance = at.narrowed.ranges, at.scene.tolerance
    simpler = simpler_in(at.model, at.roles.constants)
    fitted = fit(problem, at.roles.channels, at.roles.variables, ranges, tolerance, simpler)
    left = replace(at.roles, channels=fitted.channels, variables=fitted.variables)
    return Plan(
        at,
        left,
        fitted,
        problem_of(left, fitted.formula, at.colorimetry, fitted.declared),
        Goal("de", SHARE * max(tolerance - fitted.lean.bound.most, 0.0)),
        at.samples(),
        sample(fitted.declared, left.channels, left.variables, seed=2),
    )


def _columns(
    q: Quantity, values: np.ndarray, of: Interval, ranges: Sequence[Interval] | None
) -> list[tuple[str, np.ndarray]]:
    """A quantity's values, each component moved into its own range, and the components alone."""
    if q.type.value.width == 1:
        return [(q.name, values)]
    if ranges:
        low, high = (np.array([getattr(r, end) for r in ranges]) for end in ("low", "high"))
        share = (values.astype(np.float64) - of.low) / max(of.high - of.low, 1e-300)
        values = np.clip(low + share * (high - low), low, high).astype(np.float32)
    parts = [(name, values[:, i : i + 1]) for i, name in enumerate(q.component_names)]
    return [(q.name, values), *parts]
