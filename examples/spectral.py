"""A measured spectral sample through a profile: reflectances, then colours under any light.

    python examples/spectral.py GARNET_RED.brdf [FOLDER]

The file is one of the spectral goniometer measurements of Cornell's Program of Computer Graphics,
as they travel with pbrt-v2 (scenes/brdfs): the number of wavelengths, the wavelengths, then records
of theta_i, phi_i, theta_s, phi_s and a reflectance [1/sr] for each wavelength. A Lambert and a GGX
lobe are fitted to it; the model, compiled with wavelengths, gives the spectra back at the measured
angles, and their colours under lights the profile does not know are held against those of the
measured spectra.
"""

from __future__ import annotations

import itertools
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import brdfc
from brdfc.cmm.rendering import spectral_grid
from brdfc.colour.difference import ciede2000
from brdfc.source.errors import BrdfcError
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.formula import formula

Array = NDArray[np.float64]

ROUGHNESSES = np.geomspace(0.005, 0.6, 40)
NORMAL_REFLECTANCES = (0.02, 0.04, 0.08, 0.16, 0.32, 1.0)
LIGHTS = ("D50", "A", "FL11")


def measured(path: str | Path) -> tuple[Array, dict[str, Array], Array]:
    """Wavelengths; the angles of each record in the full geometry; reflectances (records, n)."""
    try:
        lines = Path(path).read_text().splitlines()
        words = " ".join(line.partition("#")[0] for line in lines).split()
        count = int(words[0])
        numbers = np.array(words[1:], dtype=np.float64)
        records = numbers[count:].reshape(-1, 4 + count)
    except (OSError, ValueError, IndexError) as error:
        raise BrdfcError(f"no such measurement: {error}", where=str(path)) from None
    # Both azimuths are measured from one direction there as here; 180 degrees is the mirror side.
    turned = np.where(records[:, 3] > np.pi, records[:, 3] - 2 * np.pi, records[:, 3])
    angles = {
        "incident": records[:, 0],
        "reflection": records[:, 2],
        "incident_azimuth": records[:, 1],
        "reflection_azimuth": turned,
    }
    return numbers[:count], angles, records[:, 4:]


def lobes(angles: dict[str, Array]) -> Iterator[tuple[float, float, Array]]:
    """Every alpha and F0 of the grid, and what GGX with ks = 1 then reflects, (records,) [1/sr]:
    the library's formula in float64."""
    fixed = {"Rd": (0.0,) * 3, "ks": (1.0,), "intensity": (1.0,)}
    exact = formula(brdfc.load("ggx", "full"), fixed).exact
    env = {name: values[:, None] for name, values in angles.items()}
    for alpha, f0 in itertools.product(ROUGHNESSES, NORMAL_REFLECTANCES):
        radiance = evaluate(exact, env | {"alpha": np.array([[alpha]]), "F0": np.array([[f0]])})
        yield alpha, f0, radiance[:, 0] / np.cos(angles["incident"])


def fit(angles: dict[str, Array], found: Array) -> Array:
    """A pixel: Rd by wavelength, then ks, alpha and F0.

    A difference counts by the slope of the cube root, as in lightness, so that neither the
    highlight nor the dark directions decide alone (A. Fores, J. Ferwerda, J. Gu, Color and Imaging
    Conference 20, 2012); Rd and ks are linear, alpha and F0 are searched on a grid.
    """
    cosine = np.cos(angles["incident"])[:, None]
    weight = cosine[:, 0] ** (1 / 3) * (found.mean(axis=1) + 0.01) ** (-2 / 3)
    best, least = np.zeros(0), np.inf
    for alpha, f0, shape in lobes(angles):
        columns = np.stack([np.full_like(shape, 1 / np.pi), shape], axis=1) * weight[:, None]
        solved = np.linalg.lstsq(columns, found * weight[:, None], rcond=None)[0]
        ks = float(np.clip(solved[1].mean(), 0, 1))
        rd = np.pi * (weight**2 @ (found - ks * shape[:, None])) / (weight**2).sum()
        rd = np.clip(rd, 0, 1)
        given = rd / np.pi + ks * shape[:, None]
        error = float(((np.cbrt(given * cosine) - np.cbrt(found * cosine)) ** 2).mean())
        if error < least:
            best, least = np.array([*rd, ks, alpha, f0]), error
    return best


def main() -> None:
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    wavelengths, angles, found = measured(sys.argv[1])
    folder = Path(sys.argv[2] if len(sys.argv) > 2 else "spectral")
    folder.mkdir(parents=True, exist_ok=True)
    pixel = fit(angles, found)
    *rd, ks, alpha, f0 = pixel
    print(f"{Path(sys.argv[1]).stem}: {len(found):,} directions, {len(wavelengths)} wavelengths")
    print(f"fitted ks {ks:.3f}, alpha {alpha:.3f}, F0 {f0:.2f}, and Rd by wavelength:")
    print("  " + " ".join(f"{value:.3f}" for value in rd))

    # One profile with the angles as samples of the pixel: every record in one call.
    first, last, step = wavelengths[0], wavelengths[-1], wavelengths[1] - wavelengths[0]
    model = brdfc.load("ggx", "full", spectral=f"{first:g}nm..{last:g}nm,{step:g}nm")
    compiled = brdfc.compile(model, set={"intensity": np.pi}, channels=tuple(angles))
    compiled.save(folder / "spectral_mvis.icc")
    pixels = np.hstack([np.tile(pixel, (len(found), 1)), np.stack(list(angles.values()), axis=1)])
    link = brdfc.connect(compiled.mid, compiled.mvis, transform="M2S0")
    factors = np.pi * found * np.cos(angles["incident"])[:, None]
    given = brdfc.rendering(link, "spectrum").apply(pixels)
    error = np.median(np.abs(given - factors))
    print(f"\nreflectance factors: median {np.median(factors):.4f}, median error {error:.4f}")
    for light in LIGHTS:
        seen = brdfc.viewing_conditions(light)
        measured_xyz = factors @ seen.reflectances_to_xyz(spectral_grid(compiled.mvis)).T
        profile_xyz = brdfc.rendering(link, conditions=seen).apply(pixels)
        direct_xyz = given @ seen.reflectances_to_xyz(spectral_grid(compiled.mvis)).T
        fitted = ciede2000(profile_xyz, measured_xyz, seen.white)
        exact = ciede2000(profile_xyz, direct_xyz, seen.white)
        print(
            f"under {light:<5} CIEDE2000 to the measured spectra: mean {fitted.mean():.2f}, "
            f"95 % {np.quantile(fitted, 0.95):.2f}; to the profile's own: maximum {exact.max():.1e}"
        )
    print(f"\nprofiles  {folder}/spectral_mid.icc  {folder}/spectral_mvis.icc")


if __name__ == "__main__":
    try:
        main()
    except BrdfcError as error:
        sys.exit(f"error: {error}")
