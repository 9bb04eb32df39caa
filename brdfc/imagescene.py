"""A model compiled for exactly one image and one run, and the time that saves."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from brdfc.cmm.connect import connect
from brdfc.cmm.link import Link
from brdfc.compiled import Compiled
from brdfc.compiler import compile_model
from brdfc.images.tiff import open_coefficients
from brdfc.lang.model import Model, Role
from brdfc.profiles.metadata import value_text
from brdfc.scenes.scene import Scene

TIMED = 1 << 18
"""Pixels of the image that both are timed on, at most."""


@dataclass(frozen=True)
class Saved:
    """Seconds for the whole image, from timing a part of it: of the scene's profile, and of the
    general one with the same variables. compiling: seconds that the scene's took to make."""

    scene: float
    general: float
    compiling: float


def compile_for_image(
    model: Model,
    image: str | Path,
    variables: Mapping[str, str],
    scene: Scene,
    progress: Callable[[int, int], None],
) -> tuple[Compiled, float]:
    """Profiles for one image and one run, and the seconds it took.

    variables: as text, beside what the scene says; those that neither names have their default,
    unless they come with the image. The scene's own image is not looked at.
    """
    start = time.perf_counter()
    said = {q.name for n in (*variables, *scene.variables) if (q := model.quantity(n)) is not None}
    usual = {
        q.name: value_text(q.default, q.type)
        for q in model.quantities
        if q.role is Role.ENV and q.name not in {*said, *scene.samples, *scene.channels}
    }
    there = {**usual, **scene.variables, **variables}
    exactly = replace(scene, image=Path(image), variables=there)
    compiled = compile_model(model, scene=exactly, progress=progress)
    return compiled, time.perf_counter() - start


def time_saved(compiled: Compiled, general: Compiled, image: str | Path, took: float) -> Saved:
    """Time both on the same pixels of the image."""
    assert compiled.plan is not None
    at = compiled.plan.at
    with open_coefficients(image) as opened:
        whole = next(iter(opened.bands())).reshape(-1, opened.channels)[:TIMED]
        pixels = opened.height * opened.width
    fixed = {n: v[0] for n, v in at.narrowed.fixed.items()}
    env = {q.name: fixed[q.name] for q in general.roles.variables if q.name in fixed}
    names = at.samples_of_image

    def seconds(link: Link) -> float:
        own = np.ascontiguousarray(whole[:, [names.index(n) for n in link.channels]])
        return _seconds(link, own) * pixels / len(whole)

    return Saved(
        seconds(connect(compiled.mid, compiled.mvis)),
        seconds(connect(general.mid, general.mvis, env=env)),
        took,
    )


def _seconds(link: Link, pixels: NDArray[np.float32]) -> float:
    """The better of two, after a first few pixels."""
    link.apply(pixels[:1000])
    times = []
    for _ in range(2):
        start = time.perf_counter()
        link.apply(pixels)
        times.append(time.perf_counter() - start)
    return min(times)
