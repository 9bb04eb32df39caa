"""Laws held against models that keep them, and against models with a breach hidden in a corner."""

from __future__ import annotations

import math
from functools import cache

import pytest
from law_models import reflectance

from brdfc.lang.load import load_text
from brdfc.lang.model import Model
from brdfc.laws.claims import Claim, LawResult
from brdfc.laws.examine import examine
from brdfc.laws.reflectance import Reflectance
from brdfc.symbolic.expression import const, make, quantity

LAWFUL = Claim("energy", 1, text="energy <= 1")
SHARED = Claim(
    "energy",
    1,
    condition=make("le", make("add", quantity("Rd", 3), quantity("ks", 1)), const(1)),
    text="energy <= 1 where Rd + ks <= 1",
)


@cache
def found(name: str, claim: Claim, plus: str = "", times: str = "1") -> LawResult:
    result = examine(reflectance(name, plus, times), claim)
    assert result.settled
    return result


@pytest.mark.parametrize(
    "name", ["lambert", "ward", "ward_duer", "ward_gmd", "minnaert", "ggx", "phong", "lafortune"]
)
def test_reciprocal_and_positive_models_are_found_so(name: str) -> None:
    both_ways = found(name, Claim("reciprocal"))
    assert both_ways.holds
    assert both_ways.worst < 1e-14
    assert found(name, Claim("positive")).holds


def test_the_formula_as_printed_is_not_reciprocal() -> None:
    result = found("ward_printed", Claim("reciprocal"))
    assert not result.holds
    assert result.worst > 0.98


def test_a_term_that_depends_on_one_way_at_grazing_alone_is_found() -> None:
    result = found("ward_gmd", Claim("reciprocal"), " + 0.001*max(0, 0.02 - co)")
    assert not result.holds
    angles = [math.degrees(result.at[name][0]) for name in ("incident", "reflection")]
    assert max(angles) > 88.8


def test_the_rounding_of_float64_is_no_breach() -> None:
    # ci co, but the addition of a large number leaves only 9 digits of it.
    noisy = " + 0.01*(ci + 10000000 - 10000000)*co"
    result = found("lambert", Claim("reciprocal"), noisy)
    assert result.holds
    assert result.worst < 1e-14


def test_a_dip_below_zero_in_a_corner_is_found() -> None:
    dip = " - max(0, m - 0.95)*max(0, 0.05 - ks)*max(0, 0.1 - co)"
    result = found("ward_gmd", Claim("positive"), dip)
    assert not result.holds
    assert result.worst < 0
    assert result.at["m"][0] > 0.95
    assert result.at["ks"][0] < 0.05


def test_where_the_formula_has_no_value_it_is_not_positive() -> None:
    result = found("lambert", Claim("positive"), " + 0*sqrt(co - 0.001)")
    assert not result.holds
    assert "no value" in str(result)


def test_energy_is_kept_or_broken() -> None:
    assert found("lambert", LAWFUL).worst == pytest.approx(1, abs=1e-5)
    assert found("lambert", LAWFUL).holds
    wide = found("phong", LAWFUL)
    assert not wide.holds
    assert wide.worst == pytest.approx(2, abs=1e-2)


def test_energy_is_kept_where_the_coefficients_share_it() -> None:
    result = found("ward_gmd", SHARED)
    assert result.holds
    assert result.worst == pytest.approx(1, abs=1e-4)
    assert all(rd + result.at["ks"][0] <= 1 for rd in result.at["Rd"])


def test_energy_gained_at_one_roughness_alone_is_found() -> None:
    peak = "1 + 0.01*exp(-((m - 0.2)/0.01)^2)"
    result = found("ward_gmd", SHARED, times=peak)
    assert not result.holds
    assert result.worst > 1.005
    assert result.at["m"][0] == pytest.approx(0.2, abs=0.005)


def test_a_bound_is_held_against_the_peak_of_the_narrowest_lobe() -> None:
    peak = 1 / math.pi + (10000 + 2) / (2 * math.pi)
    assert found("phong", Claim("bounded", peak * (1 + 1e-6))).holds
    too_low = found("phong", Claim("bounded", peak * 0.999))
    assert not too_low.holds
    assert too_low.worst == pytest.approx(peak, rel=1e-4)


def test_increasing_quantities_never_lower_the_radiance() -> None:
    assert found("ggx", Claim("increasing", quantities=("Rd", "ks", "F0"))).holds
    assert found("lambert", Claim("increasing", quantities=("Rd",))).worst == 0


def test_a_fall_in_one_corner_is_found() -> None:
    less = " - 0.01*max(0, ks - 0.95)*Rd"
    result = found("ward_gmd", Claim("increasing", quantities=("Rd", "ks")), less)
    assert not result.holds
    assert result.at["ks'"][0] > max(0.95, result.at["ks"][0])


@pytest.mark.parametrize(("radiance", "reciprocal"), [("ci*Rd/pi", True), ("ci*ci*Rd/pi", False)])
def test_a_model_need_not_depend_on_all_directions(radiance: str, reciprocal: bool) -> None:
    text = f"""model t "T"
channel Rd : XYZ in 0..1 = 0.5
env incident : angle in 0deg..90deg = 45deg as inci
let ci = cos(incident)
radiance = {radiance} where ci > 0 else 0*Rd
"""
    lacking = load_text(text, "t.brdf")
    assert isinstance(lacking, Model)
    result = examine(Reflectance(lacking), Claim("reciprocal"))
    assert result.holds == reciprocal
    assert "azimuth" not in str(result)
    assert examine(Reflectance(lacking), LAWFUL).holds


def test_what_is_found_is_said_in_one_line() -> None:
    line = str(found("ward_printed", Claim("reciprocal")))
    assert line.startswith("reciprocal: relative difference 1 at worst (incident=")
    assert "deg " in line
    assert line.endswith(" pairs")
    assert str(found("ward_gmd", SHARED)).startswith("energy <= 1 where Rd + ks <= 1: 1 at worst (")


def test_the_same_search_finds_the_same_point() -> None:
    assert examine(reflectance("lambert"), LAWFUL) == found("lambert", LAWFUL)
    assert examine(reflectance("ggx"), Claim("positive")) == found("ggx", Claim("positive"))


def test_an_unknown_law_is_refused() -> None:
    with pytest.raises(ValueError, match="elegant"):
        examine(reflectance("lambert"), Claim("elegant"))
