"""Coefficients of every pixel: those of single fits, and none that look sound and are not."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest
from stacks import D50, coefficients, directions, reflected

from brdfc.fit import pixels
from brdfc.fit.fitting import search
from brdfc.fit.measurements import Kind, checked
from brdfc.fit.pixel_starts import solved_within
from brdfc.fit.pixels import PixelFit
from brdfc.lang.load import load
from brdfc.source.errors import FitError


def fit_of(name: str, **fixed: tuple[float, ...]) -> PixelFit:
    return PixelFit(load(name, "full"), directions(), fixed, D50)


@pytest.mark.parametrize("name", ["lambert", "ward", "ggx"])
def test_exact_pixels_give_the_coefficients_back(name: str) -> None:
    truth = coefficients(name, 8, 9).reshape(72, -1)
    found = fit_of(name)(reflected(name, truth))
    assert found.converged.all()
    assert found.enough.all()
    assert (found.geometries == 40).all()
    assert (found.loss < 1e-6).all()
    np.testing.assert_allclose(found.coefficients, truth, rtol=5e-3, atol=1e-4)


@pytest.mark.parametrize(("name", "bound"), [("lambert", 0.005), ("ward", 0.02), ("ggx", 0.15)])
def test_noise_moves_coefficients_a_little(name: str, bound: float) -> None:
    truth = coefficients(name, 20, 20).reshape(400, -1)
    found = fit_of(name)(reflected(name, truth, 0.02))
    assert found.converged.mean() > 0.995
    assert np.percentile(np.abs(found.coefficients - truth), 99) < 2 * bound
    assert np.median(np.abs(found.coefficients - truth)) < bound / 4


@pytest.mark.parametrize(("name", "noise"), [("ward", 0.01), ("ward", 0.1), ("ggx", 0.03)])
def test_they_are_those_of_single_fits(name: str, noise: float) -> None:
    truth = coefficients(name, 40, 50)[::8, ::7].reshape(40, -1)
    values = reflected(name, truth, noise)
    fit = fit_of(name)
    found = fit(values)
    empty = checked(directions(), np.ones((40, 3)), Kind.XYZ, white=D50)
    for pixel in range(0, 40, 3):
        measured = replace(empty, values=values[pixel].astype(float))
        single = search(fit.response, measured, "cube-root", starts=6)
        assert found.loss[pixel] <= 1.01 * single.loss
        if found.loss[pixel] >= 0.999 * single.loss:
            apart = np.abs(found.coefficients[pixel] - single.coefficients)
            assert apart.max() < (0.05 if name == "ggx" else 2e-3)


@pytest.mark.parametrize("name", ["ashikhmin_shirley", "cook_torrance", "ward_anisotropic"])
def test_other_models_of_the_library(name: str) -> None:
    """With two, three and four coefficients that are not linear."""
    fit = fit_of(name)
    random = np.random.default_rng(2)
    truth = np.array(
        [[random.uniform(*_middle(c.low, c.high)) for c in fit.response.coefficients] for _ in "ab"]
    )
    found = fit(fit.response.values(truth))
    assert (found.loss[found.converged] < 0.02).all()
    assert (found.loss >= 0).all()


def _middle(low: float, high: float) -> tuple[float, float]:
    if low > 0 and high / low > 50:
        return low * (high / low) ** 0.4, low * (high / low) ** 0.7
    return low + 0.2 * (high - low), low + 0.6 * (high - low)


def test_a_pixel_does_not_know_its_neighbours() -> None:
    """However pixels are put together, the numbers are the same to the last bit."""
    fit = fit_of("ward")
    values = reflected("ward", coefficients("ward", 20, 40).reshape(800, -1), 0.05)
    values[::7, 3] = np.nan
    whole = fit(values).coefficients
    np.testing.assert_array_equal(fit(values[131:400]).coefficients, whole[131:400])
    np.testing.assert_array_equal(fit(values[::-1]).coefficients, whole[::-1])
    np.testing.assert_array_equal(fit(values[5:6]).coefficients, whole[5:6])


def test_another_process_computes_the_same() -> None:
    fit = fit_of("ggx", F0=(0.04,))
    values = reflected("ggx", coefficients("ggx", 4, 5).reshape(20, -1), 0.05)
    again = pickle.loads(pickle.dumps(fit))(values)
    np.testing.assert_array_equal(again.coefficients, fit(values).coefficients)
    assert again.coefficients.shape == (20, 5)


def test_what_is_masked_does_not_count() -> None:
    truth = coefficients("ward", 5, 6).reshape(30, -1)
    values = reflected("ward", truth)
    values[:, 5] = np.nan  # a geometry
    values[::2, 9, 1] = -1  # a sample
    values[3, :, 0] = np.nan  # a band of a pixel: nothing is known of its Rdx
    values[4] = np.nan
    values[6, 3:] = np.nan  # as many geometries as coefficients, and more than samples need
    found = fit_of("ward")(values)
    sound = np.setdiff1d(np.arange(30), [3, 4])
    assert found.geometries[[0, 1, 3, 4, 6]].tolist() == [38, 39, 0, 0, 3]
    assert found.enough[sound].all()
    assert not found.enough[[3, 4]].any()
    assert not found.converged[[3, 4]].any()
    assert np.isnan(found.coefficients[[3, 4]]).all()
    assert np.isnan(found.loss[[3, 4]]).all()
    sound = np.setdiff1d(sound, [6])
    np.testing.assert_allclose(found.coefficients[sound], truth[sound], rtol=5e-3, atol=1e-4)


def test_what_is_cut_off_has_not_converged(monkeypatch: pytest.MonkeyPatch) -> None:
    values = reflected("ward", coefficients("ward", 5, 5).reshape(25, -1), 0.05)
    monkeypatch.setattr(pixels, "MOST_STEPS", 1)
    cut = fit_of("ward")(values)
    assert not cut.converged.any()
    assert np.isfinite(cut.coefficients).all()


def test_converged_is_where_nothing_near_is_better() -> None:
    fit = fit_of("ward")
    values = reflected("ward", coefficients("ward", 6, 6).reshape(36, -1), 0.1)
    found = fit(values)
    low = np.array([c.low for c in fit.response.coefficients])
    high = np.array([c.high for c in fit.response.coefficients])
    seen = np.cos(directions()[:, :1])

    def loss(at: np.ndarray) -> np.ndarray:
        apart = np.cbrt(fit.response.values(at) * seen) - np.cbrt(values * seen)
        return np.sqrt((apart**2).mean(axis=(1, 2)))

    here = loss(found.coefficients)
    np.testing.assert_allclose(here, found.loss, rtol=1e-6)
    random = np.random.default_rng(4)
    for size in (1e-3, 1e-2, 0.1):
        for _ in range(20):
            near = found.coefficients * (1 + size * random.standard_normal((36, 5)))
            assert (
                loss(np.clip(near, low, high))[found.converged]
                >= here[found.converged] * (1 - 1e-5)
            ).all()


def test_coefficients_at_the_ends_of_their_ranges() -> None:
    """Dark, white and matte pixels: still within, and said to be fitted."""
    x, y, z = D50  # what a diffuser that reflects all has
    truth = np.array([[0, 0, 0, 0.05, 0.2], [x, y, z, 0.0, 0.2], [x / 2, 0, z, 0.3, 1.0]])
    found = fit_of("ward")(reflected("ward", truth))
    assert found.converged.all()
    np.testing.assert_allclose(found.coefficients[:, :4], truth[:, :4], atol=1e-4)
    # A matte pixel says nothing of m: it is what the model declares, about.
    assert found.coefficients[1, 4] == pytest.approx(0.15, rel=0.3)


def test_hostile_numbers() -> None:
    values = np.zeros((4, 40, 3), np.float32)
    values[1] = 1e12
    values[2] = 1e-38
    values[3, ::2] = 1e12
    found = fit_of("ward")(values)
    assert np.isfinite(found.coefficients).all()
    assert (found.coefficients >= 0).all()


def test_too_few_geometries() -> None:
    with pytest.raises(FitError, match="2 geometries for 5 coefficients of 'ward'; 3 are needed"):
        PixelFit(load("ward", "full"), directions()[:2])
    PixelFit(load("lambert", "full"), directions()[:1])


def test_normal_equations_within_ranges() -> None:
    random = np.random.default_rng(0)
    rows = random.standard_normal((50, 6, 3))
    matrix = np.einsum("qna,qnb->qab", rows, rows)
    target = random.standard_normal((50, 3)) * 4
    pairs = {(a, b): matrix[:, a, b] for a in range(3) for b in range(a, 3)}
    found = np.stack(solved_within(pairs, list(target.T), [0.0] * 3, [1.0] * 3), axis=1)
    free = np.linalg.solve(matrix, target[..., None])[..., 0]
    inside = ((free >= 0) & (free <= 1)).all(axis=1)
    np.testing.assert_allclose(found[inside], free[inside], rtol=1e-6)
    assert ((found >= 0) & (found <= 1)).all()
