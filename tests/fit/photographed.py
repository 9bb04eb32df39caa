"""Photographs of a printed cylinder, rendered from a model, not taken: by rays, step by step, apart
from the formulas of brdfc/fit/cylinder.py."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import tifffile
from numpy.typing import NDArray

from brdfc.lang.load import load
from brdfc.laws.reflectance import ANGLES, Reflectance

Array = NDArray[np.float64]

RADIUS, CAMERA, LIGHT = 27.0, 700.0, 500.0
HEIGHT, WIDTH = 24, 400
FOCAL = 4500.0
"""Pixels: the cylinder is 347 wide."""
MATRIX = np.array([[0.6, 0.25, 0.1], [0.25, 0.7, 0.05], [0.02, 0.1, 0.9]])
"""From this camera's RGB to XYZ."""
PARAMETERS = {"Rd": [0.2, 0.25, 0.35], "ks": [0.1], "m": [0.15]}


def edges() -> tuple[float, float]:
    half = FOCAL * math.tan(math.asin(RADIUS / CAMERA))
    return WIDTH / 2 - half, WIDTH / 2 + half


def angles_by_rays(light_angle: float, columns: Array, rows: Array) -> tuple[Array, Array]:
    """Directions (rows, columns, 4) and distances from the light, NaN beside the cylinder."""
    u, v = np.meshgrid(columns - WIDTH / 2, HEIGHT / 2 - rows)
    ray = np.stack([u, v, np.full_like(u, -FOCAL)], axis=-1)
    # (x, z) of camera + t ray is at the radius: a quadratic equation.
    a = ray[..., 0] ** 2 + ray[..., 2] ** 2
    b = 2 * CAMERA * ray[..., 2]
    c = CAMERA**2 - RADIUS**2
    with np.errstate(invalid="ignore"):
        t = (-b - np.sqrt(b * b - 4 * a * c)) / (2 * a)
    camera = np.array([0.0, 0.0, CAMERA])
    point = camera + t[..., None] * ray
    normal = point * [1, 0, 1] / RADIUS
    right = np.cross([0.0, 1.0, 0.0], normal)
    light = LIGHT * np.array([math.sin(light_angle), 0.0, math.cos(light_angle)])
    found = []
    for source in (light, camera):
        to = source - point
        length = np.linalg.norm(to, axis=-1)
        zenith = np.arccos((to * normal).sum(axis=-1) / length)
        found.append((zenith, np.arctan2(to[..., 1], (to * right).sum(axis=-1)), length))
    (incident, iazimuth, distance), (reflection, razimuth, _) = found
    return np.stack([incident, reflection, iazimuth, razimuth], axis=-1), distance


def model_brdf(directions: Array) -> Array:
    """(n, 3) 1/sr of Ward with PARAMETERS."""
    values = {name: directions[:, i : i + 1] for i, name in enumerate(ANGLES)}
    given = {name: np.array(value) for name, value in PARAMETERS.items()}
    return np.broadcast_to(
        Reflectance(load("ward", "full"))({**given, **values}), (len(directions), 3)
    )


def photograph(
    path: Path,
    light_angle: float,
    white: float,
    *,
    exposure: float = 1.0,
    noise: float = 0.0,
    integers: bool = True,
    dust: int = 0,
    patch: tuple[int, int] | None = None,
) -> None:
    """white: the value of a perfect diffuser that faces the light at the axis. noise: of photons,
    relative at the white. dust: so many black pixels. patch: columns of a perfect diffuser."""
    random = np.random.Generator(np.random.PCG64(7))
    columns, rows = np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5
    directions, distance = angles_by_rays(light_angle, columns, rows)
    flat = directions.reshape(-1, 4)
    lit = (flat[:, :2] < math.pi / 2).all(axis=1)
    brdf = np.zeros((len(flat), 3))
    brdf[lit] = model_brdf(flat[lit])
    brdf = brdf.reshape(HEIGHT, WIDTH, 3)
    if patch:
        brdf[:, patch[0] : patch[1]] = 1 / math.pi
    irradiance = np.maximum(np.cos(directions[..., 0]), 0) * (LIGHT / distance) ** 2
    xyz = np.nan_to_num(brdf * math.pi * irradiance[..., None])
    # A perfect diffuser has equal XYZ here: the light is that of illuminant E.
    rgb = xyz @ np.linalg.inv(MATRIX).T * white * exposure
    if noise:
        rgb += random.normal(size=rgb.shape) * noise * np.sqrt(np.abs(rgb) * white)
    for row, column in random.integers((HEIGHT, WIDTH), size=(dust, 2)):
        rgb[row, column] = 0
    if integers:
        rgb = np.clip(np.round(rgb), 0, 65535).astype(np.uint16)
    tifffile.imwrite(path, rgb if integers else rgb.astype(np.float32), photometric="rgb")
