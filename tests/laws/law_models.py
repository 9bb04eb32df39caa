"""Models in the full geometry, written out for the tests: the half vector, and a radiance."""

from __future__ import annotations

import math

from brdfc.lang.load import load_text
from brdfc.lang.model import Model
from brdfc.laws.reflectance import ANGLES, Reflectance

_GEOMETRY = """
env incident : angle in 0deg..90deg = 45deg as inci
env reflection : angle in 0deg..90deg = 0deg as refl
env incident_azimuth : angle in -180deg..180deg = 0deg as inca
env reflection_azimuth : angle in -180deg..180deg = 180deg as refa
constant intensity : number in 0..100 = 1

let ci = cos(incident)
let co = cos(reflection)
let lx = sin(incident)*cos(incident_azimuth)
let ly = sin(incident)*sin(incident_azimuth)
let vx = sin(reflection)*cos(reflection_azimuth)
let vy = sin(reflection)*sin(reflection_azimuth)
let hx = lx + vx
let hy = ly + vy
let hz = ci + co
let hh = hx^2 + hy^2 + hz^2
let t2 = (hx^2 + hy^2)/hz^2
let c = hz/sqrt(hh)
let d = sqrt(hh)/2
let s = lx*vx + ly*vy
"""

_DIFFUSE = "channel Rd : XYZ in 0..1 = 0.5\n"
_WARD = _DIFFUSE + (
    "channel ks : number in 0..1 = 0.05\nchannel m : roughness in 0.001..1 = 0.15\n"
)
_LOBE = "exp(-t2/m^2)/(4*pi*m^2)"
_TEXTS = {
    "lambert": (_DIFFUSE, "Rd/pi"),
    "ward": (_WARD, f"Rd/pi + ks*{_LOBE}/sqrt(ci*co)"),
    "ward_duer": (_WARD, f"Rd/pi + ks*{_LOBE}/(ci*co)"),
    "ward_gmd": (_WARD, "Rd/pi + ks*hh*exp(-t2/m^2)/(pi*m^2*(ci + co)^4)"),
    "ward_gmd_anisotropic": (
        _DIFFUSE + "channel ks : number in 0..1 = 0.05\n"
        "channel mx : roughness in 0.001..1 = 0.15\nchannel my : roughness in 0.001..1 = 0.15\n",
        "Rd/pi + ks*hh*exp(-((hx/mx)^2 + (hy/my)^2)/hz^2)/(pi*mx*my*(ci + co)^4)",
    ),
    "ward_printed": (_WARD, f"Rd/pi + ks*{_LOBE}/sqrt(ci*co)/ci"),
    "minnaert": (
        _DIFFUSE + "channel k : number in 0.25..2 = 1\n",
        "Rd*(k + 1)/(2*pi)*(ci*co)^(k - 1)",
    ),
    "ggx": (
        _DIFFUSE
        + "channel ks : number in 0..1 = 0.5\nchannel alpha : roughness in 0.001..1 = 0.3\n"
        "channel F0 : number in 0..1 = 0.04\n",
        "Rd/pi + ks*(F0 + (1 - F0)*(1 - min(d, 1))^5)"
        "*alpha^2/(pi*((hx^2 + hy^2)/hh + alpha^2*c^2)^2)"
        "*0.5/(co*sqrt(alpha^2 + (1 - alpha^2)*ci^2) + ci*sqrt(alpha^2 + (1 - alpha^2)*co^2))",
    ),
    "lafortune": (
        _DIFFUSE + "channel ks : number in 0..1000 = 1\nchannel Cxy : number in -1..1 = -1\n"
        "channel Cz : number in -1..1 = 1\nchannel n : number in 1..1000 = 10\n",
        "Rd/pi + ks*max(0, Cxy*s + Cz*ci*co)^n",
    ),
    "phong": (
        _DIFFUSE + "channel ks : number in 0..1 = 1\nchannel n : number in 1..10000 = 50\n",
        "Rd/pi + ks*(n + 2)/(2*pi)*max(0, ci*co - s)^n",
    ),
    "oren_nayar": (
        _DIFFUSE + "channel sigma : number in 0..1.5 = 0.3\n",
        "Rd/pi*(1 - 0.5*sigma^2/(sigma^2 + 0.33)"
        " + 0.45*sigma^2/(sigma^2 + 0.09)*max(0, s)/max(ci, co))",
    ),
    "opposition": (
        _DIFFUSE + "channel h : number in 0.01..1 = 0.1\n",
        "Rd/(4*pi*(ci + co))/(1 + sqrt(max(0, 1 - d^2))/d/h)",
    ),
}


def model(quantities: str, reflectance: str, more: str = "") -> Model:
    """A model with these declarations and this BRDF."""
    text = (
        f'model t "T"\n{quantities}{_GEOMETRY}\n'
        f"radiance = intensity*ci*({reflectance}) where ci > 0 and co > 0 else 0*Rd\n{more}"
    )
    found = load_text(text, "t.brdf")
    assert isinstance(found, Model)
    return found


def named(name: str, plus: str = "", times: str = "1", more: str = "") -> Model:
    """A model of the field, its BRDF changed by a factor and a term."""
    quantities, reflectance = _TEXTS[name]
    return model(quantities, f"({reflectance})*({times}){plus}", more)


def reflectance(name: str, plus: str = "", times: str = "1") -> Reflectance:
    """The BRDF of such a model."""
    return Reflectance(named(name, plus, times))


def given(name: str, **values: float | tuple[float, ...]) -> dict[str, tuple[float, ...]]:
    """A point of such a model: zeniths and azimuths in degrees, what is left out at its default,
    but the diffuse part at 0."""
    point = {q.name: q.default for q in named(name).quantities} | {"Rd": (0.0, 0.0, 0.0)}
    for key, value in values.items():
        components = value if isinstance(value, tuple) else (value,)
        is_angle = key in ANGLES
        point[key] = tuple(math.radians(c) if is_angle else float(c) for c in components)
    return point
