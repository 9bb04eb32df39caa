"""The library against two programs that nobody here wrote: Mitsuba 3 and SCATMECH."""

from __future__ import annotations

import mitsuba_bsdf as mitsuba
import numpy as np
import pytest
import scatmech_bsdf as scatmech
from judged_cases import Case, mitsuba_cases, scatmech_cases
from library import composed
from numpy.typing import DTypeLike
from unit_vectors import PAIRS, diffuse_light, pairs

FLOOR = 1e-15
"""1/sr; below it values are not compared, for Mitsuba sets distributions under 1e-20 to zero."""


def difference(case: Case, precision: DTypeLike) -> float:
    """The worst difference relative to the library, where that is above the floor."""
    light, viewer = pairs(case.width, precision)
    judged = case.judge(light, viewer, **case.judged)[:, None]
    value = case.formula(light, viewer, **case.given)
    compared = value > FLOOR
    assert compared.sum() > PAIRS
    return float((np.abs(judged - value)[compared] / value[compared]).max())


@pytest.mark.parametrize("case", mitsuba_cases(), ids=str)
def test_the_library_is_as_mitsuba_has_it(case: Case) -> None:
    pytest.importorskip("mitsuba", reason="Mitsuba is not installed: pip install brdfc[test]")
    assert difference(case, np.float32) <= case.tolerance


@pytest.mark.parametrize("case", scatmech_cases(), ids=str)
def test_the_library_is_as_scatmech_has_it(case: Case) -> None:
    pytest.importorskip("SCATPY", reason="SCATMECH is not installed: pip install brdfc[judges]")
    assert difference(case, np.float64) <= case.tolerance


@pytest.mark.parametrize("n", [1.2, 1.5, 1.9])
def test_the_judges_take_internal_reflectance_from_approximations(n: float) -> None:
    """Why bodies under an interface are compared with the judge's own constant."""
    light = diffuse_light(200_000)
    outside = composed("dielectric(n, cos_incident)")(light, light, n=n).mean()
    exact = 1.0 - (1.0 - outside) / n**2
    assert mitsuba.internal_reflectance(n) == pytest.approx(exact, rel=1e-3)
    assert scatmech.internal_reflectance(n) == pytest.approx(exact, rel=1e-3)
