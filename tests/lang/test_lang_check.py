"""Good texts: the Model that they become. (Bad ones are in test_lang_golden.py.)"""

from __future__ import annotations

import math

import pytest

from brdfc.lang.load import load_text
from brdfc.lang.model import Definition, Model, Module, Quantity, Role
from brdfc.lang.report import Report
from brdfc.lang.typecheck import TypeChecker
from brdfc.source.errors import ModelError
from brdfc.source.span import Source

WARD = """\
model ward "Isotropic Ward"
  cite "eq. 5a"
channel Rd : XYZ in 0..1 = (0.1, 0.2, 0.3) "diffuse reflectance"
channel ks : number in 0.01..1
channel m : roughness in 0.001..1 = 0.15
env incident : angle in -90deg..90deg = 45deg as inci
env reflection : angle in -1.5rad..1.5rad = 0deg as "r-1"
constant intensity : number in 0..100 = 1
let delta = (incident - reflection)/2
let lobe(x, r : roughness) = let q = tan(x)^2/r^2 in exp(-q) / (4*pi*r^2)
radiance = intensity*Rd*cos(incident)/pi + ks*lobe(delta, m)
  where cos(incident) > 0 and cos(reflection) > 0 else 0
law reciprocal
law energy <= 2
example incident=40deg Rd=0.5 m=0.2 -> (1, 2, 3) within 1e-4
example -> (1, 2, 3)
"""


def model(text: str) -> Model:
    found = load_text(text, "test.brdf")
    assert isinstance(found, Model)
    return found


def radiance_type(declarations: str, formula: str) -> str:
    """The type of a formula over some quantities, in words."""
    found = model(f'model t "t"\n{declarations}\nlet result = {formula}\nradiance = 1\n')
    (result,) = found.definitions
    return str(TypeChecker(Report(Source("t", ""))).check(result))


def test_a_whole_model() -> None:
    ward = model(WARD)
    assert (ward.name, ward.title, ward.citations) == ("ward", "Isotropic Ward", ("eq. 5a",))
    assert ward.origin == "test.brdf"
    rd, ks, m, incident, reflection, intensity = ward.quantities
    assert (rd.role, rd.low, rd.high, rd.default) == (Role.CHANNEL, 0, 1, (0.1, 0.2, 0.3))
    assert rd.component_names == ("Rdx", "Rdy", "Rdz")
    assert rd.description == "diffuse reflectance"
    assert ks.default == (0.01,), "the value in its range that is nearest to 0"
    assert m.default == (0.15,)
    assert (incident.low, incident.high) == (-math.pi / 2, math.pi / 2)
    assert incident.default == (45.0 * math.pi / 180,)
    assert (reflection.low, reflection.signature) == (-1.5, "r-1")
    assert (intensity.role, intensity.default) == (Role.CONSTANT, (1.0,))
    assert [d.name for d in ward.definitions] == ["delta", "lobe"]
    assert [(law.name, law.bound) for law in ward.laws] == [("reciprocal", None), ("energy", 2.0)]
    first, second = ward.examples
    assert first.given["incident"] == (40.0 * math.pi / 180,)
    assert first.given["Rd"] == (0.5, 0.5, 0.5), "one number for all components"
    assert first.given["ks"] == (0.01,), "what is not given has its default"
    assert (first.result, first.within) == ((1.0, 2.0, 3.0), 1e-4)
    assert (second.given["m"], second.within) == ((0.15,), 1e-5)
    assert ward.quantity("inci") is incident
    assert ward.quantity("m") is m
    assert ward.quantity("none") is None


def test_scopes_hold_what_names_refer_to() -> None:
    ward = model(WARD)
    assert isinstance(ward.radiance.scope["lobe"], Definition)
    assert isinstance(ward.radiance.scope["Rd"], Quantity)
    assert all(d.scope is ward.radiance.scope for d in ward.definitions)


def test_a_reflectance_may_leave_out_its_range() -> None:
    (quantity,) = model('model r "r"\nchannel k : reflectance\nradiance = k').quantities
    assert (quantity.low, quantity.high, quantity.default) == (0.0, 1.0, (0.0,))


def test_a_spectrum_has_one_channel_a_wavelength() -> None:
    text = 'model s "s"\nchannel R : spectrum(400nm..700nm, 150nm) in 0..1 = 0.5\nradiance = R'
    (quantity,) = model(text).quantities
    assert quantity.component_names == ("R_400", "R_550", "R_700")
    assert quantity.default == (0.5, 0.5, 0.5)


