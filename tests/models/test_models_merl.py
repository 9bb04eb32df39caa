"""The parameters published for the MERL materials, in the models that they are meant for."""

from __future__ import annotations

import numpy as np
import pytest
from library import Array, reflectance
from merl_parameters import FOLDER, PUBLISHED, pixels, published, read

import brdfc

needs_fits = pytest.mark.skipif(
    not FOLDER.is_dir(), reason="the published fits are not beside the checkout"
)

ZENITHS = (0.0, 15.0, 45.0, 70.0, 85.0, 89.0, 89.9, 90.0)


@needs_fits
@pytest.mark.parametrize("model", PUBLISHED)
def test_a_model_takes_all_published_parameters(model: str) -> None:
    materials = published(model)
    assert len(materials) == PUBLISHED[model].materials
    for quantity in brdfc.load(model).quantities:
        if quantity.role.value != "channel":
            continue
        values = np.array([values[quantity.name] for values in materials.values()])
        assert quantity.low <= values.min(), quantity.name
        assert values.max() <= quantity.high, quantity.name


@needs_fits
@pytest.mark.parametrize("model", PUBLISHED)
def test_one_program_has_a_value_for_every_material(model: str) -> None:
    """Finite and not negative at every pair of angles, and the same in X, Y and Z."""
    pair = brdfc.compile(brdfc.load(model), highlight="equal")
    materials = published(model)
    for incident in np.radians(ZENITHS):
        for reflection in np.radians([*ZENITHS, *(-z for z in ZENITHS)]):
            env = {"incident": incident, "reflection": reflection}
            link = brdfc.connect(pair.mid, pair.mvis, env=env)
            values = link.apply(pixels(link.channels, materials))
            assert np.isfinite(values).all()
            assert (values >= 0.0).all()
            assert (values == values[..., :1]).all()


def energies(model: str) -> dict[str, float]:
    """Energy of every material's lobe, in its mean colour: the integral of f cos(theta_r) over
    theta_r in the plane of incidence, at 45 deg."""
    step = np.radians(0.05)
    theta = np.arange(-np.pi / 2 + step / 2, np.pi / 2, step)
    viewer = np.stack([-np.sin(theta), 0.0 * theta, np.cos(theta)], axis=1)
    light = np.broadcast_to(np.sqrt([0.5, 0.0, 0.5]), viewer.shape)
    f = reflectance(model)

    def energy(channels: dict[str, Array]) -> float:
        mean = {name: value.mean() for name, value in channels.items()}
        return float((f(light, viewer, **mean | {"Rd": 0.0})[:, 0] * np.cos(theta)).sum() * step)

    return {name: energy(channels) for name, channels in published(model).items()}


@needs_fits
@pytest.mark.parametrize(
    ("model", "constant", "other_constant", "median", "other_median"),
    [
        ("cook_torrance_ngan", np.pi**2, np.pi, 0.91, 2.87),
        ("cook_torrance_ngan", np.pi**2, 4.0 * np.pi, 0.91, 0.72),
        ("cook_torrance_1982", np.pi, np.pi**2, 1.15, 0.37),
        ("abc_microfacet", np.pi, 1.0, 1.40, 4.39),
    ],
)
def test_published_lobes_carry_the_energy_of_the_same_materials_ward_fits(
    model: str, constant: float, other_constant: float, median: float, other_median: float
) -> None:
    """With the constant under F D G/(n.l n.v) that the model has; not with the other."""
    lobe, ward = energies(model), energies("ward")
    ratio = float(np.median([lobe[name] / ward[name] for name in ward]))
    assert ratio == pytest.approx(median, abs=0.006)
    assert ratio * constant / other_constant == pytest.approx(other_median, abs=0.006)


LINE = (
    "steel = Aggregate(Lambertian(albedo = [0.1, 0.2, 0.3]), "
    "NganWard(albedo = [0.01, 0.02, 0.03], roughness = 0.05))"
)


def test_a_material_is_three_pixels_one_a_colour() -> None:
    ((body, lobe),) = read(f"# comment\n{LINE}\n", "NganWard").values()
    values = {"Rd": body["albedo"], "ks": lobe["albedo"], "m": lobe["roughness"]}
    (colours,) = pixels(("Rdx", "Rdy", "Rdz", "ks", "m"), {"steel": values})
    assert colours.tolist() == [
        [0.1, 0.1, 0.1, 0.01, 0.05],
        [0.2, 0.2, 0.2, 0.02, 0.05],
        [0.3, 0.3, 0.3, 0.03, 0.05],
    ]


@pytest.mark.parametrize(
    "text",
    [
        LINE.replace("NganWard", "NganWardDuer"),
        LINE.replace("0.1, 0.2, 0.3", "0.1, 0.2"),
        LINE.replace("roughness = 0.05", "roughness"),
        f"{LINE}\n{LINE}",
        "steel = Lambertian(albedo = [0.1, 0.2, 0.3])",
    ],
)
def test_a_line_of_another_form_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"steel|albedo"):
        read(text, "NganWard")
