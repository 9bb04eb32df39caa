"""The library's models against their textbook formulas, written out here with unit vectors."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import pytest
from numpy.typing import NDArray

from brdfc.compiler import prepare
from brdfc.lang.load import load
from brdfc.lang.model import Model
from brdfc.symbolic.evaluate import evaluate

Array = NDArray[np.float64]
Values = dict[str, Array]

POINTS = 20_000
STEEP = np.radians(89.9)


class Geometry:
    """Cosines from unit vectors: light at +ti, viewer at -tr, the normal along z."""

    def __init__(self, v: Mapping[str, Array]) -> None:
        ti, tr = v["incident"], v["reflection"]
        light = np.stack([np.sin(ti), np.cos(ti)])
        viewer = np.stack([-np.sin(tr), np.cos(tr)])
        half = light + viewer
        half /= np.sqrt((half**2).sum(axis=0))
        self.ci, self.cr = light[1], viewer[1]
        self.sine2, self.cosine = half[0] ** 2, half[1]  # of the half vector against the normal
        self.tan2 = self.sine2 / self.cosine**2
        self.d = (light * half).sum(axis=0)
        self.same_side = light[0] * viewer[0] >= 0


def lambert(v: Values) -> Array:
    return np.cos(v["incident"]) * v["Rd"] / np.pi


def ward_lobe(v: Values) -> Array:
    g = Geometry(v)
    lobe = np.exp(-g.tan2 / v["m"] ** 2) / (4 * np.pi * v["m"] ** 2)
    return v["ks"] / np.sqrt(g.ci * g.cr) * lobe


def ward(v: Values) -> Array:
    return np.cos(v["incident"]) * (v["Rd"] / np.pi + ward_lobe(v))


def ward_printed(v: Values) -> Array:
    return lambert(v) + ward_lobe(v)


def schlick(f0: Array, d: Array) -> Array:
    return f0 + (1 - f0) * (1 - d) ** 5


def cook_torrance(v: Values) -> Array:
    g, m = Geometry(v), v["m"]
    distribution = np.exp(-g.tan2 / m**2) / (np.pi * m**2 * g.cosine**4)
    masking = np.minimum(2 * g.cosine * g.ci / g.d, 2 * g.cosine * g.cr / g.d)
    reflected = schlick(v["F0"], g.d) * distribution * np.minimum(1, masking)
    return g.ci * (v["Rd"] / np.pi + v["ks"] * reflected / (4 * g.ci * g.cr))


def ggx(v: Values) -> Array:
    g, a = Geometry(v), v["alpha"]
    distribution = a**2 / (np.pi * g.cosine**4 * (a**2 + g.tan2) ** 2)

    def slope(c: Array) -> Array:
        return (np.sqrt(1 + a**2 * (1 - c**2) / c**2) - 1) / 2

    masking = 1 / (1 + slope(g.ci) + slope(g.cr))
    reflected = schlick(v["F0"], g.d) * distribution * masking
    return g.ci * (v["Rd"] / np.pi + v["ks"] * reflected / (4 * g.ci * g.cr))


def oren_nayar(v: Values) -> Array:
    """All three terms of the printed L1, with the azimuth difference 0 or 180 degrees."""
    g, rho, s2 = Geometry(v), v["Rd"], v["sigma"] ** 2
    of_light, of_viewer = np.arccos(g.ci), np.arccos(g.cr)
    a, b = np.maximum(of_light, of_viewer), np.minimum(of_light, of_viewer)
    azimuth = np.where(g.same_side, 1.0, -1.0)
    less = np.where(azimuth >= 0, 0.0, (2 * b / np.pi) ** 3)
    c1 = 1 - 0.5 * s2 / (s2 + 0.33)
    c2 = 0.45 * s2 / (s2 + 0.09) * (np.sin(a) - less)
    c3 = 0.125 * s2 / (s2 + 0.09) * (4 * a * b / np.pi**2) ** 2
    direct = c1 + azimuth * c2 * np.tan(b) + (1 - np.abs(azimuth)) * c3 * np.tan((a + b) / 2)
    twice = 0.17 * s2 / (s2 + 0.13) * (1 - azimuth * (2 * b / np.pi) ** 2)
    return g.ci * (rho / np.pi * direct + rho**2 / np.pi * twice)


def ashikhmin_shirley(v: Values) -> Array:
    g, n, rs = Geometry(v), v["n"], v["Rs"]
    diffuse = 28 * v["Rd"] / (23 * np.pi) * (1 - rs)
    diffuse = diffuse * (1 - (1 - g.ci / 2) ** 5) * (1 - (1 - g.cr / 2) ** 5)
    lobe = (n + 1) / (8 * np.pi) * g.cosine**n / (g.d * np.maximum(g.ci, g.cr))
    return g.ci * (diffuse + lobe * schlick(rs, g.d))


TEXTBOOK: dict[str, Callable[[Values], Array]] = {
    f.__name__: f
    for f in (lambert, ward, ward_printed, cook_torrance, ggx, oren_nayar, ashikhmin_shirley)
}


def drawn(model: Model, seed: int) -> Values:
    """Points of a model's domain; half of them in the lobe, a quarter without a diffuse part."""
    random = np.random.default_rng(seed)
    values: Values = {}
    width = np.full((POINTS, 1), 0.1)
    for q in model.quantities:
        shape = (POINTS, q.type.value.width)
        if q.type.is_angle:
            values[q.name] = random.uniform(-STEEP, STEEP, shape)
        elif q.low > 0:
            values[q.name] = np.exp(random.uniform(np.log(q.low), np.log(q.high), shape))
        else:
            values[q.name] = random.uniform(q.low, q.high, shape)
        if q.type.name == "roughness":
            width = values[q.name]
    values["intensity"] = np.ones((POINTS, 1))
    values["Rd"][: POINTS // 4] = 0
    if "reflection" in values:
        near = values["incident"] + 2 * np.arctan(width * random.uniform(-3, 3, (POINTS, 1)))
        values["reflection"][::2] = np.clip(near, -STEEP, STEEP)[::2]
    return values


def radiance(model: Model, values: Values) -> Array:
    _, ready = prepare(model, {"intensity": 1.0}, ())
    return evaluate(ready.exact, values)


def swapped(values: Values) -> Values:
    return {**values, "incident": values["reflection"], "reflection": values["incident"]}


@pytest.mark.parametrize("name", TEXTBOOK)
def test_a_model_is_its_textbook_formula(name: str) -> None:
    model = load(name)
    values = drawn(model, 1)
    np.testing.assert_allclose(
        radiance(model, values), TEXTBOOK[name](values) + np.zeros(3), rtol=1e-9, atol=1e-30
    )


@pytest.mark.parametrize("name", TEXTBOOK)
def test_a_reciprocal_model_is_symmetric(name: str) -> None:
    model = load(name)
    values = drawn(model, 2)
    if "reflection" not in values:
        return  # without a viewing angle there is nothing to swap
    forth = radiance(model, values) / np.cos(values["incident"])
    back = radiance(model, swapped(values)) / np.cos(values["reflection"])
    symmetric = np.allclose(forth, back, rtol=1e-9, atol=1e-30)
    assert symmetric == ("reciprocal" in {law.name for law in model.laws})


@pytest.mark.parametrize("name", TEXTBOOK)
def test_a_model_is_positive(name: str) -> None:
    model = load(name)
    assert "positive" in {law.name for law in model.laws}
    assert (radiance(model, drawn(model, 3)) >= 0).all()


@pytest.mark.parametrize("name", TEXTBOOK)
@pytest.mark.parametrize("side", [-1, 1])
def test_beyond_the_horizon_there_is_nothing(name: str, side: int) -> None:
    model = load(name)
    values = drawn(model, 4)
    for angle in ("incident", "reflection"):
        if angle in values:
            beyond = {**values, angle: np.full((POINTS, 1), side * np.radians(91))}
            assert (radiance(model, beyond) == 0).all()


def albedo(name: str, **given: float) -> float:
    """What a model reflects of light along the normal, by quadrature over the hemisphere.

    There the plane shows everything: a lobe around the normal does not depend on the azimuth.
    """
    nodes, weights = np.polynomial.legendre.leggauss(400)
    angles = (nodes + 1) * np.pi / 4
    values = {name: np.full((1, 1), value) for name, value in given.items()}
    values["Rd"] = np.full((1, 3), given.get("Rd", 0.0))
    values |= {"incident": np.zeros((1, 1)), "reflection": angles[:, None]}
    values["intensity"] = np.ones((1, 1))
    reflected = radiance(load(name), values)[:, 1]
    ring = 2 * np.pi * np.sin(angles) * np.cos(angles) * np.pi / 4
    return float((weights * ring * reflected).sum())


@pytest.mark.parametrize(
    ("name", "given", "expected"),
    [
        ("ward", {"ks": 1, "m": 0.2}, 0.895),
        ("cook_torrance", {"ks": 1, "m": 0.1, "F0": 1}, 1.000),
        ("ggx", {"ks": 1, "alpha": 0.5, "F0": 1}, 0.69),
        ("ggx", {"ks": 1, "alpha": 1, "F0": 1}, 0.31),
        ("oren_nayar", {"Rd": 1, "sigma": 0.3}, 0.962),
        ("ashikhmin_shirley", {"Rs": 1, "n": 10}, 0.70),
        ("ashikhmin_shirley", {"Rd": 1, "Rs": 0.5, "n": 100}, 0.965),
    ],
)
def test_albedo_along_the_normal(name: str, given: dict[str, float], expected: float) -> None:
    assert albedo(name, **given) == pytest.approx(expected, abs=0.006)