def test_definitions_may_stand_in_any_order() -> None:
    model('model o "o"\nradiance = a\nlet a = f(m)\nlet f(x) = x*m\nchannel m : number in 0..1')


def test_a_module_has_definitions_only() -> None:
    found = load_text('module f "functions"\nlet f(x) = x\nlet half = 0.5', "f.brdf")
    assert isinstance(found, Module)
    assert [d.name for d in found.definitions] == ["f", "half"]


def test_a_let_may_name_a_condition() -> None:
    model('model c "c"\nchannel m : number in 0..1\nlet lit = m > 0\nradiance = 1 where lit else 0')


QUANTITIES = """\
channel n : number in 0..1
channel v : XYZ in 0..1
channel t : angle in 0deg..90deg"""


@pytest.mark.parametrize(
    ("formula", "type_"),
    [
        ("t + 1deg", "an angle"),
        ("t - t", "an angle"),
        ("2*t", "an angle"),
        ("t*n/2", "an angle"),
        ("-t", "an angle"),
        ("t/1rad", "a number"),
        ("n*1rad", "an angle"),
        ("asin(n) + atan2(n, 1)", "an angle"),
        ("radians(t)^2 + degrees(t)", "a number"),
        ("abs(t)", "an angle"),
        ("max(t, 1deg, 2deg)", "an angle"),
        ("clamp(t, 0deg, 80deg)", "an angle"),
        ("sign(t)", "a number"),
        ("cos(t*v)", "a vector of 3"),
        ("t*v", "a vector of 3 angles"),
        ("exp(v)*n", "a vector of 3"),
        ("max(v, 0)", "a vector of 3"),
        ("v^2 + v", "a vector of 3"),
        ("dot(v, v)", "a number"),
        ("length((n, n))", "a number"),
        ("cross(v, (1, 2, 3))", "a vector of 3"),
        ("normalize(v)", "a vector of 3"),
        ("v.y + (1, 2).x", "a number"),
        ("(t, t)", "a vector of 2 angles"),
        ("v where n > 0 else 0", "a vector of 3"),
        ("t where t > 0deg and not n == 1 else 0deg", "an angle"),
        ("let q = t in let r = q in sin(r)", "a number"),
        ("n > 0 or t < 1rad", "a condition"),
        ("pi*1rad", "an angle"),
    ],
)
def test_types(formula: str, type_: str) -> None:
    assert radiance_type(QUANTITIES, formula) == type_


def test_a_function_is_checked_for_the_types_it_is_called_with() -> None:
    text = "let f(x) = 2*x\nlet g(x) = f(f(x))\n"
    for formula, type_ in (("g(t)", "an angle"), ("g(v)", "a vector of 3"), ("g(n)", "a number")):
        found = model(f'model t "t"\n{QUANTITIES}\n{text}let result = {formula}\nradiance = 1')
        assert str(TypeChecker(Report(Source("t", ""))).check(found.definitions[-1])) == type_


def test_doubling_functions_are_checked_once_for_each_type() -> None:
    chain = "".join(f"let f{i}(x) = f{i - 1}(x) + f{i - 1}(x)\n" for i in range(1, 60))
    model(f'model d "d"\nlet f0(x) = x\n{chain}radiance = f59(2)')


@pytest.mark.parametrize("backwards", [False, True])
def test_lets_on_lets_end_somewhere(backwards: bool) -> None:
    def chain(length: int) -> str:
        lets = [f"let a{i} = a{i - 1}" for i in range(1, length)]
        return "\n".join(['model d "d"', "let a0 = 1", *(lets[::-1] if backwards else lets),
                          f"radiance = a{length - 1}"])  # fmt: skip

    model(chain(140))
    with pytest.raises(ModelError, match="150 levels deep") as caught:
        load_text(chain(5000))
    assert len(caught.value.diagnostics) == 1


def test_functions_on_functions_end_somewhere() -> None:
    chain = "".join(f"let f{i}(x) = 1 + f{i - 1}(x)\n" for i in range(1, 500))
    with pytest.raises(ModelError, match="150 levels deep"):
        load_text(f'model d "d"\nlet f0(x) = x\n{chain}radiance = f499(2)')


def test_many_errors_end_somewhere() -> None:
    lets = "".join(f"let a{i} = b{i}\n" for i in range(3000))
    with pytest.raises(ModelError) as caught:
        load_text(f'model d "d"\n{lets}radiance = 1')
    assert len(caught.value.diagnostics) == 100
